"""What tables on the terminal say: every number, beside made-up reports."""

import numpy as np
import pytest

from towercrane.cranes.tower.sway_frequencies import PendulumFrequencies
from towercrane.motions.motion import rest
from towercrane.motions.plans import Move, Plan
from towercrane.motions.profiles import trapezoid
from towercrane.report.tables.modes import lattice_tables, linear_tables
from towercrane.report.tables.runs import run_tables, verification_tables
from towercrane.report.tables.space import comparison_tables, space_modes_tables
from towercrane.report.tables.studies import sensitivity_tables, shape_tables, sweep_tables
from towercrane.studies.candidates import candidates

ASSUMED = [{"key": "a.key", "value": "3 m", "why": "some reason"}]


@pytest.fixture(autouse=True)
def _wide(monkeypatch):
    monkeypatch.setattr("towercrane.report.tables.layout.WIDTH_OF_A_PIPE", 400)


def rows_of(text):
    """Cells of every row of every table, and the lines between the tables."""
    lines = text.splitlines()
    rows = [
        [cell.strip() for cell in line.strip("│┃").replace("┃", "│").split("│")] for line in lines if line[:1] in "│┃"
    ]
    return rows, [line.rstrip() for line in lines if line[:1] not in "│┃┏┡└├"]


def said(capsys):
    return rows_of(capsys.readouterr().out)


def run_summary(**changes):
    peak = {"maximum": 1.23456, "maximum_time_s": 2.5, "minimum": -7.891, "minimum_time_s": 11.25, "units": "m"}
    solver = {"method": "dop853", "rtol": 3e-7, "evaluations": 4321, "solver_wall_seconds": 0.125}
    summary = {
        "title": "Some title",
        "crane": "Some crane",
        "peaks": {"some_output": peak, "other_output": {**peak, "maximum": 44.5, "units": "N"}},
        "look_step_s": 0.04,
        "changes": ["a.key=5"],
        "swing_period_s": 8.51239,
        "spectrum_of": "tower_tip_displacement",
        "spectrum_peaks_hz": [0.1175, 0.3123],
        "spectrum_other_hz": [0.6611],
        "spectrum_to_hz": 12.5,
        "spectrum_beyond_hz": [13.25, 340.75],
        "natural_frequencies_hz": [0.1, 0.2, 0.4, 0.8, 1.6, 3.2],
        "energy_balance": {"largest_gap_j": 0.0234, "relative_gap": 5.6e-9},
        "solver": solver,
        "wall_seconds": 0.75,
        "expected": None,
        "notices": ["look twice"],
        "idle": ["crane.x", "crane.y"],
        "assumed": ASSUMED,
    }
    return {**summary, **changes}


def test_a_run(capsys):
    run_tables(run_summary())
    rows, lines = said(capsys)
    assert rows[0] == ["variable", "maximum", "at [s]", "minimum", "at [s]", "unit"]
    assert rows[1:] == [
        ["some output", "1.2346", "2.50", "-7.891", "11.25", "m"],
        ["other output", "44.5", "2.50", "-7.891", "11.25", "N"],
    ]
    assert lines == [
        "Some crane: Some title",
        "extremes are those of looks every 0.04 s",
        "changed               a.key=5",
        "swing period          8.5124 s",
        "spectrum peaks        0.1175, 0.3123 Hz in tower tip displacement, up to 12.5 Hz",
        "                      0.6611 Hz as well, none of the crane's own: lines of drives, wind or a wide swing",
        "                      out of its sight: the crane's 13.25 to 340.8 Hz",
        "natural frequencies   0.1000, 0.2000, 0.4000, 0.8000, 1.6000 Hz where the run ended",
        "energy balance        0.023 J off, 5.6e-09 of the change",
        "solver                dop853, rtol 3e-07, 4321 evaluations, 0.125 s of 0.750 s wall",
        "note     look twice",
        "unused   crane.x, crane.y: keys of the crane file that this run has no use for",
        "assumed  a.key = 3 m: some reason",
    ]


def test_a_run_without_a_swing_or_a_spectrum_and_with_expectations(capsys):
    run_tables(
        run_summary(
            title="Some crane on its own",
            swing_period_s=None,
            spectrum_peaks_hz=[],
            spectrum_other_hz=[],
            spectrum_to_hz=None,
            natural_kinds=["a", "b", "c", "d", "e", "f"],
            expected={"met": False, "misses": ["expected this, got that"]},
        )
    )
    _, lines = said(capsys)
    assert lines[0] == "Some crane on its own"
    assert "swing period          none: no regular swing after the drives stopped" in lines
    assert "spectrum peaks        none Hz in tower tip displacement" in lines
    assert "natural frequencies   0.1000 a, 0.2000 b, 0.4000 c, 0.8000 d, 1.6000 e Hz where the run ended" in lines
    assert "expected by the case  expected this, got that" in lines
    assert not any("out of its sight" in line or "as well" in line for line in lines)
    run_tables(run_summary(expected={"met": True, "misses": []}, spectrum_beyond_hz=[18.77]))
    _, lines = said(capsys)
    assert "expected by the case  met" in lines
    assert "                      out of its sight: the crane's 18.77 Hz" in lines


SETTING = {
    "tower_modes": 2, "jib_modes": 7, "cap": 6.5, "weight_softening": True, "method": "dop853", "rtol": 2e-5,
    "atol": 3e-8,
}  # fmt: skip
WORDS = "2 tower, 7 jib modes capped at 6.5 Hz, with the weight's softening, dop853 at rtol 2.0e-05, atol 3.0e-08"


def test_an_error_that_is_asked_for(capsys):
    outputs = {
        "swing_angle": {"allowed": 2e-4, "estimated": 5e-5, "peak": 0.02, "units": "rad"},
        "rope_tension": {"allowed": 12.0, "estimated": None, "peak": 7858.3, "units": "N"},
    }
    promised = {"outcome": "out of reach", "outputs": outputs, "setting": SETTING, "stated": ["jib_modes", "rtol"],
                "left_out": ["this"], "tried": 19, "choice_cpu_seconds": 0.0137}  # fmt: skip
    run_tables(run_summary(accuracy=promised))
    rows, lines = said(capsys)
    assert rows[-3:] == [
        ["output", "allowed", "expected", "peak", "expected / peak", "unit"],
        ["swing angle", "0.0002", "5e-05", "0.02", "2.5e-03", "rad"],
        ["rope tension", "12", "unknown", "7858", "", "N"],
    ]
    assert "Error asked for: out of reach" in lines
    assert f"chosen                {WORDS}" in lines
    assert "stated by the case    jib modes, rtol; what a case leaves out is chosen" in lines
    assert "left out              this" in lines
    assert "choice                19 settings looked at, 14 ms" in lines


def test_a_verification(capsys):
    outputs = {
        "swing_angle": {"estimated": 5e-5, "actual": 6e-5, "peak": 0.02, "units": "rad"},
        "rope_tension": {"estimated": 9.0, "actual": 4.0, "peak": 8000.0, "units": "N"},
        "other_output": {"estimated": None, "actual": 3.0, "peak": 0.0, "units": "m"},
    }
    plain = {**SETTING, "cap": None, "weight_softening": False, "planar": True}
    report = {"outputs": outputs, "setting": SETTING, "finer": plain, "outcome": "slack rope", "doubts": ["a doubt"]}
    verification_tables(report)
    rows, lines = said(capsys)
    assert rows[1:] == [
        ["swing angle", "5e-05", "6e-05 (!)", "3.0e-03", "rad"],
        ["rope tension", "9", "4", "5.0e-04", "N"],
        ["other output", "unknown", "3", "", "m"],
    ]
    assert f"run                   {WORDS}" in lines
    assert (
        "richer                2 tower, 7 jib modes, in the plane, without the weight's softening, "
        "dop853 at rtol 2.0e-05, atol 3.0e-08; it ended early: slack rope" in lines
    )
    assert any(line.startswith("note     ") and line.endswith("a doubt") for line in lines)


def test_a_sensitivity_study(capsys):
    change = {"sway_radial": 0.123, "drive_torque": None}
    near = {"sway_radial": 0.0456, "drive_torque": 1.5}
    sensitivity_tables(
        {
            "crane": "Some crane", "outputs": ["sway_radial", "drive_torque"],
            "influence": [{"parameter": "jib_mass", "near": near}],
            "members": [{"member": "jib_lateral", "change": change}],
            "reduced": {"rigid": ["tower_x", "rope"], "degrees_of_freedom": 7, "change": near, "cost": 0.42},
            "degrees_of_freedom": 10, "ended": ["one ended"], "assumed": ASSUMED,
        }
    )  # fmt: skip
    rows, lines = said(capsys)
    assert ["jib mass", "4.6%", "150.0%"] in rows
    assert ["jib lateral", "12.3%", "lost"] in rows
    assert ["7 of 10", "4.6%", "150.0%", "42%"] in rows
    assert "Reduced crane, rigid in tower x, rope, beside the full one" in lines
    assert "note     one ended" in lines
    assert "assumed  a.key = 3 m: some reason" in lines


def test_motions_beside_each_other(capsys):
    def row(name, k, limits=True):
        return {
            "name": name, "title": name.upper(), "duration_s": 10.0 + k, "residual_m": 0.1 * k,
            "within_limits": limits,
            "rope_residual_m": {"0.8": 0.2 * k, "1": 0.1 * k, "1.2": None}, "torsion_residual_m": {"0.85": 0.3 * k},
            "peak_slewing_torque_Nm": 1e4 * k, "peak_trolley_force_N": 1500.0 * k,
        }  # fmt: skip

    report = {
        "crane": "Some crane", "frequencies_hz": {"trolley": {"at_start": [0.1], "at_end": [0.2]},
                                                  "slewing": {"at_start": [0.3, 0.4], "at_end": [0.5, 0.6]}},
        "candidates": [row("one", 1), row("two", 2, limits=False)], "recommended": "one", "reason": "some reason",
        "watched_s": 40.0, "damping_ratio": 0.03, "assumed": ASSUMED,
    }  # fmt: skip
    shape_tables(report)
    rows, lines = said(capsys)
    assert rows == [
        ["motion", "time [s]", "left [m]", "rope 80 %", "rope 120 %", "GJ 85 %", "torque [kN m]", "force [kN]"],
        ["ONE", "11.00", "0.1000", "0.2000", "ended early", "0.3000", "10.0", "1.50"],
        ["TWO", "12.00", "0.2000", "0.4000", "ended early", "0.6000", "20.0", "3.00"],
    ]
    assert "in 40 s after the last motion, 3% modal" in lines[0]
    assert "trolley excites 0.1000 to 0.2000 Hz, from where the motion begins to where it ends" in lines
    assert (
        "slewing excites 0.3000, 0.4000 to 0.5000, 0.6000 Hz, from where the motion begins to where it ends" in lines
    )
    assert "recommended: one, some reason" in lines
    assert any(line.startswith("too fast: ") for line in lines)


def test_the_recommended_motion_alone_is_bold(capsys, monkeypatch):
    monkeypatch.setenv("FORCE_COLOR", "1")
    row = {
        "duration_s": 10.0, "residual_m": 0.1, "within_limits": True, "peak_trolley_force_N": 1500.0,
        "rope_residual_m": {"1": 0.1}, "torsion_residual_m": {},
    }  # fmt: skip
    shape_tables(
        {
            "crane": "Some crane", "frequencies_hz": {"trolley": {"at_start": [0.1], "at_end": [0.2]}},
            "candidates": [{"name": name, "title": name.upper(), **row} for name in ("one", "two", "three")],
            "recommended": "two", "reason": "some reason", "watched_s": 40.0, "damping_ratio": 0.03, "assumed": [],
        }
    )  # fmt: skip
    rows = [line for line in capsys.readouterr().out.splitlines() if "10.00" in line]
    assert ["\x1b[1m" in row for row in rows] == [False, True, False]


def sweep_report(**changes):
    found = {
        "largest": {"value": 0.123456, "at": {"payload.mass": 700.0, "model.jib_modes": 3}},
        "smallest": {"value": -2.5, "at": {"payload.mass": 150.25, "model.jib_modes": 1}},
        "units": "rad",
    }
    report = {
        "crane": "Some crane", "title": "Some title", "runs": 12, "outcomes": {"finished": 11, "slack rope": 1},
        "varied": [{"key": "payload.mass", "units": "kg"}, {"key": "model.jib_modes", "units": "1"}],
        "extremes": {"swing_angle": found}, "seconds": 2.5, "runs_per_second": 4.8, "notices": ["look"],
        "faults": [{"at": {"payload.mass": 2.5}, "fault": "some fault"}],
        "assumed": ASSUMED,
    }  # fmt: skip
    return {**report, **changes}


def test_a_sweep(capsys):
    sweep_tables(sweep_report())
    rows, lines = said(capsys)
    assert rows == [
        ["output", "", "value", "unit", "payload.mass [kg]", "model.jib_modes [1]"],
        ["swing angle", "largest", "0.12346", "rad", "700", "3"],
        ["swing angle", "smallest", "-2.5", "rad", "150.25", "1"],
    ]
    assert lines[0] == "Some crane: Some title; 12 runs, 11 finished, 1 slack rope"
    assert "2.50 s, 4.8 runs per second" in lines
    assert "bad input at payload.mass = 2.5: some fault" in lines


@pytest.mark.parametrize(("bad", "more"), [(3, []), (5, ["bad input in 2 more runs: see the files"])])
def test_three_faults_of_a_sweep_are_told_and_the_others_counted(bad, more, capsys):
    faults = [{"at": {"payload.mass": -k, "model.jib_modes": k}, "fault": f"fault {k}"} for k in range(1, bad + 1)]
    sweep_tables(sweep_report(faults=faults))
    _, lines = said(capsys)
    told = [f"bad input at payload.mass = -{k}, model.jib_modes = {k}: fault {k}" for k in (1, 2, 3)]
    assert [line for line in lines if line.startswith("bad input")] == [*told, *more]


def test_models_beside_each_other(capsys):
    row = {
        "name": "rigid", "modes": {"tower_modes": 0, "jib_modes": 3}, "outcome": "finished",
        "sway": {"swing_angle": {"peak_deg": 1.234, "residual_deg": None}}, "slewing_torque_nm": None,
        "tower_tip_m": 0.0391, "horizontal_error_m": 0.021, "vertical_error_m": 0.77, "relative_error": 0.0456,
        "evaluations": 987, "cpu_seconds": 0.126,
    }  # fmt: skip
    early = {**row, "name": "own", "relative_error": None, "outcome": "slack rope", "horizontal_error_m": None}
    report = {
        "kind": "radial", "crane": "Some crane", "title": "Some title", "case": "some/case", "rows": [row, early],
        "recommended": "rigid", "kinds_of_modes": ["tower", "jib"], "departure_m": 0.8123, "reasons": ["since"],
        "target": 0.05, "needed": ["jib"], "assumed": ASSUMED,
    }  # fmt: skip
    comparison_tables(report)
    rows, lines = said(capsys)
    assert ["rigid", "0+3", "1.23, -", "39.1", "0.021", "0.770", "4.6e-02", "987", "0.13"] in rows
    assert ["own", "0+3", "1.23, -", "39.1", "-", "0.770", "slack rope", "987", "0.13"] in rows
    assert "for an error of 0.05 it needs jib; cheapest: rigid" in lines
    assert any(line.startswith("0.812 m by which it leaves") for line in lines)
    space = {**row, "slewing_torque_nm": 208765.0, "sway": {k: {"peak_deg": 2.5, "residual_deg": 1.5} for k in "ab"}}
    comparison_tables({**report, "kind": "space", "rows": [space], "recommended": None})
    rows, lines = said(capsys)
    assert ["rigid", "0+3", "2.50, 1.50", "2.50, 1.50", "209", "0.021", "0.770", "4.6e-02", "987", "0.13"] in rows
    assert "no model but the richest is within 0.05: give the case more modes" in lines


def test_the_recommended_model_alone_is_bold(capsys, monkeypatch):
    monkeypatch.setenv("FORCE_COLOR", "1")
    row = {
        "modes": {"tower_modes": 0}, "outcome": "finished", "sway": {}, "slewing_torque_nm": None,
        "tower_tip_m": 0.0391, "horizontal_error_m": 0.021, "vertical_error_m": 0.77, "relative_error": 0.0456,
        "evaluations": 987, "cpu_seconds": 0.126,
    }  # fmt: skip
    comparison_tables(
        {
            "kind": "radial", "crane": "Some crane", "title": "Some title", "case": "some/case", "recommended": "two",
            "rows": [{"name": name, **row} for name in ("one", "two", "three")], "kinds_of_modes": ["tower"],
            "departure_m": 0.8123, "reasons": [], "target": 0.05, "needed": [], "assumed": [],
        }
    )  # fmt: skip
    rows = [line for line in capsys.readouterr().out.splitlines() if "987" in line]
    assert ["\x1b[1m" in row for row in rows] == [False, True, False]


def test_modes_in_space(capsys):
    shares = {"radial": 0.25, "torsion": 0.75}
    mode = {"kind": "lateral sway", "frequency_hz": 0.1234567, "relative_difference": 2e-4, "energy_shares": shares}
    turned = {"value": np.pi / 3.0, "frequencies_hz": [0.25, 0.5], "kinds": ["torsion", "radial sway"]}
    buckled = {"value": 4.5, "frequencies_hz": [], "kinds": [], "outcome": "tower buckled"}
    space_modes_tables(
        {
            "name": "Some crane", "at": {"trolley_position_m": 12.5, "rope_length_m": 7.5}, "payload_mass_kg": 640.0,
            "modes": [mode, {**mode, "kind": "torsion", "relative_difference": None}], "pendulum_hz": 0.1820261,
            "missing_from_the_model": [{"frequency_hz": 0.0987654, "kind": "lateral"}], "assumed": ASSUMED,
            "sweeps": {"slewing_angle": [turned], "rope_length": [buckled]},
        }
    )  # fmt: skip
    rows, lines = said(capsys)
    assert rows[0] == ["kind", "frequency [Hz]", "more modes", "radial energy", "torsion energy"]
    assert rows[1] == ["lateral sway", "0.123457", "-2.0e-04", "25.0%", "75.0%"]
    assert rows[2] == ["torsion", "0.123457", "-", "25.0%", "75.0%"]
    assert "missing from the model: 0.098765 Hz, lateral" in lines
    assert ["60", "0.25000 T", "0.50000 RS"] in rows
    assert ["4.5", "tower buckled"] in rows
    assert lines[0] == "Some crane: small motions, trolley 12.5 m, rope 7.5 m, load 640 kg"
    assert any("swings at 0.182026 Hz" in line for line in lines)


def test_a_linear_model(capsys):
    row = {
        "dominant_state": "swing_angle",
        "frequency_hz": 0.16,
        "damping_ratio": 0.0125,
        "real": -0.25,
        "imaginary": 1.5,
    }
    signals = [{"name": name, "value": 2.5, "units": "m"} for name in ("trolley", "swing_angle")]
    linear_tables(
        {
            "name": "Some crane", "states": signals, "inputs": signals[:1], "outputs": [], "assumed": ASSUMED,
            "equilibrium": False, "rope_inclination_rad": 0.0625, "slope": [0.5, -3.25],
            "eigenvalues": [row, {**row, "dominant_state": "trolley"},
                            {**row, "dominant_state": "creep", "imaginary": 0.0, "damping_ratio": None,
                             "real": -1e-9}],
        },
        ["trolley"],
    )  # fmt: skip
    rows, lines = said(capsys)
    assert rows[1:] == [
        ["swing angle", "0.160000", "6.2500", "0.012500", "-0.250000 +- 1.500000i"],
        ["creep", "0.160000", "", "", "0.000000"],
    ]
    assert "trolley 2.5 m" in lines[0]
    assert "2 states, 1 inputs, 0 outputs; inputs: trolley" in lines
    assert "small motions about a state that is no equilibrium" in lines[0]
    assert "the rope leans by 0.0625 rad there" in lines
    assert "there swing_angle changes by -3.25 m per second" in lines


def test_a_lattice(capsys):
    answers = {"force_deflection": 1.75e-6, "moment_deflection": 9.8e-8, "frequencies_hz": [2.5, 11.5],
               "body_frequencies_hz": [0.47, 1.52]}  # fmt: skip
    errors = {"force_deflection": -0.0015, "moment_deflection": 0.155, "frequencies_hz": [0.0026, 0.44],
              "body_frequencies_hz": [-0.062, 0.13]}  # fmt: skip
    models = [{"name": name, "answers": answers, "errors": errors, "seconds": 0.042} for name in ("truss", "euler")]
    lattice_tables({"name": "Some crane", "height_m": 23.8, "models": models, "assumed": ASSUMED})
    rows, lines = said(capsys)
    assert rows[1] == ["truss", "1750 um/kN", "98 um/(kN m)", "2.5 Hz", "11.5 Hz", "0.47 Hz", "1.52 Hz", "42.00"]
    assert rows[2] == ["euler", "-0.15", "+15.50", "+0.26", "+44.00", "-6.20", "+13.00", "42.00"]
    assert lines[0].startswith("Some crane: lattice of 23.8 m")


def test_each_drive_of_least_jerk_takes_as_long_as_its_zvd():
    """Trolley and head start and stop at different times; the hoist stays as it is."""
    plans = {
        "trolley": Plan((Move(trapezoid(10.0, 25.0, 0.8, 0.1)), Move(trapezoid(25.0, 22.0, 0.5, 0.2)))),
        "rope": Plan((Move(rest(12.0, 60.0)),)),
        "slewing": Plan((Move(trapezoid(0.0, 1.0, 0.06, 0.01)),)),
    }
    found = {c.name: c for c in candidates(plans, PendulumFrequencies(9.81), 9.81)}
    for channel in ("trolley", "slewing"):
        smooth, zvd, plain = (found[name].motions[channel] for name in ("minimum-jerk", "zvd", "commanded"))
        assert smooth.duration == pytest.approx(zvd.duration, rel=1e-12)
        assert smooth.duration > plain.duration + 5.0
        assert smooth.end == pytest.approx(plain.end)
        assert float(smooth(0.0)) == float(plain(0.0))
    assert found["minimum-jerk"].motions["trolley"].duration != found["minimum-jerk"].motions["slewing"].duration
    smooth = found["minimum-jerk"].motions["slewing"]
    middle = 0.5 * smooth.duration
    assert float(smooth(middle, 1)) == pytest.approx(1.875 / smooth.duration)

"""What tables of studies say: every number, beside made-up reports."""

import pytest
from samples.tables import ASSUMED, said

from towercrane.report.tables.space import comparison_tables
from towercrane.report.tables.studies import sensitivity_tables, shape_tables, sweep_tables

pytestmark = pytest.mark.usefixtures("wide")


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
        "largest": {"value": 0.123456, "at": {"payload.mass": 700.0, "model.jib_vertical_modes": 3}},
        "smallest": {"value": -2.5, "at": {"payload.mass": 150.25, "model.jib_vertical_modes": 1}},
        "units": "rad",
    }
    report = {
        "crane": "Some crane", "title": "Some title", "runs": 12, "outcomes": {"finished": 11, "slack rope": 1},
        "varied": [{"key": "payload.mass", "units": "kg"}, {"key": "model.jib_vertical_modes", "units": "1"}],
        "extremes": {"sway_radial": found}, "seconds": 2.5, "runs_per_second": 4.8, "notices": ["look"],
        "faults": [{"at": {"payload.mass": 2.5}, "fault": "some fault"}],
        "assumed": ASSUMED,
    }  # fmt: skip
    return {**report, **changes}


def test_a_sweep(capsys):
    sweep_tables(sweep_report())
    rows, lines = said(capsys)
    assert rows == [
        ["output", "", "value", "unit", "payload.mass [kg]", "model.jib_vertical_modes [1]"],
        ["sway radial", "largest", "0.12346", "rad", "700", "3"],
        ["sway radial", "smallest", "-2.5", "rad", "150.25", "1"],
    ]
    assert lines[0] == "Some crane: Some title; 12 runs, 11 finished, 1 slack rope"
    assert "2.50 s, 4.8 runs per second" in lines
    assert "bad input at payload.mass = 2.5: some fault" in lines


@pytest.mark.parametrize(("bad", "more"), [(3, []), (5, ["bad input in 2 more runs: see the files"])])
def test_three_faults_of_a_sweep_are_told_and_the_others_counted(bad, more, capsys):
    faults = [
        {"at": {"payload.mass": -k, "model.jib_vertical_modes": k}, "fault": f"fault {k}"} for k in range(1, bad + 1)
    ]
    sweep_tables(sweep_report(faults=faults))
    _, lines = said(capsys)
    told = [f"bad input at payload.mass = -{k}, model.jib_vertical_modes = {k}: fault {k}" for k in (1, 2, 3)]
    assert [line for line in lines if line.startswith("bad input")] == [*told, *more]


def test_models_beside_each_other(capsys):
    row = {
        "name": "rigid", "modes": {"tower_modes": 0, "jib_vertical_modes": 3}, "outcome": "finished",
        "sway": {"sway_radial": {"peak_deg": 1.234, "residual_deg": None}}, "slewing_torque_nm": None,
        "tower_tip_m": 0.0391, "horizontal_error_m": 0.021, "vertical_error_m": 0.77, "relative_error": 0.0456,
        "evaluations": 987, "cpu_seconds": 0.126,
    }  # fmt: skip
    early = {**row, "name": "own", "relative_error": None, "outcome": "slack rope", "horizontal_error_m": None}
    report = {
        "kind": "radial", "crane": "Some crane", "title": "Some title", "case": "some/case", "rows": [row, early],
        "recommended": "rigid", "kinds_of_modes": ["tower", "jib"], "departure_m": 0.8123, "reasons": ["since"],
        "target": 0.05, "needed": ["jib"], "left_out": ["this scene leaves out that"], "assumed": ASSUMED,
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
            "departure_m": 0.8123, "reasons": [], "target": 0.05, "needed": [], "left_out": [], "assumed": [],
        }
    )  # fmt: skip
    rows = [line for line in capsys.readouterr().out.splitlines() if "987" in line]
    assert ["\x1b[1m" in row for row in rows] == [False, True, False]

"""What tables of runs and verifications say: every number, beside made-up reports."""

import pytest
from samples.tables import ASSUMED, said

from towercrane.report.tables.runs import run_tables, verification_tables

pytestmark = pytest.mark.usefixtures("wide")


def run_summary(**changes):
    peak = {"maximum": 1.23456, "maximum_time_s": 2.5, "minimum": -7.891, "minimum_time_s": 11.25, "units": "m"}
    solver = {"method": "dop853", "rtol": 3e-7, "evaluations": 4321, "solver_wall_seconds": 0.125}
    summary = {
        "title": "Some title",
        "crane": "Some crane",
        "peaks": {"some_output": peak, "other_output": {**peak, "maximum": 44.5, "units": "N"}},
        "look_step_s": 0.04,
        "evaluated_from_s": 0.0,
        "loads": {},
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
        "idle": ["crane.x", "crane.y", "crane.jib.segments.0.z", "crane.jib.segments.1.z"],
        "assumed": ASSUMED,
        "left_out": ["this scene leaves out that"],
    }
    return {**summary, **changes}


def test_loads_of_a_run(capsys):
    most, least = {"value": -2345678.0, "time_s": 3.25, "direction_rad": 0.5}, {"value": 1.0, "time_s": 0.0}
    load = {"maximum": least, "minimum": most, "largest": "minimum", "units": "N m"}
    run_tables(
        run_summary(
            loads={
                "overturning_moment": {**load, "static": -2e6, "dynamic_factor": 1.172839},
                "base_torque": {**load, "static": 1e-9, "dynamic_factor": None},
                "base_shear": {**load, "units": "N", "static": None, "dynamic_factor": None},
            }
        )
    )
    rows, lines = said(capsys)
    assert rows[3:] == [
        ["load", "unit", "largest", "at [s]", "static", "factor"],
        ["overturning moment", "kN m", "-2345.7", "3.25", "-2000", "1.173"],
        ["base torque", "kN m", "-2345.7", "3.25", "0", ""],
        ["base shear", "kN", "-2345.7", "3.25", "unknown", ""],
    ]
    assert "largest overturning moment: tips towards 28.6 deg from the x axis" in lines


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
        "changed               a.key=5",
        "swing period          8.5124 s",
        "spectrum peaks        0.1175, 0.3123 Hz in tower tip displacement, up to 12.5 Hz",
        "                      0.6611 Hz too: no natural frequencies, they come from drives, wind or a wide swing",
        "                      too fast to be seen: natural frequencies of 13.25 to 340.8 Hz",
        "natural frequencies   0.1000, 0.2000, 0.4000, 0.8000, 1.6000 Hz where the run ended",
        "energy balance        0.023 J off, 5.6e-09 of the change",
        "solver                dop853, rtol 3e-07, 4321 evaluations, 0.125 s in the solver, 0.750 s in all",
        "note     look twice",
        "left out this scene leaves out that",
        "unused   x, y in [crane]; z in [crane.jib.segments]: keys of the crane file that this run has no use for",
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
    assert "spectrum peaks        none in tower tip displacement" in lines
    assert "natural frequencies   0.1000 a, 0.2000 b, 0.4000 c, 0.8000 d, 1.6000 e Hz where the run ended" in lines
    assert "expected by the case  expected this, got that" in lines
    assert not any("too fast" in line or "Hz too" in line for line in lines)
    run_tables(run_summary(expected={"met": True, "misses": []}, spectrum_beyond_hz=[18.77]))
    _, lines = said(capsys)
    assert "expected by the case  met" in lines
    assert "                      too fast to be seen: natural frequencies of 18.77 Hz" in lines


SETTING = {
    "tower_modes": 2, "jib_vertical_modes": 7, "cap": 6.5, "weight_softening": True, "method": "dop853", "rtol": 2e-5,
    "atol": 3e-8,
}  # fmt: skip
WORDS = (
    "2 tower, 7 jib vertical modes capped at 6.5 Hz, the tower softened by the weight, "
    "dop853 at rtol 2.0e-05, atol 3.0e-08"
)


def test_an_error_that_is_asked_for(capsys):
    outputs = {
        "sway_radial": {"allowed": 2e-4, "estimated": 5e-5, "peak": 0.02, "units": "rad"},
        "hoist_rope_force": {"allowed": 12.0, "estimated": None, "peak": 7858.3, "units": "N"},
    }
    promised = {"outcome": "out of reach", "outputs": outputs, "setting": SETTING,
                "stated": ["jib_vertical_modes", "rtol"],
                "left_out": ["this"], "tried": 19, "choice_cpu_seconds": 0.0137}  # fmt: skip
    run_tables(run_summary(accuracy=promised))
    rows, lines = said(capsys)
    assert rows[-3:] == [
        ["output", "allowed", "expected", "peak", "expected / peak", "unit"],
        ["sway radial", "0.0002", "5e-05", "0.02", "2.5e-03", "rad"],
        ["hoist rope force", "12", "unknown", "7858", "", "N"],
    ]
    assert "Error asked for: out of reach" in lines
    assert f"chosen                {WORDS}" in lines
    assert "stated by the case    jib vertical modes, rtol; what a case leaves out is chosen" in lines
    assert "left out              this" in lines
    assert "choice                19 settings looked at, 14 ms" in lines


def test_a_verification(capsys):
    outputs = {
        "sway_radial": {"estimated": 5e-5, "actual": 6e-5, "peak": 0.02, "units": "rad"},
        "hoist_rope_force": {"estimated": 9.0, "actual": 4.0, "peak": 8000.0, "units": "N"},
        "other_output": {"estimated": None, "actual": 3.0, "peak": 0.0, "units": "m"},
    }
    plain = {**SETTING, "cap": None, "weight_softening": False, "planar": True}
    report = {"outputs": outputs, "setting": SETTING, "finer": plain, "outcome": "slack rope", "doubts": ["a doubt"]}
    verification_tables(report)
    rows, lines = said(capsys)
    assert rows[1:] == [
        ["sway radial", "5e-05", "6e-05 (!)", "3.0e-03", "rad"],
        ["hoist rope force", "9", "4", "5.0e-04", "N"],
        ["other output", "unknown", "3", "", "m"],
    ]
    assert f"run                   {WORDS}" in lines
    assert (
        "richer                2 tower, 7 jib vertical modes, in the plane, the tower not softened by the weight, "
        "dop853 at rtol 2.0e-05, atol 3.0e-08; it ended early: slack rope" in lines
    )
    assert any(line.startswith("note     ") and line.endswith("a doubt") for line in lines)

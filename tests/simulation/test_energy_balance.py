"""A run whose energy is off by more than its tolerances explain says so, and nothing else."""

import json
from dataclasses import replace

import numpy as np
import pytest
from samples import qtz5613
from typer.testing import CliRunner

from towercrane.cases.case import load_case
from towercrane.cli import app
from towercrane.motions.motion import phases, rest
from towercrane.motions.profiles import s_curve, smooth_ramps
from towercrane.runs.run import record_case
from towercrane.runs.summary import expected, summarise
from towercrane.runs.sweep import sweep
from towercrane.simulation import energy_balance
from towercrane.simulation.energy_balance import NOT_CONSERVED, explained, first_off
from towercrane.simulation.lanes.many import integrate_many
from towercrane.simulation.lanes.run import LaneRun
from towercrane.simulation.methods.method import EnergyDriftWarning
from towercrane.simulation.simulate import record, rows_of
from towercrane.simulation.starts.start import Start


def heavier(factor):
    """A crane whose equations pull at the load by another gravity than its energy knows."""
    model = qtz5613.model(1, 1)
    constants = replace(model.constants, gravity=factor * model.constants.gravity)
    vars(model)["system"] = replace(model.system, constants=constants)
    return model


def swung(model, **options):
    return record(model, qtz5613.standing(20.0, 18.0), 10.0, start=Start("zero", along=0.3), **options)


@pytest.mark.parametrize("factor", [0.5, 0.999, 1.001, 1.5])
def test_equations_that_do_not_keep_the_energy_are_an_outcome_of_their_own(factor):
    run = swung(heavier(factor))
    assert run.attrs["outcome"] == NOT_CONSERVED
    assert run.attrs["end_time"] == run["time"].values[-1] < 10.0
    assert len(run["payload_position"].values) == len(run["time"].values)
    gap = abs(run["total_energy"].values - run["total_energy"].values[0] - run["input_work"].values)
    assert gap[-1] > 0.0
    assert f"{gap[-1]:.2g} J" in run.attrs["message"]
    assert "solver.rtol" in run.attrs["message"]


def test_right_equations_are_not_suspected():
    for method, rtol in (("dop853", 1e-11), ("dop853", 1e-8), ("dopri5", 1e-6), ("dop853", 1e-5)):
        assert swung(heavier(1.0), method=method, rtol=rtol, atol=1e-2 * rtol).attrs["outcome"] == "finished"


def test_in_lanes_it_is_the_outcome_of_its_run_alone():
    drives = qtz5613.standing(20.0, 18.0)
    cut = phases((drives["trolley"], drives["rope"]), 10.0)
    runs = [LaneRun(heavier(factor), cut, Start("zero", along=0.3)) for factor in (1.0, 1.001, 1.0)]
    found = integrate_many(runs, rows_of(10.0, 0.5), threads=1)
    assert found.outcomes == ["finished", NOT_CONSERVED, "finished"]


def test_a_vibration_fed_by_the_method_is_not_called_a_slack_rope():
    case = load_case("hard/modes-8-14", ["run.duration=20 s", "solver.method=dopri5", "solver.rtol=1e-3",
                                         "solver.atol=1e-5"])  # fmt: skip
    result = record_case(case)
    assert result.attrs["outcome"] == NOT_CONSERVED
    assert result["hoist_rope_force"].values[:-1].min() > 0.0


def test_wide_swings_finish_with_their_energy():
    for changes in (
        ["start.sway_radial=1.5 rad", "run.duration=300 s"],
        ["start.sway_radial=1.5 rad", "run.duration=60 s", "solver.rtol=1e-6", "solver.atol=1e-8"],
    ):
        case = load_case("hard/swing-1.2-rad", [*changes, "model.tower_modes=0", "model.jib_vertical_modes=0"])
        result = record_case(case)
        assert result.attrs["outcome"] == "finished"
        gap = np.ptp(result["total_energy"].values - result["input_work"].values)
        assert gap < 100.0 * case.solver.rtol * result.attrs["payload_mass"] * 9.81 * 5.0
        # Nothing is put in, yet the load's height gives and takes all that the swing has.
        summary = summarise(case, result)
        assert summary["energy_balance"]["relative_gap"] < 100.0 * case.solver.rtol
        assert not [notice for notice in summary["notices"] if "balance" in notice]


HOISTS = {
    "let out smoothly": smooth_ramps(2.0, 0.5, 10.0, 20.0),
    "hauled by an s-curve": s_curve(18.0, 1.0, 0.5, 0.2, 0.1),
    "let out a little": s_curve(1.0, 2.0, 0.5, 0.2, 0.1),
}


def hung(hoist, method, rtol):
    """Largest error of the work of a load that hangs while its rope changes, in parts of the largest work."""
    rope = HOISTS[hoist]
    drives = {"trolley": rest(30.0), "rope": rope}
    run = record(qtz5613.model(0, 0), drives, 60.0, method=method, rtol=rtol, atol=1e-2 * rtol)
    assert run.attrs["outcome"] == "finished"
    times = run["time"].values
    # Weight times lift, and half the mass times the square of the speed.
    exact = 800.0 * (9.81 * (rope(0.0) - rope(times)) + 0.5 * rope(times, 1) ** 2)
    return np.max(abs(run["input_work"].values - exact)) / np.max(abs(exact))


@pytest.mark.parametrize("method", ["dop853", "dopri5", "scipy-dop853", "scipy-rk45", "scipy-lsoda"])
@pytest.mark.parametrize("hoist", HOISTS)
def test_rows_of_the_work_of_a_hanging_load_are_its_weight_times_its_lift(hoist, method):
    assert hung(hoist, method, 1e-8) < 1e-6


@pytest.mark.parametrize("hoist", HOISTS)
def test_the_work_of_a_hanging_load_is_as_good_as_the_tolerance(hoist):
    # No state but the work moves in a way that a step could be measured by.
    with pytest.warns(EnergyDriftWarning):
        errors = [hung(hoist, "scipy-lsoda", rtol) for rtol in (1e-4, 1e-6, 1e-8)]
    assert errors[2] < 0.1 * errors[1] < 0.01 * errors[0]
    assert all(error < 20.0 * rtol for error, rtol in zip(errors, (1e-4, 1e-6, 1e-8), strict=True))


def test_loads_in_lanes_have_the_tolerance_of_their_own_work():
    crane = qtz5613.model(0, 0)
    for mass in (20.0, 5000.0):
        other = crane.with_load(replace(crane.load, mass=mass))
        assert np.array_equal(other.system.scale, qtz5613.model(0, 0, load=mass).system.scale)
        assert other.system.scale[-1] == pytest.approx(mass * 9.81 * crane.crane.jib_length)


def test_the_command_ends_with_code_3_and_names_what_to_change(tmp_path, monkeypatch):
    monkeypatch.setattr(energy_balance, "SHARE", 0.0)
    monkeypatch.setattr(energy_balance, "UNSTEERED", 0.0)
    monkeypatch.setattr(energy_balance, "ROUNDING", 0.0)
    short = ["--set", "run.duration=5 s", "--no-pictures"]
    done = CliRunner().invoke(app, ["run", "qtz5613/condition-3", *short, "--out", str(tmp_path)])
    assert done.exit_code == 3
    assert NOT_CONSERVED in done.output
    summary = json.loads((tmp_path / "summary.json").read_text(encoding="utf-8"))
    assert summary["outcome"] == NOT_CONSERVED
    assert summary["end_time_s"] < 5.0
    assert len([notice for notice in summary["notices"] if "solver.rtol" in notice]) == 1
    case = load_case("hard/hard-stop", ["run.duration=1 s"])
    assert expected(case, record_case(case))["misses"][0].endswith(f'got "{NOT_CONSERVED}"')
    monkeypatch.setattr(energy_balance, "SHARE", -1.0)
    rows = sweep("qtz5613/condition-3", {"run.duration": [2.0, 3.0]})
    assert set(rows.outcome.values) == {NOT_CONSERVED}


def test_a_balance_that_the_tolerance_spoils_says_which_tolerance_would_do():
    case = load_case("hard/zero-start", ["solver.rtol=3e-3", "solver.atol=3e-5", "run.duration=20 s"])
    summary = summarise(case, record_case(case))
    assert summary["outcome"] == "finished"
    (said,) = [notice for notice in summary["notices"] if "balance is off" in notice]
    rtol, atol = [float(word) for word in said.split() if "e-" in word][-2:]
    better = load_case("hard/zero-start", [f"solver.rtol={rtol}", f"solver.atol={atol}", "run.duration=20 s"])
    assert summarise(better, record_case(better))["energy_balance"]["relative_gap"] < 2e-3


def test_the_first_row_that_is_off_is_found():
    rows = {"rope_length": np.full(5, 2.0), "input_work": np.zeros(5)}
    most = explained(90, 1e-6, 1e-8, 10.0 * 2.0)
    assert most == pytest.approx((0.5 * 100 * 1e-6 + 1e-3 * (10 / 90) ** 5) * 20.0)
    energy = np.array([7.0, 7.0, 7.0 - 0.9 * most, 7.0 + 1.1 * most, 7.0])
    assert first_off({**rows, "total_energy": energy}, 10.0, 90, 1e-6, 1e-8)[0] == 3
    assert first_off({**rows, "total_energy": energy}, 10.0, 120, 1e-6, 1e-8) == (-1, "")
    assert first_off({**rows, "total_energy": energy, "input_work": energy - 7.0}, 10.0, 90, 1e-6, 1e-8)[0] == -1
    assert first_off({**rows, "total_energy": np.full(5, np.nan)}, 10.0, 90, 1e-6, 1e-8)[0] == -1

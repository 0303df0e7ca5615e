"""A solver method is one object: one that is added runs from the command line to the summary."""

import json
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.exact_systems import oscillator
from samples.qtz5613 import model, motions
from scipy.integrate import RK23
from typer.testing import CliRunner

from towercrane.cases.case import load_case
from towercrane.cli import app
from towercrane.motions.motion import phases
from towercrane.runs.sweep import sweep
from towercrane.simulation.integrate import integrate
from towercrane.simulation.methods.method import EnergyDriftWarning
from towercrane.simulation.methods.registry import METHODS
from towercrane.simulation.methods.runge_kutta import RungeKutta
from towercrane.simulation.simulate import simulate

CASE = "qtz5613/condition-3"

# Bogacki and Shampine, A 3(2) pair of Runge-Kutta formulas, Appl. Math. Lett. 2 (1989) 321-325.
BS32 = RungeKutta(
    name="bs32",
    order=3,
    error_order=2,
    dense_order=3,
    stages=3,
    a=np.array([[0.0, 0.0, 0.0, 0.0], [1 / 2, 0.0, 0.0, 0.0], [0.0, 3 / 4, 0.0, 0.0], [2 / 9, 1 / 3, 4 / 9, 0.0]]),
    c=np.array([0.0, 1 / 2, 3 / 4, 1.0]),
    error=np.array([[5 / 72, -1 / 12, -1 / 9, 1 / 8]]),
    # The cubic that has the values and slopes of both ends.
    dense=np.array([[1.0, -4 / 3, 5 / 9], [0.0, 1.0, -2 / 3], [0.0, 4 / 3, -8 / 9], [0.0, -1.0, 1.0]]),
    reach=np.sqrt(3.0),
)


@pytest.fixture
def added(monkeypatch):
    monkeypatch.setitem(METHODS, "bs32", BS32)


def run(tmp_path, *changes):
    settings = [f"--set={change}" for change in ("solver.method=bs32", *changes)]
    done = CliRunner().invoke(app, ["run", CASE, *settings, "--no-pictures", "--json", "--out", str(tmp_path)])
    return done, json.loads((tmp_path / "summary.json").read_text("utf-8")) if done.exit_code == 0 else {}


def test_coefficients_are_those_of_scipy():
    assert_allclose(BS32.error[0], RK23.E, rtol=1e-15)
    assert_allclose(BS32.dense, RK23.P, rtol=1e-15)


@pytest.mark.usefixtures("added")
def test_an_added_pair_has_its_order():
    exact, errors = oscillator(omega=1.0, duration=4.0), []
    cut = phases((exact.motion,), exact.duration)
    for rtol in (1e-6, 1e-9):
        start, times = exact.solution(np.zeros(1))[0], np.linspace(0.0, 4.0, 41)
        found = integrate(exact.system, cut, start, times, method="bs32", rtol=rtol, atol=rtol)
        errors.append((np.max(abs(found.states - exact.solution(times))), found.accepted))
    order = np.log(errors[0][0] / errors[1][0]) / np.log(errors[1][1] / errors[0][1])
    assert 2.9 < order < 3.1
    assert errors[1][0] < 2e-8


@pytest.mark.usefixtures("added")
def test_an_added_pair_runs_from_the_command_to_its_summary(tmp_path):
    done, summary = run(tmp_path, "run.duration=3 s", "solver.rtol=1e-6", "solver.atol=1e-8")
    assert done.exit_code == 0, done.output
    assert summary["outcome"] == "finished"
    assert summary["solver"]["method"] == "bs32"
    # Nobody has measured what it does in 600 s, and the run does not keep that to itself.
    assert len([said for said in summary["notices"] if "what bs32 does to the energy" in said]) == 1
    exact = simulate(model(), motions(), 3.0, rtol=1e-10)
    with pytest.warns(EnergyDriftWarning, match="was not measured"):
        rough = simulate(model(), motions(), 3.0, method="bs32", rtol=1e-6, atol=1e-8)
    assert 1e-9 < float(abs(rough.sway_radial - exact.sway_radial).max()) < 1e-5
    assert rough.attrs["smallest_step"] > 0.0


@pytest.mark.usefixtures("added")
def test_an_added_pair_runs_in_lanes_as_it_does_alone(monkeypatch):
    case = load_case(CASE, ["run.duration=2 s", "solver.method=bs32", "solver.rtol=1e-5", "solver.atol=1e-7"])
    lanes = sweep(case, {"payload.mass": [1000.0, 2000.0]})
    monkeypatch.setattr(RungeKutta, "compiled", False)
    alone = sweep(case, {"payload.mass": [1000.0, 2000.0]})
    assert set(lanes.outcome.values) == {"finished"}
    assert np.array_equal(lanes.evaluations, alone.evaluations)
    for name in ("sway_radial_max", "hoist_rope_force_max"):
        assert_allclose(lanes[name], alone[name], rtol=1e-14)


def test_a_limit_of_an_added_pair_is_kept_at_the_door(tmp_path, monkeypatch):
    monkeypatch.setitem(METHODS, "bs32", replace(BS32, energy_drift=((1e-4, 0.2), (1e-6, 1e-3)), loosest=1e-4))
    done, _ = run(tmp_path, "solver.rtol=1e-3", "run.duration=1 s")
    said = "bs32 feeds free vibration without bound beyond rtol or atol 0.0001; use rtol 1e-06 or dop853"
    assert said in str(done.exception)


def test_a_name_that_no_method_has_is_refused_with_those_there_are(tmp_path):
    done, _ = run(tmp_path)
    assert 'wanted: one of "dop853", "dopri5", "scipy-dop853"' in str(done.exception)


@pytest.mark.parametrize(
    ("change", "wanted"),
    [
        ({"a": BS32.a.T}, "strictly lower triangular"),
        ({"c": np.array([0.0, 1 / 2, 1 / 4, 1.0])}, "add up to c"),
        ({"stages": 4}, "last regular stage"),
        ({"stages": 2}, "last regular stage"),
        ({"error": BS32.error[:, :3]}, "error weights for the regular stages"),
        ({"error": BS32.error + 1e-6}, "add up to nothing"),
        ({"dense": BS32.dense[:, ::-1] * 1.5}, "dense output that ends in the step"),
    ],
)
def test_coefficients_that_do_not_fit_each_other_make_no_method(change, wanted):
    with pytest.raises(ValueError, match=f"bs32: wanted .*{wanted}"):
        replace(BS32, **change)

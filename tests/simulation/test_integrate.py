"""Every integrator on every system with a known answer: absolute error, samples, tolerances, named ends."""

import dataclasses

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.exact_systems import ALL, Exact, driven, kepler
from samples.bare_systems import plain_system

from towercrane.motions.motion import phases, rest
from towercrane.simulation.integrate import integrate
from towercrane.simulation.methods import runge_kutta as module
from towercrane.simulation.methods.registry import METHODS


def solve(exact: Exact, times=None, **options):
    cut = phases((exact.motion,), exact.duration)
    times = np.linspace(0.0, exact.duration, 41) if times is None else times
    return integrate(exact.system, cut, exact.solution(np.zeros(1))[0], times, **options)


def error(exact: Exact, **options) -> float:
    run = solve(exact, **options)
    assert run.outcome == "finished"
    return float(np.max(abs(run.states - exact.solution(run.times))))


@pytest.mark.parametrize("exact", ALL, ids=[e.name for e in ALL])
@pytest.mark.parametrize("method", METHODS)
def test_error_follows_the_tolerance(method, exact):
    errors = [error(exact, method=method, rtol=rtol, atol=rtol) for rtol in (1e-5, 1e-8)]
    assert errors[0] < 6e-3
    assert errors[1] < 6e-6
    assert 100 < errors[0] / errors[1] < 10_000


@pytest.mark.parametrize("exact", ALL, ids=[e.name for e in ALL])
def test_tight_tolerance_reaches_rounding(exact):
    assert error(exact, method="dop853", rtol=1e-13, atol=1e-13) < 2e-11


def test_samples_between_steps_are_as_good_as_steps():
    exact = kepler()
    times = np.sort(np.r_[np.random.default_rng(1).uniform(0, exact.duration, 400), 0.0, exact.duration])
    run = solve(exact, times, rtol=1e-11, atol=1e-11)
    assert_allclose(run.states, exact.solution(times), atol=3e-9)


def test_restart_at_switch_points_buys_accuracy_at_no_cost():
    # Without restarts the step control meets the jumps of acceleration by surprise. SciPy offers both ways.
    exact = driven()
    split = solve(exact, method="scipy-dop853", rtol=1e-4, atol=1e-6)
    whole = solve(exact, method="scipy-dop853", rtol=1e-4, atol=1e-6, split=False)
    error_split = np.max(abs(split.states - exact.solution(split.times)))
    error_whole = np.max(abs(whole.states - exact.solution(whole.times)))
    assert error_split < 4e-5
    assert error_whole > 3 * error_split
    assert split.evaluations < 0.6 * whole.evaluations


def test_chunks_do_not_change_the_result(monkeypatch):
    exact, seen = kepler(), []
    whole = solve(exact)
    monkeypatch.setattr(module, "STEPS_PER_CALL", 3)
    parts = solve(exact, progress=seen.append)
    assert np.array_equal(parts.states, whole.states)
    assert seen == sorted(seen)
    assert len(seen) > 5
    assert seen[-1] == exact.duration


def test_interrupted_run_keeps_what_is_finished(monkeypatch):
    monkeypatch.setattr(module, "STEPS_PER_CALL", 3)
    calls = []

    def stop(time):
        calls.append(time)
        if len(calls) == 3:
            raise KeyboardInterrupt

    exact = kepler()
    run = solve(exact, progress=stop)
    assert run.outcome == "interrupted"
    assert run.end_time == calls[-1] < exact.duration
    assert_allclose(run.states, exact.solution(run.times), atol=1e-6)
    assert 0 < len(run.times) < 41


def _blows_up(own, t, y, inputs):
    return (y[0] * y[0],), ()


def test_absolute_tolerance_counts_in_each_state_s_own_scale():
    exact = kepler()
    scaled = dataclasses.replace(exact, system=dataclasses.replace(exact.system, scale=np.full(4, 1e4)))
    for method in ("dop853", "scipy-dop853"):
        strict = solve(exact, method=method, rtol=1e-12, atol=1e-6)
        loose = solve(scaled, method=method, rtol=1e-12, atol=1e-6)
        assert loose.accepted < 0.6 * strict.accepted


@pytest.mark.parametrize("method", METHODS)
def test_blow_up_is_a_named_outcome(method):
    with np.errstate(all="ignore"):
        run = integrate(
            plain_system(_blows_up, 1), phases((rest(0.0),), 2.0), np.ones(1), np.linspace(0, 2, 21), method=method
        )
    assert run.outcome == "step size collapsed"
    assert_allclose(run.end_time, 1.0, atol=2e-7 if method == "scipy-lsoda" else 2e-9)


def _leaves_its_domain(own, t, y, inputs):
    return (np.sqrt(1.0 - t),), ()


@pytest.mark.parametrize("method", METHODS)
def test_slopes_that_are_no_numbers_end_a_run_by_name(method):
    with np.errstate(all="ignore"):
        run = integrate(
            plain_system(_leaves_its_domain, 1), phases((rest(0.0),), 2.0), np.zeros(1), np.zeros(1), method=method
        )
    # LSODA calls a state that is not finite a success.
    assert run.outcome == ("state not finite" if method == "scipy-lsoda" else "step size collapsed")
    assert_allclose(run.end_time, 1.0, atol=1e-3)


def test_start_that_is_not_finite_is_a_named_outcome():
    for method in ("dop853", "scipy-dop853"):
        run = integrate(
            plain_system(_blows_up, 1), phases((rest(0.0),), 2.0), np.array([np.nan]), np.zeros(1), method=method
        )
        assert run.outcome == "state not finite"


def test_state_without_weight_does_not_steer_the_step():
    exact = kepler()
    free = dataclasses.replace(exact.system, scale=np.array([1.0, 1.0, 1.0, np.inf]))
    loose = dataclasses.replace(exact, system=free)
    assert solve(loose, method="dop853").accepted != solve(exact, method="dop853").accepted


def test_unknown_method_is_refused():
    with pytest.raises(ValueError, match=r"method: wanted one of dop853.*got 'euler'"):
        solve(kepler(), method="euler")


def _relaxation(own, t, y, inputs):
    return (y[1], 20.0 * (1.0 - y[0] * y[0]) * y[1] - y[0], y[0] * y[1]), ()


def test_radau_copes_with_a_state_that_nothing_depends_on():
    # Its differences for the Jacobian grow tenfold each time; a warning would fail this test.
    system = dataclasses.replace(plain_system(_relaxation, 3), scale=np.array([1.0, 1.0, np.inf]))
    arguments = phases((rest(0.0),), 60.0), np.array([2.0, 0.0, 0.0]), np.array([60.0])
    implicit = integrate(system, *arguments, method="scipy-radau", rtol=1e-7, atol=1e-9)
    explicit = integrate(system, *arguments, rtol=1e-9, atol=1e-11)
    assert_allclose(implicit.states, explicit.states, atol=1e-5)

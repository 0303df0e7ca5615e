"""Every integrator on every system with a known answer: declared order, absolute error, samples, guards, ends."""

import dataclasses

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.exact_systems import ALL, Exact, driven, growth_and_decay, kepler, oscillator

from modal.compiler.compiled import kernel
from towercrane.motions.motion import phases, rest
from towercrane.simulation.integrate import integrate
from towercrane.simulation.methods import runge_kutta as module
from towercrane.simulation.methods.registry import METHODS
from towercrane.simulation.methods.runge_kutta import RungeKutta
from towercrane.simulation.system import rhs_signature

PAIRS = {name: method for name, method in METHODS.items() if method.compiled}


def solve(exact: Exact, times=None, **options):
    cut = phases((exact.motion,), exact.duration)
    times = np.linspace(0.0, exact.duration, 41) if times is None else times
    return integrate(exact.system, cut, exact.solution(np.zeros(1))[0], times, **options)


def error(exact: Exact, **options) -> float:
    run = solve(exact, **options)
    assert run.outcome == "finished"
    return float(np.max(abs(run.states - exact.solution(run.times))))


def fixed_steps(tableau: RungeKutta, exact: Exact, steps: int, x: float = 1.0) -> float:
    """Error with equal steps, written out in NumPy from the tableau alone; x < 1 looks at the dense output."""
    inputs = phases((exact.motion,), exact.duration).inputs[0]
    h, y, worst = exact.duration / steps, exact.solution(np.zeros(1))[0], 0.0
    for step in range(steps):
        k = np.zeros((len(tableau.a), len(y)))
        for i in range(len(tableau.a)):
            k[i] = exact.system.slope((step + tableau.c[i]) * h, y + h * tableau.a[i] @ k, inputs)[0]
        inner = y + h * (tableau.dense @ x ** np.arange(1, tableau.dense.shape[1] + 1)) @ k
        y = y + h * tableau.a[tableau.stages] @ k
        seen, at = (y, step + 1) if x == 1.0 else (inner, step + x)
        worst = max(worst, np.max(abs(seen - exact.solution(np.array([at * h]))[0])))
    return worst


@pytest.mark.parametrize(("name", "coarse", "bound"), [("dop853", 8, 1.2e-8), ("dopri5", 48, 1.5e-9)])
def test_declared_order_is_reached_and_not_exceeded(name, coarse, bound):
    tableau, exact = PAIRS[name], growth_and_decay(duration=4.0)
    errors = [fixed_steps(tableau, exact, coarse * 2**level) for level in range(3)]
    slopes = np.log2(np.array(errors[:-1]) / errors[1:])
    assert errors[0] < bound
    assert np.all((slopes > tableau.order - 0.25) & (slopes < tableau.order + 0.25)), slopes


@pytest.mark.parametrize("name", PAIRS)
def test_dense_output_has_its_declared_order(name):
    # The error inside a step is of order dense_order + 1 locally; over a run it meets the step ends' own error.
    tableau, exact = PAIRS[name], oscillator(omega=1.0, duration=4.0)
    errors = []
    for steps in (8, 16, 32):
        inputs = phases((exact.motion,), exact.duration).inputs[0]
        h, y = exact.duration / steps, exact.solution(np.zeros(1))[0]
        k = np.zeros((len(tableau.a), 2))
        for i in range(len(tableau.a)):
            k[i] = exact.system.slope(tableau.c[i] * h, y + h * tableau.a[i] @ k, inputs)[0]
        x = 0.37
        inner = y + h * (tableau.dense @ x ** np.arange(1, tableau.dense.shape[1] + 1)) @ k
        errors.append(np.max(abs(inner - exact.solution(np.array([x * h]))[0])))
    slopes = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all((slopes > tableau.dense_order + 0.7) & (slopes < tableau.dense_order + 1.5)), slopes


@pytest.mark.parametrize("tableau", PAIRS.values(), ids=PAIRS)
def test_tableau_is_consistent(tableau):
    assert_allclose(tableau.a.sum(axis=1), tableau.c, atol=3e-15)
    assert_allclose(tableau.error.sum(axis=1), 0.0, atol=3e-15)
    # At the end of the step the dense output is the step.
    assert_allclose(tableau.dense.sum(axis=1), tableau.a[tableau.stages], atol=1e-13)


def test_coefficients_are_those_of_scipy():
    from scipy.integrate import DOP853, RK45

    dop853, dopri5 = PAIRS["dop853"], PAIRS["dopri5"]
    assert_allclose(dop853.a[:12, :12], DOP853.A, rtol=1e-16)
    assert_allclose(dop853.error, [DOP853.E5, DOP853.E3], rtol=1e-16)
    assert_allclose(dopri5.dense, RK45.P, rtol=1e-15)
    assert_allclose(dopri5.error[0], RK45.E, rtol=1e-15, atol=1e-18)


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


@kernel(rhs_signature())
def _falling(t, y, dy, inputs, numbers, vectors, matrices, tables, work, guards):
    dy[0] = y[1]
    dy[1] = -9.81
    guards[0] = 100.0
    guards[1] = y[0]


@kernel(rhs_signature())
def _blows_up(t, y, dy, inputs, numbers, vectors, matrices, tables, work, guards):
    dy[0] = y[0] ** 2


def _system(rhs, size, guards=()):
    return dataclasses.replace(
        oscillator().system,
        equations=lambda: rhs,
        size=size,
        guards=guards,
        floors=np.zeros(len(guards)),
        scale=np.ones(size),
    )


@pytest.mark.parametrize("method", ["dop853", "dopri5", "scipy-dop853"])
def test_guard_stops_at_its_zero(method):
    system = _system(_falling, 2, ("never", "landed"))
    cut = phases((rest(0.0),), 10.0)
    run = integrate(system, cut, np.array([20.0, 0.0]), np.arange(0.0, 10.0, 0.1), method=method)
    assert run.outcome == "landed"
    assert_allclose(run.end_time, np.sqrt(2 * 20 / 9.81), rtol=1e-10)
    assert run.times[-1] <= run.end_time < run.times[-1] + 0.1
    assert_allclose(run.states[:, 0], 20 - 9.81 * run.times**2 / 2, atol=1e-9)


@kernel(rhs_signature())
def _swinging_guards(t, y, dy, inputs, numbers, vectors, matrices, tables, work, guards):
    dy[0] = y[1]
    dy[1] = -(numbers[0] ** 2) * y[0]
    guards[0] = y[0] + numbers[1]
    guards[1] = y[0] + numbers[2]


@pytest.mark.parametrize("rtol", [1e-3, 1e-6, 1e-9])
@pytest.mark.parametrize("grid", [1e-3, 0.1, 3.0])
def test_a_dip_is_found_whatever_the_samples_and_the_step(rtol, grid):
    # cos(3 t) falls below -0.97 for a tenth of a second only; the higher floor is met first and must be named.
    system = dataclasses.replace(_system(_swinging_guards, 2, ("low", "lower")), numbers=np.array([3.0, 0.97, 0.6]))
    cut = phases((rest(0.0),), 30.0)
    run = integrate(system, cut, np.array([1.0, 0.0]), np.arange(0.0, 30.0, grid), rtol=rtol, atol=rtol)
    assert run.outcome == "lower"
    assert_allclose(run.end_time, np.arccos(-0.6) / 3.0, atol=30 * rtol)
    only = dataclasses.replace(system, floors=np.array([0.0, -np.inf]))
    run = integrate(only, cut, np.array([1.0, 0.0]), np.arange(0.0, 30.0, grid), rtol=rtol, atol=rtol)
    assert run.outcome == "low"
    if rtol < 1e-3:
        assert_allclose(run.end_time, np.arccos(-0.97) / 3.0, atol=300 * rtol)


@pytest.mark.parametrize(
    ("method", "rtol", "runs"),
    [("dop853", 1e-2, 300), ("dop853", 1e-4, 300), ("dopri5", 1e-3, 300), ("scipy-dop853", 1e-3, 40)],
)
def test_shallow_dips_between_stages_are_found(method, rtol, runs):
    # A vibration that starts at a drawn phase and turns back a drawn bit below the floor, or above it.
    random, missed, invented = np.random.default_rng(5), 0, 0
    for _ in range(runs):
        depth = 10.0 ** random.uniform(np.log10(max(1e-2, 5.0 * rtol)), -0.7) * random.choice([-1.0, 1.0])
        phase = random.uniform(-2.5, 1.0)
        system = dataclasses.replace(
            _system(_swinging_guards, 2, ("low", "lower")),
            numbers=np.array([3.0, 1.0 - depth, 9.0]),
            floors=np.array([0.0, -np.inf]),
        )
        start, span = np.array([np.cos(phase), -3.0 * np.sin(phase)]), (np.pi + 1.0 - phase) / 3.0
        if start[0] < depth - 1.0:
            continue
        run = integrate(system, phases((rest(0.0),), span), start, np.zeros(1), method=method, rtol=rtol, atol=rtol)
        missed += depth > 0.0 and run.outcome != "low"
        invented += depth < 0.0 and run.outcome == "low"
    assert (missed, invented) == (0, 0)


def test_absolute_tolerance_counts_in_each_state_s_own_scale():
    exact = kepler()
    scaled = dataclasses.replace(exact, system=dataclasses.replace(exact.system, scale=np.full(4, 1e4)))
    for method in ("dop853", "scipy-dop853"):
        strict = solve(exact, method=method, rtol=1e-12, atol=1e-6)
        loose = solve(scaled, method=method, rtol=1e-12, atol=1e-6)
        assert loose.accepted < 0.6 * strict.accepted


def test_guard_below_zero_at_the_start_is_an_outcome_at_once():
    run = integrate(
        _system(_falling, 2, ("never", "landed")),
        phases((rest(0.0),), 1.0),
        np.array([-1.0, 0.0]),
        np.zeros(1),
    )
    assert (run.outcome, run.end_time, len(run.times)) == ("landed", 0.0, 1)


@pytest.mark.parametrize("method", METHODS)
def test_blow_up_is_a_named_outcome(method):
    with np.errstate(all="ignore"):
        run = integrate(
            _system(_blows_up, 1), phases((rest(0.0),), 2.0), np.ones(1), np.linspace(0, 2, 21), method=method
        )
    assert run.outcome == "step size collapsed"
    assert_allclose(run.end_time, 1.0, atol=2e-7 if method == "scipy-lsoda" else 2e-9)


@kernel(rhs_signature())
def _leaves_its_domain(t, y, dy, inputs, numbers, vectors, matrices, tables, work, guards):
    dy[0] = np.sqrt(1.0 - t)


@pytest.mark.parametrize("method", METHODS)
def test_slopes_that_are_no_numbers_end_a_run_by_name(method):
    with np.errstate(all="ignore"):
        run = integrate(
            _system(_leaves_its_domain, 1), phases((rest(0.0),), 2.0), np.zeros(1), np.zeros(1), method=method
        )
    # LSODA calls a state that is not finite a success.
    assert run.outcome == ("state not finite" if method == "scipy-lsoda" else "step size collapsed")
    assert_allclose(run.end_time, 1.0, atol=1e-3)


def test_start_that_is_not_finite_is_a_named_outcome():
    for method in ("dop853", "scipy-dop853"):
        run = integrate(
            _system(_blows_up, 1), phases((rest(0.0),), 2.0), np.array([np.nan]), np.zeros(1), method=method
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


# --- equations that switch -----------------------------------------------------------------------------


class _Never:
    """Switch that leaves everything as it is."""

    def __init__(self, changes_equations):
        self.changes_equations = changes_equations

    def begin(self, state, numbers, floors, guards_at):
        pass

    def cross(self, guard, state, numbers, floors, guards_at):
        return True


def test_switching_without_progress_is_a_named_outcome():
    system = dataclasses.replace(_system(_falling, 2, ("never", "landed")), switch=_Never(True))
    run = integrate(system, phases((rest(0.0),), 10.0), np.array([20.0, 0.0]), np.arange(0.0, 10.0, 0.1))
    assert run.outcome == "switching without progress"
    assert_allclose(run.end_time, np.sqrt(2 * 20 / 9.81), rtol=1e-10)
    assert 0.0 < run.smallest_step < run.end_time


def test_scipy_is_refused_where_equations_switch():
    # It would not call the switch, and so solve other equations than those of the crane.
    system = dataclasses.replace(_system(_falling, 2, ("never", "landed")), switch=_Never(True))
    arguments = phases((rest(0.0),), 10.0), np.array([20.0, 0.0]), np.zeros(1)
    with pytest.raises(ValueError, match=r"method: wanted one of dop853, dopri5 .*switch.*got 'scipy-lsoda'"):
        integrate(system, *arguments, method="scipy-lsoda")
    merely_restarts = dataclasses.replace(system, switch=_Never(False))
    assert integrate(merely_restarts, *arguments, method="scipy-lsoda").outcome == "landed"


@kernel(rhs_signature())
def _relaxation(t, y, dy, inputs, numbers, vectors, matrices, tables, work, guards):
    dy[0] = y[1]
    dy[1] = 20.0 * (1.0 - y[0] ** 2) * y[1] - y[0]
    dy[2] = y[0] * y[1]


def test_radau_copes_with_a_state_that_nothing_depends_on():
    # Its differences for the Jacobian grow tenfold each time; a warning would fail this test.
    system = dataclasses.replace(_system(_relaxation, 3), scale=np.array([1.0, 1.0, np.inf]))
    arguments = phases((rest(0.0),), 60.0), np.array([2.0, 0.0, 0.0]), np.array([60.0])
    implicit = integrate(system, *arguments, method="scipy-radau", rtol=1e-7, atol=1e-9)
    explicit = integrate(system, *arguments, rtol=1e-9, atol=1e-11)
    assert_allclose(implicit.states, explicit.states, atol=1e-5)

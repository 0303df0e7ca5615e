"""Guards that stop a run or switch its equations: found where they vanish, whatever the samples and the step."""

import dataclasses

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.bare_systems import plain_system

from towercrane.motions.motion import phases, rest
from towercrane.simulation.integrate import integrate


def _falling(own, t, y, inputs):
    return (y[1], -9.81), (100.0, y[0])


def falling():
    return plain_system(_falling, 2, guards=("never", "landed"))


@pytest.mark.parametrize("method", ["dop853", "dopri5", "scipy-dop853"])
def test_guard_stops_at_its_zero(method):
    system = falling()
    cut = phases((rest(0.0),), 10.0)
    run = integrate(system, cut, np.array([20.0, 0.0]), np.arange(0.0, 10.0, 0.1), method=method)
    assert run.outcome == "landed"
    assert_allclose(run.end_time, np.sqrt(2 * 20 / 9.81), rtol=1e-10)
    assert run.times[-1] <= run.end_time < run.times[-1] + 0.1
    assert_allclose(run.states[:, 0], 20 - 9.81 * run.times**2 / 2, atol=1e-9)


@dataclasses.dataclass(frozen=True)
class Swinging:
    frequency: float
    low: float
    lower: float

    @property
    def system(self):
        return plain_system(_swinging_guards, 2, self, guards=("low", "lower"))


def _swinging_guards(own, t, y, inputs):
    return (y[1], -(own.frequency * own.frequency) * y[0]), (y[0] + own.low, y[0] + own.lower)


@pytest.mark.parametrize("rtol", [1e-3, 1e-6, 1e-9])
@pytest.mark.parametrize("grid", [1e-3, 0.1, 3.0])
def test_a_dip_is_found_whatever_the_samples_and_the_step(rtol, grid):
    # cos(3 t) falls below -0.97 for a tenth of a second only; the higher floor is met first and must be named.
    system = Swinging(3.0, 0.97, 0.6).system
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
        system = dataclasses.replace(Swinging(3.0, 1.0 - depth, 9.0).system, floors=np.array([0.0, -np.inf]))
        start, span = np.array([np.cos(phase), -3.0 * np.sin(phase)]), (np.pi + 1.0 - phase) / 3.0
        if start[0] < depth - 1.0:
            continue
        run = integrate(system, phases((rest(0.0),), span), start, np.zeros(1), method=method, rtol=rtol, atol=rtol)
        missed += depth > 0.0 and run.outcome != "low"
        invented += depth < 0.0 and run.outcome == "low"
    assert (missed, invented) == (0, 0)


def test_guard_below_zero_at_the_start_is_an_outcome_at_once():
    run = integrate(
        falling(),
        phases((rest(0.0),), 1.0),
        np.array([-1.0, 0.0]),
        np.zeros(1),
    )
    assert (run.outcome, run.end_time, len(run.times)) == ("landed", 0.0, 1)


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
    system = dataclasses.replace(falling(), switch=_Never(True))
    run = integrate(system, phases((rest(0.0),), 10.0), np.array([20.0, 0.0]), np.arange(0.0, 10.0, 0.1))
    assert run.outcome == "switching without progress"
    assert_allclose(run.end_time, np.sqrt(2 * 20 / 9.81), rtol=1e-10)
    assert 0.0 < run.smallest_step < run.end_time


def test_scipy_is_refused_where_equations_switch():
    # It would not call the switch, and so solve other equations than those of the crane.
    system = dataclasses.replace(falling(), switch=_Never(True))
    arguments = phases((rest(0.0),), 10.0), np.array([20.0, 0.0]), np.zeros(1)
    with pytest.raises(ValueError, match=r"method: wanted one of dop853, dopri5 .*switch.*got 'scipy-lsoda'"):
        integrate(system, *arguments, method="scipy-lsoda")
    merely_restarts = dataclasses.replace(system, switch=_Never(False))
    assert integrate(merely_restarts, *arguments, method="scipy-lsoda").outcome == "landed"

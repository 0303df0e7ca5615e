"""Slewing cranes whose friction sticks: each run meets its tolerance or ends with a named outcome."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.balance import imbalance
from samples.lab_crane import PARAMETERS, crane, motions, run

from towercrane.cranes.parts import friction
from towercrane.cranes.slewing import equations
from towercrane.motions.motion import phases
from towercrane.simulation.integrate import integrate
from towercrane.simulation.simulate import simulate


@pytest.fixture(scope="module")
def sticking():
    return {kind: run(crane(kind, friction_law="stick-slip"), motions(), 25.0, rtol=1e-10) for kind in PARAMETERS}


@pytest.mark.parametrize(
    ("kind", "sway", "platform", "switches"),
    [("multi-mass", 0.7243, 6.54696, 10), ("enhanced", 0.7728, 6.55437, 10), ("basic", 0.7272, 6.54827, 6)],
)
def test_friction_that_sticks(sticking, kind, sway, platform, switches):
    trajectory, outputs, met = sticking[kind]
    assert trajectory.outcome == "finished"
    assert_allclose(np.degrees(outputs["sway_tangential"][-1]), sway, atol=6e-5)
    assert_allclose(outputs["platform_angle"][-1], platform, atol=6e-6)
    assert sum(guard in (equations.SLIDING, equations.HOLDING) for guard in met) == switches
    assert imbalance(outputs) < 2e-9
    # At rest the platform does not creep: neither before the coupling has wound up nor at the end.
    still = outputs["platform_angle"][trajectory.times > 24.0]
    assert np.all(still == still[0])
    assert np.all(outputs["platform_angle"][trajectory.times < 0.3] == 0.0)


@pytest.mark.parametrize("kind", PARAMETERS)
def test_friction_never_exceeds_its_limit_and_opposes_sliding(sticking, kind):
    trajectory, _, _ = sticking[kind]
    model = crane(kind, friction_law="stick-slip")
    rate = trajectory.states[:, (model.size - 1) // 2 + model.crane.coordinates.index("platform_angle")]
    assert np.any(rate == 0.0)
    assert np.any(rate > 0.1)
    cut = phases((motions()["shaft"], motions()["rope"]), 25.0)
    for time, state in zip(trajectory.times[::10], trajectory.states[::10], strict=True):
        phase = min(int(np.searchsorted(cut.times, time + 1e-9, side="right")) - 1, len(cut.inputs) - 1)
        slope, guards = model.system.slope(time - cut.times[phase], state, cut.inputs[phase])
        assert guards[equations.HOLDING] >= 0.0
        # Power of friction is what the balance lacks against the same crane without it.
        bare = crane(kind, friction_law="none").system.slope(time - cut.times[phase], state, cut.inputs[phase])[0]
        slips = state[(model.size - 1) // 2 + model.crane.coordinates.index("platform_angle")]
        assert_allclose(slope[-1] - bare[-1], -22.0 * abs(slips), atol=1e-6)


def test_a_breakaway_is_no_reversal_though_rounding_turns_its_first_rates():
    # With a soft stiffness of 750 N m/rad the coupling, wound up by 0.2 rad, pulls more than friction can hold.
    model, drive = crane("enhanced", friction_law="stick-slip", drive_soft_stiffness=750.0), motions()
    cut = phases((drive["shaft"], drive["rope"]), 1.0)
    system, (rhs, numbers) = model.system, model.system.code(cut.inputs[0])
    switch, numbers, floors = system.switch, numbers.copy(), system.floors.copy()
    state = model.start(cut.inputs[0])
    driven = (model.size - 1) // 2 + model.crane.coordinates.index("platform_angle")
    state[model.crane.coordinates.index("platform_angle")] = -0.2

    def guards_at():
        slope, guards = np.empty(model.size), np.empty(6)
        rhs(0.0, state, slope, cut.inputs[0], numbers, system.table, guards)
        return guards

    switch.begin(state, numbers, floors, guards_at)
    assert numbers[system.place_of("friction_state")] == friction.SLIP_AHEAD
    state[driven] = -1e-27
    assert np.all(guards_at() >= floors)
    # A rate that has turned is one.
    state[driven] = -1e-9
    assert guards_at()[equations.SLIDING] < floors[equations.SLIDING]
    switch.cross(equations.SLIDING, state, numbers, floors, guards_at)
    assert state[driven] == 0.0


def test_ever_narrower_friction_approaches_the_one_that_sticks(sticking):
    def end(found):
        return np.array([np.degrees(found["sway_tangential"][-1]), found["platform_angle"][-1]])

    limit, gaps = end(sticking["multi-mass"][1]), []
    for width in (1e-4, 1e-5, 1e-6):
        trajectory, outputs, _ = run(
            crane(friction_rate=width), motions(), 25.0, method="scipy-lsoda", rtol=1e-7, step=0.5
        )
        assert trajectory.outcome == "finished"
        # LSODA begins anew where the rope has left its length, with small steps.
        assert trajectory.evaluations < 150_000
        gaps.append(abs(end(outputs) - limit))
    assert np.all(gaps[-1] < [2.5e-4, 2.5e-6])
    assert_allclose(gaps[0] / gaps[1], 10.0, rtol=0.15)
    assert_allclose(gaps[1] / gaps[2], 10.0, rtol=0.05)
    trajectory, outputs, _ = run(
        crane(friction_rate=1e-6), motions(), 25.0, method="scipy-radau", rtol=1e-5, step=0.5
    )
    assert trajectory.outcome == "finished"
    assert np.all(abs(end(outputs) - limit) < [2e-3, 2e-5])


def test_friction_that_sticks_refuses_solvers_that_know_no_switch():
    with pytest.raises(ValueError, match=r"method: wanted one of dop853, dopri5 .*sticks.*got 'scipy-radau'"):
        simulate(crane(friction_law="stick-slip"), motions(), 1.0, method="scipy-radau")


def test_friction_stronger_than_the_drive_holds_for_ever():
    trajectory, outputs, met = run(crane(friction_law="stick-slip", friction_torque=1e6), motions(), 25.0)
    assert trajectory.outcome == "finished"
    assert np.all(outputs["platform_angle"] == 0.0)
    assert set(met) <= {equations.INSIDE, equations.OUTSIDE}
    assert_allclose(outputs["sway_tangential"], 0.0, atol=1e-12)


def test_switch_that_does_nothing_ends_the_run_by_name():
    class Stuck:
        changes_equations = True

        def begin(self, state, numbers, floors, guards_at):
            floors[equations.INSIDE] = 0.0

        def cross(self, guard, state, numbers, floors, guards_at):
            return True

    model, drive = crane(), motions()
    system, cut = replace(model.system, switch=Stuck()), phases((drive["shaft"], drive["rope"]), 5.0)
    trajectory = integrate(system, cut, model.start(cut.inputs[0]), np.zeros(1))
    assert trajectory.outcome == "switching without progress"
    assert 0.0 < trajectory.end_time < 5.0

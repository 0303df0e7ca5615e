"""Slewing cranes where solvers fail: each run meets its tolerance or ends with a named outcome."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.balance import imbalance
from samples.lab_crane import MULTI_MASS, PARAMETERS, crane, lossless, motions, run
from scipy.special import ellipj, ellipk

from towercrane.cranes.slewing import kernel
from towercrane.cranes.slewing.description import Drive, Link, LumpedCrane, Point
from towercrane.cranes.slewing.model import LumpedModel
from towercrane.kernels.payload import Load
from towercrane.motions.motion import phases, rest
from towercrane.motions.profiles import trapezoid
from towercrane.simulation.integrate import integrate
from towercrane.simulation.simulate import simulate

STILL = {"shaft": rest(0.0), "rope": rest(2.0)}


def at_rest(model: LumpedModel, rope: float = 2.0) -> np.ndarray:
    return model.start(phases((rest(0.0), rest(rope)), 1.0).inputs[0])


# --- the load over the horizontal ----------------------------------------------------------------------


def pushed(model: LumpedModel, outward: float, ahead: float = 0.3) -> np.ndarray:
    """Start at rest but for the load's speed [m/s]."""
    state, first = at_rest(model), (model.size - 1) // 2 + model.rope
    state[first : first + 2] = outward / 2.0, ahead / 2.0
    return state


@pytest.mark.parametrize("kind", PARAMETERS)
@pytest.mark.parametrize("speed", [6.5, 8.0, 10.5, 15.0])
def test_load_passes_over_the_horizontal(kind, speed):
    model = replace(lossless(kind), rope_as_rod=True)
    trajectory, outputs, _ = run(model, STILL, 10.0, pushed(model, speed), step=0.01, rtol=1e-9)
    assert trajectory.outcome == "finished"
    assert trajectory.evaluations < 120_000
    assert np.max(abs(outputs["sway_radial"])) > np.pi / 2
    energy = outputs["total_energy"]
    assert np.max(abs(energy - energy[0])) < 1e-6 * (0.5 * 50.5 * speed**2)
    n = model.rope
    assert_allclose(np.linalg.norm(trajectory.states[:, n : n + 3], axis=1), 1.0, atol=1e-8)


@pytest.mark.parametrize("kind", ["multi-mass", "enhanced"])
@pytest.mark.parametrize("speed", [8.0, 10.5, 15.0])
def test_rope_goes_slack_above_the_horizontal(kind, speed):
    # The jib springs up as the load rises: the rope goes slack at speeds that would carry a load around a fixed tip.
    model = lossless(kind)
    ends = []
    for rtol in (1e-4, 1e-6, 1e-9):
        trajectory, outputs, _ = run(model, STILL, 10.0, pushed(model, speed), rtol=rtol)
        assert trajectory.outcome == "slack rope"
        _, guards = model.system.slope(0.0, trajectory.end_state, phases((rest(0.0), rest(2.0)), 1.0).inputs[0])
        assert abs(guards[kernel.TENSION]) < 1e-4
        assert np.all(outputs["rope_tension"] > 0.0)
        ends.append(trajectory.end_time)
    assert_allclose(ends, ends[-1], atol=1e-4)


# --- the hard stop in the coupling ---------------------------------------------------------------------


@pytest.mark.parametrize(("rtol", "error"), [(1e-6, 5e-2), (1e-8, 5e-3), (1e-11, 1e-6)])
def test_hard_stop_of_the_coupling(rtol, error):
    # The 206 contacts magnify errors by chance: between tolerances that differ by a third they scatter a hundredfold,
    # around 4e-3 at 1e-6 and 3e-5 at 1e-8.
    trajectory, outputs, met = run(crane(drive_stiff_stiffness=7.5e6), motions(), 5.0, rtol=rtol)
    assert trajectory.outcome == "finished"
    assert abs(np.degrees(outputs["sway_radial"][-1]) - 11.444332) < error
    contacts = [guard for guard in met if guard in (kernel.INSIDE, kernel.OUTSIDE)]
    # Never twice the same way through the corner: no crossing is lost.
    assert all(a != b for a, b in pairwise(contacts))
    assert len(contacts) == 206


def test_hard_stop_by_another_solver():
    trajectory, outputs, _ = run(
        crane(drive_stiff_stiffness=7.5e6), motions(), 5.0, rtol=1e-10, method="scipy-lsoda", step=0.5
    )
    assert trajectory.outcome == "finished"
    assert_allclose(np.degrees(outputs["sway_radial"][-1]), 11.44433, atol=2e-5)


@pytest.mark.parametrize(("stiff", "error"), [(750.0, 1e-8), (7.5e6, 1e-6)])
def test_corner_that_is_only_touched(stiff, error):
    # The shaft's speed is raised until the twist is just seen to reach the corner; on either side the run is the
    # same. A touch that falls between the stages of a step is not seen: against the hard stop that costs a few 1e-7.
    def winding(speed):
        model = crane(drive_soft_stiffness=400.0, drive_stiff_stiffness=stiff, friction_law="none")
        return run(model, motions(hold=2.0, speed=speed), 4.0, rtol=1e-9)

    low, high = 0.05, 0.738
    assert not winding(low)[2]
    assert winding(high)[2]
    while (middle := 0.5 * (low + high)) not in (low, high):
        low, high = (low, middle) if winding(middle)[2] else (middle, high)
    below, above = winding(low), winding(high)
    assert below[0].outcome == above[0].outcome == "finished"
    assert len(below[2]) == 0
    assert len(above[2]) in (1, 2)
    n = 8 + 3
    assert_allclose(above[0].states[:, :n], below[0].states[:, :n], rtol=0, atol=error)


def test_corner_is_watched_only_where_the_stiffness_bends():
    straight = run(crane(drive_soft_stiffness=750.0), motions(), 5.0)
    assert straight[2] == []


# --- friction ------------------------------------------------------------------------------------------


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
    assert sum(guard in (kernel.SLIDING, kernel.HOLDING) for guard in met) == switches
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
        assert guards[kernel.HOLDING] >= 0.0
        # Power of friction is what the balance lacks against the same crane without it.
        bare = crane(kind, friction_law="none").system.slope(time - cut.times[phase], state, cut.inputs[phase])[0]
        slips = state[(model.size - 1) // 2 + model.crane.coordinates.index("platform_angle")]
        assert_allclose(slope[-1] - bare[-1], -22.0 * abs(slips), atol=1e-6)


def test_a_breakaway_is_no_reversal_though_rounding_turns_its_first_rates():
    model, drive = crane("enhanced", friction_law="stick-slip"), motions()
    cut = phases((drive["shaft"], drive["rope"]), 1.0)
    switch, numbers, floors = model.system.switch, model.system.numbers.copy(), model.system.floors.copy()
    state = model.start(cut.inputs[0])
    driven = (model.size - 1) // 2 + model.crane.coordinates.index("platform_angle")
    # Wound up by 0.2 rad with a soft stiffness of 750 N m/rad: more than friction can hold.
    state[model.crane.coordinates.index("platform_angle")] = -0.2
    numbers[kernel.SOFT] = 750.0

    def guards_at():
        constants = (numbers, *model.system.constants[1:])
        slope, guards, work = np.empty(model.size), np.empty(6), np.zeros(model.system.work_shape)
        model.system.rhs(0.0, state, slope, cut.inputs[0], *constants, work, guards)
        return guards

    switch.begin(state, numbers, floors, guards_at)
    assert numbers[kernel.FRICTION_STATE] == kernel.SLIP_AHEAD
    state[driven] = -1e-27
    assert np.all(guards_at() >= floors)
    # A rate that has turned is one.
    state[driven] = -1e-9
    assert guards_at()[kernel.SLIDING] < floors[kernel.SLIDING]
    switch.cross(kernel.SLIDING, state, numbers, floors, guards_at)
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
    assert set(met) <= {kernel.INSIDE, kernel.OUTSIDE}
    assert_allclose(outputs["sway_tangential"], 0.0, atol=1e-12)


def test_switch_that_does_nothing_ends_the_run_by_name():
    class Stuck:
        changes_equations = True

        def begin(self, state, numbers, floors, guards_at):
            floors[kernel.INSIDE] = 0.0

        def cross(self, guard, state, numbers, floors, guards_at):
            return True

    model, drive = crane(), motions()
    system, cut = replace(model.system, switch=Stuck()), phases((drive["shaft"], drive["rope"]), 5.0)
    trajectory = integrate(system, cut, model.start(cut.inputs[0]), np.zeros(1))
    assert trajectory.outcome == "switching without progress"
    assert 0.0 < trajectory.end_time < 5.0


# --- stiffness -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("inertia", "sway", "platform", "methods"),
    [
        (6.0, 15.890460, 3.5529586, ("dop853", "scipy-lsoda", "scipy-radau")),
        (0.06, 15.887425, 3.5593490, ("dop853", "scipy-lsoda", "scipy-radau")),
        (6e-4, 15.887500, 3.5594092, ("scipy-lsoda", "scipy-radau")),
    ],
)
def test_platform_of_hardly_any_inertia(inertia, sway, platform, methods):
    for method in methods:
        trajectory, outputs, _ = run(crane(inertia_platform=inertia), motions(), 5.0, method=method, rtol=1e-7)
        assert trajectory.outcome == "finished"
        assert_allclose(np.degrees(outputs["sway_radial"][-1]), sway, atol=5e-6)
        assert_allclose(outputs["platform_angle"][-1], platform, atol=5e-7)


def test_platform_of_hardly_any_inertia_that_sticks():
    # Without inertia of its own the platform follows its coupling; friction is set-valued, not stiff.
    found = []
    for inertia in (6e-2, 6e-3, 6e-4):
        model = crane(inertia_platform=inertia, friction_law="stick-slip")
        trajectory, outputs, _ = run(model, motions(), 3.0)
        assert trajectory.outcome == "finished"
        assert imbalance(outputs) < 1e-6
        found.append(outputs["platform_angle"][-1])
    gaps = abs(np.diff(found))
    assert gaps[1] < 0.2 * gaps[0] + 1e-7


def test_all_springs_a_thousand_times_stiffer():
    names = [n for n in vars(MULTI_MASS) if n.startswith("stiffness")] + [
        "drive_soft_stiffness",
        "drive_stiff_stiffness",
    ]
    model = crane(**{name: 1e3 * getattr(MULTI_MASS, name) for name in names})
    runs = [run(model, motions(), 5.0, rtol=rtol) for rtol in (1e-5, 1e-9)]
    for trajectory, outputs, _ in runs:
        assert trajectory.outcome == "finished"
        assert np.max(abs(outputs["sway_radial"] - runs[-1][1]["sway_radial"])) < 1e-4
    implicit = run(model, motions(), 1.0, rtol=1e-6, method="scipy-radau")
    assert implicit[0].outcome == "finished"
    assert_allclose(implicit[1]["sway_radial"], runs[-1][1]["sway_radial"][:21], atol=1e-5)


# --- long and far --------------------------------------------------------------------------------------


def arm_alone(inertia: float, stiffness: float) -> LumpedModel:
    """The shortest crane: an arm on a coupling, and the load."""
    return LumpedModel(
        LumpedCrane(
            name="arm",
            coordinates=("platform_angle",),
            points={"tip": Point(14.0, (Link("platform_angle", {"": 2.0}),), {"": 2.2})},
            springs=(),
            drive=Drive("platform_angle", stiffness, stiffness, 0.25, 0.0, "none"),
            inertias={"platform_angle": inertia},
            suspension="tip",
            jib_angle="platform_angle",
            readings={},
        ),
        Load(50.5),
    )


def test_one_hour_of_free_swing_is_the_exact_pendulum():
    # In the jib's own plane nothing moves but the load: 60 degrees, some 1190 periods.
    model, amplitude = arm_alone(95.0, 750.0), np.radians(60)
    start = model.start(phases((rest(0.0), rest(2.0)), 1.0).inputs[0], "equilibrium", amplitude)
    trajectory, outputs, _ = run(model, STILL, 3600.0, start, step=1.0, rtol=1e-11)
    assert trajectory.outcome == "finished"
    k, omega = np.sin(amplitude / 2), np.sqrt(9.81 / 2.0)
    sn, *_ = ellipj(ellipk(k**2) - omega * trajectory.times, k**2)
    assert_allclose(outputs["sway_radial"], 2 * np.arcsin(k * sn), atol=1e-6)
    assert np.all(outputs["platform_angle"] == 0.0)


def test_one_hour_of_free_swing_in_space_keeps_its_energy():
    model = arm_alone(95.0, 20.0)
    start = model.start(phases((rest(0.0), rest(2.0)), 1.0).inputs[0], "equilibrium", 0.8)
    start[model.size // 2 + 2] = 0.7
    trajectory, outputs, _ = run(model, STILL, 3600.0, start, step=1.0, rtol=1e-10)
    assert trajectory.outcome == "finished"
    energy = outputs["total_energy"]
    swing = 50.5 * 9.81 * 2.0 * (1 - np.cos(0.8))
    assert np.max(abs(energy - energy[0])) < 1e-6 * swing
    assert np.max(abs(np.linalg.norm(trajectory.states[:, 1:4], axis=1) - 1)) < 1e-7


def test_one_hour_with_a_loose_tolerance():
    trajectory, outputs, _ = run(crane("enhanced"), motions(), 3600.0, step=1.0, rtol=1e-4)
    assert trajectory.outcome == "finished"
    assert imbalance(outputs) < 1e-3
    late = trajectory.times > 3000
    # Drag in the square of the speed lets a small swing last: its amplitude falls as one over time.
    assert 1.0 < np.degrees(np.max(abs(outputs["sway_radial"][late]))) < 3.0
    assert np.max(abs(outputs["rope_tension"][late] - 50.5 * 9.81)) < 2.0


@pytest.mark.parametrize("kind", PARAMETERS)
def test_rope_hauled_from_twenty_metres_to_one(kind):
    hauled = {"shaft": motions()["shaft"], "rope": trapezoid(20.0, 1.0, 0.8, 0.5)}
    runs = [run(crane(kind), hauled, 30.0, rtol=rtol) for rtol in (1e-6, 1e-10)]
    for trajectory, outputs, _ in runs:
        assert trajectory.outcome == "finished"
        assert np.max(abs(outputs["sway_radial"] - runs[-1][1]["sway_radial"])) < 3e-4
    assert imbalance(runs[-1][1]) < 3e-10
    assert_allclose(runs[-1][1]["rope_length"][[0, -1]], [20.0, 1.0], rtol=1e-12)


def test_small_swing_grows_as_the_rope_is_hauled_slowly():
    # Adiabatic invariant of the pendulum: energy over frequency, so the angle grows with length^(-3/4).
    model = arm_alone(95.0, 750.0)
    drive = {"shaft": rest(0.0), "rope": trapezoid(20.0, 1.0, 0.02, 0.001)}
    start = model.start(phases((rest(0.0), rest(20.0)), 1.0).inputs[0], "equilibrium", 1e-3)
    trajectory, outputs, _ = run(model, drive, 1000.0, start, step=0.1)
    assert trajectory.outcome == "finished"
    angle = abs(outputs["sway_radial"])
    before, after = angle[trajectory.times < 9.0].max(), angle[trajectory.times > 985.0].max()
    assert_allclose(after / before, 20.0**0.75, rtol=0.02)

"""The jib crane under torques: its plan's drive it along the plan, gains bring it back, held ones let errors grow."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.balance import imbalance
from samples.jib_cranes import (
    HEAVY,
    LOAD,
    PRINTED,
    constant,
    peak,
    planned,
    printed_plan,
    smooth_plan,
    standing,
    trapezoid_plan,
)

from towercrane.cranes.jib.linear import growth_rates, static_matrices, static_torques
from towercrane.cranes.jib.model import DrivenJibCrane
from towercrane.cranes.jib.tracking import TrackingJibCrane
from towercrane.motions.motion import phases
from towercrane.simulation.directions import restore_rows
from towercrane.simulation.integrate import integrate
from towercrane.simulation.simulate import simulate


@pytest.mark.parametrize(
    ("crane", "motions", "duration", "gains", "bound"),
    [
        (HEAVY, printed_plan(), 3.0, (0.0, 0.0), 1e-12),
        (HEAVY, smooth_plan(), 5.0, (0.0, 0.0), 1e-11),
        (PRINTED, printed_plan(), 1.0, (0.0, 0.0), 1e-8),
        (HEAVY, smooth_plan(), 70.0, (8e6, 4e6), 1e-9),
        (HEAVY, trapezoid_plan(), 60.0, (8e6, 4e6), 1e-9),
        (HEAVY, printed_plan(), 90.0, (5e6, 2e6), 1e-10),
    ],
    ids=[
        "open printed plan",
        "open smooth plan",
        "open light booms",
        "held smooth",
        "held trapezoids",
        "held printed",
    ],
)
def test_the_plans_torques_drive_the_crane_along_the_plan(crane, motions, duration, gains, bound):
    model = TrackingJibCrane(crane, LOAD, *gains)
    result = simulate(model, motions, duration, output_step=0.5, rtol=1e-12, atol=1e-14)
    assert result.attrs["outcome"] == "finished"
    assert peak(result["joint_error"]) < bound
    asked = simulate(planned(crane), motions, duration, output_step=0.5, rtol=1e-12, atol=1e-14)
    for name in ("joint_torque", "sway_in_plane", "hoist_rope_force", "total_energy", "input_work"):
        assert peak(result[name] - asked[name]) < 1e3 * bound * peak(asked[name])
    assert imbalance(result) < 1e-10


def test_the_error_of_a_joint_is_how_far_it_is_beyond_its_plan():
    model, plan = TrackingJibCrane(HEAVY, LOAD), standing(fold=0.1)
    state = model.start(phases(tuple(plan.values()), 1.0).inputs[0])
    state[:3] += 0.01, 0.02, -0.03
    seen = model.observe(plan, np.zeros(1), state[None], state[None], np.zeros((1, len(model.system.guards))))
    assert_allclose(seen["joint_error"].values, [[0.01, 0.02, -0.03]], atol=1e-15)


def test_gains_bring_a_crane_back_that_starts_off_its_plan():
    model = TrackingJibCrane(HEAVY, LOAD, 8e6, 4e6)
    cut = phases(tuple(standing()[channel] for channel in model.channels), 30.0)
    start = model.start(cut.inputs[0])
    start[:3] += [0.01, -0.01, 0.01]
    run = integrate(model.system, cut, start, np.linspace(0, 30, 31), rtol=1e-9, atol=1e-11)
    off = abs(run.states[:, :3] - [0.0, 0.6, -0.2])
    assert run.outcome == "finished"
    assert peak(off[-5:]) < 0.1 * peak(off)
    # Without gains the booms fall away from it.
    loose = integrate(TrackingJibCrane(HEAVY, LOAD).system, cut, start, np.array([0.0, 2.0]))
    assert peak(loose.states[-1, :3] - [0.0, 0.6, -0.2]) > 0.05


def test_both_loads_are_put_back_on_their_ropes():
    model = TrackingJibCrane(HEAVY, LOAD)
    state = np.arange(1.0, 21.0)
    restore_rows(state, model.system.directions)
    for n, p in ((state[3:6], state[9:12]), (state[13:16], state[16:19])):
        assert_allclose([np.linalg.norm(n), n @ p], [1.0, 0.0], atol=1e-14)
    assert_allclose(state[[0, 6, 12, 19]], [1.0, 7.0, 13.0, 20.0])


def test_torques_that_hold_the_crane_hold_it_and_errors_grow_as_predicted():
    luff, fold = 0.8, 0.0
    torques = static_torques(HEAVY, LOAD, luff, fold)
    off = 1e-9
    model = DrivenJibCrane(HEAVY, LOAD, (0.0, luff + off, fold))
    motions = dict(zip(model.channels, constant(*torques, 20.0), strict=True))
    result = simulate(model, motions, 4.0, output_step=0.1, rtol=1e-13, atol=1e-17)
    error = result["joint_angle"].values - [0.0, luff, fold]
    mass, stiffness = static_matrices(HEAVY, LOAD, luff, fold, 20.0)
    squared, shapes = np.linalg.eig(np.linalg.solve(mass, -stiffness))
    weights = np.linalg.solve(shapes, [0.0, off, 0.0, 0.0, 0.0])
    expected = (shapes * weights) @ np.cosh(np.sqrt(squared.astype(complex))[:, None] * result.time.values)
    assert_allclose(error, expected.real[:3].T, atol=2e-4 * peak(error))
    assert peak(error) > 300 * off


@pytest.mark.parametrize(
    ("crane", "luff_only", "all_free"),
    [
        (PRINTED, (0.344, 0.600, 0.886, 1.313), (13.9, 21.7, 24.9, 28.8)),
        (HEAVY, (0.363, 0.621, 0.836, 0.964), (1.59, 2.58, 3.37, 4.42)),
    ],
    ids=["printed", "heavy"],
)
def test_growth_rates_of_booms_under_held_torques(crane, luff_only, all_free):
    poses = (0.3, 0.8, 1.2, 1.5)
    assert_allclose([growth_rates(crane, LOAD, a, 0.0, 20.0, (1, 3))[0] for a in poses], luff_only, atol=6e-4)
    assert_allclose([growth_rates(crane, LOAD, a, 0.0, 20.0)[0] for a in poses], all_free, rtol=3e-3)

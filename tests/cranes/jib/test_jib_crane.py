"""The jib crane over time: figures of its source, limits with exact answers, balance, plans driven, hard cases."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.balance import imbalance
from samples.jib_cranes import (
    HEAVY,
    LOAD,
    PRINTED,
    peak,
    planned,
    printed_plan,
    smooth_plan,
    standing,
    trapezoid_plan,
)
from scipy.optimize import least_squares

from towercrane.cranes.jib.linear import growth_rates, static_matrices, static_torques
from towercrane.cranes.jib.model import TORQUES, DrivenJibCrane
from towercrane.cranes.jib.tracking import TrackingJibCrane
from towercrane.kernels.payload import Load
from towercrane.motions.motion import Motion, phases, rest
from towercrane.motions.profiles import trapezoid
from towercrane.simulation.directions import restore_rows
from towercrane.simulation.integrate import integrate
from towercrane.simulation.simulate import simulate

TIGHT = {"rtol": 1e-11, "atol": 1e-13}
G = 9.81


def constant(*values):
    """Channels that rest at these values, in the order of the model's."""
    return tuple(rest(v) for v in values)


# --- the source's plan -------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def printed():
    return simulate(planned(PRINTED), printed_plan(), 200.0, output_step=0.05, **TIGHT)


def test_the_printed_plan_reaches_its_check_values(printed):
    sway = printed["sway_in_plane"].sel(time=[20, 80, 200], method="nearest")
    assert_allclose(sway, [2.021362e-3, -3.450128e-3, 1.202940e-3], atol=6e-10)
    luff_torque = printed["joint_torque"].sel(joint="luff")
    assert_allclose(luff_torque.sel(time=40, method="nearest"), 7.66133e5, rtol=1e-6)
    assert_allclose([luff_torque.min(), luff_torque.max()], [8.23e4, 1.179e6], rtol=5e-4)
    assert printed.attrs["outcome"] == "finished"


def test_a_plan_in_one_plane_stays_in_it_exactly(printed):
    assert np.all(printed["sway_lateral"] == 0.0)
    assert np.all(printed["joint_torque"].sel(joint="slew") == 0.0)
    tension = printed["rope_tension"] / (LOAD.mass * G)
    assert_allclose([tension.min(), tension.max()], [0.998, 1.002], atol=5e-4)


@pytest.mark.parametrize(
    ("luff", "fold", "peaks", "residual", "torques"),
    [
        (0.0, 0.0, (1.49, 1.53, 4.08), 2.929, (4.43e5, 1.234e6)),
        (0.15, 0.0, (1.78, 1.95, 4.29), 3.432, (2.66e5, 1.220e6)),
        (0.3, 0.0, (2.13, 2.34, 4.52), 3.8804, (8.23e4, 1.179e6)),
        (0.37, 0.0, (2.44, 2.51, 4.63), 4.066, (-4.0e3, 1.150e6)),
        (0.3, -0.3, (1.81, 2.01, 4.29), 3.489, (2.26e5, 1.201e6)),
        (0.3, 0.2, (2.48, 2.52, 4.62), 4.071, (-1.6e4, 1.140e6)),
    ],
)
def test_sway_left_over_swings_at_the_pendulum_frequency_and_does_not_fade(luff, fold, peaks, residual, torques):
    # The source prints "about 0.1 Hz" and gives no start pose; the elevations here bracket what 1.2 rad allow.
    result = simulate(planned(PRINTED), printed_plan(luff, fold), 200.0, output_step=0.1, **TIGHT)
    sway = result["sway_in_plane"]
    reached = [1e3 * peak(sway.sel(time=slice(*span))) for span in ((0, 20), (20, 60), (60, 80))]
    assert_allclose(reached, peaks, atol=6e-3)
    late = sway.sel(time=slice(80.2, 200))
    t, values = late.time.values, 1e3 * late.values

    def misfit(x):
        return x[0] * np.cos(x[2] * t) + x[1] * np.sin(x[2] * t) - values

    omega = np.sqrt(G / 20)
    guess = np.linalg.lstsq(np.stack([np.cos(omega * t), np.sin(omega * t)], axis=1), values, rcond=None)[0]
    fit = least_squares(misfit, [*guess, omega], xtol=1e-12, ftol=1e-12)
    assert_allclose(np.hypot(*fit.x[:2]), residual, atol=6e-4)
    assert_allclose(fit.x[2] / (2 * np.pi), 0.111465, atol=6e-7)
    assert peak(fit.fun) < 1e-4 * residual
    luff_torque = result["joint_torque"].sel(joint="luff")
    assert_allclose([luff_torque.min(), luff_torque.max()], torques, rtol=5e-3, atol=300)


def test_torques_at_a_jump_are_right_limits():
    # The luffing acceleration jumps by -0.001 rad/s^2 at 20 s, 60 s and +0.001 at 80 s; sway and rates do not.
    result = simulate(planned(), printed_plan(), 100.0, output_step=0.02, **TIGHT)
    torque, times = result["joint_torque"].values, result.time.values
    mass, _ = static_matrices(HEAVY, LOAD, 0.5, 0.0, 20.0)
    for jump, change in ((20.0, -0.001), (60.0, -0.001), (80.0, 0.001)):
        at = int(np.argmin(abs(times - jump)))
        limits = [
            np.array([np.polynomial.Polynomial.fit(times[s], torque[s, j], 4)(jump) for j in (1, 2)])
            for s in (slice(at - 8, at), slice(at + 1, at + 9))
        ]
        assert_allclose(torque[at, 1:], limits[1], atol=1e-3)
        # Along the booms' elevation: inertia of the booms and of the load along its nearly upright rope.
        luff = float(result["joint_angle"][at, 1])
        reach = 25 * np.cos(luff)
        rope = reach * np.cos(float(result["sway_in_plane"][at]))
        rope += 25 * np.sin(luff) * np.sin(float(result["sway_in_plane"][at]))
        booms = mass[1, 1] - LOAD.mass * 25**2
        assert_allclose((limits[1] - limits[0])[0], change * (booms + LOAD.mass * rope**2), rtol=1e-5)


def test_elevations_and_ways_of_swing_have_the_stated_signs():
    turned = simulate(planned(), standing(slew=0.5 * np.pi), 0.1, output_step=0.1, swing_angle=0.2)
    assert_allclose(turned["sway_in_plane"][0], 0.2, rtol=1e-12)
    assert_allclose(turned["sway_lateral"][0], 0.0, atol=1e-15)
    reach = 15 * np.cos(0.6) + 10 * np.cos(0.4) + 20 * np.sin(0.2)
    height = 12 + 15 * np.sin(0.6) + 10 * np.sin(0.4) - 20 * np.cos(0.2)
    assert_allclose(turned["payload_position"][0], [0.0, reach, height], atol=1e-12)
    # A crane that begins to slew leaves its load behind; one that begins to luff down moves it outward.
    begin = {**standing(), "slew": trapezoid(0.0, 1.0, 0.1, 0.05)}
    assert simulate(planned(), begin, 1.0)["sway_lateral"][-1] < -1e-4
    lower = {**standing(), "luff": trapezoid(0.6, 0.1, 0.1, 0.05)}
    assert simulate(planned(), lower, 1.0)["sway_in_plane"][-1] < -1e-4


# --- balance and symmetry -------------------------------------------------------------------------------------


@pytest.mark.parametrize("motions", [smooth_plan(), trapezoid_plan()], ids=["smooth", "trapezoids"])
@pytest.mark.parametrize("load", [LOAD, Load(5000.0, rope_damping=2e4, drag_area=30.0)], ids=["lossless", "lossy"])
def test_energy_gained_is_the_work_of_joints_and_winch_less_losses(motions, load):
    result = simulate(planned(load=load), motions, 100.0, output_step=0.5, **TIGHT)
    assert imbalance(result) < 5e-12
    assert peak(result["input_work"]) > 1e5


def momentum_about_the_post(states, crane, load, length):
    """J theta' of post and booms (rods: their points move across their plane by slewing alone), and the load's."""
    theta, n, rates, p = states[:, :3], states[:, 3:6], states[:, 6:9], states[:, 9:12]
    first, second = crane.primary_length, crane.secondary_length
    h2, h3 = first * np.cos(theta[:, 1]), second * np.cos(theta[:, 1] + theta[:, 2])
    primary, secondary = crane.primary_mass_per_length * first, crane.secondary_mass_per_length * second
    inertia = crane.post_inertia + primary * h2**2 / 3 + secondary * (h2**2 + h2 * h3 + h3**2 / 3)
    reach = h2 + h3
    drawn_in = -first * np.sin(theta[:, 1]) * rates[:, 1]
    drawn_in -= second * np.sin(theta[:, 1] + theta[:, 2]) * (rates[:, 1] + rates[:, 2])
    turn = np.exp(1j * theta[:, 0])
    place = reach * turn + length * (n[:, 0] + 1j * n[:, 1])
    speed = (drawn_in + 1j * reach * rates[:, 0]) * turn + length * (p[:, 0] + 1j * p[:, 1])
    return inertia * rates[:, 0] + load.mass * (place.conj() * speed).imag


def test_free_booms_keep_energy_and_momentum_about_the_post():
    model = DrivenJibCrane(HEAVY, LOAD, (0.3, 0.9, -0.4), (0.3, 0.2, -0.3), rope_as_rod=True)
    idle = dict(zip(model.channels, constant(0.0, 0.0, 0.0, 20.0), strict=True))
    cut, times = phases(tuple(idle.values()), 3.0), np.linspace(0.0, 3.0, 31)
    start = model.start(cut.inputs[0], "zero", 0.3)
    run = integrate(model.system, cut, start, times, rtol=1e-13, atol=1e-15)
    momentum = momentum_about_the_post(run.states, HEAVY, LOAD, 20.0)
    assert peak(momentum) > 1e5
    assert np.ptp(momentum) < 1e-11 * peak(momentum)
    assert np.ptp(run.states[:, 1]) > 0.5
    assert np.all(run.states[:, -1] == 0.0)
    result = simulate(model, idle, 3.0, swing_angle=0.3, rtol=1e-13, atol=1e-15)
    energy = result["total_energy"].values
    assert np.ptp(energy) < 1e-12 * peak(energy)


def test_every_joint_gets_its_own_torque():
    times, shares = np.array([0.0, 2.0]), np.array([1.0, 0.02, -0.003])
    torques = {
        name: Motion(times, size * shares[None]) for name, size in zip(TORQUES, (3e4, 1.7e6, 5e5), strict=False)
    }
    model = DrivenJibCrane(HEAVY, LOAD, (0.3, 0.6, -0.2))
    result = simulate(model, torques | {"rope": rest(20.0)}, 2.0, output_step=0.25)
    wanted = np.stack([torque(result.time.values) for torque in torques.values()], axis=1)
    assert_allclose(result["joint_torque"], wanted, rtol=1e-14)
    # And each moves its own joint: at the start by the masses alone.
    start = model.start(np.zeros((4, 3)))
    inputs = phases((*torques.values(), rest(20.0)), 1.0).inputs[0]
    bare = inputs.copy()
    bare[:3] = 0.0
    slopes = [model.system.slope(0.0, start, row)[0] for row in (inputs, bare)]
    mass, _ = static_matrices(HEAVY, LOAD, 0.6, -0.2, 20.0)
    condensed = mass[:3, :3] - mass[:3, 3:] @ np.linalg.solve(mass[3:, 3:], mass[3:, :3])
    rates = slice(6, 9)
    assert_allclose(condensed @ (slopes[0] - slopes[1])[rates], inputs[:3, 0], rtol=1e-9)


@pytest.mark.parametrize("swing_angle", [0.0, 0.4])
def test_energy_at_rest_counts_from_the_foot_of_the_post(swing_angle):
    luff, fold, rope = 0.6, -0.2, 20.0
    result = simulate(planned(), standing(0.7, luff, fold, rope), 0.1, output_step=0.1, swing_angle=swing_angle)
    hinge = HEAVY.post_height + 15.0 * np.sin(luff)
    heights = {
        200.0 * 15.0: HEAVY.post_height + 7.5 * np.sin(luff),
        120.0 * 10.0: hinge + 5.0 * np.sin(luff + fold),
        LOAD.mass: hinge + 10.0 * np.sin(luff + fold) - rope * np.cos(swing_angle),
    }
    wanted = G * sum(mass * height for mass, height in heights.items())
    assert_allclose(result["total_energy"][0], wanted, rtol=1e-14)


def test_slewing_the_whole_plan_turns_the_whole_answer():
    options = {"output_step": 0.5, **TIGHT}
    straight = simulate(planned(), smooth_plan(), 80.0, swing_angle=0.05, **options)
    turned = simulate(planned(), smooth_plan(2.3), 80.0, swing_angle=0.05, **options)
    for name in ("sway_in_plane", "sway_lateral", "rope_tension", "total_energy", "joint_torque"):
        assert peak(turned[name] - straight[name]) < 1e-9 * peak(straight[name])
    c, s = np.cos(2.3), np.sin(2.3)
    rotated = straight["payload_position"].values @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
    assert_allclose(turned["payload_position"], rotated, atol=1e-8)


# --- the crane under its plan's torques ---------------------------------------------------------------------


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
    for name in ("joint_torque", "sway_in_plane", "rope_tension", "total_energy", "input_work"):
        assert peak(result[name] - asked[name]) < 1e3 * bound * peak(asked[name])
    assert imbalance(result) < 1e-10


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

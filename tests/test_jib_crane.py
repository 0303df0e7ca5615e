"""The jib crane over time: figures of its source, limits with exact answers, balance, plans driven, hard cases."""

import numpy as np
import pytest
from balance import imbalance
from jib_cranes import HEAVY, LOAD, PRINTED, after, peak, planned, printed_plan, smooth_plan, standing, trapezoid_plan
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, least_squares
from scipy.special import ellipj, ellipk, jv, yv

from towercrane.cranes.jib_crane import DrivenJibCrane, JibCrane, PlannedJibCrane
from towercrane.cranes.jib_crane_linear import LinearSway, growth_rates, static_matrices, static_torques
from towercrane.cranes.jib_crane_tracking import TrackingJibCrane
from towercrane.integrate import integrate
from towercrane.motion import Motion, phases, rest, smooth_ramps, trapezoid
from towercrane.payload import Load
from towercrane.simulate import simulate

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


def test_a_restart_puts_both_loads_back_on_their_ropes():
    model = TrackingJibCrane(HEAVY, LOAD)
    state = np.arange(1.0, 21.0)
    model.system.restore(state)
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


# --- the linear model -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("faster", "swing", "frozen", "heaving"),
    [(1, 0.259, 3.9e-3, 2.7e-5), (2, 1.38, 1.1e-2, 9.8e-5), (4, 6.19, 4.8e-2, 2.8e-2), (8, 17.8, 0.28, 0.24)],
)
def test_linear_sway_errs_as_much_as_it_should(faster, swing, frozen, heaving):
    motions, duration = printed_plan(faster=faster), 80 / faster + 60
    exact = simulate(planned(PRINTED), motions, duration, **TIGHT)["sway_in_plane"]
    assert_allclose(np.degrees(peak(exact)), swing, rtol=3e-3)
    errors = [
        peak(simulate(LinearSway(PRINTED, LOAD, heave), motions, duration, **TIGHT)["sway_in_plane"] - exact)
        for heave in (False, True)
    ]
    assert_allclose(np.array(errors) / peak(exact), [frozen, heaving], rtol=0.03)


def test_linear_sway_converges_to_the_exact_one_with_slew_and_hoist():
    # What is left out is of third order in the sway.
    errors = []
    for scale in (0.25, 0.125):
        motions = {
            **standing(),
            "slew": smooth_ramps(0.0, 0.05 * scale, 8.0, 12.0),
            "rope": smooth_ramps(20.0, -0.3, 4.0, 16.0),
        }
        runs = [simulate(m, motions, 40.0, **TIGHT) for m in (planned(), LinearSway(HEAVY, LOAD))]
        for name in ("sway_in_plane", "sway_lateral"):
            errors.append(peak(runs[0][name] - runs[1][name]) / peak(runs[0][name]))
    assert max(errors) < 6e-4
    assert_allclose(np.divide(errors[:2], errors[2:]), 4.0, rtol=0.05)


# --- hoisting -------------------------------------------------------------------------------------------------


def hoisted(start, end, speed):
    rope = Motion(np.array([0.0, (start - end) / speed]), np.array([[start, -speed]]))
    return {**standing(), "rope": rope}, (start - end) / speed


def test_small_sway_while_hoisting_is_the_bessel_solution():
    speed, start, angle = 0.2, 20.0, 1e-5
    motions, duration = hoisted(start, 4.0, speed)
    duration -= 0.5
    result = simulate(planned(), motions, duration, output_step=0.5, swing_angle=angle, rtol=1e-12, atol=1e-18)
    length = result["rope_length"].values

    def basis(rope):
        z = 2 * np.sqrt(G * rope) / speed
        value = np.array([jv(1, z), yv(1, z)]) / np.sqrt(rope)
        # d/dl [l^-1/2 C_1(z)] = -(sqrt g / v) l^-1 C_2(z)
        return value, -np.sqrt(G) / speed * np.array([jv(2, z), yv(2, z)]) / rope

    value, slope = basis(start)
    amplitudes = np.linalg.solve([value, slope], [angle, 0.0])
    expected = amplitudes @ basis(length)[0]
    # The pendulum's own third order is 1e-11 of the swing.
    assert_allclose(result["sway_in_plane"], expected, atol=1e-7 * peak(expected))
    assert peak(expected) > 2.5 * angle


def test_rope_hauled_from_20_m_to_1_m():
    motions, duration = hoisted(20.0, 1.0, 0.2)
    motions["rope"] = Motion(np.array([0.0, duration + 1.0]), motions["rope"].coefficients)
    result = simulate(planned(), motions, duration, output_step=0.01, swing_angle=0.1, rtol=1e-10, atol=1e-12)
    assert result.attrs["outcome"] == "finished"

    def pendulum(t, y):
        return [y[1], -(G * np.sin(y[0]) - 2 * 0.2 * y[1]) / (20 - 0.2 * t)]

    wanted = result.time.values
    leg = solve_ivp(pendulum, (0, duration), [0.1, 0.0], "DOP853", wanted, rtol=1e-12, atol=1e-14)
    assert_allclose(result["sway_in_plane"], leg.y[0], atol=1e-6)
    # Turning points: small sway grows as l^(-3/4), to 0.3201 at 4.24 m and 0.899 at 1.07 m; a real one beyond it.
    swing, length = abs(result["sway_in_plane"].values), result["rope_length"].values
    turns = 1 + np.flatnonzero((swing[1:-1] > swing[:-2]) & (swing[1:-1] >= swing[2:]))
    for at, grown, small in ((4.24, 0.3208, 0.3201), (1.07, 0.917, 0.899)):
        near = turns[np.argmin(abs(length[turns] - at))]
        assert_allclose([length[near], swing[near]], [at, grown], atol=6e-3)
        assert_allclose(0.1 * (20 / length[near]) ** 0.75, small, rtol=5e-3)
    # The winch works against a real tension: the balance closes to the solver's tolerance.
    assert imbalance(result) < 1e-8


# --- hard cases -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("delta", [0.1, 1e-3, 1e-6])
def test_a_swing_past_the_pole_of_the_angles_is_the_exact_spherical_pendulum(delta):
    length, low, high = 20.0, np.radians(40), 0.5 * np.pi - delta
    c_low, c_high = np.cos(low), np.cos(high)
    omega2 = G / length
    # Both turning points share energy and momentum about the vertical.
    momentum = np.sqrt(2 * omega2 * (c_low - c_high) / (1 / np.sin(low) ** 2 - 1 / np.sin(high) ** 2))
    model = planned()
    n, p = np.array([0.0, np.sin(high), -c_high]), np.array([-momentum / np.sin(high), 0.0, 0.0])
    cut = phases(tuple(standing()[channel] for channel in model.channels), 20.0)
    times = np.linspace(0.0, 20.0, 101)
    run = integrate(model.system, cut, np.concatenate([n, p, [0.0]]), times, rtol=1e-9, atol=1e-11)
    assert run.outcome == "finished"
    # s = cos(tilt): s'^2 = -2 (g/l) (s - s_high)(s - s_low)(s - s_3).
    energy = momentum**2 / (2 * np.sin(high) ** 2) - omega2 * c_high
    third = -energy / omega2 - c_low - c_high
    m = (c_low - c_high) / (c_low - third)
    sn = ellipj(np.sqrt(0.5 * omega2 * (c_low - third)) * times + ellipk(m), m)[0]
    assert_allclose(-run.states[:, 2], c_low - (c_low - c_high) * sn**2, atol=2e-7)
    # No angle is a state: the pole costs nothing.
    assert run.evaluations < 1500


def test_one_hour_of_free_swing_keeps_the_rope_s_length_and_its_period():
    angle = np.radians(40)
    model = planned()
    cut = phases(tuple(standing()[channel] for channel in model.channels), 3600.0)
    start = model.start(cut.inputs[0], "zero", angle)
    for rtol, stretch, loss in ((1e-6, 1e-5, 1e-3), (1e-9, 3e-9, 3e-7)):
        run = integrate(model.system, cut, start, np.linspace(3590, 3600, 41), rtol=rtol, atol=0.01 * rtol)
        assert peak(np.linalg.norm(run.states[:, :3], axis=1) - 1) < stretch
        swing = np.arctan2(run.states[:, 0], -run.states[:, 2])
        rate = np.linalg.norm(run.states[:, 3:6], axis=1)
        energy = 0.5 * rate**2 + G / 20 * (1 - np.cos(swing))
        assert peak(energy / (G / 20 * (1 - np.cos(angle))) - 1) < loss
    # Jacobi: sin(theta/2) = sin(angle/2) cd(sqrt(g/l) t).
    m = np.sin(angle / 2) ** 2
    sn = ellipj(ellipk(m) - np.sqrt(G / 20) * run.times, m)[0]
    assert peak(swing - 2 * np.arcsin(np.sin(angle / 2) * sn)) < 1e-5


def test_a_start_at_rest_where_the_printed_angles_are_singular_stays_at_rest():
    for model, motions in (
        (planned(), standing(slew=0.4)),
        (TrackingJibCrane(HEAVY, LOAD, 8e6, 4e6), standing(slew=0.4)),
    ):
        result = simulate(model, motions, 10.0)
        assert peak(result["sway_in_plane"]) == 0.0
        assert peak(result["sway_lateral"]) == 0.0
        assert_allclose(result["rope_tension"], LOAD.mass * G, rtol=1e-12)
        assert_allclose(result["joint_torque"][-1], static_torques(HEAVY, LOAD, 0.6, -0.2), rtol=1e-9, atol=1e-6)


def test_a_load_that_falls_behind_its_rope_ends_the_run_when_it_does():
    # Paid out faster than it falls: T = m (g - l'') for a load that hangs still.
    rope = smooth_ramps(10.0, 10.0, 1.5, 1.5)
    motions = {**standing(), "rope": after(1.0, rope)}
    result = simulate(planned(), motions, 4.0)
    assert result.attrs["outcome"] == "slack rope"
    assert_allclose(result.attrs["end_time"], 1.0 + brentq(lambda t: rope(t, 2) - G, 0.0, 0.75), atol=1e-9)
    assert_allclose(result["rope_tension"][-1], 0.0, atol=1e-3)
    rod = simulate(planned(rope_as_rod=True), motions, 4.0)
    assert rod.attrs["outcome"] == "finished"
    assert rod["rope_tension"].min() < 0.0


def test_booms_lowered_faster_than_the_load_falls_end_the_run_at_the_jump():
    motions = {**standing(), "luff": after(2.0, trapezoid(0.6, -0.6, 1.0, 1.0))}
    for model in (planned(), TrackingJibCrane(HEAVY, LOAD, 8e6, 4e6)):
        result = simulate(model, motions, 5.0)
        assert result.attrs["outcome"].startswith("slack rope")
        assert result.attrs["end_time"] == 2.0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"primary_length": 0.0}, r"JibCrane\.primary_length: wanted a positive"),
        ({"secondary_mass_per_length": -1.0}, r"JibCrane\.secondary_mass_per_length"),
        ({"post_inertia": float("nan")}, r"JibCrane\.post_inertia: wanted zero or more"),
        ({"gravity": 0.0}, r"JibCrane\.gravity"),
    ],
)
def test_impossible_cranes_are_refused(change, message):
    import dataclasses

    with pytest.raises(ValueError, match=message):
        dataclasses.replace(HEAVY, **change)


def test_impossible_arguments_are_refused():
    with pytest.raises(ValueError, match=r"TrackingJibCrane\.damping"):
        TrackingJibCrane(HEAVY, LOAD, 1.0, -1.0)
    with pytest.raises(ValueError, match="state: wanted"):
        simulate(planned(), standing(), 1.0, state="bent")


def test_results_say_what_they_are():
    result = simulate(PlannedJibCrane(HEAVY, LOAD), standing(), 1.0)
    assert list(result["joint"].values) == ["slew", "luff", "fold"]
    assert result["joint_torque"].dims == ("time", "joint")
    assert result.attrs["crane"] == "heavy booms"
    assert isinstance(HEAVY, JibCrane)
    assert all(variable.attrs["units"] and variable.attrs["long_name"] for variable in result.data_vars.values())

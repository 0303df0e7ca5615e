"""The jib crane under its source's plan: printed figures, sway left over, torques at jumps, signs."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.jib_cranes import (
    HEAVY,
    LOAD,
    PRINTED,
    TIGHT,
    G,
    peak,
    planned,
    printed_plan,
    standing,
)
from scipy.optimize import least_squares

from towercrane.cranes.jib.linear import static_matrices
from towercrane.motions.profiles import trapezoid
from towercrane.simulation.simulate import simulate
from towercrane.simulation.starts.start import Start


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
    tension = printed["hoist_rope_force"] / (LOAD.mass * G)
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
    turned = simulate(planned(), standing(slew=0.5 * np.pi), 0.1, output_step=0.1, start=Start(along=0.2))
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

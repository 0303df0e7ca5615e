"""The load of the jib crane: linear sway, hoisting, and hard cases with known answers."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.balance import imbalance
from samples.jib_cranes import HEAVY, LOAD, PRINTED, after, peak, planned, printed_plan, standing
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import ellipj, ellipk, jv, yv

from towercrane.cranes.jib.linear import LinearSway, static_torques
from towercrane.cranes.jib.model import PlannedJibCrane
from towercrane.cranes.jib.parameters import JibCrane
from towercrane.cranes.jib.tracking import TrackingJibCrane
from towercrane.motions.motion import Motion, phases
from towercrane.motions.profiles import smooth_ramps, trapezoid
from towercrane.simulation.integrate import integrate
from towercrane.simulation.simulate import simulate
from towercrane.simulation.starts.begin import begin
from towercrane.simulation.starts.start import Start

TIGHT = {"rtol": 1e-11, "atol": 1e-13}
G = 9.81


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
    result = simulate(planned(), motions, duration, output_step=0.5, start=Start(along=angle), rtol=1e-12, atol=1e-18)
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
    result = simulate(planned(), motions, duration, output_step=0.01, start=Start(along=0.1), rtol=1e-10, atol=1e-12)
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
    # No angle is a state: the pole costs nothing, only the turn of so wide a swing bounds the steps.
    assert run.evaluations < 3000


def test_one_hour_of_free_swing_keeps_the_rope_s_length_and_its_period():
    angle = np.radians(40)
    model = planned()
    cut = phases(tuple(standing()[channel] for channel in model.channels), 3600.0)
    start = begin(model, cut.inputs[0], Start("zero", along=angle))
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
        assert_allclose(result["hoist_rope_force"], LOAD.mass * G, rtol=1e-12)
        assert_allclose(result["joint_torque"][-1], static_torques(HEAVY, LOAD, 0.6, -0.2), rtol=1e-9, atol=1e-6)


def test_a_load_that_falls_behind_its_rope_ends_the_run_when_it_does():
    # Paid out faster than it falls: T = m (g - l'') for a load that hangs still.
    rope = smooth_ramps(10.0, 10.0, 1.5, 1.5)
    motions = {**standing(), "rope": after(1.0, rope)}
    result = simulate(planned(), motions, 4.0)
    assert result.attrs["outcome"] == "slack rope"
    assert_allclose(result.attrs["end_time"], 1.0 + brentq(lambda t: rope(t, 2) - G, 0.0, 0.75), atol=1e-9)
    assert_allclose(result["hoist_rope_force"][-1], 0.0, atol=1e-3)
    rod = simulate(planned(rope_as_rod=True), motions, 4.0)
    assert rod.attrs["outcome"] == "finished"
    assert rod["hoist_rope_force"].min() < 0.0


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
        ({"post_inertia": float("nan")}, r"JibCrane\.post_inertia: wanted a finite number, zero or more"),
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
        simulate(planned(), standing(), 1.0, start=Start("bent"))


def test_results_say_what_they_are():
    result = simulate(PlannedJibCrane(HEAVY, LOAD), standing(), 1.0)
    assert list(result["joint"].values) == ["slew", "luff", "fold"]
    assert result["joint_torque"].dims == ("time", "joint")
    assert result.attrs["crane"] == "heavy booms"
    assert isinstance(HEAVY, JibCrane)
    assert all(variable.attrs["units"] and variable.attrs["long_name"] for variable in result.data_vars.values())

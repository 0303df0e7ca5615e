"""The radial crane over time: limits with known answers, balance, the source's conditions, hard starts."""

import itertools

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.balance import imbalance
from samples.qtz5613 import CONDITIONS, CRANE, in_plane, model, motions, standing
from scipy.integrate import solve_ivp

from towercrane.kernels.load import Load
from towercrane.motions.motion import rest, sequence
from towercrane.motions.profiles import s_curve, trapezoid
from towercrane.simulation.methods.method import EnergyDriftWarning
from towercrane.simulation.simulate import simulate
from towercrane.simulation.starts.start import Start

RUN_OPTIONS = ("start", "rtol", "atol", "output_step", "method")
TIGHT = {"rtol": 1e-11, "atol": 1e-13}


def condition(number: int, tower: int = 2, jib: int = 2, duration: float = 120.0, **options):
    speed, load, rope = CONDITIONS[number]
    run_options = {k: options.pop(k) for k in RUN_OPTIONS if k in options}
    return simulate(model(tower, jib, load, **options), motions(speed, rope), duration, **run_options)


def peak(result, name: str = "sway_radial") -> float:
    return float(abs(result[name]).max())


# --- the ladder: rigid structures are a pendulum on a moving support -----------------------------------


@pytest.mark.parametrize("angle", [0.1, 1.2, 2.5])
def test_rigid_crane_is_the_nonlinear_pendulum_on_a_moving_winch(angle):
    drives = {
        "trolley": sequence(s_curve(5, 41, 0.8, 0.1, 0.05), rest(41, 4), trapezoid(41, 20, 1.0, 0.3)),
        "rope": sequence(rest(18, 10), trapezoid(18, 7, 0.6, 0.2), rest(7, 5), trapezoid(7, 15, 0.6, 0.1)),
    }
    # Coarse enough bounds for a slack rope are irrelevant here: the pendulum itself knows no tension.
    result = simulate(
        model(0, 0, rope_as_rod=True), drives, 60.0, start=Start(along=angle), output_step=0.25, **TIGHT
    )
    switches = np.unique(np.r_[0.0, drives["trolley"].switch_times, drives["rope"].switch_times, 60.0])
    y, expected = np.array([angle, 0.0]), [[0.0, angle]]
    for start, stop in itertools.pairwise(switches):
        times = result.time.values[(result.time > start) & (result.time <= stop)]
        middle = 0.5 * (start + stop)

        def pendulum(t, y, middle=middle):
            # Accelerations of the pieces, looked up inside the piece.
            at = min(max(t, start + 1e-8), stop - 1e-8)  # noqa: B023
            x2, length, rate = drives["trolley"](at, 2), drives["rope"](at), drives["rope"](at, 1)
            return [y[1], -(9.81 * np.sin(y[0]) + x2 * np.cos(y[0]) + 2 * rate * y[1]) / length]

        leg = solve_ivp(pendulum, (start, stop), y, "DOP853", rtol=1e-12, atol=1e-13, dense_output=True)
        expected += [[t, leg.sol(t)[0]] for t in times]
        y = leg.y[:, -1]
    expected = np.array(expected)
    wrapped = np.angle(np.exp(1j * (result["sway_radial"].values - expected[:, 1])))
    assert_allclose(result.time.values, expected[:, 0])
    assert np.max(abs(wrapped)) < 1e-6


@pytest.mark.parametrize(("number", "swing"), [(3, 0.020387), (4, 0.026196)])
def test_rigid_crane_swings_as_the_source_prints(number, swing):
    # Printed: 0.020 and 0.026 rad.
    assert_allclose(peak(condition(number, 0, 0, **TIGHT)), swing, atol=2e-6)


def test_rigid_jib_is_the_limit_of_stiff_jibs():
    import dataclasses

    def displacement(stiffer):
        beam = dataclasses.replace(CRANE.jib, second_moment_of_area=0.0035 * stiffer)
        crane = dataclasses.replace(CRANE, jib=beam)
        return simulate(in_plane(crane, Load(800.0), 2, 1), motions(), 20.0, rtol=1e-9)[
            "tower_tip_displacement"
        ].values

    rigid = simulate(model(2, 0), motions(), 20.0, rtol=1e-9)["tower_tip_displacement"].values
    gaps = [np.max(abs(displacement(s) - rigid)) for s in (300, 1200)]
    assert gaps[1] < 1e-4
    assert 3.0 < gaps[0] / gaps[1] < 5.0


def test_planar_run_in_space_stays_planar_exactly():
    plane = condition(3, output_step=0.5)
    space = condition(3, output_step=0.5, axes=3)
    assert np.all(space["sway_tangential"] == 0.0)
    assert_allclose(space["sway_radial"], plane["sway_radial"], atol=1e-9)


# --- balance -------------------------------------------------------------------------------------------


def test_energy_balance_with_every_drive_and_every_loss_over_600_seconds():
    back_and_forth = sequence(trapezoid(5, 41, 0.8, 0.1), rest(41, 40), s_curve(41, 12, 1.0, 0.2, 0.1))
    hoist = sequence(rest(18, 20), trapezoid(18, 6, 0.5, 0.2), rest(6, 60), trapezoid(6, 16, 0.5, 0.1))
    lossy = in_plane(
        CRANE, Load(800.0, rope_damping=500.0, drag_area=3.0), 2, 3, weight_softening=True, damping=(0.005, 0.01)
    )
    result = simulate(
        lossy, {"trolley": back_and_forth, "rope": hoist}, 600.0, output_step=0.5, rtol=1e-11, atol=1e-13
    )
    assert result.attrs["outcome"] == "finished"
    assert imbalance(result) < 1e-9
    assert float(result["input_work"][-1]) != 0.0


def test_undamped_free_vibration_keeps_its_energy():
    result = simulate(
        model(2, 3), standing(20.0, 12.0), 120.0, start=Start(along=0.5), output_step=0.5, rtol=1e-12, atol=1e-14
    )
    energy = result["total_energy"].values
    scale = 800 * 9.81 * 12 * (1 - np.cos(0.5))
    assert np.max(abs(energy - energy[0])) < 2e-12 * scale


def test_settings_of_the_source_pump_energy_and_the_default_does_not():
    free = {"start": Start("zero", along=0.02), "output_step": 1.0}
    weightless = model(2, 3, self_weight=False, rope_as_rod=True)

    def gain(**solver):
        result = simulate(weightless, standing(20.0, 18.0), 600.0, **free, **solver)
        assert result.attrs["outcome"] == "finished"
        energy = result["total_energy"].values
        lowest = 9.81 * -(800 * 18.0) - float(abs(_sag_energy(weightless)))
        return float((energy[-1] - energy[0]) / (energy[0] - lowest))

    with pytest.warns(EnergyDriftWarning, match="dopri5 at rtol 0.001 gains energy"):
        assert gain(method="dopri5", rtol=1e-3, atol=1e-6) > 0.15
    assert abs(gain()) < 1e-6


def _sag_energy(crane_model) -> float:
    """Energy [J] that trolley and load give up between the undeformed crane and its equilibrium."""
    inputs = np.array([[20.0, 0.0, 0.0], [18.0, 0.0, 0.0]])
    q = crane_model.equilibrium(inputs)
    return 0.5 * q @ crane_model.constants.stiffness @ q


# --- the source's working conditions -------------------------------------------------------------------


def test_conditions_from_equilibrium_swing_as_measured():
    swings = [peak(condition(number)) for number in (1, 2, 3, 4)]
    assert_allclose(swings, [0.03969, 0.02040, 0.02041, 0.02590], atol=1.5e-5)


def test_condition_1_swings_more_while_braking_and_condition_2_less():
    def ramps(number):
        result = condition(number)
        speed = CONDITIONS[number][0]
        ramp, brake = speed / 0.1, 36.0 / speed
        angle = abs(result["sway_radial"])
        return float(angle.sel(time=slice(0, ramp + 8.5)).max()), float(angle.sel(time=slice(brake, 120)).max())

    starting, braking = ramps(1)
    assert braking > 1.5 * starting
    starting, braking = ramps(2)
    assert braking < 0.85 * starting


def test_rope_length_hardly_moves_the_tower_and_mass_does():
    heavy, short, light = condition(3), condition(4), condition(2)
    name = "tower_tip_displacement"
    assert_allclose(short[name].max() - short[name].min(), heavy[name].max() - heavy[name].min(), rtol=2e-3)
    assert float(heavy[name].max() - heavy[name].min()) > 1.4 * float(light[name].max() - light[name].min())


def test_slack_rope_ends_the_zero_start_of_condition_4():
    result = condition(4, start=Start("zero"))
    assert result.attrs["outcome"] == "slack rope"
    assert_allclose(result.attrs["end_time"], 17.5659, atol=2e-3)
    assert float(result["hoist_rope_force"].min()) > -1e-4
    assert float(result.time[-1]) == result.attrs["end_time"]


def test_parametric_resonance_of_condition_4_if_the_rope_could_push():
    # Structure at 0.312 Hz, pendulum at 0.158 Hz: two to one. It needs a tension below zero, down to -0.49 m g.
    result = condition(4, start=Start("zero"), rope_as_rod=True)
    assert result.attrs["outcome"] == "finished"
    assert_allclose(peak(result), 0.603, atol=2e-3)
    assert float(result["hoist_rope_force"].min()) < -0.45 * 800 * 9.81
    assert peak(condition(3, start=Start("zero"), rope_as_rod=True)) < 0.030


# --- outputs and tolerances ----------------------------------------------------------------------------


def test_outputs_of_one_state_by_hand():
    crane = model(1, 1)
    tower, jib = crane.crane.tower, crane.crane.vertical
    lean, sag = 0.1 / tower(23.8)[0], -1.0 / jib(55.6)[0]
    state = np.array([lean, sag, 0.6, -0.8, 0.0, 0.0, 0.4, 0.3, 0.0])
    seen = crane.observe(standing(20.0, 10.0), np.zeros(1), state[None], np.zeros((1, 9)), np.full((1, 8), 7.0))
    tilt, w = lean * tower(23.8, 1)[0], sag * jib(20.0)[0]
    assert tilt > 0
    hung = np.array([0.1 + 20 * np.cos(tilt) + w * np.sin(tilt), 0.0, -20 * np.sin(tilt) + w * np.cos(tilt)])
    expected = {
        "tower_tip_displacement": 0.1,
        "tower_tip_tilt": tilt,
        "jib_tip_deflection": -1.0,
        "sway_radial": np.arctan2(0.6, 0.8),
        "swing_rate": 0.5,
        "hoist_rope_force": 7.0,
        "payload_position": hung + 10 * np.array([0.6, 0.0, -0.8]),
    }
    for name, value in expected.items():
        assert_allclose(seen[name].values[0], value, rtol=1e-12, err_msg=name)


def test_tolerance_is_metres_where_a_mode_moves_most():
    # Higher tower modes hardly move the tip; a tolerance on the tip alone lets them ring up and pump energy.
    def run(**solver):
        return simulate(model(4, 4), motions(), 60.0, **solver)["tower_tip_displacement"].values

    loose, tight = run(rtol=1e-6, atol=1e-5), run(rtol=1e-10, atol=1e-12)
    assert np.max(abs(loose - tight)) < 1e-4


def test_methods_agree_on_the_whole_crane():
    runs = {
        method: condition(3, duration=56.0, output_step=0.25, rtol=1e-9, atol=1e-11, method=method)
        for method in ("dop853", "dopri5", "scipy-dop853", "scipy-lsoda")
    }
    for name in ("tower_tip_displacement", "jib_tip_deflection", "sway_radial"):
        reference = runs["dop853"][name].values
        for method, result in runs.items():
            assert np.max(abs(result[name].values - reference)) < 2e-7 * np.max(abs(reference)), (method, name)


def test_rows_at_a_switch_time_show_the_right_limit():
    # Braking sets in at 45 s: the trolley's jerk tilts the rope's pull at once.
    result = condition(3, rtol=1e-10)
    tension = result["hoist_rope_force"]
    before, at, after = (float(tension.sel(time=t, method="nearest")) for t in (44.95, 45.0, 45.05))
    assert abs(at - after) < abs(at - before)


# --- guards --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("end", [0.0, 55.6])
def test_trolley_may_park_at_either_end_of_the_jib(end):
    rng = np.random.default_rng(3)
    for _ in range(20):
        drive = {"trolley": trapezoid(20.0, end, rng.uniform(0.5, 2), rng.uniform(0.1, 1)), "rope": rest(10.0)}
        assert simulate(model(0, 0), drive, 80.0, output_step=10.0).attrs["outcome"] == "finished"


@pytest.mark.parametrize(("end", "off"), [(60.0, 55.6), (-3.0, 0.0)])
def test_trolley_off_the_jib_is_an_outcome_with_its_time(end, off):
    drive = {"trolley": trapezoid(20.0, end, 2.0, 0.5), "rope": rest(10.0)}
    result = simulate(model(1, 1), drive, 60.0)
    assert result.attrs["outcome"] == "trolley off the jib"
    assert_allclose(drive["trolley"](result.attrs["end_time"]), off, atol=1e-8)


def test_slack_rope_of_a_falling_winch():
    drive = {"trolley": rest(20.0), "rope": trapezoid(5.0, 15.0, 8.0, 12.0)}
    for method in ("dop853", "scipy-dop853"):
        result = simulate(model(0, 0), drive, 5.0, method=method)
        assert (result.attrs["outcome"], result.attrs["end_time"]) == ("slack rope", 0.0)


def test_loose_tolerance_does_not_step_over_a_slack_rope():
    tight = condition(4, 2, 3, start=Start("zero"))
    with pytest.warns(EnergyDriftWarning, match="loses energy"):
        loose = condition(4, 2, 3, start=Start("zero"), rtol=1e-4, atol=1e-6)
    assert loose.attrs["outcome"] == tight.attrs["outcome"] == "slack rope"
    assert_allclose(loose.attrs["end_time"], tight.attrs["end_time"], atol=1e-3)
    assert float(loose.time[-1]) == loose.attrs["end_time"]
    assert abs(float(loose["hoist_rope_force"][-1])) < 1e-3

"""The overhead crane over time: balance, limits with exact answers, beam theory."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.balance import imbalance
from oracles.pendulums import Pendulum

from towercrane.cases.case import load_case
from towercrane.cases.models import model_of
from towercrane.kernels.load import Load
from towercrane.linear.linearise import linearise
from towercrane.motions.motion import Motion, rest
from towercrane.runs.run import run_case
from towercrane.simulation.simulate import simulate
from towercrane.simulation.starts.start import Start

SHIPPED = model_of(load_case("overhead-crane/hoist"))
CRANE, LOAD = replace(SHIPPED.crane, bridge_damping_ratio=0.0), Load(SHIPPED.load.mass)
BENDING, SPAN = CRANE.bridge_youngs_modulus * CRANE.bridge_second_moment_of_area, CRANE.bridge_span
MIDDLE = 0.5 * SPAN


def model(load=LOAD, **changes):
    return replace(SHIPPED, crane=replace(CRANE, **changes), load=load)


def steady(value, rate=0.0, acceleration=0.0):
    return Motion(np.array([0.0, 20.0]), np.array([[value, rate, 0.5 * acceleration]]))


def run(crane, motions, duration, **options):
    """Tightly solved, to its end."""
    result = simulate(crane, motions, duration, rtol=1e-11, atol=1e-13, **options)
    assert result.attrs["outcome"] == "finished"
    return result


def standing(place=MIDDLE, length=6.0):
    return {"bridge": rest(10.0), "trolley": rest(place), "rope": rest(length)}


def bridge_frequency(place):
    """Of a bridge with trolley and hanging load, half the girder moving [rad/s]; its stiffness [N/m]."""
    stiffness = np.pi**4 * BENDING / (2.0 * SPAN**3)
    carried = (CRANE.trolley_mass + LOAD.mass) * np.sin(np.pi * place / SPAN) ** 2
    return np.sqrt(stiffness / (0.5 * CRANE.bridge_mass_per_length * SPAN + carried)), stiffness


@pytest.mark.parametrize(("name", "gap"), [("travel", 1e-10), ("hoist", 1e-9)])
def test_shipped_runs_finish_and_keep_their_energy(name, gap):
    result = run_case(load_case(f"overhead-crane/{name}"))
    assert result.attrs["outcome"] == "finished"
    assert imbalance(result) < gap


def test_energy_balances_with_every_drive_and_loss():
    motions = {"bridge": steady(5.0, 0.3, 0.2), "trolley": steady(4.0, -0.1, 0.08), "rope": steady(8.0, -0.4, 0.03)}
    lossy = model(Load(LOAD.mass, rope_damping=2e4, drag_area=20.0), bridge_damping_ratio=0.03)
    result = run(lossy, motions, 15.0, start=Start("zero", along=0.4), output_step=0.05)
    assert abs(result["sway_along_bridge"]).max() > 0.01
    assert np.ptp(result["input_work"].values) > 1e5
    assert imbalance(result) < 1e-11


def test_a_load_below_a_rail_is_a_pendulum():
    result = run(model(), standing(0.0), 20.0, start=Start(along=1.2), output_step=0.1)
    exact = Pendulum(6.0, 1.2).direction(CRANE.gravity, result["time"].values)
    found = (result["payload_position"].values - [10.0, 0.0, CRANE.runway_height]) / 6.0
    assert_allclose(found, exact, rtol=0, atol=1e-9)


def test_under_a_bridge_that_gathers_speed_gravity_is_inclined():
    pull = 0.8
    motions = standing(0.0) | {"bridge": steady(2.0, 0.0, pull)}
    result = run(model(), motions, 10.0, output_step=0.1)
    gravity, lean = np.hypot(CRANE.gravity, pull), np.arctan2(pull, CRANE.gravity)
    swung = Pendulum(6.0, lean).direction(gravity, result["time"].values)
    expected = np.arctan2(swung[:, 0], -swung[:, 2]) - lean
    assert_allclose(result["sway_along_runway"], expected, rtol=0, atol=1e-9)
    # The drive pulls bridge and trolley, and what the rope takes.
    masses = CRANE.girder_mass + CRANE.bridge_end_carriage_mass + CRANE.trolley_mass
    taken = result["hoist_rope_force"].values * np.sin(expected)
    assert_allclose(result["bridge_force"], masses * pull - taken, rtol=1e-9)


def test_a_stiffer_bridge_comes_to_the_pendulum_in_proportion():
    # Both drives gather speed at once: the load swings in the plane of their accelerations.
    motions = standing() | {"bridge": steady(2.0, 0.0, 0.5), "trolley": steady(MIDDLE, 0.0, 0.3)}
    pull = np.hypot(0.5, 0.3)
    gravity, lean = np.hypot(CRANE.gravity, pull), np.arctan2(pull, CRANE.gravity)
    errors = []
    for stiffer in (100.0, 1000.0):
        stiff = model(bridge_youngs_modulus=stiffer * CRANE.bridge_youngs_modulus)
        result = run(stiff, motions, 5.0, output_step=0.05)
        swung = Pendulum(6.0, lean).direction(gravity, result["time"].values)
        found = np.arctan(np.tan(result["sway_along_runway"].values) * pull / 0.5)
        errors.append(abs(found - np.arctan2(swung[:, 0], -swung[:, 2]) + lean).max())
    assert errors[1] < 1e-5
    assert 0.05 < errors[1] / errors[0] < 0.2


@pytest.mark.parametrize("place", [MIDDLE, 5.0])
def test_bridge_let_fall_vibrates_as_one_mass_on_its_spring(place):
    # At mid-span the bridge would fall away from the load.
    rod = replace(model(), rope_as_rod=True)
    result = run(rod, standing(place), 3.0, start=Start("zero"), output_step=0.01)
    frequency, stiffness = bridge_frequency(place)
    shape = np.sin(np.pi * place / SPAN)
    weight = 2.0 / np.pi * CRANE.girder_mass + (CRANE.trolley_mass + LOAD.mass) * shape
    sag, wave = CRANE.gravity * weight / stiffness, np.cos(frequency * result["time"].values)
    assert_allclose(result["bridge_deflection"], sag * (1.0 - wave), rtol=0, atol=1e-9 * sag)
    tension = LOAD.mass * (CRANE.gravity - shape * sag * frequency**2 * wave)
    assert_allclose(result["hoist_rope_force"], tension, rtol=0, atol=1e-8 * LOAD.mass * CRANE.gravity)


def test_a_bridge_that_falls_away_from_its_load_slackens_the_rope():
    result = simulate(model(), standing(), 3.0, start=Start("zero"))
    assert (result.attrs["outcome"], result.attrs["end_time"]) == ("slack rope", 0.0)


def test_a_jerk_of_the_hoist_shakes_the_bridge_as_a_step_of_force_does():
    motions = standing() | {"rope": steady(9.0, 0.0, -0.7)}
    result = run(model(), motions, 2.0, output_step=0.01)
    frequency, stiffness = bridge_frequency(MIDDLE)
    step, wave = 0.7 * LOAD.mass / stiffness, np.cos(frequency * result["time"].values)
    sag = result["bridge_deflection"].values
    assert_allclose(sag - sag[0], step * (1.0 - wave), rtol=0, atol=1e-9 * step)
    tension = LOAD.mass * (CRANE.gravity + 0.7 - step * frequency**2 * wave)
    assert_allclose(result["hoist_rope_force"], tension, rtol=1e-9)


@pytest.mark.parametrize("place", [MIDDLE, 4.0])
def test_linear_model_has_the_pendulum_and_the_bridge_with_all_that_hangs_on_it(place):
    found = linearise(model(bridge_damping_ratio=0.02), standing(place), outputs=[]).eigenvalues()
    vibrations = sorted((e.value for e in found if e.value.imag > 1e-6), key=abs)
    frequency, stiffness = bridge_frequency(place)
    assert_allclose(np.abs(vibrations[:2]), np.sqrt(CRANE.gravity / 6.0), rtol=1e-8)
    assert_allclose(abs(vibrations[2]), frequency, rtol=1e-8)
    # A damper that gives the bare girder 2 % gives the heavier one less.
    bare = np.sqrt(stiffness / (0.5 * CRANE.girder_mass))
    assert_allclose(-vibrations[2].real / abs(vibrations[2]), 0.02 * frequency / bare, rtol=1e-7)


def test_deflections_are_those_of_a_girder_on_two_supports_within_what_one_mode_leaves_out():
    def drop(place, mass):
        return -CRANE.uplift_at_rest(place, mass) * np.sin(np.pi * place / SPAN)

    places = np.array([MIDDLE, 0.25 * SPAN])
    by_force = np.array([drop(place, 1e3) - drop(place, 0.0) for place in places])
    exact = 1e3 * CRANE.gravity * (places * (SPAN - places)) ** 2 / (3.0 * BENDING * SPAN)
    assert_allclose(1.0 - by_force / exact, [0.0145, 0.1240], atol=1e-4)
    by_weight = drop(MIDDLE, 0.0) - CRANE.trolley_mass / 1e3 * by_force[0]
    exact = 5.0 * CRANE.bridge_mass_per_length * CRANE.gravity * SPAN**4 / (384.0 * BENDING)
    assert_allclose(by_weight / exact - 1.0, 0.0039, atol=1e-4)


def test_a_trolley_on_its_way_is_where_the_bent_bridge_is():
    motions = standing() | {"trolley": steady(4.0, 0.7)}
    result = run(model(), motions, 19.0, output_step=0.1)
    hung = result["payload_position"].values[:, 2] + 6.0 * np.cos(result["sway_along_bridge"].values)
    assert_allclose(CRANE.runway_height - hung, result["trolley_drop"], rtol=0, atol=1e-12)
    shape = np.sin(np.pi * (4.0 + 0.7 * result["time"].values) / SPAN)
    assert_allclose(result["trolley_drop"], shape * result["bridge_deflection"].values, rtol=0, atol=1e-15)


def test_a_crane_at_rest_stands_on_its_rails_as_moments_say():
    result, place = run(model(), standing(0.2 * SPAN), 0.1), 0.2
    bridge = CRANE.bridge_mass_per_length * SPAN + CRANE.bridge_end_carriage_mass
    carried = CRANE.trolley_mass + LOAD.mass
    assert_allclose(result["first_rail_load"], CRANE.gravity * (0.5 * bridge + (1.0 - place) * carried), rtol=1e-10)
    assert_allclose(result["second_rail_load"], CRANE.gravity * (0.5 * bridge + place * carried), rtol=1e-10)


def test_sways_are_those_of_the_line_from_trolley_to_load():
    motions = {"bridge": steady(5.0, 0.3, 0.2), "trolley": steady(4.0, 0.1, -0.08), "rope": rest(8.0)}
    result = run(model(), motions, 3.0, start=Start(along=0.3))
    x, y, z = result["payload_position"].values.T
    down = CRANE.runway_height - result["trolley_drop"].values - z
    assert_allclose(result["sway_along_runway"], np.arctan2(x - result["bridge_position"], down), atol=1e-12)
    assert_allclose(result["sway_along_bridge"], np.arctan2(y - result["trolley_position"], down), atol=1e-12)
    assert abs(result["sway_along_bridge"]).max() > 1e-3


def test_a_start_of_another_name_is_refused():
    with pytest.raises(ValueError, match="'equilibrium' or 'zero'"):
        model().start(np.zeros((3, 3)), "zero-no-self-weight")

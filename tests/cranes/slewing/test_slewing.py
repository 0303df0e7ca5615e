"""The slewing cranes over time: balances, limits with known answers, and what the sources report of them.

The sources print the load, the arms and the shaft's speed; all other parameters are assumed, so their measured curves
cannot be met to the last digit. What they say in words is checked against the figures reached here.
"""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.balance import imbalance
from samples.lab_crane import (
    PARAMETERS,
    crane,
    degrees,
    inputs,
    lossless,
    motions,
    run,
)

from towercrane.cranes.slewing.model import LumpedModel
from towercrane.cranes.slewing.outputs import point_of
from towercrane.kernels.load import Load
from towercrane.motions.motion import rest, sequence
from towercrane.motions.profiles import trapezoid
from towercrane.simulation.starts.begin import begin
from towercrane.simulation.starts.start import Start

KINDS = tuple(PARAMETERS)
STILL = {"shaft": rest(0.0), "rope": rest(2.0)}
HOIST = sequence(rest(2.0, 2.0), trapezoid(2.0, 1.0, 0.3, 0.5), rest(1.0, 1.0), trapezoid(1.0, 2.5, 0.4, 0.5))


def kicked(model: LumpedModel, swing_angle: float, size: float, ahead: float) -> np.ndarray:
    """Start with the load drawn outward and pushed ahead, and random rates of the structure."""
    state, n, rates = (
        begin(model, inputs(), Start("zero", along=swing_angle)),
        model.coordinates,
        (model.size - 1) // 2,
    )
    state[rates : rates + n] = size * np.random.default_rng(1).normal(size=n)
    # Of an elastic rope the load's speed, of another its direction's rate.
    state[rates + model.rope + 1] = ahead * (1.0 if model.carried.elasticity is None else 2.0)
    return state


def times(outputs: dict, step: float = 0.01) -> np.ndarray:
    return step * np.arange(len(outputs["sway_radial"]))


# --- balances ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", KINDS)
def test_energy_stays_without_losses(kind):
    model = replace(lossless(kind), rope_as_rod=True)
    trajectory, outputs, met = run(model, STILL, 25.0, kicked(model, 0.6, 0.05, 0.4), rtol=1e-12)
    assert trajectory.outcome == "finished"
    assert len(met) > 3  # the corner of the coupling is crossed again and again
    energy = outputs["total_energy"]
    lowest = run(model, STILL, 0.05)[1]["total_energy"][0]
    assert np.max(abs(energy - energy[0])) < 1e-9 * (energy[0] - lowest)


@pytest.mark.parametrize("law", ["none", "tanh", "stick-slip"])
@pytest.mark.parametrize("kind", KINDS)
def test_energy_balance_while_slewing_and_hoisting_with_every_loss(kind, law):
    lossy = replace(crane(kind, friction_law=law, drag_jib_tip=0.5), load=Load(50.5, 20.0, 1.0))
    trajectory, outputs, _ = run(lossy, {**motions(), "rope": HOIST}, 15.0, rtol=1e-11)
    assert trajectory.outcome == "finished"
    assert imbalance(outputs) < 1e-10


@pytest.mark.parametrize("kind", KINDS)
def test_angular_momentum_stays_when_nothing_holds_the_platform(kind):
    # Dampers, springs and the rope act within the crane; only drive, friction, air and the rope's hinge, which
    # damps the swing in space, act from outside.
    free = {"drive_soft_stiffness": 0.0, "drive_stiff_stiffness": 0.0, "drive_damping": 0.0, "drag_jib_tip": 0.0}
    model = replace(crane(kind, friction_law="none", **free), load=Load(50.5), rope_as_rod=True)
    drive = {"shaft": rest(0.0), "rope": trapezoid(2.0, 1.0, 0.3, 0.5)}
    trajectory, outputs, _ = run(model, drive, 20.0, kicked(model, 0.6, 0.3, 0.9), rtol=1e-12)
    assert trajectory.outcome == "finished"
    n, rates, y = model.coordinates, (model.size - 1) // 2, trajectory.states
    q, qd = y[:, :n], y[:, rates : rates + n]
    points = [
        [np.stack(np.broadcast_arrays(*part), axis=1) for part in point_of(body, q.T, qd.T)]
        for body in model.constants.bodies
    ]
    hung, moving = points[model.constants.suspension]
    haul = drive["rope"](trajectory.times, 1)
    length = np.linalg.norm(outputs["payload_position"] - hung, axis=1)
    rope = model.rope
    direction, swing = y[:, rope : rope + 3], y[:, rates + rope : rates + rope + 3]
    velocity = swing
    if model.carried.elasticity is None:
        velocity = moving + haul[:, None] * direction + length[:, None] * swing
    load = outputs["payload_position"], velocity
    masses = [(body.mass, *point) for body, point in zip(model.constants.bodies, points, strict=True)]
    momentum = qd @ model.crane.row(model.crane.inertias)[:-1]
    for mass, place, velocity in [*masses, (50.5, *load)]:
        momentum = momentum + mass * (place[:, 0] * velocity[:, 1] - place[:, 1] * velocity[:, 0])
    assert_allclose(momentum, momentum[0], rtol=2e-11)


@pytest.mark.parametrize("kind", KINDS)
def test_accelerations_turn_with_the_crane(kind):
    rng = np.random.default_rng(4)
    model = replace(crane(kind, drag_jib_tip=0.5), load=Load(50.5, 20.0, 1.0))
    n, rates = model.coordinates, (model.size - 1) // 2
    angles = np.array([name.endswith("angle") for name in model.crane.coordinates])
    for _ in range(50):
        state, drive = rng.normal(size=model.size), rng.normal(size=(2, 3))
        drive[1, 0] = 2.0
        state[model.rope : model.rope + 3] /= np.linalg.norm(state[model.rope : model.rope + 3])
        turn = rng.uniform(-3, 3)
        matrix = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
        turned = state.copy()
        turned[:n] += turn * angles
        for first in (model.rope, rates + model.rope):
            turned[first : first + 3] = matrix @ state[first : first + 3]
        slope, guards = model.system.slope(0.0, state, drive)
        expected = slope.copy()
        for first in (model.rope, rates + model.rope):
            expected[first : first + 3] = matrix @ slope[first : first + 3]
        drive[0, 0] += turn
        found, guards_turned = model.system.slope(0.0, turned, drive)
        assert_allclose(found, expected, atol=1e-12 * np.max(abs(expected)))
        assert_allclose(guards_turned[0], guards[0], atol=1e-12 * np.max(abs(expected)) * 50.5)


@pytest.mark.parametrize("kind", KINDS)
def test_mass_matrix_is_symmetric_positive_definite_anywhere(kind):
    # Read off the accelerations that unit forces cause, so the solution of the equations is checked as well.
    rng = np.random.default_rng(5)
    model = crane(kind)
    system, n, rates = model.system, model.coordinates, (model.size - 1) // 2
    # Forces everywhere: the equations are written for what is not zero.
    system, *pushed = (
        replace(system, constants=replace(model.constants, steady_force=model.constants.steady_force + 1.0 + force))
        for force in (np.zeros(n), *1e6 * np.eye(n))
    )
    drive, least = np.zeros((2, 3)), np.inf
    drive[1, 0] = 2.0
    size = np.ones(model.size)
    size[:n] = [1.0 if name.endswith("angle") else 0.1 for name in model.crane.coordinates]
    for _ in range(5000):
        state = size * rng.normal(size=model.size)
        still = system.slope(0.0, state, drive)[0][rates : rates + n]
        slopes = np.array([own.slope(0.0, state, drive)[0][rates : rates + n] for own in pushed])
        responses = (slopes - still) / 1e6
        scale = 1 / np.sqrt(np.diag(responses))
        scaled = responses * np.outer(scale, scale)
        assert np.max(abs(scaled - scaled.T)) < 1e-9
        least = min(least, np.linalg.eigvalsh(0.5 * (scaled + scaled.T)).min())
    assert least > 1e-3


# --- outputs -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", KINDS)
def test_readings_follow_their_definitions(kind):
    drive = motions()
    model = crane(kind)
    trajectory, outputs, _ = run(model, drive, 6.0, step=0.5)
    p, reach = PARAMETERS[kind], 2.0
    if kind == "basic":
        bending = reach * p.stiffness_jib_lateral * outputs["jib_lateral"]
    else:
        bending = p.stiffness_jib_lateral * (outputs["jib_angle"] - outputs["tower_angle"])
    assert_allclose(outputs["jib_moment_horizontal"], bending, rtol=1e-9, atol=1e-9)
    assert_allclose(outputs["jib_moment_vertical"], -reach * 6e4 * outputs["jib_vertical"], rtol=1e-12)
    assert_allclose(outputs["jib_moment_vertical"][0], 64.5 * 9.81 * reach, rtol=1e-10)
    twist = outputs["platform_angle"] - drive["shaft"](trajectory.times)
    slopes = np.gradient(outputs["platform_angle"], 0.5)
    elastic = -np.clip(twist, -0.25, 0.25) * 20.0 - np.sign(twist) * np.maximum(abs(twist) - 0.25, 0.0) * 750.0
    assert_allclose(outputs["drive_torque_elastic"], elastic, rtol=1e-10, atol=1e-10)
    rate = trajectory.states[:, (model.size - 1) // 2 + model.crane.coordinates.index("platform_angle")]
    assert np.max(abs(rate - slopes)) < 0.5
    assert_allclose(
        outputs["drive_torque"], elastic - 60.0 * (rate - drive["shaft"](trajectory.times, 1)), rtol=1e-9, atol=1e-9
    )


def test_sway_is_positive_outward_and_in_the_turning_sense():
    for angle, name, sign in ((0.3, "radial", 1), (-0.3, "radial", -1)):
        start = begin(crane(), inputs(), Start(along=angle))
        assert_allclose(run(crane(), STILL, 0.05, start)[1][f"sway_{name}"][0], sign * 0.3, rtol=1e-12)
    # The shaft starts to turn counter-clockwise: the load falls behind.
    assert degrees(run(crane(), motions(), 1.9)[1], "tangential")[-1] < -10


# --- what the sources report ---------------------------------------------------------------------------

EXAMPLES = {1: (0.71, 8.0), 2: (1.42, 8.0), 3: (2.13, 6.0), 4: (2.84, 6.0), 5: (3.55, 6.0), 6: (4.26, 6.0)}
"""Ramp and constant speed of the shaft in the examples of Marinovic et al. [s]."""


@pytest.fixture(scope="module")
def examples():
    return {n: run(crane(), motions(*drive), 25.0, step=0.01)[1] for n, drive in EXAMPLES.items()}


def test_sway_along_the_jib_falls_with_longer_ramps(examples):
    # Reported: up to 26 degrees, in constant rotation.
    peaks = {n: degrees(found, "radial").max() for n, found in examples.items()}
    assert_allclose(list(peaks.values()), [26.489, 26.391, 25.281, 23.064, 20.081, 16.843], atol=2e-3)
    at = times(examples[1])[degrees(examples[1], "radial").argmax()]
    assert_allclose(at, 3.52, atol=0.011)
    assert 0.71 < at < 8.71


def test_first_example_in_its_course(examples):
    along, across = degrees(examples[1], "radial"), degrees(examples[1], "tangential")
    at, platform = times(examples[1]), examples[1]["platform_angle"]
    # Reported: the load first moves inward, by a third of a degree measured and up to 2 computed.
    assert_allclose((along[at < 3].min(), at[along[at < 3].argmin()]), (-1.734, 1.83), atol=0.011)
    assert_allclose(across.min(), -14.416, atol=2e-3)
    assert_allclose(at[across.argmin()], 1.94, atol=0.011)
    # Reported: the platform starts after the shaft, for the coupling has to wind up first.
    assert_allclose(platform[at <= 0.71][-1], 0.00869, atol=1e-5)
    assert_allclose(examples[1]["shaft_angle"][at <= 0.71][-1], 0.262, atol=1e-3)
    tenth = at[np.gradient(platform, 0.01) > 0.0738][0]
    assert_allclose(tenth, 0.81, atol=0.011)
    assert_allclose(platform[-1], 6.5274, atol=1e-4)


def test_what_is_reported_but_not_reproduced(examples):
    # Reported: the largest tangential sway comes after the stop, and its mean in constant rotation is slightly
    # positive. Here it comes before, and the mean is negative; both hang on data that the source does not give.
    at, across = times(examples[1]), degrees(examples[1], "tangential")
    before, after = at < 9.42, at >= 9.42
    assert_allclose(across[before].max(), 12.320, atol=2e-3)
    assert_allclose(at[across.argmax()], 6.33, atol=0.011)
    assert_allclose(across[after].max(), 6.935, atol=2e-3)
    constant = across[(at > 0.71) & (at < 8.71)]
    assert_allclose(constant.mean(), -0.459, atol=2e-3)


@pytest.mark.parametrize(("kind", "peak"), [("enhanced", 26.461), ("basic", 26.394)])
def test_smaller_models_have_nearly_the_same_sway(kind, peak):
    found = run(crane(kind), motions(), 25.0, step=0.01)[1]
    assert_allclose(degrees(found, "radial").max(), peak, atol=2e-3)


@pytest.mark.parametrize(
    ("width", "sway", "platform"),
    [(0.1, 0.008, 6.4095), (0.01, 0.035, 6.5274), (1e-3, 0.554, 6.5447), (1e-4, 0.706, 6.5468)],
)
def test_width_of_the_friction_decides_how_the_platform_comes_to_rest(width, sway, platform):
    method = "scipy-lsoda" if width < 1e-3 else "dop853"
    trajectory, found, _ = run(crane(friction_rate=width), motions(), 25.0, method=method)
    assert trajectory.outcome == "finished"
    assert_allclose(degrees(found, "tangential")[-1], sway, atol=6e-4)
    assert_allclose(found["platform_angle"][-1], platform, atol=6e-5)

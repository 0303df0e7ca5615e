"""Linear models about a steady rotation, beside a cone's known answer."""

import dataclasses

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.bare_systems import plain_system

from towercrane.kernels.algebra import dot
from towercrane.kernels.polynomial import polynomial
from towercrane.linear.linearise import linearise
from towercrane.results.recording import Quantity

G = 9.81


# --- a steady rotation ---------------------------------------------------------------------------------

LENGTH, RADIUS, MASS = 2.0, 2.0, 50.0


@dataclasses.dataclass(frozen=True)
class Platform:
    inertia: float


def equations(platform, t, y, inputs):
    """Slopes of (angle, n, rate, p, work) on a free platform, of (n, p, work) on a prescribed one."""
    half = (len(y) - 1) // 2
    direction, swing = y[half - 3 : half], y[2 * half - 3 : 2 * half]
    angle, rate, turn = polynomial(inputs[0], t) if platform is None else (y[0], y[half], 0.0)
    c, s = np.cos(angle), np.sin(angle)
    inward = -RADIUS * rate * rate * c, -RADIUS * rate * rate * s, G
    square, turns = dot(swing, swing), []
    if platform is not None:
        # I phi'' = R T side.n with the tension T = m (l p.p - n.(a_D + g e_z)).
        across = RADIUS * (c * direction[1] - s * direction[0])
        turn = (
            MASS * across * (LENGTH * square - dot(direction, inward)) / (platform.inertia + MASS * across * across)
        )
        turns = [turn]
    pull = inward[0] - RADIUS * turn * s, inward[1] + RADIUS * turn * c, G
    along = dot(pull, direction)
    turning = [-(a - along * n) / LENGTH - square * n for a, n in zip(pull, direction, strict=True)]
    return [*y[half : 2 * half], *turns, *turning, 0.0], []


class Arm:
    """Rigid arm that slews and carries a load: by a prescribed angle, or free with an inertia of its own."""

    axes = 3

    def __init__(self, inertia=None):
        self.n = 0 if inertia is None else 1
        self.channels = ("slew",) if inertia is None else ()
        self.state_names = {} if inertia is None else {"platform": "rad"}
        size = 2 * self.n + 7
        system = plain_system(equations, size, None if inertia is None else Platform(inertia))
        self.system = dataclasses.replace(system, scale=np.full(size, np.inf))

    def start(self, inputs, state="equilibrium"):
        y = np.zeros(self.system.size)
        y[self.n + 2] = -1.0
        return y

    def observe(self, motions, times, states, slopes, guards):
        return {"payload": Quantity(("time", "axis"), states[:, self.n : self.n + 3], "m", "rope direction")}


def cone(rate):
    """Tilt of the rope in steady rotation."""
    tilt = 0.1
    for _ in range(200):
        tilt = np.arctan(rate**2 * (RADIUS + LENGTH * np.sin(tilt)) / G)
    return tilt


def turning_state(rate, angle, leading=()):
    tilt = cone(rate)
    across, along = np.array([np.cos(angle), np.sin(angle), 0]), np.array([-np.sin(angle), np.cos(angle), 0])
    return np.concatenate([
        leading[:1], np.sin(tilt) * across - [0, 0, np.cos(tilt)], leading[1:], np.sin(tilt) * rate * along, [0.0],
    ])  # fmt: skip


@pytest.mark.parametrize("angle", [0.0, 0.7, 4.0])
def test_steady_rotation_of_a_prescribed_arm(angle):
    rate, tilt = 0.738, cone(0.738)
    inputs = np.array([[angle, rate, 0.0]])
    linear = linearise(Arm(), inputs, state=turning_state(rate, angle), turning="slew", inputs="motion", outputs=[])
    # Hessian of the effective potential and the Coriolis term, per mass and length.
    s, c, reach = np.sin(tilt), np.cos(tilt), RADIUS + LENGTH * np.sin(tilt)
    pull = G * c + rate**2 * reach * s
    expected = np.zeros((4, 4))
    expected[:2, 2:] = np.eye(2)
    expected[2, 0] = -(pull - rate**2 * LENGTH * c**2) / LENGTH
    expected[3, 1] = -(pull - rate**2 * LENGTH) / LENGTH
    expected[2, 3], expected[3, 2] = 2 * rate * c, -2 * rate * c
    assert_allclose(linear.a, expected, rtol=1e-10, atol=1e-12)
    assert_allclose(linear.point.slope, 0.0, atol=1e-12)
    # Which way the arm points is nothing to the load; faster turning throws it out; a push leaves it behind.
    thrown = 2 * rate * reach * c / LENGTH
    assert_allclose(linear.b, [[0, 0, 0], [0, 0, 0], [0, thrown, 0], [0, 0, -reach / LENGTH]], rtol=1e-10, atol=1e-12)


def test_inertial_directions_are_no_equilibrium_of_a_rotation():
    state = turning_state(0.738, 0.0)
    linear = linearise(Arm(), np.array([[0.0, 0.738, 0.0]]), state=state, inputs="motion", outputs=[])
    assert np.max(abs(linear.point.slope)) > 0.09


def test_free_platform_turns_without_resistance():
    inertia = 151.0
    linear = linearise(Arm(inertia), {}, outputs=["payload"])
    assert [s.name for s in linear.outputs] == ["payload_outward", "payload_sideways", "payload_up"]
    assert linear.inputs == ()
    table = linear.eigenvalues()
    assert [e.value for e in table[:2]] == [0.0, 0.0]
    assert [e.state for e in table] == ["platform", "platform", "sway_outward", "sway_sideways"]
    both = np.sqrt(G / LENGTH * np.array([1.0, 1.0 + MASS * RADIUS**2 / inertia]))
    assert_allclose(2 * np.pi * linear.frequencies, both, rtol=1e-10)


def test_free_platform_in_steady_rotation_keeps_its_momentum():
    rate, angle = 0.738, 0.7
    state = turning_state(rate, angle, leading=(angle, rate))
    linear = linearise(Arm(151.0), {}, state=state, turning="platform", outputs=[])
    assert_allclose(linear.point.slope, [rate, 0, 0, 0, 0, 0], atol=1e-12)
    assert np.all(linear.a[:, 0] == 0.0)
    # Angle and momentum are free: two zero eigenvalues, and two oscillations.
    values = np.sort(abs(np.linalg.eigvals(linear.a)))
    assert np.max(values[:2]) < 1e-5 < 1.0 < values[2]
    assert_allclose(np.linalg.eigvals(linear.a).real, 0.0, atol=1e-5)
    # A whole turn of the frame is no other frame.
    again = turning_state(rate, angle + 2.0, leading=(angle + 2.0, rate))
    assert_allclose(linearise(Arm(151.0), {}, state=again, turning="platform", outputs=[]).a, linear.a, atol=1e-11)


def test_a_sway_far_from_the_vertical():
    # At an angle the rope swings with its tangent: l s'' = -g sin, so -g cos / l; sideways the tension remains.
    tilt = 2.5
    state = np.array([np.sin(tilt), 0, -np.cos(tilt), 0, 0, 0, 0.0])
    linear = linearise(Arm(), np.array([[0.0, 0.0, 0.0]]), state=state, inputs="motion", outputs=[])
    assert_allclose(np.diag(linear.a[2:, :2]), -G * np.cos(tilt) / LENGTH * np.ones(2), rtol=1e-10)
    assert_allclose(linear.point.slope, [0, 0, -G * np.sin(tilt) / LENGTH, 0], atol=1e-13)
    upright = linearise(Arm(), np.zeros((1, 3)), state=np.array([0, 0, 1.0, 0, 0, 0, 0]), inputs="motion", outputs=[])
    assert_allclose(np.sort(np.linalg.eigvals(upright.a).real), np.sqrt(G / LENGTH) * np.array([-1, -1, 1, 1]))


def test_frame_must_turn_with_something_known():
    with pytest.raises(ValueError, match="turning: wanted one of slew, got 'tilt'"):
        linearise(Arm(), np.zeros((1, 3)), turning="tilt", outputs=[])

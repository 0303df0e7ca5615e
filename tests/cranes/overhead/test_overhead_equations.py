"""Equations of the overhead crane beside those of Lagrange, by sympy from positions and the girder's field."""

import numpy as np
import pytest
import sympy as sp
from numpy.testing import assert_allclose
from samples.overhead_crane import SMALL as CRANE

from towercrane.cranes.overhead import equations
from towercrane.cranes.overhead.model import OverheadModel
from towercrane.cranes.overhead.parameters import OverheadCrane
from towercrane.kernels.load import Load

LOADS = {"lossless": Load(900.0), "lossy": Load(900.0, rope_damping=250.0, drag_area=3.0)}


class Lagrange:
    """Coordinates x, y, rope's length, uplift at mid-span, and two angles of the rope; all forces but the drives'."""

    def __init__(self):
        c, place = CRANE, sp.Symbol("place")
        span = sp.nsimplify(c.bridge_span)
        q = _, y, length, uplift, alpha, beta = sp.symbols("x y l u alpha beta")
        v = sp.symbols("xd yd ld ud alphad betad")
        mass, drag, hinge = given = sp.symbols("mass drag hinge")
        direction = sp.Matrix([sp.sin(alpha) * sp.cos(beta), sp.sin(beta), -sp.cos(alpha) * sp.cos(beta)])
        field = uplift * sp.sin(sp.pi * place / span)
        hung = sp.Matrix([q[0], y, c.runway_height + field.subs(place, y)])
        load = hung + length * direction

        def rate(of):
            return of.jacobian(q) * sp.Matrix(v)

        def over_the_girder(density):
            return sp.integrate(density, (place, 0, span))

        moved, speed, turning = rate(hung), rate(load), rate(direction)
        mu, bending = c.bridge_mass_per_length, c.bridge_youngs_modulus * c.bridge_second_moment_of_area
        kinetic = (
            mu * over_the_girder(v[0] ** 2 + field.subs(uplift, v[3]) ** 2) + c.bridge_end_carriage_mass * v[0] ** 2
        )
        kinetic = (kinetic + c.trolley_mass * moved.dot(moved) + mass * speed.dot(speed)) / 2
        potential = bending / 2 * over_the_girder(sp.diff(field, place, 2) ** 2)
        potential += c.gravity * (mu * over_the_girder(field) + c.trolley_mass * hung[2] + mass * load[2])
        push = -drag * sp.sqrt(speed.dot(speed)) * speed
        losses = load.jacobian(q).T * push - hinge * direction.jacobian(q).T * turning
        modal = mu * over_the_girder(sp.sin(sp.pi * place / span) ** 2)
        bending_alone = bending * over_the_girder(sp.diff(field / uplift, place, 2) ** 2)
        losses[3] -= 2 * c.bridge_damping_ratio * sp.sqrt(bending_alone * modal) * v[3]
        momenta = sp.Matrix([sp.diff(kinetic, one) for one in v])
        rest = momenta.jacobian(q) * sp.Matrix(v) - losses
        rest -= sp.Matrix([sp.diff(kinetic - potential, one) for one in q])
        bent = direction.jacobian([alpha, beta]) * sp.Matrix(v[4:])
        parts = [momenta.jacobian(v), rest, direction, turning, bent.jacobian([alpha, beta]),
                 direction.jacobian([alpha, beta])]  # fmt: skip
        self.matrices = sp.lambdify((*q, *v, *given), parts, "numpy", cse=True)

    def solve(self, q, v, driven, load):
        """Uplift's acceleration, that of the rope's direction, and forces of bridge, trolley and rope."""
        inertia, rest, _, _, turn, jacobian = (
            np.asarray(one, dtype=float) for one in self.matrices(*q, *v, load.mass, load.drag, load.rope_damping)
        )
        free = np.linalg.solve(inertia[3:, 3:], -rest[3:, 0] - inertia[3:, :3] @ driven)
        forces = inertia[:3] @ np.concatenate([driven, free]) + rest[:3, 0]
        return free[0], jacobian @ free[1:] + turn @ v[4:], forces

    def direction(self, q, v):
        _, _, direction, turning, _, _ = self.matrices(*q, *v, 1.0, 0.0, 0.0)
        return direction.ravel(), turning.ravel()


@pytest.fixture(scope="module")
def lagrange():
    return Lagrange()


def drawn(random, lagrange):
    """Coordinates, rates, driven accelerations, and the same as state and inputs."""
    low, high = [0, 0.2, 1, -0.3, -1.2, -1.2], [40, 11.8, 7, 0.3, 1.2, 1.2]
    q, v, driven = random.uniform(low, high), random.normal(size=6), random.normal(size=3)
    state = np.zeros(equations.SIZE)
    state[equations.UPLIFT], state[equations.RATE] = q[3], v[3]
    state[1:4], state[5:8] = lagrange.direction(q, v)
    return q, v, driven, state, np.stack([q[:3], v[:3], 0.5 * driven], axis=1)


@pytest.mark.parametrize("load", LOADS.values(), ids=LOADS)
def test_accelerations_tension_and_forces_of_the_drives_are_those_of_lagrange(lagrange, load):
    random, system = np.random.default_rng(5), OverheadModel(CRANE, load).system
    for _ in range(100):
        q, v, driven, state, inputs = drawn(random, lagrange)
        uplifting, turning, forces = lagrange.solve(q, v, driven, load)
        slope, guards = system.slope(0.0, state, inputs)
        assert_allclose(slope[equations.RATE], uplifting, rtol=1e-11, atol=1e-9)
        assert_allclose(slope[equations.SWAY : equations.WORK], turning, rtol=1e-10, atol=1e-10)
        assert_allclose(guards[equations.TENSION], -forces[2], rtol=1e-11, atol=1e-7)
        assert_allclose(guards[[equations.BRIDGE_FORCE, equations.TROLLEY_FORCE]], forces[:2], rtol=1e-11, atol=1e-7)


def test_rails_carry_what_is_not_in_free_fall(lagrange):
    random, crane = np.random.default_rng(6), CRANE
    system, span = OverheadModel(crane, LOADS["lossless"]).system, crane.bridge_span
    places, weights = np.polynomial.legendre.leggauss(40)
    places, weights = 0.5 * span * (places + 1.0), 0.5 * span * weights
    for _ in range(20):
        q, _, _, state, inputs = drawn(random, lagrange)
        slope, guards = system.slope(0.0, state, inputs)
        # The trolley's acceleration upwards is a second difference of its height.
        h = 1e-4
        before, now, after = (
            (state[0] + slope[0] * e + 0.5 * slope[equations.RATE] * e * e)
            * np.sin(np.pi * np.polyval(inputs[1, ::-1], e) / span)
            for e in (-h, 0.0, h)
        )
        line = crane.bridge_mass_per_length * (crane.gravity + slope[equations.RATE] * np.sin(np.pi * places / span))
        hung = crane.trolley_mass * (crane.gravity + (after - 2.0 * now + before) / h**2)
        hung -= guards[equations.TENSION] * state[3]
        ends = crane.bridge_end_carriage_mass * crane.gravity
        first, second = guards[[equations.FIRST_RAIL, equations.SECOND_RAIL]]
        assert_allclose(first + second, weights @ line + hung + ends, rtol=1e-6, atol=0.01)
        assert_allclose(
            second * span, weights @ (line * places) + hung * q[1] + 0.5 * ends * span, rtol=1e-6, atol=0.1
        )


def test_numbers_that_leave_no_crane_are_refused():
    fields = {name: getattr(CRANE, name) for name in CRANE.__slots__}
    for name, value in (("bridge_span", 0.0), ("trolley_mass", -1.0), ("bridge_damping_ratio", float("nan"))):
        with pytest.raises(ValueError, match=name):
            OverheadCrane(**fields | {name: value})

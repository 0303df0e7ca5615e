"""Loads below a hook: any number of rigid links against all constraints at once."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from towercrane.kernels.elastic_rope import TAUT, Elasticity
from towercrane.kernels.hanging import hang_load
from towercrane.kernels.load import Load, Sling
from towercrane.kernels.payload import Rope, State, Structure

G = 9.81


def directed(rng, axes):
    """A unit vector and its rate."""
    n = rng.normal(size=axes)
    n /= np.linalg.norm(n)
    p = rng.normal(size=axes)
    return n, p - (p @ n) * n


def drawn(rng, axes, n, bodies):
    """A structure that no crane has, and a chain below it."""
    root, jacobian, rates = rng.normal(size=(n, n)), rng.normal(size=(axes, n)), rng.normal(size=n)
    mass = root @ root.T + n * np.eye(n)
    crane = Structure(
        [mass[i, : i + 1] for i in range(n)], rng.normal(size=n), rng.normal(size=axes), jacobian @ rates,
        rng.normal(size=axes), jacobian, rng.normal(size=axes), rng.normal(size=axes),
    )  # fmt: skip
    rope = Rope(rng.uniform(1.0, 3.0), *rng.normal(size=2), (0.3 * rng.normal(size=n)).tolist())
    links = [directed(rng, axes) for _ in range(bodies)]
    lower, moving = ([x for own in links[1:] for x in own[part]] for part in range(2))
    load = Load(rng.uniform(0.5, 2.0), 0.7, 0.4, slings=tuple(Sling(*rng.uniform(0.3, 2.0, 3)) for _ in links[1:]))
    return crane, State(rng.normal(size=n), links[0][0], rates, links[0][1], lower, moving), rope, load


def solved(crane, state, rope, load):
    """Accelerations of coordinates and bodies, forces of links and power, of masses and constraints in one matrix."""
    axes, n, bodies = len(state.direction), len(state.rates), load.bodies
    links, jacobian = [(state.direction, state.swing), *state.links()], np.reshape(crane.jacobian, (axes, n))
    lengths = [rope.length, *(sling.length for sling in load.slings)]
    velocity = crane.velocity + (rope.rate + np.dot(rope.paid, state.rates)) * links[0][0]
    velocities = velocity + np.cumsum([far * np.array(p) for far, (_, p) in zip(lengths, links, strict=True)], axis=0)
    through = velocities - crane.wind
    air = [-body.drag * np.linalg.norm(v) * v for body, v in zip(bodies, through, strict=True)]
    hinge = -load.rope_damping / rope.length * state.swing
    size, masses = n + axes * len(bodies), np.repeat([body.mass for body in bodies], axes)
    mass, force = np.diag(np.concatenate([np.ones(n), masses])), np.zeros(size)
    mass[:n, :n] = crane.mass_matrix()
    force[:n] = crane.force - jacobian.T @ hinge
    force[n:] = np.ravel(air) - masses * np.tile([0.0] * (axes - 1) + [G], len(bodies))
    force[n : n + axes] += hinge
    held, right = np.zeros((len(bodies), size)), np.zeros(len(bodies))
    thrown = crane.bias + crane.ground
    for i, (length, (own, p)) in enumerate(zip(lengths, links, strict=True)):
        held[i, n + i * axes : n + (i + 1) * axes] = own
        right[i] = -length * np.dot(p, p)
        if i:
            held[i, n + (i - 1) * axes : n + i * axes] = -np.array(own)
        else:
            held[i, :n] = -jacobian.T @ own - rope.paid
            right[i] += rope.acceleration + own @ thrown
    whole = np.block([[mass, held.T], [held, np.zeros((len(bodies), len(bodies)))]])
    found = np.linalg.solve(whole, np.concatenate([force, right]))
    power = -load.rope_damping * state.swing @ state.swing - found[size] * rope.rate
    pushed = zip(air, bodies, velocities, strict=True)
    power += sum((own - body.mass * np.array(crane.ground)) @ v for own, body, v in pushed)
    return found[:n], found[n:size].reshape(-1, axes), found[size:], power


@pytest.mark.parametrize("axes", [2, 3])
def test_a_chain_accelerates_as_masses_and_constraints_in_one_matrix_do(axes):
    rng = np.random.default_rng(axes)
    for n in (0, 1, 4):
        for bodies in (1, 2, 3, 5):
            for _ in range(5):
                crane, state, rope, load = drawn(rng, axes, n, bodies)
                found = hang_load(crane, state, rope, load, G)
                accelerations, placed, forces, power = solved(crane, state, rope, load)
                largest = max(1.0, abs(forces).max(), abs(placed).max())
                assert_allclose(found.accelerations, accelerations, rtol=0, atol=4e-14 * largest)
                assert_allclose([found.tension, *found.guards], forces, rtol=0, atol=4e-14 * largest)
                assert found.power == pytest.approx(power, rel=1e-12, abs=1e-12 * largest)
                paying, hauled = np.dot(rope.paid, found.accelerations), np.dot(rope.paid, state.rates)
                turning = np.reshape(found.turning, (bodies, axes))
                moved = np.array(found.suspension) + (rope.acceleration + paying) * state.direction
                moved = moved + 2.0 * (rope.rate + hauled) * state.swing + rope.length * turning[0]
                lower = [sling.length * own for sling, own in zip(load.slings, turning[1:], strict=True)]
                assert_allclose(np.cumsum([moved, *lower], axis=0), placed, rtol=0, atol=4e-14 * 10 * largest)


def test_below_an_elastic_rope_that_pulls_alike_a_chain_accelerates_alike():
    rng = np.random.default_rng(7)
    for n in (0, 3):
        for bodies in (2, 4):
            crane, state, rope, load = drawn(rng, 3, n, bodies)
            rigid = hang_load(crane, state, rope, load, G)
            sign = np.sign(rigid.tension)
            whole = rope.length / (1.0 + 0.01 * sign) + 3.0
            unstretched = rope.length - 0.01 * sign * whole
            rate = rope.rate + np.dot(rope.paid, state.rates)
            place = crane.place + rope.length * state.direction
            velocity = crane.velocity + rate * state.direction + rope.length * state.swing
            elastic = Elasticity(rigid.tension / (0.01 * sign), whole - unstretched, 0.0, TAUT)
            found = hang_load(
                crane, state._replace(direction=place, swing=velocity), rope._replace(length=unstretched),
                replace(load, elasticity=elastic), G,
            )  # fmt: skip
            assert_allclose(found.accelerations, rigid.accelerations, rtol=1e-10, atol=1e-10)
            assert_allclose(found.guards[: bodies - 1], rigid.guards, rtol=1e-10, atol=1e-10)
            assert_allclose(found.turning[3:], rigid.turning[3:], rtol=1e-9, atol=1e-9)
            hook = solved(crane, state, rope, load)[1][0] - crane.ground
            assert_allclose(found.turning[:3], hook, rtol=1e-9, atol=1e-9)

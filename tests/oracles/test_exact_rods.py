"""The exact rods by themselves: elastica, frequencies, free flight, tops, energy."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles import exact_rods, rod_comparison
from oracles import rod_kernels as at
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc

STILL = np.zeros(5)
LENGTH, MASS, BENDING = 10.0, 50.0, 4e6


def rod(count, clamped=True, bending=(1e6, BENDING, 2.0 * BENDING), inertias=(2.0, 0.01, 0.01), stretch=1e10):
    """A rod along x; bending about y is to z."""
    places = np.column_stack([np.linspace(0.0, LENGTH, count + 1), np.zeros((count + 1, 2))])
    nodes, ends, elements = exact_rods.chain(0, places, (stretch, *bending), MASS, inertias, 0)
    if clamped:
        nodes[0, at.MASS] = np.inf
    return exact_rods.Rods(places, nodes, ends, elements)


def elastica(force):
    """Tip of a clamped rod of unit length and stiffness under a dead force across it (Bisshopp and Drucker 1945)."""
    root = np.sqrt(force)

    def start(p):
        return np.arcsin(1.0 / (p * np.sqrt(2.0)))

    p = brentq(lambda p: ellipk(p * p) - ellipkinc(start(p), p * p) - root, np.sqrt(0.5) + 1e-12, 1.0 - 1e-12)
    across = 1.0 - 2.0 / root * (ellipe(p * p) - ellipeinc(start(p), p * p))
    return np.sqrt(2.0 * (2.0 * p * p - 1.0)) / root, across


@pytest.mark.parametrize("force", [1.0, 10.0])
def test_cantilever_under_a_dead_force_is_the_elastica(force):
    errors = []
    for count in (8, 16):
        bent = rod(count)
        bent.nodes[-1, at.GRAVITY] = force * BENDING / LENGTH**2 / bent.nodes[-1, at.MASS]
        tip = bent.at_rest(bent.undeformed(), STILL, loads=8)[-1, at.PLACE : at.PLACE + 3] / LENGTH
        along, across = elastica(force)
        assert abs(tip[1]) < 1e-20
        errors.append(np.hypot(tip[0] - along, tip[2] + across))
    assert 3.5 < errors[0] / errors[1] < 4.5
    assert 5e-5 * force < errors[1] < 8e-5 * force


def test_modes_of_a_cantilever_are_those_of_euler_beam_and_shaft():
    straight = rod(16)
    squares = np.linalg.eigvals(straight.gradient(straight.undeformed(), STILL)).real
    found = np.sqrt(np.sort(-squares))

    def misses(exact):
        return found[np.argmin(abs(found - exact))] / exact - 1.0

    for bending in (BENDING, 2.0 * BENDING):
        exact = np.array([1.87510407, 4.69409113, 7.85475744]) ** 2 * np.sqrt(bending / MASS) / LENGTH**2
        # What rotary inertia of 0.01 kg m is left takes 5e-6 and more.
        assert np.all(abs(np.array([misses(w) for w in exact])) < [8e-6, 6e-5, 2e-4])
    assert misses(np.pi / 2 * np.sqrt(1e6 / 2.0) / LENGTH) == pytest.approx(-5.4e-4, rel=0.02)


def axes(state):
    return Rotation.from_quat(state[:, at.TURN : at.TURN + 4], scalar_first=True)


def momenta(rods, state):
    """Momentum, and angular momentum about the origin."""
    arm = axes(state).apply([1.0, 0.0, 0.0]) * rods.nodes[:, at.MOMENT, None]
    v, w = state[:, at.SPEED : at.SPEED + 3], state[:, at.SPIN : at.SPIN + 3]
    linear = rods.nodes[:, at.MASS, None] * v + np.cross(axes(state).apply(w), arm)
    own = axes(state).apply(rods.nodes[:, at.INERTIA : at.INERTIA + 3] * w) + np.cross(arm, v)
    return np.concatenate([linear.sum(axis=0), (np.cross(state[:, :3], linear) + own).sum(axis=0)])


def kinetic_energy(rods, state):
    node, row = rods.nodes[rods.free], state[rods.free]
    v, w = row[:, at.SPEED : at.SPEED + 3], row[:, at.SPIN : at.SPIN + 3]
    swept = axes(row).apply(np.cross(w, [1.0, 0.0, 0.0])) * node[:, at.MOMENT, None]
    squares = node[:, at.MASS] * (v**2).sum(axis=1) + (node[:, at.INERTIA : at.INERTIA + 3] * w**2).sum(axis=1)
    return float(0.5 * squares.sum() + (v * swept).sum())


def march(rods, state, duration, steps, inputs=STILL):
    state = state.copy()
    drives = np.tile(inputs, (2 * steps + 1, 1))
    at.march(state, *rods.parts, rods.rail, drives, duration / steps)
    return state


def test_turned_and_moved_rods_carry_no_strain_and_turn_on_at_their_speed():
    free = rod(4, clamped=False, inertias=(2.0, 0.1, 0.1))
    state, speed = free.undeformed(), 0.1
    state[:, at.SPEED + 1] = speed * (free.places[:, 0] - LENGTH / 2)
    state[:, at.SPIN + 2] = speed
    turned = march(free, state, 2.0 * np.pi / 3.0 / speed, 200_000)
    c, s = np.cos(2.0 * np.pi / 3.0), np.sin(2.0 * np.pi / 3.0)
    exact = np.column_stack([c * (free.places[:, 0] - 5.0) + 5.0, s * (free.places[:, 0] - 5.0), np.zeros(5)])
    assert_allclose(turned[:, :3], exact, atol=2e-8)
    assert_allclose(turned[:, at.TURN], np.cos(np.pi / 3.0), rtol=1e-8)
    # What strain there is, is centrifugal.
    assert free.rates(turned, STILL)[1] < 1e-9 * kinetic_energy(free, turned)


def test_tumbling_rods_keep_energy_momentum_and_angular_momentum():
    free = rod(6, clamped=False, bending=(1e5, 4e4, 8e4), inertias=(2.0, 1.0, 1.0), stretch=1e6)
    free.nodes[2, at.MOMENT], free.nodes[2, at.MASS] = -300.0, 500.0
    free.nodes[2, at.INERTIA : at.INERTIA + 3] = 100.0, 400.0, 500.0
    state, rng = free.undeformed(), np.random.default_rng(5)
    state[:, at.SPEED :] = rng.normal(size=(7, 6))
    later = march(free, state, 5.0, 100_000)
    assert abs(later[:, 3:7] - state[:, 3:7]).max() > 0.3
    before, after = (kinetic_energy(free, s) + free.rates(s, STILL)[1] for s in (state, later))
    assert free.rates(later, STILL)[1] > 0.1 * before
    assert_allclose(after, before, rtol=3e-9)
    assert_allclose(momenta(free, later), momenta(free, state), rtol=1e-11)


@pytest.mark.parametrize("tilt", [0.0, 0.7])
def test_unbalanced_body_precesses_as_a_symmetric_top(tilt):
    # Spin about its axis and across it, about the centre of mass, which stands 0.4 m off the node; the node's axes
    # are tilted against the body's about e2.
    own = Rotation.from_rotvec([0.0, tilt, 0.0])
    (xx, _, xz), (_, yy, _), (_, _, zz) = (
        own.inv().as_matrix() @ np.diag([3.0, 20.0, 20.0]) @ own.as_matrix()
    ).tolist()
    first, _, raised = own.inv().apply([20.0, 0.0, 0.0])
    body = np.array([[50.0, xx, yy, zz, first, 0.0, 0.0, raised, xz]])
    top = exact_rods.Rods(np.zeros((1, 3)), body, np.zeros((0, 2), dtype=int), np.zeros((0, 12)))
    state = top.undeformed()
    state[0, at.TURN : at.TURN + 4] = own.as_quat(scalar_first=True)
    spin, nutation, central = 5.0, 1.5, 20.0 - 20.0**2 / 50.0
    state[0, at.SPIN : at.SPIN + 3] = own.inv().apply([spin, 0.0, nutation])
    state[0, at.SPEED : at.SPEED + 3] = -np.cross([spin, 0.0, nutation], [0.4, 0.0, 0.0])
    later = march(top, state, 2.0, 4000)[0]
    momentum = np.array([3.0 * spin, 0.0, central * nutation])
    axis, angle = momentum / np.linalg.norm(momentum), 2.0 * np.linalg.norm(momentum) / central
    start = np.array([1.0, 0.0, 0.0])
    pointing = (
        start * np.cos(angle) + np.cross(axis, start) * np.sin(angle) + axis * (axis @ start) * (1.0 - np.cos(angle))
    )
    # The centre of mass rests at 0.4 m.
    assert_allclose(later[:3], 0.4 * (start - pointing), atol=1e-9)


def test_crane_keeps_its_energy_once_its_drives_are_held():
    # They are from 10 s on, the slewing joint at 0.56 rad.
    rods, motions = exact_rods.crane_rods(rod_comparison.stiffer(1.0), 1500.0), rod_comparison.BRISK
    times, seen = exact_rods.states(rods, motions, 16.0, every=1.0)
    held = exact_rods.inputs_at(motions, times[-1:])[0]
    energies = np.array([kinetic_energy(rods, state) + rods.rates(state, held)[1] for state in seen[10:]])
    motion = np.ptp([kinetic_energy(rods, state) for state in seen[10:]])
    assert motion > 1e4
    assert np.ptp(energies) < 1e-9 * motion
    assert np.ptp([kinetic_energy(rods, s) + rods.rates(s, held)[1] for s in seen[:10]]) > motion


def test_halved_elements_move_the_load_by_less_than_a_millimetre():
    motions, crane = rod_comparison.BRISK, rod_comparison.stiffer(1.0)
    coarse, finer = (
        exact_rods.course(exact_rods.crane_rods(crane, 1500.0, *n), motions, 6.0)[1] for n in ((4, 8), (8, 16))
    )
    gap = abs(coarse - finer).max()
    assert 2e-4 < gap < 5e-4

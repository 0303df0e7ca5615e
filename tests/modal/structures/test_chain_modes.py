"""Modes of chains and structures against the closed form, their own equations and exact symmetric cases."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from samples.qtz5613 import CRANE

from modal import Beam, Chain, CraneFrame, EndBody, Foundation, Segment, cantilever_modes, crane_structure
from modal.structures.chain_modes import chain_modes
from modal.structures.part_shapes import FORCE, MOMENT, ROTATION, SLOPE
from modal.structures.structure_modes import structure_modes

TOWER, END_BODY = CRANE.tower, CRANE.end_body
EI = TOWER.bending_stiffness
UNIFORM = Chain((Segment(TOWER.length, TOWER.mass_per_length, EI),))
GENERAL = Chain(
    (
        Segment(10.0, 400.0, EI, 2e8, 30.0, end_ratio=0.8, mass_power=1.0),
        Segment(8.0, 350.0, 0.8 * EI, 1.5e8, 30.0),
        Segment(6.0, 300.0, 0.6 * EI, 1e8, 20.0),
    ),
    {2: EndBody(500.0, 100.0, 0.3), 3: EndBody(800.0, 2000.0, 1.1)},
    gravity=9.81,
    foundation=Foundation(1e10, 1e9),
)


def test_uniform_clamped_chain_has_the_modes_of_the_closed_form():
    ours, closed = chain_modes(UNIFORM, 6, END_BODY), cantilever_modes(TOWER, 6, END_BODY)
    np.testing.assert_allclose(ours.angular_frequencies, closed.angular_frequencies, rtol=1e-13)
    x = np.linspace(0.0, TOWER.length, 9)
    for derivative in range(4):
        exact = closed(x, derivative)
        assert np.abs(ours(x, derivative) - exact).max() < 2e-13 * np.abs(exact).max()
    np.testing.assert_allclose(ours.rotation(x), ours(x, 1), atol=1e-15)
    pairs = [
        (getattr(ours, name)(), getattr(closed, name)()) for name in ("mass_matrix", "slope_matrix", "weight_matrix")
    ]
    pairs += [(ours.stiffness_matrix(), closed.stiffness_matrix())]
    pairs += list(zip(ours.mass_moments(), closed.mass_moments(), strict=True))
    pairs += [(ours.deflection_integrals(), closed.deflection_integrals())]
    for mine, theirs in pairs:
        assert np.abs(mine - theirs).max() < 1e-12 * np.abs(theirs).max()


@pytest.mark.parametrize("theory", ["haringx", "engesser"])
def test_matrices_of_a_general_chain_give_back_its_frequencies(theory):
    """Mass, stiffness, weight and end load are separate integrals; together they are diagonal in the modes."""
    chain = replace(GENERAL, shear_theory=theory, axial_load=2e5)
    modes = chain_modes(chain, 6, END_BODY)
    end, turn = modes(chain.length), modes.rotation(chain.length)
    mass = modes.mass_matrix() + END_BODY.mass * np.outer(end, end) + END_BODY.rotary_inertia * np.outer(turn, turn)
    assert np.abs(mass - np.eye(6)).max() < 2e-13
    load = chain.axial_load + chain.gravity * END_BODY.mass
    stiffness = modes.stiffness_matrix() - chain.gravity * modes.weight_matrix() - load * modes.slope_matrix()
    omega = modes.angular_frequencies
    assert np.abs(stiffness / np.outer(omega, omega) - np.eye(6)).max() < 2e-13


def test_shapes_obey_the_equations_of_the_beam():
    modes = chain_modes(GENERAL, 5)
    shapes, omega2 = modes.shapes, modes.angular_frequencies[:, None] ** 2
    x = np.array([1.0, 4.0, 9.0, 12.0, 15.0, 19.0, 23.0])
    v, theta, force, moment, slope = (shapes.evaluate(x, quantity) for quantity in range(5))
    P, m = GENERAL.compression(x), GENERAL.section(x, "mass_per_length")
    bending, S = GENERAL.section(x, "bending_stiffness"), GENERAL.section(x, "shear_stiffness")
    inertia = GENERAL.section(x, "rotary_inertia")
    checks = [
        (slope, shapes.evaluate(x, derivative=1)),
        (S * (slope - theta), force + P * theta),
        (bending * shapes.evaluate(x, ROTATION, 1), moment),
        (shapes.evaluate(x, FORCE, 1), -m * omega2 * v),
        (shapes.evaluate(x, MOMENT, 1), -force - P * slope - inertia * omega2 * theta),
    ]
    for left, right in checks:
        assert np.abs(left - right).max() < 1e-11 * np.abs(right).max()


def test_momentum_balances_the_reaction_of_the_foot():
    modes = chain_modes(replace(GENERAL, gravity=0.0), 6)
    force, moment = (modes.shapes.evaluate(0.0, quantity) for quantity in (FORCE, MOMENT))
    zeroth, first = modes.mass_moments()
    omega2 = modes.angular_frequencies**2
    np.testing.assert_allclose(force, omega2 * zeroth, rtol=1e-9)
    spin = modes.rotary_moments()
    np.testing.assert_allclose(-moment, -omega2 * (first + spin), rtol=1e-9)


def test_equal_frequencies_get_independent_orthonormal_shapes():
    """Jib and counter-jib alike on a tower that hardly moves: one mode each, at the same frequency."""
    jib = Chain((Segment(30.0, 120.0, 7e8),))
    tower = Chain((Segment(1.0, 1.0, 1e16),), {1: EndBody(1e12, 1e14)})
    modes = structure_modes(crane_structure(CraneFrame(tower, jib, jib), 0.0), 3)
    assert np.ptp(modes.angular_frequencies[[0, 1]]) < 1e-6 * modes.angular_frequencies[0]
    assert np.abs(modes.mass_matrix() - np.eye(3)).max() < 1e-6


def test_a_symmetric_crane_has_symmetric_and_antisymmetric_modes():
    jib = Chain((Segment(30.0, 120.0, 7e8),))
    tower = Chain((Segment(24.0, 350.0, EI),), {1: EndBody(1000.0, 1e5)})
    modes = structure_modes(crane_structure(CraneFrame(tower, jib, jib), 0.0), 6)
    x = np.linspace(1.0, 30.0, 5)
    right, left = (modes.parts[name].evaluate(x) for name in ("jib", "counter-jib"))
    tilt = modes.parts["tower"].evaluate(24.0, ROTATION)
    for k in range(6):
        parity = 1.0 if np.sign(right[k, -1]) == np.sign(left[k, -1]) else -1.0
        assert np.abs(right[k] - parity * left[k]).max() < 1e-9 * np.abs(right[k]).max()
        assert parity < 0.0 or abs(tilt[k]) < 1e-9 * np.abs(modes.parts["jib"].evaluate(x, SLOPE)[k]).max()
    assert np.abs(modes.mass_matrix() - np.eye(6)).max() < 1e-10


def test_no_modes_and_bad_requests():
    none = chain_modes(UNIFORM, 0, END_BODY)
    assert none.count == 0
    assert none(3.0).shape == (0,)
    assert none.mass_matrix().shape == none.stiffness_matrix().shape == none.weight_matrix().shape == (0, 0)
    with pytest.raises(ValueError, match="end_body"):
        chain_modes(UNIFORM, 2, EndBody(np.inf))
    with pytest.raises(ValueError, match=r"position: wanted 0 to 23\.8 m, got 24\.0"):
        chain_modes(UNIFORM, 2)(24.0)
    with pytest.raises(ValueError, match="derivative"):
        chain_modes(UNIFORM, 2)(1.0, -1)


def test_segment_splits_into_itself():
    segment = Segment(10.0, 400.0, EI, 2e8, 30.0, 0.7, 1.0, 3.0, 1.0)
    near, far = segment.split(3.7)
    assert near.mass + far.mass == pytest.approx(segment.mass, rel=1e-14)
    whole, cut = Chain((segment,)), Chain((near, far))
    x = np.array([0.0, 1.0, 3.6, 3.8, 9.9])
    for name in ("mass_per_length", "bending_stiffness", "shear_stiffness", "rotary_inertia"):
        np.testing.assert_allclose(whole.section(x, name), cut.section(x, name), rtol=1e-14)
    assert replace(whole, gravity=9.81).compression(x) == pytest.approx(replace(cut, gravity=9.81).compression(x))


def test_the_far_end_belongs_to_the_last_segment():
    end = np.array([GENERAL.length])
    assert GENERAL.section(end, "bending_stiffness") == 0.6 * EI
    assert GENERAL.section(end, "mass_per_length") == 300.0
    assert GENERAL.compression(end)[0] == pytest.approx(9.81 * 800.0, rel=1e-9)


def test_bodies_stand_on_whole_nodes():
    for node in (1.0, "1", True):
        with pytest.raises(ValueError, match=r"Chain\.bodies: wanted nodes 0 to 1"):
            Chain(UNIFORM.segments, {node: END_BODY})


def test_beam_and_chain_agree_on_what_they_are():
    assert Beam(10.0, 2.0, 3.0, 4.0).mass == Chain((Segment(10.0, 2.0, 12.0),)).mass

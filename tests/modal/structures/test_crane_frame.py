"""Tower and jib as one exact structure: published frequencies, collocation, limits and refused input."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from oracles.collocation import collocated_crane

from modal.beams.beam import EndBody
from modal.beams.chain import Chain, Foundation, Pendulum
from modal.beams.segment import Segment
from modal.structures.crane_frame import CraneFrame, crane_structure
from modal.structures.structure_modes import structure_modes

MODULUS = 206e9
COUNTER_JIB = 12.3 * 159.3
HEAD = EndBody(COUNTER_JIB + 15130.0, COUNTER_JIB * 12.3**2 / 3.0 + 15130.0 * 12.3**2)
TOWER = Chain((Segment(23.8, 350.0, MODULUS * 0.014),), {1: HEAD})
JIB = Chain((Segment(55.6, 123.8, MODULUS * 0.0035),))
JIB_MASS = 55.6 * 123.8
CRANE = CraneFrame(TOWER, JIB, trolley_mass=350.0, payload_mass=800.0, rope_length=18.0)
RIGID_JIB = EndBody(HEAD.mass + JIB_MASS, HEAD.rotary_inertia + JIB_MASS * 55.6**2 / 3.0)


def hertz(crane, trolley, count):
    return crane_structure(crane, trolley).angular_frequencies(count) / (2.0 * np.pi)


@pytest.mark.parametrize(
    ("trolley", "flexible", "rigid", "softened"),
    [
        (5.0, (0.117452, 0.347987, 0.802624, 2.405649, 3.044157), (0.4757, 1.8356, 18.574), (0.3465, 0.7974)),
        (41.0, (0.117452, 0.311800, 0.794502, 2.409990, 3.018964), (0.4462, 1.7869), (0.3106, 0.7890)),
    ],
)
def test_published_crane_flexible_rigid_and_under_its_weight(trolley, flexible, rigid, softened):
    np.testing.assert_allclose(hertz(CRANE, trolley, 5), flexible, atol=6e-7)
    stiff = replace(CRANE, tower=replace(TOWER, bodies={1: RIGID_JIB}), jib=None)
    np.testing.assert_allclose(hertz(stiff, trolley, 1 + len(rigid))[1:], rigid, rtol=5e-5, atol=5e-5)
    heavy = replace(CRANE, tower=replace(TOWER, gravity=9.81))
    np.testing.assert_allclose(hertz(heavy, trolley, 3)[1:], softened, atol=6e-5)


@pytest.mark.parametrize("gravity", [0.0, 9.81])
@pytest.mark.parametrize("trolley", [5.0, 41.0])
def test_crane_is_that_of_collocation(trolley, gravity):
    # In units of the tower's length, mass and bending stiffness.
    length, mass, bending = 23.8, 350.0 * 23.8, MODULUS * 0.014
    second = np.sqrt(bending / (mass * length**3))

    def scaled(segment):
        return Segment(
            segment.length / length, segment.mass_per_length * length / mass, segment.bending_stiffness / bending
        )

    unit = 1.0 / (length * second**2)
    crane = CraneFrame(
        Chain(
            (scaled(TOWER.segments[0]),),
            {1: EndBody(HEAD.mass / mass, HEAD.rotary_inertia / (mass * length**2))},
            gravity=gravity * unit,
        ),
        Chain((scaled(JIB.segments[0]),)),
        trolley_mass=350.0 / mass,
        payload_mass=800.0 / mass,
        rope_length=18.0 / length,
        gravity=9.81 * unit,
    )
    wanted = collocated_crane(crane, trolley / length, 5) * second / (2.0 * np.pi)
    heavy = replace(CRANE, tower=replace(TOWER, gravity=gravity))
    np.testing.assert_allclose(hertz(heavy, trolley, 5), wanted, rtol=1e-11)


def test_stiff_jib_nears_the_rigid_one_in_proportion():
    rigid = hertz(replace(CRANE, tower=replace(TOWER, bodies={1: RIGID_JIB}), jib=None), 41.0, 2)[1]
    found = []
    for factor in (16.0, 64.0, 256.0, 1024.0):
        jib = replace(JIB, segments=(replace(JIB.segments[0], bending_stiffness=MODULUS * 0.0035 * factor),))
        found.append(hertz(replace(CRANE, jib=jib), 41.0, 2)[1])
    np.testing.assert_allclose(found[:3], [0.4358, 0.4436, 0.4455], atol=6e-5)
    ratio = (rigid - found[2]) / (rigid - found[3])
    assert 3.95 < ratio < 4.05


def test_equal_jibs_have_modes_that_leave_the_tower_alone():
    # Both jibs bend alike and their moments on the tower cancel: each then vibrates as if clamped.
    plain = CraneFrame(Chain(TOWER.segments, {1: EndBody(5000.0, 1e4)}), JIB, JIB)
    both = hertz(plain, 0.0, 12)
    beam = MODULUS * 0.0035 / 123.8
    clamped = np.sqrt(beam) * np.array([1.875104068711961, 4.694091132974175, 7.854757438237613]) ** 2 / 55.6**2
    for frequency in clamped / (2.0 * np.pi):
        assert np.abs(both / frequency - 1.0).min() < 1e-12


def test_trolley_anywhere_and_at_both_ends():
    frequencies = np.array([hertz(CRANE, trolley, 4) for trolley in (0.0, 0.5, 5.0, 55.1, 55.6)])
    np.testing.assert_allclose(frequencies[0], frequencies[1], rtol=1e-3)
    np.testing.assert_allclose(frequencies[4], frequencies[3], rtol=0.05)
    assert (np.diff(frequencies[:, 1]) < 0.0).all()


def test_refused_cranes():
    for trolley in (-1.0, 55.7):
        with pytest.raises(ValueError, match="position: wanted 0"):
            crane_structure(CRANE, trolley)
    with pytest.raises(ValueError, match="trolley_position: wanted zero or more"):
        crane_structure(replace(CRANE, jib=None), -1.0)
    with pytest.raises(ValueError, match=r"CraneFrame.tower: wanted no pendulum of its own"):
        replace(CRANE, tower=replace(TOWER, pendulum=Pendulum(800.0, 18.0)))
    with pytest.raises(ValueError, match=r"CraneFrame.payload_mass: wanted a finite number, zero or more, got -1"):
        replace(CRANE, payload_mass=-1.0)


@pytest.mark.parametrize("name", ["jib", "counter_jib"])
@pytest.mark.parametrize(
    "more",
    [
        {"gravity": 9.81},
        {"axial_load": 1e4},
        {"pendulum": Pendulum(800.0, 18.0)},
        {"foundation": Foundation(rotation_stiffness=1e9)},
    ],
    ids=lambda more: next(iter(more)),
)
def test_jibs_are_segments_and_bodies_alone(name, more):
    with pytest.raises(ValueError, match=rf"CraneFrame\.{name}: wanted segments and bodies alone"):
        replace(CRANE, **{name: replace(JIB, **more)})


@pytest.mark.parametrize("gap", [1e-6, 1e-4, 1e-2, 0.3])
def test_a_trolley_close_to_a_node_costs_no_digits(gap):
    """The piece between is stiffer than the rest by up to 1e23; frequencies go over into those without it."""
    jib = JIB.length
    at_end, near, nearer = (crane_structure(CRANE, jib - d).angular_frequencies(5) for d in (0.0, gap, 0.5 * gap))
    slope = (near - nearer) / (nearer - at_end)
    assert np.abs(near / at_end - 1.0).max() < 0.05 * gap + 1e-12
    judged = np.abs(nearer / at_end - 1.0) > 1e-9
    np.testing.assert_allclose(slope[judged], 1.0, rtol=0.02 + 0.2 * gap)
    modes = structure_modes(crane_structure(CRANE, jib - gap), 5)
    assert np.abs(modes.mass_matrix() - np.eye(5)).max() < 1e-10


def test_static_displacements_are_those_of_beam_theory():
    tower, jib = TOWER.segments[0], JIB.segments[0]
    structure = crane_structure(replace(CRANE, payload_mass=0.0), JIB.length - 1e-4)
    forces = np.zeros(len(structure.unknowns))
    tip = structure.members[-1].unknowns[2]
    forces[tip] = -1000.0
    moved = structure.displacements(forces)
    L, H, arm = jib.length, tower.length, 1000.0 * jib.length
    tilt = arm * H / tower.bending_stiffness
    sway = arm * H**2 / (2 * tower.bending_stiffness)
    assert moved[structure.members[0].unknowns[2]] == pytest.approx(sway, rel=1e-11)
    assert moved[tip] == pytest.approx(-1000.0 * L**3 / (3 * jib.bending_stiffness) - tilt * L, rel=1e-11)

"""Lattice jibs as beams beside the same jibs member by member, pinned and with rigid joints."""

from __future__ import annotations

import re
from dataclasses import replace
from math import pi
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.flat_top import FLAT_TOP, LIEGE, SECTION_LENGTH

import modal
from modal import Chain, chain_frequencies, chain_structure
from modal.elements.space_beam import SpaceBeam
from modal.elements.space_frame import SpaceFrame
from modal.lattices.jib_truss import LatticeJib
from modal.lattices.section import LatticeSection
from modal.lattices.space_comparison import KINDS, beam_answers, compare_in_space, frame_answers, tip_loads

JIB = LatticeJib(tuple((SECTION_LENGTH, lattice) for lattice in FLAT_TOP))
SHORT = LatticeJib(((12.0, LIEGE),))
ROUND_BARS = 0.25 / pi


def per_cent(found, reference):
    """Of deflections, then of frequencies by kind."""
    change = [100.0 * (np.array(found.deflections) / reference.deflections - 1.0)]
    change += [100.0 * (np.array(found.frequencies_hz[k]) / reference.frequencies_hz[k] - 1.0) for k in KINDS]
    return np.array(change)


@pytest.fixture(scope="module")
def flat_top():
    return compare_in_space(JIB.frame, JIB.beam, 0.4)


@pytest.fixture(scope="module")
def short():
    return compare_in_space(SHORT.frame, lambda: SHORT.beam(24), ROUND_BARS)


def test_the_readme_says_what_these_jibs_come_to(flat_top, short):
    text = Path(modal.__file__).with_name("README.md").read_text("utf-8")
    for name, found, pinned in (
        ("60 m, beam of sections", flat_top[2], flat_top[0]),
        ("60 m, rigid joints", flat_top[1], flat_top[0]),
        ("12 m, beam of sections", short[2], short[0]),
    ):
        said = [cell.split(", ") for cell in re.search(rf"\| {name} \| (.*) \|", text)[1].split(" | ")]
        assert_allclose(np.array(said, dtype=float), per_cent(found.answers, pinned.answers), atol=0.0051)


def test_the_frame_of_a_flat_top_jib_has_the_published_numbers(flat_top):
    """Against finite elements of the same jib by others, whose frequencies are higher by up to 0.1 %."""
    pinned, rigid, _ = flat_top
    assert pinned.name == "pinned"
    assert JIB.frame().mass == pytest.approx(10855.0, abs=1.0)
    assert_allclose(pinned.answers.deflections, [3.123e-5, 8.429e-5, 1.943e-6], rtol=3e-4)
    theirs = {
        "vertical": [0.7451, 3.0635, 7.2011],
        "lateral": [0.4340, 2.0077, 4.8757],
        "torsion": [2.7791, 6.5679, 10.676],
    }
    for kind, frequencies in theirs.items():
        assert_allclose(pinned.answers.frequencies_hz[kind], frequencies, rtol=1e-3)
    # Joints stiffen torsion.
    stiffer = per_cent(rigid.answers, pinned.answers)
    assert_allclose(stiffer[0], [-0.75, -1.02, -9.06], atol=0.01)
    assert 0.0 < stiffer[1:3].min() < stiffer[1:3].max() < 0.7
    assert 5.0 < stiffer[3].min() < stiffer[3].max() < 8.0


def test_the_beam_of_a_flat_top_jib_keeps_to_its_frame(flat_top):
    pinned, _, beam = flat_top
    errors = np.abs(per_cent(beam.answers, pinned.answers))
    assert (errors[0] < [0.02, 0.01, 0.14]).all()
    assert (errors[1] < [0.02, 0.06, 0.17]).all()
    assert (errors[2] < [0.01, 0.02, 0.05]).all()
    assert (errors[3] < [0.03, 0.11, 0.22]).all()


def test_a_lateral_force_on_the_rail_twists_the_jib(flat_top):
    """It goes below the shear centre."""
    frame, beam = JIB.frame(), JIB.beam()
    loads = tip_loads(frame)
    found = np.sum(loads[2] * frame.displacements(loads[1]))
    force = np.zeros((len(beam.lengths), 6))
    force[-1, 1] = 1.0
    assert_allclose(found, 1.149e-6, rtol=5e-4)
    assert_allclose(beam.displacements(force)[-1, 3], found, rtol=3e-3)


def test_parallel_diagonals_keep_to_their_frame(short):
    pinned, rigid, beam = short
    first = [model.answers.frequencies_hz[kind][0] for model in (pinned, rigid) for kind in KINDS]
    assert_allclose(first, [5.278, 5.893, 12.814, 5.299, 5.915, 13.219], rtol=3e-4)
    assert_allclose(rigid.answers.deflections[0], 1.2883e-6, rtol=1e-4)
    errors = per_cent(beam.answers, pinned.answers)
    assert_allclose(errors[1:, 0], [-0.09, -0.22, -0.65], atol=0.01)
    assert (np.abs(errors[0]) < [0.7, 0.8, 1.0]).all()


def test_panels_half_as_long_bring_beam_and_frame_together():
    """What the beam leaves out is of the second order in the panel."""

    def error(panel, height):
        # Diagonals keep their slope, so that only the number of panels changes.
        lattice = replace(LIEGE, panel_length=panel, height=height, breadth=height / 0.75**0.5)
        jib = LatticeJib(((12.0, lattice),))
        return per_cent(beam_answers(jib.beam(48)), frame_answers(jib.frame(), jib.beam(48)))[0, :2]

    coarse, fine = error(2.0, 0.75**0.5), error(1.0, 0.5 * 0.75**0.5)
    assert (np.abs(coarse / fine) > 3.0).all()
    assert (np.abs(coarse / fine) < 5.0).all()


@pytest.mark.parametrize("plane", ["vertical", "lateral"])
def test_segments_of_a_jib_bend_as_its_beam_in_space(plane):
    """In the plane a force to the side is at the shear centre, the mass at the axis."""
    segments = tuple(one for length, lattice in JIB.parts for one in lattice.segments(length, plane))
    found = chain_frequencies(Chain(segments), 3) / (2.0 * np.pi)
    sections = [lattice.at(0.05 + 0.1 * k, length) for length, lattice in JIB.parts for k in range(10)]
    laws = [np.array([getattr(one, name) for one in sections]) for name in ("flexibility", "mass_matrix")]
    beam = SpaceBeam(np.ones(60), *laws)
    rtol = {"vertical": 2e-4, "lateral": 5e-3}[plane]
    assert_allclose(found, beam_answers(beam).frequencies_hz[plane], rtol=rtol)


@pytest.mark.parametrize(("shape", "bounds"), [("triangle", (3e-3, 3e-3)), ("rectangle", (3e-3, 3e-2))])
@pytest.mark.parametrize("side", ["up", "down"])
@pytest.mark.parametrize("lacing", ["zigzag", "X"])
def test_other_shapes_and_lacings_keep_to_their_frame_under_loads(shape, bounds, side, lacing):
    """A torque on the corners of a rectangle changes its shape besides, near the tip."""
    posts = 6e-4 if lacing == "X" else 0.0
    lattice = replace(
        FLAT_TOP[0], shape=shape, side=side, side_lacing=lacing, base_lacing=lacing, side_post_area=posts,
        base_post_area=6e-4 if lacing == "X" or shape == "triangle" else 0.0,
        end_height=1.5,
    )  # fmt: skip
    jib = LatticeJib(((40.0, lattice),))
    frame = jib.frame()
    loads = tip_loads(frame)
    found = np.einsum("kni,kni->k", loads, frame.displacements(loads))
    errors = np.abs(beam_answers(jib.beam(40)).deflections / found - 1.0)
    assert (errors < [bounds[0], bounds[0], bounds[1]]).all()


def test_a_cantilever_of_rigid_members_is_a_beam():
    """Against closed forms: deflection, twist by a pair of forces on arms, the first bending frequency."""
    count, length, EI, GJ, m = 16, 8.0, 3e6, 2e6, 40.0
    nodes = np.zeros((count + 1, 3))
    nodes[:, 0] = np.linspace(0.0, length, count + 1)
    pairs = np.stack([np.arange(count), np.arange(1, count + 1)], axis=1)
    one = np.ones(count)
    line = SpaceFrame(nodes, pairs, 1e9 * one, m * one, np.array([0]), EI * one, GJ * one)
    loads = np.zeros((2, count + 1, 3))
    loads[0, -1, 2] = loads[1, -1, 1] = 1.0
    moved = line.displacements(loads)
    assert_allclose([moved[0, -1, 2], moved[1, -1, 1]], length**3 / (3.0 * EI), rtol=1e-9)
    omega = 1.8751040687**2 * np.sqrt(EI / (m * length**4))
    assert_allclose(line.modes(2)[0], omega, rtol=1e-5)
    # An arm across the end.
    arms = np.vstack([nodes, [[length, 0.5, 0.0], [length, -0.5, 0.0]]])
    pairs = np.vstack([pairs, [[count, count + 1], [count, count + 2]]])
    stiff = np.r_[one, 1e6, 1e6]
    frame = SpaceFrame(arms, pairs, 1e9 * stiff, m * np.r_[one, 1e-6, 1e-6], np.array([0]), EI * stiff, GJ * stiff)
    couple = np.zeros((count + 3, 3))
    couple[-2:, 2] = 1.0, -1.0
    assert_allclose(frame.displacements(couple)[-2, 2] / 0.5, length / GJ, rtol=1e-6)


def test_panels_whose_lengths_do_not_add_up_in_binary_meet_all_the_same():
    lattice = replace(FLAT_TOP[0], panel_length=1.39)
    frame = LatticeJib(((40 * 1.39, lattice), (3 * 1.39, lattice))).frame()
    # Two base chords of 44 nodes, a top chord of 43 and its root.
    assert len(frame.nodes) == 2 * 44 + 44
    assert (frame.modes(2)[0] > 0.0).all()


def test_a_jib_says_what_does_not_fit():
    with pytest.raises(ValueError, match=r"wanted a whole number of panels of 2\.0 m, got 9\.0 m, which is 4\.5"):
        LatticeJib(((9.0, FLAT_TOP[0]),))
    with pytest.raises(ValueError, match="wanted one breadth all along"):
        LatticeJib(((10.0, FLAT_TOP[0]), (10.0, replace(FLAT_TOP[1], breadth=1.2))))
    with pytest.raises(ValueError, match="wanted at least one, got none"):
        LatticeJib(())
    assert isinstance(FLAT_TOP[0].at(0.5, 10.0), LatticeSection)


def test_segments_of_parallel_diagonals_bend_as_their_frame():
    """Sides that lean alike over a crossed base, which leaves the planes apart."""
    lattice = replace(LIEGE, base_lacing="X", end_height=0.7)
    frame, segments = LatticeJib(((24.0, lattice),)).frame(), lattice.segments(24.0, "vertical")
    loads = tip_loads(frame)
    up = np.sum(loads[0] * frame.displacements(loads[0]))

    def error(chain):
        force = np.zeros(2 * len(chain.segments))
        force[-2] = 1.0
        return chain_structure(chain).displacements(force)[-2] / up - 1.0

    assert abs(error(Chain(segments))) < 3.5e-3
    assert error(Chain(tuple(replace(one, coupling=0.0) for one in segments))) < -0.02

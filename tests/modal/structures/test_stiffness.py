"""Dynamic stiffness of one segment: 50-digit arithmetic, closed forms, tapers, and pieces that stay short enough."""

from __future__ import annotations

from itertools import pairwise, product

import mpmath
import numpy as np
import pytest
from oracles.determinants import state_matrix

from modal.beams.chain import Chain
from modal.beams.segment import Segment
from modal.structures.kernels.block_stiffness import make_absolute, relative_stiffness
from modal.structures.kernels.blocks import SIZES, grown
from modal.structures.kernels.cut import pieces_within
from modal.structures.kernels.piece import SERIES, TERMS, piece_transfer
from modal.structures.members import HELD, Member
from modal.structures.structure import Structure, chain_frequencies, chain_structure

INF = float("inf")
WHOLE = 1.0, 1.0, 1.0, 1.0
"""Breadths at the ends of a uniform segment, its length, and what is left of it from its near end."""


def exact_stiffness(segment, length, compression, omega2, theory):
    """Stiffness (4, 4) of a uniform piece from its transfer matrix."""
    transfer = mpmath.expm(state_matrix(segment, compression, mpmath.mpf(omega2), theory) * mpmath.mpf(length))
    blocks = {(i, j): transfer[2 * i : 2 * i + 2, 2 * j : 2 * j + 2] for i, j in product((0, 1), repeat=2)}
    inverse = blocks[0, 1] ** -1
    out = mpmath.zeros(4, 4)
    out[0:2, 0:2], out[0:2, 2:4] = inverse * blocks[0, 0], -inverse
    out[2:4, 0:2] = blocks[1, 0] - blocks[1, 1] * inverse * blocks[0, 0]
    out[2:4, 2:4] = blocks[1, 1] * inverse
    return np.array(out.tolist(), dtype=float)


@pytest.mark.parametrize(
    ("shear", "rotary", "compression", "theory", "omega2"),
    [
        (INF, 0.0, 0.0, "haringx", 0.0),
        (INF, 0.0, 0.0, "haringx", 2.7e5),
        (INF, 0.67, 1.92, "haringx", 4.3),
        (INF, 0.0, -710.0, "haringx", 5.1e5),
        (5.3, 0.0, 1.0, "haringx", 40.0),
        (312.0, 0.0032, 287.0, "engesser", 1.76e5),
        (25.0, 0.01, -2.0, "engesser", 3e3),
        (65.5, 0.186, 0.0, "haringx", 3681.0),
    ],
)
@pytest.mark.parametrize("moved", [0.0, 0.9])
def test_a_piece_is_exact_where_all_effects_meet_at_the_end_of_its_reach(
    shear, rotary, compression, theory, omega2, moved
):
    # Mass that vibrates beyond the axis counts for more.
    segment = Segment(1.0, 1.0 / (1.0 - moved), 1.0, shear, rotary)
    engesser = float(theory == "engesser")
    row = np.array(
        [1.0, 1.0, 1.0, 1.0 / shear, rotary, 1.0, 0.0, 0.0, 0.0, compression, 0.0, engesser, 0.0, 0.0, 0.0]
    )
    row[13] = moved / max(omega2, 1.0)
    length = 1.0 / pieces_within(row, WHOLE, omega2, 1.0)
    got, transfer, scratch = np.zeros((4, 4)), np.zeros((4, 4)), np.zeros((4, 4))
    series, state = np.zeros((SERIES, TERMS)), np.zeros((TERMS + 1, 6))
    piece_transfer(row, (1.0, 1.0, length, 1.0), omega2, 1.0, series, state, transfer)
    relative_stiffness(transfer, length, scratch, got)
    make_absolute(got, length)
    with mpmath.workdps(50):
        wanted = exact_stiffness(segment, length, compression, omega2, theory)
    # Against the size of the stiffness at rest: an end may be at its resonance.
    size = np.array([(length**3 + 12.0 * length / shear) ** -0.5, length**-0.5] * 2)
    assert np.abs((got - wanted) / np.outer(size, size)).max() < 1e-13


@pytest.mark.parametrize(
    ("powers", "roots"), [((1.0, 3.0), (5.3150994237, 15.207167955)), ((2.0, 4.0), (8.7192588551, 21.145662388))]
)
def test_wedge_and_cone_are_the_limits_of_truncated_ones(powers, roots):
    def frequencies(ratio):
        segment = Segment(1.0, 1.0, 1.0, end_ratio=ratio, mass_power=powers[0], bending_power=powers[1])
        return chain_frequencies(Chain((segment,)), 2)

    one, two, three = (frequencies(ratio) for ratio in (1e-3, 1e-4, 1e-5))
    steps = (one - two) / (two - three)
    assert (steps > 9.7).all()
    assert (steps < 10.1).all()
    np.testing.assert_allclose(three + (three - two) / 9.0, roots, rtol=6e-8)


TAPERS = {
    "pulled taut at a thin end": (
        Segment(1.0, 1.0, 1.0, end_ratio=0.1, mass_power=2, bending_power=4),
        {"gravity": 30.0, "axial_load": -11.0},
    ),
    "shear left by weight at a thin end": (
        Segment(1.0, 1.0, 1.0, 2.0, end_ratio=0.3, mass_power=2, bending_power=3, shear_power=1),
        {"gravity": 1.5, "shear_theory": "engesser"},
    ),
    "shear column under its weight": (Segment(1.0, 1.0, 10.0, 1.0), {"gravity": 0.6, "shear_theory": "engesser"}),
    "all effects": (
        Segment(1.0, 1.0, 1.0, 30.0, 0.01, end_ratio=0.5, mass_power=1.3, bending_power=3.1, shear_power=0.7),
        {"gravity": 0.6, "axial_load": 0.3},
    ),
    "widening": (Segment(1.0, 1.0, 0.05, end_ratio=6.0, mass_power=1, bending_power=3), {}),
}


@pytest.mark.parametrize("name", TAPERS)
def test_a_segment_is_the_same_in_pieces(name):
    segment, loads = TAPERS[name]
    whole = chain_structure(Chain((segment,), **loads))
    near, middle = segment.split(0.23)
    parts = chain_structure(Chain((near, *middle.split(0.41)), **loads))
    np.testing.assert_allclose(parts.angular_frequencies(8), whole.angular_frequencies(8), rtol=1e-10)
    if name == "all effects":
        np.testing.assert_allclose(parts.buckling_factor(), whole.buckling_factor(), rtol=1e-12)


def test_thin_end_of_a_light_load_is_no_shear_instability():
    # The whole weight on the thin end's shear stiffness would be unstable; where it bears it is not.
    segment, loads = TAPERS["shear left by weight at a thin end"]
    base = loads["gravity"] * segment.mass
    assert base > segment.shear_stiffness * segment.end_ratio
    assert 1.5 < chain_structure(Chain((segment,), **loads)).buckling_factor() < segment.shear_stiffness / base


def test_no_piece_has_a_fixed_end_mode():
    rng = np.random.default_rng(4)
    for _ in range(300):
        theory = float(rng.random() < 0.5)
        row = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, theory, 0.0, 0.0, 0.0])
        row[3], row[4] = rng.choice([0.0, 10 ** rng.uniform(-3, 1)]), rng.choice([0.0, 10 ** rng.uniform(-4, 0)])
        row[9] = rng.choice([-1, 1]) * 10 ** rng.uniform(-2, 2)
        omega2 = 10 ** rng.uniform(-1, 5)
        row[13] = rng.choice([0.0, rng.uniform(0.0, 0.99)]) / omega2
        pieces = pieces_within(row, WHOLE, omega2, 1.0)
        if pieces == 0 or pieces > 400:
            continue
        shear = INF if row[3] == 0.0 else 1.0 / row[3]
        segment = Segment(1.0 / pieces, 1.0, 1.0, shear, row[4], mass_flexibility=row[13])
        # Held at both ends and cut once more, so that nothing is taken for granted about the piece.
        structure = Structure((), shear_theory="engesser" if theory else "haringx")
        node = structure.add_unknown("m"), structure.add_unknown("rad")
        one, other = segment.split(0.5 * segment.length)
        structure.members = [
            Member(one, (HELD, HELD, *node), compression=row[9]),
            Member(other, (*node, HELD, HELD), compression=row[9]),
        ]
        assert structure.count_below(np.sqrt(omega2)) == 0


def test_the_measure_of_a_block_is_the_same_however_it_grows():
    EI, mass, flexibility, rotary, L = 2.5, 1.5, 0.3, 0.02, 0.9
    row = np.array([L, mass, EI, flexibility, rotary, 1.0, *[0.0] * 9])
    sizes, passed = np.zeros(SIZES), 0.0
    for piece in (0.2, 0.6, 0.1):
        assert grown(sizes, row, (1.0, 1.0, piece, L - passed), 1e-3, 1.0)
        passed += piece
    # A cantilever's tip under a unit moment and a unit force, and what its mass feels of each section's own force.
    felt = mass * (L**4 / (12 * EI) + L**2 * flexibility / 2) + rotary * L**2 / (2 * EI)
    expected = [L, L / EI, L**2 / (2 * EI), L**3 / (3 * EI), L * flexibility, felt, 0.0]
    np.testing.assert_allclose(sizes, expected, rtol=1e-14)


def test_stepped_is_unsplit():
    whole = chain_frequencies(Chain((Segment(1.0, 1.0, 1.0, 25.0, 0.01),)), 10)
    cuts = (0.0, 0.13, 0.5, 0.77, 1.0)
    stepped = Chain(tuple(Segment(far - near, 1.0, 1.0, 25.0, 0.01) for near, far in pairwise(cuts)))
    np.testing.assert_allclose(chain_frequencies(stepped, 10), whole, rtol=1e-12)

"""Lattices of jibs as beams: closed forms of triangles and rectangles, what tapers, what couples."""

from __future__ import annotations

from dataclasses import replace
from math import hypot

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.flat_top import FLAT_TOP

from modal.lattices.section import AXIAL, SHEAR_Y, SHEAR_Z

E = 206e9
STOUT = 1e4
"""Area of chords [m^2] whose strain counts for nothing beside that of lacing."""

TRIANGLE = FLAT_TOP[0]
RECTANGLE = replace(TRIANGLE, shape="rectangle", height=2.4, breadth=0.6, end_height=None)

TABLE = [
    (3.332, 1.050, 52.5, 0.61, 0.70, 269), (2.894, 0.929, 46.3, 0.61, 0.69, 234),
    (2.037, 0.787, 37.8, 0.62, 0.62, 198), (1.311, 0.626, 31.5, 0.62, 0.54, 163),
    (0.758, 0.464, 24.4, 0.58, 0.44, 126), (0.387, 0.323, 18.6, 0.56, 0.34, 98),
]  # fmt: skip
"""Of the six sections at mid-height: EI up and aside [GN m^2], GJ [MN m^2], e and z_m [m], m [kg/m]."""


def middle(lattice):
    return lattice.section(0.5 * (lattice.height + lattice.far_height))


def zigzag(panel, depth, area):
    """Shear stiffness of a wall."""
    return E * area * panel * depth**2 / hypot(panel, depth) ** 3


@pytest.mark.parametrize(("lattice", "row"), list(zip(FLAT_TOP, TABLE, strict=True)))
def test_sections_of_a_flat_top_jib_are_those_of_its_table(lattice, row):
    section = middle(lattice)
    found = [
        section.bending("vertical")[0] / 1e9, section.bending("lateral")[0] / 1e9, section.torsional_stiffness / 1e6,
        section.shear_centre, section.mass_centre, section.mass_per_length,
    ]  # fmt: skip
    half_units = [5e-4, 5e-4, 0.05, 0.005, 0.005, 0.5]
    assert (np.abs(np.subtract(found, row)) < 1.01 * np.array(half_units)).all()


@pytest.mark.parametrize("side", ["up", "down"])
def test_a_triangle_has_its_closed_forms(side):
    lattice = replace(TRIANGLE, side=side)
    sign = 1.0 if side == "up" else -1.0
    b, h, p, A_b, A_t = lattice.breadth, lattice.height, lattice.panel_length, 5200e-6, 9600e-6
    s = hypot(h, 0.5 * b)
    S_s, S_b = zigzag(0.5 * p, s, 1250e-6), zigzag(p, b, 900e-6)
    section = middle(lattice)
    assert_allclose(section.bending("vertical")[0], E * h**2 * 2.0 * A_b * A_t / (2.0 * A_b + A_t), rtol=1e-12)
    assert_allclose(section.bending("lateral")[0], 0.5 * E * A_b * b**2, rtol=1e-12)
    assert_allclose(section.axial_stiffness, E * (2.0 * A_b + A_t), rtol=1e-12)
    # The base's nodes step in two panels, the sides' in one.
    a, c = b**2 / S_b + p**2 / (2.0 * E * A_b), 2.0 * s**2 / S_s
    assert_allclose(section.torsional_stiffness, (b * h) ** 2 / (a + c), rtol=1e-12)
    assert_allclose(section.shear_centre, sign * h * a / (a + c), rtol=1e-12)
    # With chords that do not yield.
    rigid = middle(replace(lattice, base_chord_area=STOUT, opposite_chord_area=STOUT))
    a = b**2 / S_b
    assert_allclose(rigid.bending("vertical")[1], 2.0 * S_s * h**2 / s**2, rtol=1e-5)
    assert_allclose(rigid.bending("lateral")[1], S_b + S_s * b**2 / (2.0 * s**2), rtol=1e-5)
    assert_allclose(rigid.torsional_stiffness, (b * h) ** 2 / (a + c), rtol=1e-5)
    assert_allclose(rigid.shear_centre, sign * h * a / (a + c), rtol=1e-5)


def test_a_rectangle_has_its_closed_forms():
    """Where the zigzags of all four walls meet in the same nodes steps do not soften it in torsion."""
    b, h, p, A = RECTANGLE.breadth, RECTANGLE.height, RECTANGLE.panel_length, 5200e-6
    lattice = replace(RECTANGLE, opposite_chord_area=A)
    S_side, S_flat = zigzag(p, h, 1250e-6), zigzag(p, b, 900e-6)
    section = middle(lattice)
    assert_allclose(section.bending("vertical")[0], E * A * h**2, rtol=1e-12)
    assert_allclose(section.bending("lateral")[0], E * A * b**2, rtol=1e-12)
    around = 2.0 * h**2 / S_side + 2.0 * b**2 / S_flat
    assert_allclose(section.torsional_stiffness, 4.0 * (b * h) ** 2 / around, rtol=1e-12)
    assert_allclose(section.shear_centre, 0.5 * h, rtol=1e-12)
    rigid = middle(replace(lattice, base_chord_area=STOUT, opposite_chord_area=STOUT))
    assert_allclose(
        [rigid.bending(plane)[1] for plane in ("vertical", "lateral")], [2.0 * S_side, 2.0 * S_flat], rtol=1e-5
    )


def test_crossed_diagonals_are_a_chord_at_mid_wall():
    """On its two chords a base wall's would stiffen the jib to the side."""
    plain, crossed = (middle(replace(TRIANGLE, base_lacing=lacing)) for lacing in ("zigzag", "X"))
    assert_allclose(crossed.bending("lateral")[0], plain.bending("lateral")[0], rtol=1e-12)
    c, s = 2.0 / hypot(2.0, 1.4), 1.4 / hypot(2.0, 1.4)
    e_h = -2.0 * 900.0 * s * c**2 / (700.0 + 2.0 * 900.0 * s**3)
    more = E * 2.0 * 900e-6 * c * (c**2 + e_h * s**2)
    assert_allclose(crossed.axial_stiffness - plain.axial_stiffness, more, rtol=1e-12)


def test_parallel_diagonals_couple_axial_strain_with_shear_and_others_do_not():
    """Parallel ones of the base make a jib that bends down under its weight bend to the side."""
    crossed = middle(replace(TRIANGLE, side_lacing="N", base_lacing="N", side_post_area=6e-4)).flexibility
    for other in ("zigzag", "X"):
        plain = middle(replace(TRIANGLE, side_lacing=other, base_lacing=other)).flexibility
        assert abs(plain[AXIAL, SHEAR_Z]) < 1e-9 * abs(crossed[AXIAL, SHEAR_Z])
    assert abs(crossed[SHEAR_Y, AXIAL]) > 0.0


def test_a_taper_carries_shear_in_its_chords_and_aside_none():
    lattice = replace(TRIANGLE, end_height=1.2)
    for piece in lattice.pieces(10.0):
        assert -0.06 / 1.2 < piece.coupling_vertical < -0.06 / 1.8
        assert piece.coupling_lateral == 0.0
    assert sum(piece.length for piece in lattice.pieces(10.0)) == pytest.approx(10.0, rel=1e-14)
    down = replace(lattice, side="down").pieces(10.0)
    assert [piece.coupling_vertical for piece in down] == pytest.approx(
        [piece.coupling_vertical for piece in lattice.pieces(10.0)], rel=1e-12
    )
    assert len(TRIANGLE.pieces(10.0)) == 1


@pytest.mark.parametrize("plane", ["vertical", "lateral"])
def test_segments_have_at_their_middle_what_pieces_have(plane):
    lattice = FLAT_TOP[4]
    segments, pieces = lattice.segments(10.0, plane), lattice.pieces(10.0)
    for segment, piece in zip(segments, pieces, strict=True):
        at = np.array(0.5 * piece.length)
        assert segment.length == pytest.approx(piece.length)
        assert segment.section("bending_stiffness", at) == pytest.approx(getattr(piece, f"bending_{plane}"), rel=1e-9)
        assert segment.section("shear_stiffness", at) == pytest.approx(getattr(piece, f"shear_{plane}"), rel=2e-3)
        assert segment.section("mass_per_length", at) == pytest.approx(piece.mass_per_length, rel=2e-4)
        assert segment.inclined_chords == (plane == "vertical")


def test_a_stated_mass_takes_the_place_of_the_members_own():
    (own,), (stated,) = TRIANGLE.pieces(10.0), TRIANGLE.pieces(10.0, 300.0)
    assert stated.mass_per_length == 300.0
    assert stated.mass_centre == own.mass_centre
    assert stated.rotary_vertical / own.rotary_vertical == pytest.approx(300.0 / own.mass_per_length)
    (segment,) = TRIANGLE.segments(10.0, "lateral", 300.0)
    assert (segment.mass_per_length, segment.rotary_inertia) == pytest.approx((300.0, stated.rotary_lateral))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"height": -1.8}, "JibLattice.height: wanted a positive finite number, got -1.8"),
        ({"end_height": 0.0}, "JibLattice.end_height: wanted a positive finite number, got 0.0"),
        ({"shape": "square"}, r"JibLattice.shape: wanted one of \('triangle', 'rectangle'\), got 'square'"),
        ({"side_lacing": "N"}, "JibLattice.side_post_area: N lacing carries shear through its posts, got 0"),
        ({"side_post_area": 6e-4}, "JibLattice.side_post_area: wanted 0 for zigzag sides of a triangle"),
        ({"opposite_lacing": "K"}, "JibLattice.opposite_lacing: wanted one of"),
    ],
)
def test_a_lattice_says_what_it_lacks(changes, message):
    with pytest.raises(ValueError, match=message):
        replace(TRIANGLE, **changes)

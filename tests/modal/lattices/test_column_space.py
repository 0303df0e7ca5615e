"""Laced columns in space: the law of their section, torsion and bending beside their frame, member by member."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from modal import ColumnTruss, LacedColumn
from modal.lattices.column_section import column_section
from modal.lattices.column_space import column_beam, column_frame
from modal.lattices.space_comparison import beam_answers, frame_answers, tip_loads

BASE = LacedColumn(60e-4, 1.7, 2.0, 6e-4, 210e9, "X", 6e-4)
HEIGHT, MASS = 40.0, 300.0
TAPER = ColumnTruss(replace(BASE, leg_spacing=8.0), HEIGHT, MASS, 0.25)
STEPPED = ColumnTruss(
    replace(BASE, leg_spacing=3.8), 12.0, 500.0, 0.5,
    ColumnTruss(replace(BASE, leg_spacing=1.9, panel_height=1.0, youngs_modulus=2e11), 20.0, 200.0),
)  # fmt: skip


def straight(lacing):
    return ColumnTruss(replace(BASE, lacing=lacing), HEIGHT, MASS)


def twist(truss):
    """Of the top per torque on it, member by member."""
    frame = column_frame(truss)
    load = tip_loads(frame)[2]
    return np.sum(load * frame.displacements(load))


def test_a_column_is_the_law_of_its_chords_and_walls():
    for lacing in ("X", "zigzag", "N"):
        column = replace(BASE, lacing=lacing, plan_bracing_area=3e-4)
        section = column_section(column)
        bending, shear, coupling = section.bending("vertical")
        assert_allclose(section.bending("lateral"), (bending, shear, coupling), rtol=1e-12)
        assert_allclose(bending, column.bending_stiffness.value, rtol=1e-12)
        assert coupling == 0.0
        assert_allclose(section.mass_per_length, column.mass_per_length, rtol=1e-12)
        # In bending a zigzag's steps are the column's own; parallel diagonals going round couple both planes.
        steps = 2.0**2 / (6.0 * bending) if lacing == "zigzag" else 0.0
        rtol = 2e-2 if lacing == "N" else 1e-12
        assert_allclose(1.0 / shear + steps, 1.0 / column.shear_stiffness.value, rtol=rtol)


def test_the_torsional_stiffness_is_that_of_bredt_where_the_zigzags_step_apart():
    b, p = BASE.leg_spacing, BASE.panel_height
    for lacing in ("X", "zigzag"):
        column = replace(BASE, lacing=lacing)
        wall = 1.0 / column.wall.shear_flexibility(b, 210e9)
        steps = 4.0 * p**2 / (210e9 * 60e-4) if lacing == "zigzag" else 0.0
        found = column_section(column).torsional_stiffness
        assert_allclose(found, 4.0 * b**4 / (4.0 * b**2 / wall + steps), rtol=1e-12)


@pytest.mark.parametrize(
    ("truss", "bound"),
    [
        (straight("X"), 1e-10), (straight("zigzag"), 3.3e-3), (straight("N"), 8e-3), (TAPER, 6e-3),
        (replace(TAPER, column=replace(TAPER.column, lacing="zigzag")), 2.3e-2), (STEPPED, 1.4e-3),
    ],
)  # fmt: skip
def test_a_torque_on_the_top_twists_beam_and_frame_alike(truss, bound):
    assert abs(beam_answers(column_beam(truss)).deflections[2] / twist(truss) - 1.0) < bound


@pytest.mark.parametrize(
    ("truss", "bounds"),
    [
        (straight("X"), {"vertical": 0.8, "torsion": 0.06}),
        (straight("zigzag"), {"vertical": 0.45, "torsion": 0.45}),
        (straight("N"), {"vertical": 1.3, "torsion": 0.8}), (TAPER, {"vertical": 0.17, "torsion": 0.12}),
        (STEPPED, {"vertical": 0.7, "torsion": 0.1}),
    ],
)  # fmt: skip
def test_frequencies_of_a_column_in_space_keep_to_its_frame(truss, bounds):
    beam = column_beam(truss)
    found, reference = beam_answers(beam), frame_answers(column_frame(truss), beam)
    for kind, bound in bounds.items():
        errors = 100.0 * (np.array(found.frequencies_hz[kind]) / reference.frequencies_hz[kind] - 1.0)
        assert 0.5 * bound < np.abs(errors).max() < bound
    # Both planes are alike.
    assert_allclose(reference.frequencies_hz["lateral"], reference.frequencies_hz["vertical"], rtol=1e-6)


def test_without_what_sloping_legs_carry_a_taper_is_far_off():
    """The same beam of sections that stand upright."""
    upright = [column_section(TAPER.column, 8.0 - 6.0 * (k + 0.5) / 24) for k in range(24)]
    beam = column_beam(TAPER)
    plain = replace(beam, flexibilities=np.array([section.flexibility for section in upright]))
    reference = frame_answers(column_frame(TAPER), beam).frequencies_hz["vertical"][0]
    assert beam_answers(beam).frequencies_hz["vertical"][0] == pytest.approx(reference, rel=2e-3)
    assert beam_answers(plain).frequencies_hz["vertical"][0] < 0.9 * reference


def test_the_frame_of_a_column_is_its_truss():
    frame = column_frame(STEPPED)
    assert frame.mass == pytest.approx(12.0 * 500.0 + 20.0 * 200.0)
    stiffness = frame.matrices[0].toarray()
    # The truss counts x, y, z of a node, the frame z, x, y.
    order = (3 * np.arange(len(frame.nodes))[:, None] + [2, 0, 1]).ravel()
    expected = STEPPED.stiffness.toarray()[np.ix_(order, order)]
    assert_allclose(stiffness, expected, atol=1e-12 * expected.max())
    own = column_frame(replace(STEPPED, mass_per_length=None, above=None))
    assert own.mass > 12.0 * BASE.density * 4.0 * BASE.leg_area

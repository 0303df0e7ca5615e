"""Laced columns whose legs draw together, and columns on columns: beams beside the truss, elements beside beams."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from oracles.plain_truss import plain_truss

from modal import Chain, ColumnTruss, EndBody, LacedColumn, StructureElements, chain_frequencies, chain_structure
from modal.lattices.lattice_comparison import compare_truss
from modal.lattices.lattice_taper import column_segments
from modal.structures.influence import influence, keeping
from modal.structures.structure_modes import structure_modes

BASE = LacedColumn(60e-4, 8.0, 2.0, 6e-4, 210e9, "X", 6e-4)
HEIGHT, MASS = 40.0, 300.0
SLEWING = EndBody(18e3, 5e6)

WORST = {"X": 0.8, "zigzag": 0.9, "N": 2.1}
"""Per cent by lacing over `GRID`, as the docstring of `modal.lattices.lattice_taper.column_segments` states them."""

GRID = [
    (8.0, 1.0, 2.0), (8.0, 1.0, 1.0), (8.0, 2.0, 2.0), (8.0, 4.0, 2.0), (4.0, 1.0, 2.0), (3.8, 1.6, 2.0),
    (2.0, 1.2, 1.0), (1.68, 1.68, 2.0), (2.0, 4.0, 2.0),
]  # fmt: skip


def errors(column, top_ratio, body):
    """Of the first three frequencies, beam against truss [%]."""
    segments = column_segments(column, HEIGHT, top_ratio, MASS)
    truss = ColumnTruss(column, HEIGHT, MASS, top_ratio)
    found = chain_frequencies(Chain(segments, {len(segments): body} if body else {}), 3)
    return 100.0 * (found / truss.bending_frequencies(3, body) - 1.0)


@pytest.mark.parametrize("lacing", WORST)
def test_a_taper_keeps_to_its_truss_within_what_is_stated_and_no_closer(lacing):
    found = [
        errors(replace(BASE, lacing=lacing, leg_spacing=foot, panel_height=panel), top / foot, body)
        for foot, top, panel in GRID
        for body in (None, SLEWING)
    ]
    worst = np.abs(found).max()
    assert 0.9 * WORST[lacing] < worst <= WORST[lacing]


def test_a_heavy_slewing_part_on_a_taper_is_within_a_third_of_a_per_cent():
    for lacing in ("X", "zigzag"):
        assert np.abs(errors(replace(BASE, lacing=lacing), 0.25, SLEWING)[:2]).max() < 0.34


def test_the_truss_of_a_taper_draws_together():
    """A straight truss whose nodes move in, member by member."""
    truss = ColumnTruss(BASE, 8.0, MASS, 0.25)
    assert truss.nodes[-4:, 0] == pytest.approx([-1.0, 1.0, 1.0, -1.0])
    assert truss.node_masses.sum() == pytest.approx(8.0 * MASS)
    _, stiffness = plain_truss(BASE, 4, breadths=np.linspace(8.0, 2.0, 5))
    np.testing.assert_allclose(truss.stiffness.toarray()[12:, 12:], stiffness, atol=1e-12 * stiffness.max())


@pytest.mark.parametrize("theory", ["haringx", "engesser"])
def test_elements_know_inclined_chords(theory):
    segments = column_segments(BASE, HEIGHT, 0.25, MASS)
    chain = Chain(segments, {len(segments): SLEWING}, axial_load=3e6, gravity=9.81, shear_theory=theory)
    structure = chain_structure(chain)
    elements = StructureElements(structure, 56)
    np.testing.assert_allclose(elements.angular_frequencies(4), structure.angular_frequencies(4), rtol=1e-9)
    np.testing.assert_allclose(elements.buckling_factor(), structure.buckling_factor(), rtol=1e-9)


def test_shear_of_a_taper_is_predicted_with_what_its_chords_carry():
    segments = column_segments(BASE, HEIGHT, 0.5, MASS)
    tower = Chain(tuple(replace(one, rotary_inertia=0.0) for one in segments), {len(segments): SLEWING})
    plain = structure_modes(chain_structure(keeping(tower, ())), 2)
    predicted = influence(plain, tower).changes["shear"]
    actual = chain_frequencies(tower, 2) / plain.angular_frequencies - 1.0
    np.testing.assert_allclose(predicted, actual, rtol=0.25)
    # Of the first mode's shear the chords carry most.
    straight = replace(tower, segments=tuple(replace(one, inclined_chords=False) for one in tower.segments))
    assert influence(plain, straight).changes["shear"][0] < 3.0 * predicted[0]


def test_a_column_on_a_column_is_one_truss():
    foot, mast = replace(BASE, leg_spacing=3.8), replace(BASE, leg_spacing=1.9, panel_height=1.0, youngs_modulus=2e11)
    above = ColumnTruss(mast, 20.0, 200.0)
    both = ColumnTruss(foot, 12.0, 500.0, 0.5, above)
    assert both.panels == 26
    assert both.nodes[-1, 2] == 32.0
    assert both.node_masses.sum() == pytest.approx(12.0 * 500.0 + 20.0 * 200.0)
    shear, euler = compare_truss(both, SLEWING, repeats=1)[1:]
    assert np.abs([*shear.errors.frequencies_hz, *shear.errors.body_frequencies_hz]).max() < 5e-3
    assert abs(shear.errors.force_deflection) < 5e-3
    assert abs(euler.errors.force_deflection) > 0.03
    with pytest.raises(ValueError, match=r"ColumnTruss.above: wanted legs 1\.9 m apart as below, got 2 m"):
        replace(both, above=replace(above, column=replace(mast, leg_spacing=2.0)))
    halves = ColumnTruss(mast, 8.0, 200.0, 1.0, ColumnTruss(mast, 12.0, 200.0))
    np.testing.assert_allclose(halves.bending_frequencies(2), above.bending_frequencies(2), rtol=1e-10)

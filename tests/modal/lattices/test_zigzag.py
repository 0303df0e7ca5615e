"""Zigzag lacing beside its truss: exact under loads on the top, and what is left of frequencies, effect by effect."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from modal import Chain, ColumnTruss, EndBody, LacedColumn, Segment, chain_frequencies
from modal.lattices.lattice_taper import column_segments

BASE = LacedColumn(60e-4, 8.0, 2.0, 6e-4, 210e9, "zigzag", 6e-4)
HEIGHT, MASS = 40.0, 300.0
SLEWING = EndBody(18e3, 5e6)
STRAIGHT = [(8.0, 2.0), (4.0, 2.0), (1.7, 2.0), (1.0, 1.0)]
"""Breadths and heights of panels [m]."""


def of(breadth, panel, **changes):
    return replace(BASE, leg_spacing=breadth, panel_height=panel, **changes)


def errors(column, top_ratio, body):
    """Of the first three frequencies, beam against truss [%]."""
    segments = column_segments(column, HEIGHT, top_ratio, MASS)
    found = chain_frequencies(Chain(segments, {len(segments): body} if body else {}), 3)
    return 100.0 * (found / ColumnTruss(column, HEIGHT, MASS, top_ratio).bending_frequencies(3, body) - 1.0)


@pytest.mark.parametrize(("breadth", "panel"), STRAIGHT)
@pytest.mark.parametrize("diagonal", [2e-4, 6e-4, 40e-4])
def test_a_force_and_a_moment_on_the_top_deflect_beam_and_truss_alike(breadth, panel, diagonal):
    column = of(breadth, panel, diagonal_area=diagonal)
    truss = ColumnTruss(column, HEIGHT, MASS)
    EI, S = column.bending_stiffness.value, column.shear_stiffness.value
    assert_allclose(truss.tip(force=1.0), [HEIGHT**3 / (3.0 * EI) + HEIGHT / S, HEIGHT**2 / (2.0 * EI)], rtol=1e-10)
    assert_allclose(truss.tip(moment=1.0), [HEIGHT**2 / (2.0 * EI), HEIGHT / EI], rtol=1e-10)


@pytest.mark.parametrize(("breadth", "panel"), STRAIGHT)
def test_with_rigid_horizontals_the_truss_is_the_beam_with_its_mass_at_the_nodes(breadth, panel):
    """All that is left then is that the truss has no mass between its nodes."""
    column = of(breadth, panel, horizontal_area=6.0)
    count = round(HEIGHT / panel)
    light = Segment(panel, 1e-9 * MASS, column.bending_stiffness.value, column.shear_stiffness.value)
    bodies = {}
    for k in range(1, count + 1):
        mass = MASS * panel * (0.5 if k == count else 1.0)
        bodies[k] = EndBody(mass, mass * breadth**2 / 4.0)
    found = chain_frequencies(Chain((light,) * count, bodies), 3)
    assert_allclose(found, ColumnTruss(column, HEIGHT, MASS).bending_frequencies(3), rtol=5e-5)


@pytest.mark.parametrize(("breadth", "panel"), STRAIGHT)
def test_horizontals_lower_the_truss_as_they_lower_the_beam(breadth, panel):
    def lowered(frequencies):
        light, rigid = (frequencies(of(breadth, panel, horizontal_area=area)) for area in (6e-4, 6.0))
        return light / rigid - 1.0

    of_truss = lowered(lambda column: ColumnTruss(column, HEIGHT, MASS).bending_frequencies(3))
    of_beam = lowered(lambda column: chain_frequencies(Chain((column.segment(HEIGHT, MASS),)), 3))
    assert_allclose(of_beam, of_truss, rtol=0.06)
    if breadth == 8.0:
        assert_allclose(100.0 * of_truss, [-0.056, -0.51, -1.62], rtol=0.01)


@pytest.mark.parametrize(
    ("foot", "top", "panel", "worst"),
    [
        (8.0, 8.0, 2.0, 0.65), (8.0, 4.4, 2.0, 0.68), (4.0, 4.0, 2.0, 0.64), (4.0, 2.2, 2.0, 0.64),
        (1.7, 1.7, 2.0, 0.63), (1.7, 0.95, 2.0, 0.69), (1.0, 1.0, 1.0, 0.16), (1.0, 0.55, 1.0, 0.17),
        (8.0, 1.0, 2.0, 0.86), (4.0, 1.0, 2.0, 0.76),
    ],
)  # fmt: skip
def test_frequencies_keep_to_the_truss_at_every_breadth(foot, top, panel, worst):
    found = [errors(of(foot, panel), top / foot, body) for body in (None, SLEWING)]
    assert 0.95 * worst < np.abs(found).max() <= worst


def test_panels_half_as_high_leave_a_quarter():
    """The mass at nodes alone is an error of second order in the height of a panel."""
    coarse, fine = (errors(of(1.7, panel, horizontal_area=6.0), 1.0, None) for panel in (2.0, 1.0))
    assert_allclose(fine / coarse, 0.25, rtol=0.04)


def test_only_a_zigzag_moves_its_mass_beyond_its_axis():
    assert of(8.0, 2.0).mass_flexibility.value == pytest.approx(2.0 * 8.0 / (8.0 * 210e9 * 6e-4), rel=1e-14)
    for changes in ({"lacing": "X"}, {"lacing": "N"}, {"horizontal_area": 0.0}):
        assert of(8.0, 2.0, **changes).mass_flexibility.value == 0.0
    for beam in ("euler", "code-equivalent"):
        assert of(8.0, 2.0).segment(HEIGHT, MASS, beam).mass_flexibility == 0.0

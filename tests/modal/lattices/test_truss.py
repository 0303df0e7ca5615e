"""Truss of a laced column against members added one by one, against closed forms, and the beams beside it."""

from __future__ import annotations

from dataclasses import asdict, replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.plain_truss import plain_truss
from scipy.linalg import eigh

from modal import ColumnTruss, EndBody, LacedColumn, Mechanism, compare_lattice_models

QTZ5613 = LacedColumn(
    leg_area=198.8e-4 / 4,
    leg_spacing=1.68,
    panel_height=1.4,
    diagonal_area=8e-4,
    youngs_modulus=2.06e11,
    horizontal_area=8e-4,
    plan_bracing_area=8e-4,
)
HEIGHT, MASS = 23.8, 350.0
SLEWING = EndBody(23972.67, 9.480729e6)


@pytest.mark.parametrize("lacing", ["zigzag", "X", "N"])
def test_whole_truss_and_its_bending(lacing):
    """All modes of the plain truss: bending comes in pairs, one of each is found, and torsion is not."""
    column = replace(QTZ5613, lacing=lacing)
    truss = ColumnTruss(column, 7 * 1.4, MASS)
    nodes, stiffness = plain_truss(column, 7)
    assert_allclose(truss.nodes, nodes, atol=1e-14)
    assert_allclose(truss.stiffness.toarray()[12:, 12:], stiffness, atol=1e-12 * stiffness.max())
    masses = np.repeat(truss.node_masses[4:], 3)
    assert_allclose(truss.node_masses.sum(), MASS * 7 * 1.4, rtol=1e-14)
    squared, modes = eigh(stiffness, np.diag(masses))
    push = np.zeros((len(masses), 2))
    push[0::3, 0], push[1::3, 1] = 1.0, 1.0
    sideways = ((push.T @ (masses[:, np.newaxis] * modes)) ** 2).sum(axis=0) / masses[::3].sum()
    bending = np.sqrt(squared[sideways > 1e-4])[:6]
    assert_allclose(bending[0::2], bending[1::2], rtol=1e-9)
    assert_allclose(truss.bending_frequencies(3), bending[0::2], rtol=1e-9)


def test_opposite_faces_as_shadows_split_each_bending_frequency():
    truss = ColumnTruss(QTZ5613, HEIGHT, MASS)
    _, stiffness = plain_truss(QTZ5613, 17, shadow=True)
    found = np.sqrt(eigh(stiffness, np.diag(np.repeat(truss.node_masses[4:], 3)), subset_by_index=[0, 4])[0])
    # Torsion is the third.
    pairs = found[[[0, 1], [3, 4]]]
    split = pairs[:, 1] / pairs[:, 0] - 1.0
    assert_allclose(split, [1.2e-3, 8.4e-3], rtol=0.03)
    assert (np.abs(pairs.mean(axis=1) / truss.bending_frequencies(2) - 1.0) < 3e-3).all()


def test_rigid_body_ties_the_top():
    """The plain truss with its top nodes on the body's three motions in the plane of x; the twin in y is left out."""
    truss = ColumnTruss(QTZ5613, 7 * 1.4, MASS)
    nodes, stiffness = plain_truss(QTZ5613, 7)
    masses = np.diag(np.repeat(truss.node_masses[4:], 3))
    n = len(masses) - 12
    tie = np.zeros((n + 12, n + 6))
    tie[:n, :n] = np.eye(n)
    for leg, (x, y, _) in enumerate(nodes[-4:]):
        rows = slice(n + 3 * leg, n + 3 * leg + 3)
        tie[rows, n:] = [[1, 0, 0, 0, 0, -y], [0, 1, 0, 0, 0, x], [0, 0, 1, -x, -y, 0]]
    body = EndBody(3e3, 5e4, 0.7)
    inertia = np.diag([3e3, 3e3, 3e3, 5e4 + 3e3 * 0.49, 5e4 + 3e3 * 0.49, 1e5])
    inertia[[0, 3, 1, 4], [3, 0, 4, 1]] = 3e3 * 0.7
    mass = tie.T @ masses @ tie
    mass[n:, n:] += inertia
    squared, modes = eigh(tie.T @ stiffness @ tie, mass)
    sideways = (modes[n : n + 2] ** 2).sum(axis=0) * 3e3 > 1e-9
    found = truss.bending_frequencies(3, body)
    assert_allclose(found, np.sqrt(squared[sideways])[:6:2], rtol=1e-9)
    load = np.zeros((n + 6, 2))
    load[n, 0], load[n + 3, 1] = 1.0, 1.0
    displacements = np.linalg.solve(tie.T @ stiffness @ tie, load)[[n, n + 3]]
    assert_allclose(truss.tip(1.0), displacements[:, 0], rtol=1e-10)
    assert_allclose(truss.tip(moment=1.0), displacements[:, 1], rtol=1e-10)
    # A force in x moves the top in x alone.
    assert abs(np.linalg.solve(tie.T @ stiffness @ tie, load[:, 0])[n + 1]) < 1e-9 * truss.tip(1.0)[0]


@pytest.mark.parametrize(
    ("panel_height", "diagonal", "horizontal"),
    [(1.4, 8e-4, 8e-4), (2.8, 8e-4, 8e-4), (1.4, 16e-4, 16e-4), (2.8, 8e-4, 24e-4)],
)
def test_crossed_lacing_stiffens_the_legs_as_the_formula_says(panel_height, diagonal, horizontal):
    """Curvature under a moment, far from both ends."""
    column = replace(
        QTZ5613, lacing="X", panel_height=panel_height, diagonal_area=diagonal, horizontal_area=horizontal
    )
    short, tall = (ColumnTruss(column, n * panel_height, MASS).tip(moment=1.0)[1] for n in (10, 20))
    assert_allclose(10 * panel_height / (tall - short), column.bending_stiffness.value, rtol=2e-10)


def test_single_diagonals_do_not_help_the_legs():
    height = 10 * 1.4
    deflection, rotation = ColumnTruss(QTZ5613, height, MASS).tip(moment=1.0)
    assert_allclose(rotation, height / QTZ5613.bending_stiffness.value, rtol=1e-12)
    assert_allclose(deflection, 0.5 * height**2 / QTZ5613.bending_stiffness.value, rtol=1e-12)


@pytest.mark.parametrize(
    ("panels", "errors"),
    [
        (6, [(0.00, 0.56, 0.00, 0.02), (-50.01, 63.76, 0.15, 123.00), (12.10, 9.36, -33.12, 48.91)]),
        (12, [(0.00, 0.23, 0.00, 0.00), (-20.01, 18.79, 0.49, 40.48), (4.84, 3.76, -12.22, 22.71)]),
        (17, [(0.00, 0.13, 0.01, 0.00), (-11.08, 9.71, 0.77, 21.27), (2.68, 2.09, -6.22, 12.85)]),
        (24, [(0.00, 0.07, 0.01, 0.00), (-5.89, 4.97, 0.95, 10.61), (1.42, 1.11, -2.75, 6.55)]),
        (36, [(0.00, 0.03, 0.00, 0.00), (-2.70, 2.23, 0.84, 4.48), (0.65, 0.51, -0.86, 2.73)]),
    ],
)
def test_errors_of_the_three_beams(panels, errors):
    """Per cent: deflection under a force, first frequency bare, first two with the slewing part; zigzag lacing."""
    models = compare_lattice_models(QTZ5613, panels * 1.4, SLEWING, MASS, repeats=1)
    assert [model.name for model in models] == ["truss", "shear-flexible", "euler", "code-equivalent"]
    for model, expected in zip(models[1:], errors, strict=True):
        e = model.errors
        found = 100.0 * np.array([e.force_deflection, e.frequencies_hz[0], *e.body_frequencies_hz])
        assert_allclose(found, expected, rtol=0, atol=0.0051)


def test_published_tower():
    """The shear-flexible beam is the truss statically and under a body, the code's inertia is not."""
    truss, flexible, euler, equivalent = compare_lattice_models(QTZ5613, HEIGHT, SLEWING, MASS, repeats=1)
    assert_allclose(truss.answers.body_frequencies_hz, [0.473857, 1.522225], rtol=1e-6)
    assert_allclose(truss.answers.frequencies_hz, [2.587439, 11.488469], rtol=1e-6)
    assert (np.abs(flexible.errors.body_frequencies_hz) < 6e-5).all()
    # Without a body on top it shows that the truss has its masses at the nodes alone.
    assert_allclose(flexible.errors.frequencies_hz, [1.33e-3, 4.04e-3], rtol=0.01)
    assert abs(flexible.errors.force_deflection) < 1e-11
    for beam in (flexible, euler):
        assert abs(beam.errors.moment_deflection) < 1e-12
    assert_allclose(equivalent.errors.moment_deflection, 0.1548, atol=1e-4)
    assert_allclose(equivalent.errors.body_frequencies_hz[0], -0.0622, atol=1e-4)
    assert all(model.seconds > 0.0 for model in (truss, flexible, euler, equivalent))
    assert set(asdict(truss)) == {"name", "answers", "errors", "seconds"}


@pytest.mark.parametrize("lacing", ["X", "N"])
def test_shear_flexible_beam_of_other_lacings(lacing):
    models = compare_lattice_models(replace(QTZ5613, lacing=lacing), HEIGHT, SLEWING, MASS, repeats=1)
    e = models[1].errors
    worst = max(abs(x) for x in (e.force_deflection, e.moment_deflection, *e.frequencies_hz, *e.body_frequencies_hz))
    assert 0.002 < worst < 0.0075


def test_mode_that_only_distorts_levels_is_no_bending():
    """X lacing without horizontals has one below the second bending mode."""
    column = replace(QTZ5613, lacing="X", horizontal_area=0.0, plan_bracing_area=0.0)
    e = compare_lattice_models(column, HEIGHT, SLEWING, MASS, repeats=1)[1].errors
    assert max(abs(f) for f in e.frequencies_hz) < 0.002


def test_members_own_mass():
    truss = ColumnTruss(QTZ5613, 7 * 1.4)
    # The feet carry legs and diagonals, the top no less than a level between.
    diagonal, legs = 8e-4 * np.hypot(1.4, 1.68), 198.8e-4 * 1.4
    per_panel = legs + 4 * diagonal + 4 * 8e-4 * 1.68 + 2 * 8e-4 * 1.68 * np.sqrt(2)
    assert_allclose(truss.node_masses.sum(), 7 * 7850.0 * per_panel, rtol=1e-13)
    assert_allclose(QTZ5613.mass_per_length, 7850.0 * per_panel / 1.4, rtol=1e-13)
    assert_allclose(truss.node_masses[:4], 7850.0 * (legs / 8 + diagonal / 2), rtol=1e-13)


def test_plan_bracing_is_not_strained():
    with_bracing, without = (ColumnTruss(replace(QTZ5613, plan_bracing_area=a), 7.0, MASS) for a in (8e-4, 0.0))
    assert_allclose(with_bracing.tip(1.0, 1.0), without.tip(1.0, 1.0), rtol=1e-12)


def test_mechanism_is_refused():
    with pytest.raises(Mechanism, match="zigzag lacing without horizontals"):
        ColumnTruss(replace(QTZ5613, horizontal_area=0.0), HEIGHT, MASS)


@pytest.mark.parametrize(
    ("height", "mass", "name"),
    [(23.0, MASS, "height"), (0.0, MASS, "height"), (HEIGHT, 0.0, "mass_per_length"), (np.inf, MASS, "height")],
)
def test_refuses_what_makes_no_sense(height, mass, name):
    with pytest.raises(ValueError, match=name):
        ColumnTruss(QTZ5613, height, mass)


def test_refuses_counts_and_bodies_that_make_no_sense():
    truss = ColumnTruss(QTZ5613, 2.8, MASS)
    assert truss.bending_frequencies(0).shape == (0,)
    with pytest.raises(ValueError, match="count"):
        truss.bending_frequencies(-1)
    with pytest.raises(ValueError, match="count: wanted at most"):
        truss.bending_frequencies(6)
    with pytest.raises(ValueError, match="body: wanted finite"):
        truss.bending_frequencies(1, EndBody(np.inf))
    with pytest.raises(ValueError, match="no density"):
        ColumnTruss(replace(QTZ5613, density=0.0), HEIGHT)
    with pytest.raises(ValueError, match="beam: wanted one of"):
        QTZ5613.segment(HEIGHT, beam="timoshenko")

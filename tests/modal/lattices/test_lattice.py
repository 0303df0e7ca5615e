"""Laced column against closed-form values, limits and a truss solved member by member."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from modal.lattices.lattice import LacedColumn

QTZ5613 = LacedColumn(
    leg_area=198.8e-4 / 4,
    leg_spacing=1.68,
    panel_height=1.4,
    diagonal_area=8e-4,
    youngs_modulus=2.06e11,
)
HEIGHT = 23.8


def test_chord_second_moment_is_the_table_value_and_counts_the_legs_own():
    assert QTZ5613.chord_second_moment_of_area.value == pytest.approx(0.014027328, rel=1e-12)
    own = replace(QTZ5613, leg_second_moment_of_area=1e-6).chord_second_moment_of_area.value
    assert own == pytest.approx(0.014027328 + 4e-6, rel=1e-12)


def test_equivalent_second_moment_factor_and_rigid_lacing_limit():
    chords = QTZ5613.chord_second_moment_of_area.value
    factor = QTZ5613.equivalent_second_moment_of_area(HEIGHT).value / chords
    assert factor == pytest.approx(47.6**2 / (47.6**2 + 40 * 0.014027328 / 16e-4), rel=1e-13)
    assert factor == pytest.approx(0.866, abs=5e-4)
    rigid = replace(QTZ5613, diagonal_area=1e9).equivalent_second_moment_of_area(HEIGHT).value
    assert rigid == pytest.approx(chords, rel=1e-12)


def test_equivalent_slenderness_gives_the_same_buckling_load():
    slenderness = QTZ5613.equivalent_slenderness(HEIGHT).value
    euler = np.pi**2 * QTZ5613.total_leg_area / slenderness**2
    equivalent = np.pi**2 * QTZ5613.equivalent_second_moment_of_area(HEIGHT).value / (2 * HEIGHT) ** 2
    assert slenderness == pytest.approx(np.sqrt(47.6**2 * 198.8e-4 / 0.014027328 + 40 * 198.8 / 16), rel=1e-13)
    assert equivalent == pytest.approx(euler, rel=1e-13)


@pytest.mark.parametrize(
    ("panel_height", "diagonal", "horizontal", "factor"),
    [
        (1.4, 8e-4, 8e-4, 1.0221),
        (2.8, 8e-4, 8e-4, 1.0798),
        (1.4, 16e-4, 16e-4, 1.0443),
        (2.8, 8e-4, 24e-4, 1.0930),
    ],
)
def test_crossed_lacing_stiffens_the_legs(panel_height, diagonal, horizontal, factor):
    column = replace(
        QTZ5613, lacing="X", panel_height=panel_height, diagonal_area=diagonal, horizontal_area=horizontal
    )
    assert column.stiffening_factor.value == pytest.approx(factor, abs=5.1e-5)
    ratio = column.bending_stiffness.value / (2.06e11 * column.chord_second_moment_of_area.value)
    assert ratio == pytest.approx(column.stiffening_factor.value, rel=1e-14)


def test_crossed_lacing_without_horizontals_follows_the_legs_for_free():
    assert replace(QTZ5613, lacing="X").stiffening_factor.value == pytest.approx(1.0, abs=1e-15)


def plane_truss_stiffness(nodes, members):
    """Stiffness matrix of a pin-jointed plane truss; members are (i, j, E A)."""
    stiffness = np.zeros((2 * len(nodes), 2 * len(nodes)))
    for i, j, EA in members:
        along = nodes[j] - nodes[i]
        length = np.hypot(*along)
        row = np.zeros(2 * len(nodes))
        row[2 * i : 2 * i + 2], row[2 * j : 2 * j + 2] = -along / length, along / length
        stiffness += EA / length * np.outer(row, row)
    return stiffness


@pytest.mark.parametrize("lacing", ["zigzag", "X", "N"])
def test_shear_stiffness_against_one_panel_of_truss(lacing):
    """One face panel between a rigid foot and a sideways push on its upper right node, legs rigid."""
    column = replace(QTZ5613, lacing=lacing, horizontal_area=6e-4, leg_area=1e4)
    b, h_p, E = column.leg_spacing, column.panel_height, column.youngs_modulus
    nodes = np.array([[0.0, 0.0], [b, 0.0], [0.0, h_p], [b, h_p]])
    diagonals = [(1, 2)] if lacing != "X" else [(1, 2), (0, 3)]
    # Zigzag needs no horizontal: the next diagonal takes the force over at the same node.
    horizontal = E * column.horizontal_area if lacing == "N" else 1e4 * E
    members = [(i, j, E * column.diagonal_area) for i, j in diagonals]
    members += [(0, 2, column.leg_area * E), (1, 3, column.leg_area * E), (2, 3, horizontal)]
    pushed = np.linalg.solve(plane_truss_stiffness(nodes, members)[4:, 4:], [0.0, 0.0, 1.0, 0.0])
    # Both faces share the shear; the push acts on the far end of the horizontal, which N lacing strains.
    assert column.shear_stiffness.value == pytest.approx(2.0 * h_p / pushed[2], rel=1e-6)


def test_zigzag_shear_stiffness_value():
    """Diagonals and, in series, legs whose forces step."""
    steps = 1.4**2 / (6.0 * 2.06e11 * 49.7e-4 * 1.68**2)
    assert QTZ5613.shear_stiffness.value == pytest.approx(1.0 / (1.0 / 1.2452741e8 + steps), rel=1e-7)


def test_every_property_says_what_it_is_for():
    for name in ("chord_second_moment_of_area", "stiffening_factor", "bending_stiffness", "shear_stiffness"):
        assert len(getattr(QTZ5613, name).use) > 40
    assert "Not for vibration" in QTZ5613.equivalent_second_moment_of_area(HEIGHT).use


@pytest.mark.parametrize(
    ("change", "name"),
    [
        ({"leg_area": 0.0}, "leg_area"),
        ({"leg_spacing": float("nan")}, "leg_spacing"),
        ({"youngs_modulus": float("inf")}, "youngs_modulus"),
        ({"horizontal_area": -1e-4}, "horizontal_area"),
        ({"lacing": "K"}, "lacing"),
        ({"lacing": "N"}, "horizontal_area"),
    ],
)
def test_refuses_what_makes_no_sense(change, name):
    with pytest.raises(ValueError, match=name):
        replace(QTZ5613, **change)


def test_refuses_a_height_that_is_none():
    with pytest.raises(ValueError, match="height"):
        QTZ5613.equivalent_slenderness(0.0)

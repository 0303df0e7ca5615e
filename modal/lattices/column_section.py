"""Square laced column as sections of chords and walls."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from modal.lattices.section import LatticeSection
from modal.lattices.walls import Chord

if TYPE_CHECKING:
    from modal.lattices.lattice import LacedColumn
    from modal.lattices.walls import Wall

CORNERS = ((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))
"""Legs of a column in half leg spacings, each a quarter turn from the last."""

PARTS = 32
"""Parts of a column that tapers, along each of which it counts as of one breadth."""


def column_section(column: LacedColumn, spacing: float | None = None, slope: float = 0.0) -> LatticeSection:
    """Section of a column where its legs are so far apart [m], a distance that changes by a slope [1].

    Plan bracing has no part in it but its mass.
    """
    breadth = column.leg_spacing if spacing is None else spacing
    # Both bars of a level reach across two diagonals of the square.
    bracing = 2.0 * 2.0**0.5 * breadth * column.plan_bracing_area / column.panel_height
    chords = tuple(
        Chord(
            0.5 * breadth * y,
            0.5 * breadth * z,
            column.leg_area,
            0.5 * slope * y,
            0.5 * slope * z,
            0.25 * column.density * bracing,
        )
        for y, z in CORNERS
    )
    return LatticeSection(chords, column_walls(column), column.youngs_modulus, column.density)


def column_walls(column: LacedColumn) -> tuple[Wall, ...]:
    """Walls of a column, each from one leg to the next."""
    return tuple(replace(column.wall, first=leg, second=(leg + 1) % 4) for leg in range(4))


def column_parts(
    column: LacedColumn, height: float, top_ratio: float = 1.0, count: int = PARTS
) -> list[tuple[float, LatticeSection]]:
    """A column as equal parts from the foot up: heights [m] and sections at their middles."""
    change = column.leg_spacing * (top_ratio - 1.0)
    return [
        (height / count, column_section(column, column.leg_spacing + change * (k + 0.5) / count, change / height))
        for k in range(count)
    ]

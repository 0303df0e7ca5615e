"""The tower in torsion, stated or from its lattice."""

from __future__ import annotations

from typing import TYPE_CHECKING

from modal import Shaft
from modal.lattices.column_section import PARTS, column_parts
from towercrane.cranes.tower.file.members import laced_column, tower_pieces
from towercrane.cranes.tower.file.plane import stays_in_plane
from towercrane.schema.provenance import Assumption

if TYPE_CHECKING:
    from collections.abc import Iterator

    from towercrane.cranes.tower.file.case_tables import TowerCase
    from towercrane.cranes.tower.file.tables import Crane

KEYS = {"torsional_inertia_per_length": (1.0, "kg m"), "torsional_stiffness": (1e6, "MN m^2")}
"""What torsion of a tower takes, and the unit that it is shown in."""


def tower_shaft(crane: Crane, length: float) -> Shaft | None:
    """The tower in torsion as a shaft of a length [m]; None where neither its file nor its lattice says what it is.

    What the file states is that of one uniform shaft; the rest is that of the lattice, piece by piece, whose levels
    diaphragms are taken to keep square.
    """
    tower = crane.tower
    inertia, stiffness = tower.torsional_inertia_per_length, tower.torsional_stiffness
    if inertia is not None and stiffness is not None:
        pieces = [(0.0, inertia, stiffness)]
    elif (laced := _twisting(crane)) is not None:
        pieces = [(at, inertia or own, stiffness or law) for at, own, law in laced]
    else:
        return None
    # A stated height may miss the sum of the segments by rounding.
    springs = ((min(own.height, length), own.torsional_stiffness) for own in tower.collars)
    held = tuple(sorted(spring for spring in springs if spring[1]))
    return Shaft(length, *pieces[0][1:], held, tuple(pieces[1:]))


def computed(tables: TowerCase) -> Iterator[Assumption]:
    """Values in torsion that a crane's file does not state and that follow from its lattice; in the plane none."""
    if stays_in_plane(tables):
        return
    tower = tables.crane.tower
    lacking = [key for key in KEYS if getattr(tower, key) is None]
    pieces = _twisting(tables.crane) if lacking else None
    if pieces is None:
        return
    for key, values in zip(KEYS, list(zip(*pieces, strict=True))[1:], strict=True):
        if key in lacking:
            size, unit = KEYS[key]
            texts = dict.fromkeys(f"{value / size:.4g}" for value in (values[0], values[-1]))
            why = "not stated: computed from the tower's lattice, its levels kept square"
            yield Assumption(f"crane.tower.{key}", f"{' to '.join(texts)} {unit}", why)


def _twisting(crane: Crane) -> list[tuple[float, float, float]] | None:
    """Where pieces of a lattice begin [m], their inertias per length [kg m] and torsional stiffnesses [N m^2]."""
    tower, at = crane.tower, 0.0
    found = []
    for piece in tower_pieces(tower):
        modulus = piece.youngs_modulus or tower.youngs_modulus
        if piece.lattice is None or modulus is None:
            return None
        count = 1 if piece.top_breadth_ratio == 1.0 else PARTS
        for length, section in column_parts(
            laced_column(piece.lattice, modulus), piece.length, piece.top_breadth_ratio, count
        ):
            share = piece.mass_per_length / section.mass_per_length
            found.append((at, share * section.rotary_inertias[2], section.torsional_stiffness))
            at += length
    return found

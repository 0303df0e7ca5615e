"""Lattices of a tower crane's file, each as what is compared in space."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

from modal import Chain
from modal.lattices.column_space import column_beam, column_frame
from modal.lattices.jib_truss import LatticeJib
from towercrane.cranes.tower.file.members import jib_lattice, spread, tower_truss

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from modal.elements.space_beam import SpaceBeam
    from modal.elements.space_frame import SpaceFrame
    from modal.lattices.jib import JibLattice
    from towercrane.cranes.tower.file.jib_tables import Arm, JibSegment
    from towercrane.cranes.tower.file.tables import Crane


@dataclass(frozen=True, slots=True)
class CraneLattice:
    """A lattice of a crane that is clamped at its root.

    Parameters
    ----------
    name : str
        "tower", "jib" or "counter-jib".
    key : str
        Where the crane's file describes it.
    length : float
        Of whole panels [m].
    frame : callable
        The lattice member by member, of the rigidity of its joints or pinned, see
        `modal.lattices.space.frame_of_round`.
    beam : callable
        The beam in space that stands for it.
    planes : tuple of Chain, optional
        Beams of a jib that bend up and to the side; a tower bends alike in both planes.
    """

    name: str
    key: str
    length: float
    frame: Callable[[float | None], SpaceFrame]
    beam: Callable[[], SpaceBeam]
    planes: tuple[Chain, Chain] | None = None


def lattices_of(crane: Crane) -> Iterator[CraneLattice]:
    """Lattices of which a crane's file has all members, over as many panels as come next to their lengths.

    Raises
    ------
    ValueError
        If a truss is a mechanism, or its parts do not fit each other.
    """
    truss = tower_truss(crane)
    if truss is not None:
        length, key = float(truss.nodes[-1, 2]), "crane.tower.lattice"
        yield CraneLattice("tower", key, length, partial(column_frame, truss), partial(column_beam, truss))
    for name, key, jib in (("jib", "crane.jib", crane.jib), ("counter-jib", "crane.counter_jib", crane.counter_jib)):
        parts = [_part(piece, jib) for piece in jib.pieces]
        laced = [part for part in parts if part is not None]
        if not parts or len(laced) < len(parts):
            continue
        try:
            whole = LatticeJib(tuple(laced))
        except ValueError as error:
            raise ValueError(f"{key}: {error}") from error
        up, aside = (
            Chain(tuple(one for length, lattice in laced for one in lattice.segments(length, plane)))
            for plane in ("vertical", "lateral")
        )
        yield CraneLattice(name, key, whole.length, whole.frame, whole.beam, (up, aside))


def _part(piece: JibSegment, jib: Arm) -> tuple[float, JibLattice] | None:
    """Length and lattice of a piece of a jib; a stated mass is spread over the members as their own would be."""
    modulus = piece.youngs_modulus or jib.youngs_modulus
    if piece.lattice is None or modulus is None:
        return None
    lattice = jib_lattice(piece.lattice, modulus)
    length = max(1, round(piece.length / lattice.panel_length)) * lattice.panel_length
    if (stated := spread(piece)) is None:
        return length, lattice
    factor = stated / lattice.at(0.5, length).mass_per_length
    further = factor * lattice.further_mass_per_length
    return length, replace(lattice, density=factor * lattice.density, further_mass_per_length=further)

"""Lattices of a tower crane's file, each as what is compared in space."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from modal.lattices.column_space import column_beam, column_frame
from towercrane.cranes.tower.file.members import tower_truss

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from modal.elements.space_beam import SpaceBeam
    from modal.elements.space_frame import SpaceFrame
    from towercrane.cranes.tower.file.tables import Crane


@dataclass(frozen=True, slots=True)
class CraneLattice:
    """A lattice of a crane that is clamped at its root.

    Parameters
    ----------
    name : str
        "tower", "jib" or "counter-jib".
    length : float
        Of whole panels [m].
    planes_alike : bool
        Whether it bends alike in both planes.
    frame : callable
        The lattice member by member, of the rigidity of its joints or pinned, see
        `modal.lattices.space.frame_of_round`.
    beam : callable
        The beam that stands for it.
    """

    name: str
    length: float
    planes_alike: bool
    frame: Callable[[float | None], SpaceFrame]
    beam: Callable[[], SpaceBeam]


def lattices_of(crane: Crane) -> Iterator[CraneLattice]:
    """Lattices of which a crane's file has all members.

    Raises
    ------
    ValueError
        If a truss is a mechanism, or its parts do not fit each other.
    """
    truss = tower_truss(crane)
    if truss is not None:
        length = float(truss.nodes[-1, 2])
        yield CraneLattice("tower", length, True, partial(column_frame, truss), partial(column_beam, truss))

"""Laced column in space: member by member, pinned or with rigid joints, and as a beam of sections."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from modal.lattices.column_section import column_parts
from modal.lattices.space import beam_of, frame_of_round

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from modal.elements.space_beam import SpaceBeam
    from modal.elements.space_frame import SpaceFrame
    from modal.lattices.section import LatticeSection
    from modal.lattices.truss import ColumnTruss

    Floats = NDArray[np.float64]


def column_frame(truss: ColumnTruss, rigidity: float | None = None) -> SpaceFrame:
    """A column, and what stands on it, with its height along x and its mass along its members.

    A stated mass per length is spread over the members as their own would be.

    Parameters
    ----------
    truss : ColumnTruss
    rigidity : float, optional
        Of rigid joints, see `modal.lattices.space.frame_of_round`; without it all are pinned.
    """
    pairs, areas, moduli = truss.members
    nodes = np.roll(truss.nodes, 1, axis=1)
    return frame_of_round(nodes, pairs, areas, moduli, _masses(truss), np.arange(4), rigidity)


def column_beam(truss: ColumnTruss, elements: int = 24) -> SpaceBeam:
    """A column, and what stands on it, as a beam of so many elements each."""
    sections: list[tuple[float, LatticeSection]] = []
    factors: list[float] = []
    column: ColumnTruss | None = truss
    while column is not None:
        parts = column_parts(column.column, column.height, column.top_ratio, elements)
        sections += parts
        own = sum(length * section.mass_per_length for length, section in parts)
        stated = column.mass_per_length
        factors += [1.0 if stated is None else stated * column.height / own] * elements
        last, column = column.column.panel_height, column.above
    return beam_of(sections, column_frame(truss), 0.5 * last, np.array(factors))


def _masses(truss: ColumnTruss) -> Floats:
    """Masses per length of all members [kg/m]."""
    pairs, areas = truss.own_members
    masses = np.array(areas) * (truss.column.density or 1.0)
    if truss.mass_per_length is not None:
        lengths = np.linalg.norm(truss.nodes[pairs[:, 1]] - truss.nodes[pairs[:, 0]], axis=1)
        masses *= truss.mass_per_length * truss.height / float(masses @ lengths)
    return masses if truss.above is None else np.concatenate([masses, _masses(truss.above)])

"""What ties a tower to a building, as runs know it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from modal.beams.beam import Beam

if TYPE_CHECKING:
    from towercrane.cranes.tower.modes.parameters import TowerCrane

MOST_COLLARS = 8
"""Collars of one tower; outputs are named after their number."""

SAME_HEIGHT = 1e-6
"""Relative; heights in a file may miss the sum of segments by rounding."""


@dataclass(frozen=True, slots=True)
class TowerCollar:
    """What ties a tower to a building at a height.

    Parameters
    ----------
    height : float
        [m]
    stiffness : float
        Force per deflection, in every direction [N/m].
    rotation_stiffness, torsional_stiffness : float
        Moment per rotation of the section, and per twist [N m/rad].
    """

    height: float
    stiffness: float
    rotation_stiffness: float = 0.0
    torsional_stiffness: float = 0.0


def collars_of(crane: TowerCrane) -> tuple[TowerCollar, ...]:
    """Collars of a crane's tower, the lowest first, with the springs that hold its shaft there."""
    tower, twisted = crane.tower, () if crane.shaft is None else crane.shaft.springs
    if isinstance(tower, Beam):
        return ()
    found = []
    for node, own in sorted(tower.collars.items()):
        height = tower.nodes[node]
        torsional = sum(stiffness for at, stiffness in twisted if abs(at - height) <= SAME_HEIGHT * height)
        found.append(TowerCollar(height, own.stiffness, own.rotation_stiffness, torsional))
    return tuple(found)

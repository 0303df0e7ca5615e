"""What ties a tower to a building, as runs know it."""

from __future__ import annotations

from dataclasses import dataclass

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
    gap : float
        Play to each side, within which the tower is free [m].
    """

    height: float
    stiffness: float
    rotation_stiffness: float = 0.0
    torsional_stiffness: float = 0.0
    gap: float = 0.0

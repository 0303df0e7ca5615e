"""Where a wind that differs from place to place blows on a tower crane."""

from __future__ import annotations

from math import cos, pi, sin, sqrt
from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.parts.turbulence.field import Places
from towercrane.cranes.tower.file.build import crane_of

if TYPE_CHECKING:
    from towercrane.cranes.tower.file.case_tables import TowerCase


def places_of(tables: TowerCase) -> Places:
    """Places that see a wind of their own when the run begins, of a crane that stands undeformed along x."""
    nodes, crane = None if tables.wind is None else tables.wind.nodes, crane_of(tables)
    assert nodes is not None, "the wind differs from place to place"
    height, luffing, angle = crane.tower.length, crane.luffing, getattr(tables.motion.luffing, "start", 0.0)
    along = nodes.along_jib(crane.jib.length, crane.counter_jib_length)
    foot = (0.0, 0.0) if luffing is None else luffing.foot
    ahead, up = np.maximum(along, 0.0), np.minimum(along, 0.0)
    raised = [
        (foot[0] + x * cos(angle), height + foot[1] + x * sin(angle)) if x > 0.0 else (back, height)
        for x, back in zip(ahead, up, strict=True)
    ]
    reach = crane.jib.length if luffing is not None else getattr(tables.motion.trolley, "start", crane.jib.length / 2)
    hung = foot[0] + reach * cos(angle), height + foot[1] + reach * sin(angle) * (luffing is not None)
    tower = [(0.0, z) for z in nodes.tower_heights(height)]
    points = np.array([(x, 0.0, z) for x, z in (*tower, *raised, (hung[0], hung[1] - tables.rope.length))])
    return Places(points, height, 2.0 * pi * sqrt(tables.rope.length / tables.crane.gravity))

"""Where a wind that differs from place to place blows on a tower crane, and which way wind turns a free head."""

from __future__ import annotations

from math import asin, cos, degrees, inf, pi, sin, sqrt
from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.parts.turbulence.field import Places
from towercrane.cranes.tower.file.build import crane_of
from towercrane.schema.motions import FreeTurn

if TYPE_CHECKING:
    from collections.abc import Iterator

    from towercrane.cranes.tower.file.case_tables import TowerCase
    from towercrane.cranes.tower.model import FlexibleModel

HELD = "the head is free to turn: natural frequencies are those with its brake holding it"


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


def weathervane(tables: TowerCase, model: FlexibleModel) -> Iterator[str]:
    """Where a free head comes to rest, and what its brake holds; of a steady wind, or the mean of one that is not.

    The torque of a wind v at an angle delta from downwind is -(C v^2 |sin delta| + x d v^2) sin delta, with C the
    integral of the drag c x along jib and counter-jib, and the drag d of the load at x.
    """
    turn, wind = tables.motion.slewing, tables.wind
    if not isinstance(turn, FreeTurn) or wind is None:
        return
    own = float(model.constants.head_area_moment.sum())
    load = model.load.drag * float(getattr(tables.motion.trolley, "start", 0.0))
    head = f"a free head in the wind: int c x = {own:.4g} kg"
    if own >= 0.0:
        yield f"{head}, the jib's: it comes to rest with its jib downwind, and leaves upwind"
    elif load >= -own:
        yield f"{head}, the counter-jib's, but the load's drag, {load:.4g} kg, still turns the jib downwind"
    else:
        away = 180.0 - degrees(asin(load / -own))
        yield (
            f"{head}, the counter-jib's: the weathervane is reversed, the jib comes to rest {away:.3g} deg from "
            "downwind, and leaves downwind"
        )
    if own <= 0.0 or not wind.speed:
        return
    speed = wind.speed * float(wind.over_height.share(model.crane.tower_height))
    torque = turn.brake_torque
    share = (-load + sqrt(load * load + 4.0 * own * torque / speed**2)) / (2.0 * own)
    within = f"within {degrees(asin(share)):.3g} deg of that" if share < 1.0 else "at any angle"
    slowest = sqrt(torque / (own + load)) if own + load > 0.0 else inf
    yield (
        f"in {speed:.4g} m/s the brake of {1e-3 * torque:.4g} kN m holds the head {within}; below {slowest:.3g} m/s "
        "it does not turn even broadside"
    )

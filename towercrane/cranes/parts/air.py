"""The air at several places, and its force on a load at rest."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.kernels.algebra import Row, Vector, dot

if TYPE_CHECKING:
    from towercrane.kernels.load import Load, Momentary


def air_at(nodes: int, drives: Row) -> list[Vector]:
    """Velocity of the air at each place, the load's the last; zero without wind.

    The last three channels are the components for the load; those along x and y for other places stand before them.
    """
    if not nodes:
        return [(0.0, 0.0, 0.0)]
    values = [channel[0] for channel in drives[-2 * nodes - 1 :]]
    return [(east, north, values[-1]) for east, north in zip(values[:-1:2], values[1:-1:2], strict=True)]


def load_force(load: Load | Momentary, gravity: Any, wind: Row) -> list[Any]:
    """Force of weight and of a wind along the load's axes on all that hangs on the rope, at rest [N]."""
    speed = np.sqrt(dot(wind, wind))
    pull = [load.whole_drag * speed * own for own in wind]
    return [*pull[:-1], pull[-1] - load.whole_mass * gravity]

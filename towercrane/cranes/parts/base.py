"""What a crane does to its base: force and moment with their resultants, named alike for every kind of crane.

They are summed from what every mass resists, its weight and the wind on it (d'Alembert), not from springs or modes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from towercrane.kernels.algebra import Row, Vector, cross, dot
from towercrane.simulation.observed import About

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence


NONE = 0.0, 0.0, 0.0


class Reaction(NamedTuple):
    """Force [N] and moment [N m] by the crane, along fixed axes of which the last is up."""

    force: Vector
    moment: Vector


BASE: dict[str, tuple[Callable[[Reaction], Any], About]] = {
    "base_force_x": (lambda on: on.force[0], About("N", "force of the crane on its base along x")),
    "base_force_y": (lambda on: on.force[1], About("N", "force of the crane on its base along y")),
    "base_force_z": (
        lambda on: on.force[2], About("N", "force of the crane on its base, upward: its weight is negative"),
    ),
    "base_shear": (
        lambda on: length(on.force[:2]), About("N", "horizontal force of the crane on its base", kink=True),
    ),
    "base_moment_x": (
        lambda on: on.moment[0], About("N m", "moment of the crane on its base about x, positive: tips towards -y"),
    ),
    "base_moment_y": (
        lambda on: on.moment[1], About("N m", "moment of the crane on its base about y, positive: tips towards +x"),
    ),
    "base_torque": (lambda on: on.moment[2], About("N m", "moment of the crane on its base about the vertical")),
    "overturning_moment": (
        lambda on: length(on.moment[:2]),
        About("N m", "resultant of the moments that tip the crane, weights where they hang deflected", kink=True),
    ),
}  # fmt: skip
"""Outputs of a base, how each is read off and what it is."""


def length(vector: Row) -> Any:
    """Of a vector; that of one component is its size."""
    return np.sqrt(dot(vector, vector))


def base_outputs(on: Reaction) -> dict[str, Any]:
    """All of them."""
    return {name: read(on) for name, (read, _) in BASE.items()}


def base_about() -> dict[str, About]:
    """What they are."""
    return {name: about for name, (_, about) in BASE.items()}


def together(pushed: Sequence[tuple[Vector, Vector]]) -> Reaction:
    """Force and moment about the origin of forces at places."""
    force: Vector = NONE
    moment: Vector = NONE
    for place, own in pushed:
        force, moment = added(force, own), added(moment, cross(place, own))
    return Reaction(force, moment)


def added(first: Any, *others: Any) -> Any:
    """Sum of vectors."""
    return tuple(sum(own, start) for start, *own in zip(first, *others, strict=True))


def rope_on_crane(tension: Any, damping: Any, length: Any, direction: Row, swing: Row) -> tuple[Vector, Vector]:
    """Force of a rope on what it hangs from, and couple of its damper there.

    Parameters
    ----------
    tension : number
        [N]
    damping : number
        Where the rope hangs, a torque per rate of swing [N m s/rad].
    length : number
        Of the rope [m].
    direction, swing : sequence of 3 numbers
        Unit vector down the rope and its rate [1/s].
    """
    # The damper pulls the load back and the rope's upper end along.
    away = dot(swing, direction)
    across = [p - away * n for p, n in zip(swing, direction, strict=True)]
    held = damping / length
    x, y, z = (tension * n + held * p for n, p in zip(direction, across, strict=True))
    turned = cross(tuple(direction), tuple(across))
    return (x, y, z), (damping * turned[0], damping * turned[1], damping * turned[2])

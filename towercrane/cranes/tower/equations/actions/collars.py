"""Collars with play: the tower is free within the gap and meets a spring beyond it, whose floor moves with its play.

Floor and tower are round: what counts is how far the section is from the collar's centre, and along that way the
collar pushes back. In the plane that is the way to one of two sides.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from towercrane.cranes.tower.equations.actions.ground import floor_of
from towercrane.kernels.algebra import dot
from towercrane.kernels.choices import below, choose

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.tower.equations.constants import Constants, Drives
    from towercrane.cranes.tower.equations.play import Play
    from towercrane.kernels.algebra import Row

    Floats = NDArray[np.float64]


class Met(NamedTuple):
    """A collar: force of the tower on it along the first two axes of the coordinates [N], way of the tower beyond its
    play (negative: what is left of it) [m], energy of its spring [J]."""

    force: tuple[Any, Any]
    beyond: Any
    energy: Any


def meet(crane: Constants, coordinates: Row, drives: Drives) -> list[Met]:
    """The collars with play, the lowest first."""
    if crane.play is None:
        return []
    q_x, q_y = ([coordinates[i] for i in crane.part(kind)] for kind in ("tower_x", "tower_y"))
    found = []
    for k, number in enumerate(crane.play.numbers):
        (floor_x, floor_y), stiffness = floor_of(crane, drives, number), crane.play.stiffness[k]
        x, y, gap = dot(crane.play.bends[k], q_x) - floor_x, 0.0, crane.play.gaps[k]
        if crane.axes == 3:
            y = dot(crane.play.bends[k], q_y) - floor_y
        way = abs(x) if crane.axes == 2 else np.sqrt(x * x + y * y)
        pressed = below(gap, way)
        depth = choose(pressed, way - gap, 0.0)
        share = stiffness * depth / choose(pressed, way, gap)
        # No force is a plain zero, whatever side the tower is on.
        force = choose(pressed, share * x, 0.0), choose(pressed, share * y, 0.0)
        found.append(Met(force, way - gap, 0.5 * stiffness * (depth * depth)))
    return found


def held_back(crane: Constants, drives: Drives, met: list[Met]) -> tuple[list[Any], Any]:
    """Forces of collars with play on the coordinates, and the power of their floors."""
    forces: list[Any] = [0.0] * crane.coordinates
    power: Any = 0.0
    if crane.play is None:
        return forces, power
    for k, number in enumerate(crane.play.numbers):
        moving = floor_of(crane, drives, number, order=1)
        power = power - dot(met[k].force, moving)
        for kind, force in zip(("tower_x", "tower_y"), met[k].force, strict=True):
            for place, bend in zip(crane.part(kind), crane.play.bends[k], strict=False):
                forces[place] = forces[place] - bend * force
    return forces, power


def pressed_at_rest(crane: Constants, q: Floats, drives: Drives) -> tuple[Floats, Floats]:
    """Forces of collars with play on coordinates at rest, shape (n,), and their stiffness, shape (n, n).

    Along the way of the tower a collar has its spring, across it what the turning of its force gives.
    """
    met = meet(crane, q.tolist(), drives)
    stiffness = np.zeros((len(q), len(q)))
    for k, own in enumerate(met):
        if crane.play is None or own.beyond <= 0.0:
            continue
        along = np.array(own.force) / np.hypot(*own.force)
        turned = own.beyond / (own.beyond + crane.play.gaps[k])
        spring = crane.play.stiffness[k] * (turned * np.eye(2) + (1.0 - turned) * np.outer(along, along))
        bends = np.zeros((2, len(q)))
        for row, kind in zip(bends, ("tower_x", "tower_y"), strict=True):
            part = crane.part(kind)
            row[part.start : part.stop] = crane.play.bends[k][: len(part)]
        stiffness += bends.T @ spring @ bends
    return np.array(held_back(crane, drives, met)[0], dtype=float), stiffness


def sides(beyond: list[Any]) -> list[Any]:
    """Guards of collars: the way to each corner from within its play, and from beyond it."""
    return [way for own in beyond for way in (-own, own)]


def names_of(play: Play | None) -> list[str]:
    """What happens at these guards."""
    numbers = () if play is None else play.numbers
    return [name for k in numbers for name in (f"tower meets collar {k + 1}", f"tower leaves collar {k + 1}")]


def corners_of(play: Play | None, first: int) -> tuple[tuple[int, int], ...]:
    """Pairs of these guards, of which the first is at a place among all."""
    return tuple((first + 2 * k, first + 2 * k + 1) for k in range(0 if play is None else len(play.numbers)))

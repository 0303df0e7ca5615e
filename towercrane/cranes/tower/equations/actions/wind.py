"""Pressure of a wind on tower, head and jib, which stand still for it unless the head is free to turn."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from towercrane.cranes.parts.air import air_at
from towercrane.kernels.algebra import Vector, dot
from towercrane.kernels.choices import below, choose

if TYPE_CHECKING:
    from towercrane.cranes.tower.equations.constants import Constants, Drives
    from towercrane.cranes.tower.equations.head import Head
    from towercrane.kernels.payload import State


class Blown(NamedTuple):
    """Forces on the modes; on the head force along e2, moments about e1, e3; power."""

    forces: list[Any]
    side: Any
    rolling: Any
    turning: Any
    power: Any


def winds_of(crane: Constants, drives: Drives) -> list[Vector]:
    """Velocity of the air at each place along the axes of the coordinates, the load's the last; zero without wind.

    See :func:`towercrane.cranes.parts.air.air_at`.
    """
    c, s = crane.plane_cosine, crane.plane_sine
    return [(c * east + s * north, c * north - s * east, up) for east, north, up in air_at(crane.wind, drives)]


def pressures(crane: Constants, head: Head, winds: list[Vector]) -> list[Any]:
    """Squared speed across the jib, with its sign, at each place on what turns.

    Of a head that is free to turn it is that of the air against the head; between the ends of a panel that is linear,
    and its square has the same force and moment as what is linear between the values for both ends.
    """
    normals = [dot(winds[node], head.rotation[1::3]) for node in crane.head_nodes]
    if crane.slewing != "free":
        return [abs(normal) * normal for normal in normals]
    parts = zip(normals, crane.head_places, strict=True)
    against = [normal - (head.top[1] + place * head.spin[2]) for normal, place in parts]
    return [end for pair in zip(against[::2], against[1::2], strict=True) for end in panel_pressures(*pair)]


def panel_pressures(begin: Any, end: Any) -> tuple[Any, Any]:
    """Values at both ends whose linear course has the integrals of r |r| and of r |r| s, with r linear over s.

    Where r changes its sign, at s_0, both are those of r^2 less twice those up to there.
    """
    changes = below(begin * end, 0.0)
    upto = choose(changes, begin / choose(changes, begin - end, 1.0), 0.0)
    sense = np.sign(choose(changes, end, begin + end))
    force = (begin * begin + begin * end + end * end - 2.0 * begin * begin * upto) / 3.0
    moment = (begin * begin + 2.0 * begin * end + 3.0 * end * end - 2.0 * begin * begin * upto * upto) / 12.0
    return sense * (4.0 * force - 6.0 * moment), sense * (6.0 * moment - 2.0 * force)


def press_tower(crane: Constants, state: State, winds: list[Vector]) -> tuple[list[Any], Any]:
    """Forces of the wind on the tower's modes, among all coordinates, and their power."""
    forces: list[Any] = [0.0] * crane.coordinates
    power: Any = 0.0
    met = [winds[node] for node in crane.tower_nodes]
    speeds = [np.sqrt(dot(wind, wind)) for wind in met]
    for kind, axis in (("tower_x", 0), ("tower_y", 1)):
        along = [speed * wind[axis] for speed, wind in zip(speeds, met, strict=True)]
        for i in crane.part(kind):
            forces[i] = dot(along, crane.tower_exposure[:, i])
            power = power + forces[i] * state.rates[i]
    return forces, power


def press_wind(crane: Constants, state: State, head: Head, winds: list[Vector]) -> Blown:
    """Forces of the wind."""
    forces, power = press_tower(crane, state, winds)
    rolling, pressing = 0.0, pressures(crane, head, winds)
    for i in crane.lateral:
        forces[i] = dot(pressing, crane.head_exposure[:, i])
        power = power + forces[i] * state.rates[i]
    for i in crane.vertical:
        for press, exposure in zip(pressing, crane.head_exposure, strict=True):
            rolling = rolling - exposure[i] * state.coordinates[i] * press
    side, turning = dot(pressing, crane.head_area), dot(pressing, crane.head_area_moment)
    power = power + (side * head.top[1] + rolling * head.spin[0] + turning * head.spin[2])
    return Blown(forces, side, rolling, turning, power)

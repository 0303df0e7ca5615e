"""Pressure of a wind on tower, head and jib, all of which stand still for it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from towercrane.cranes.parts.air import air_at
from towercrane.kernels.algebra import Vector, dot

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
    """Squared speed across the jib, with its sign, at each place on what turns."""
    normals = [dot(winds[node], head.rotation[1::3]) for node in crane.head_nodes]
    return [abs(normal) * normal for normal in normals]


def press_wind(crane: Constants, state: State, head: Head, winds: list[Vector]) -> Blown:
    """Forces of the wind."""
    forces: list[Any] = [0.0] * crane.coordinates
    power, rolling, pressing = 0.0, 0.0, pressures(crane, head, winds)
    met = [winds[node] for node in crane.tower_nodes]
    speeds = [np.sqrt(dot(wind, wind)) for wind in met]
    along_x, along_y = ([speed * wind[k] for speed, wind in zip(speeds, met, strict=True)] for k in (0, 1))
    pressed = (
        (crane.part("tower_x"), along_x, crane.tower_exposure),
        (crane.part("tower_y"), along_y, crane.tower_exposure),
        (crane.lateral, pressing, crane.head_exposure),
    )
    for modes, pressure, exposure in pressed:
        for i in modes:
            forces[i] = dot(pressure, exposure[:, i])
            power = power + forces[i] * state.rates[i]
    for i in crane.vertical:
        for press, exposure in zip(pressing, crane.head_exposure, strict=True):
            rolling = rolling - exposure[i] * state.coordinates[i] * press
    side, turning = dot(pressing, crane.head_area), dot(pressing, crane.head_area_moment)
    power = power + (side * head.top[1] + rolling * head.spin[0] + turning * head.spin[2])
    return Blown(forces, side, rolling, turning, power)

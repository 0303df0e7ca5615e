"""Pressure of a wind on tower, head and jib, all of which stand still for it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from towercrane.kernels.algebra import dot

if TYPE_CHECKING:
    from towercrane.cranes.tower.equations.constants import Constants, Drives
    from towercrane.cranes.tower.equations.head import Head
    from towercrane.kernels.payload import State


class Blown(NamedTuple):
    """Velocity of the air along x, y, z; forces on the modes; on the head force along e2, moments about e1, e3;
    power."""

    wind: tuple[Any, ...]
    forces: list[Any]
    side: Any
    rolling: Any
    turning: Any
    power: Any


def wind_velocity(crane: Constants, drives: Drives) -> tuple[Any, Any, Any]:
    """Velocity of the air, whose components are the last three channels, along x, y, z; zero where none blows."""
    if not crane.wind:
        return 0.0, 0.0, 0.0
    east, north, up = (channel[0] for channel in drives[-3:])
    c, s = crane.plane_cosine, crane.plane_sine
    return c * east + s * north, c * north - s * east, up


def press_wind(crane: Constants, state: State, head: Head, drives: Drives) -> Blown:
    """Forces of the wind."""
    wind = wind_velocity(crane, drives)
    speed = np.sqrt(dot(wind, wind))
    normal = dot(wind, head.rotation[1::3])
    press = abs(normal) * normal
    pressed = (
        (crane.part("tower_x"), speed * wind[0]), (crane.part("tower_y"), speed * wind[1]), (crane.lateral, press),
    )  # fmt: skip
    forces: list[Any] = [0.0] * crane.coordinates
    power, rolling = 0.0, 0.0
    for modes, pressure in pressed:
        for i in modes:
            forces[i] = pressure * crane.exposure[i]
            power = power + forces[i] * state.rates[i]
    for i in crane.vertical:
        rolling = rolling - crane.exposure[i] * state.coordinates[i] * press
    side, turning = crane.head_area * press, crane.head_area_moment * press
    power = power + (side * head.top[1] + rolling * head.spin[0] + turning * head.spin[2])
    return Blown(wind, forces, side, rolling, turning, power)

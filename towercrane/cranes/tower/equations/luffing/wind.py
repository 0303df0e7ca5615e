"""Pressure of a wind on tower, counter-jib and a jib that pivots, all of which stand still for it.

The jib is pressed by the component of the wind across its chord, to its side and up or down: c |w| w of each place.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from towercrane.cranes.tower.equations.actions.wind import press_tower
from towercrane.cranes.tower.equations.luffing.hinge import luffing_of, pivot_of
from towercrane.cranes.tower.equations.luffing.pivot import Coupled, foot_of
from towercrane.kernels.algebra import Vector, dot

if TYPE_CHECKING:
    from towercrane.cranes.tower.equations.constants import Constants
    from towercrane.cranes.tower.equations.head import Head
    from towercrane.kernels.payload import State


class Blown(NamedTuple):
    """Forces on the coordinates but by way of the head; on what turns, about the tower's top along the head's axes;
    on the jib alone, about its foot along its axes; power."""

    forces: list[Any]
    turning: Coupled
    jib: Coupled
    power: Any


def blow(crane: Constants, state: State, head: Head, winds: list[Vector]) -> Blown:
    """Forces of the wind."""
    own, pivot, q = luffing_of(crane), pivot_of(crane, state), state.coordinates
    assert own.exposure is not None, "there is something that it meets"
    frame, foot = foot_of(head, pivot, own.foot)
    forces, power = press_tower(crane, state, winds)
    side, up, rolling, behind, turned, lifted, swept = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for part in own.exposure.head:
        wind, jib = winds[part.node], part.jib
        across, above = dot(wind, frame.rotation[1::3]), dot(wind, frame.rotation[2::3])
        speed = np.sqrt(across * across + above * above)
        y, z = speed * across, speed * above
        normal = dot(wind, head.rotation[1::3])
        press = abs(normal) * normal
        side, up = side + jib.mass * y, up + jib.mass * z
        turned, lifted = turned + jib.moment * y, lifted + jib.moment * z
        behind, swept = behind + part.counter.mass * press, swept + part.counter.moment * press
        for modes, pressure, arm in ((crane.lateral, y, z), (crane.vertical, z, -y)):
            for i in modes:
                first = jib.first[i - crane.lateral.start]
                forces[i] = forces[i] + first * pressure
                rolling = rolling + first * q[i] * arm
    forces[-1] = forces[-1] + lifted
    for i in range(crane.movers, crane.coordinates):
        power = power + forces[i] * state.rates[i]
    alone = Coupled((0.0, side, up), (rolling, -lifted, turned))
    (fx, fy, fz), (mx, my, mz) = alone.seen_from_head(pivot, foot.place)
    turning = Coupled((fx, fy + behind, fz), (mx, my, mz + swept))
    power = power + dot(turning.momentum, head.top) + dot(turning.moment, head.spin)
    return Blown(forces, turning, alone, power)

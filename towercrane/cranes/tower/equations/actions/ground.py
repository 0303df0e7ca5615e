"""An earthquake: all places are relative to the ground, whose acceleration adds to that of gravity everywhere.

Exact for a ground that moves without turning, and for all that stands on it or is tied to what moves with
it: springs of a foundation, collars of a rigid building.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from towercrane.kernels.algebra import Vector, cross, dot

if TYPE_CHECKING:
    from towercrane.cranes.tower.equations.body import Body, Carried
    from towercrane.cranes.tower.equations.constants import Constants, Drives
    from towercrane.cranes.tower.equations.head import Head
    from towercrane.kernels.payload import State

STILL = 0.0, 0.0, 0.0


class Ground(NamedTuple):
    """Velocity and acceleration of the ground along the axes of the coordinates."""

    velocity: Vector = STILL
    acceleration: Vector = STILL


class Shaken(NamedTuple):
    """Forces on the modes of the tower, and power on all but the load."""

    forces: list[Any]
    power: Any


def ground_of(crane: Constants, drives: Drives) -> Ground:
    """Motion of the ground, whose displacements along the fixed axes are three channels; none where it rests."""
    if not crane.ground:
        return Ground()
    east, north, up = drives[crane.ground : crane.ground + 3]
    c, s = crane.plane_cosine, crane.plane_sine
    velocity, acceleration = (
        (c * east[k] + s * north[k], c * north[k] - s * east[k], up[k]) for k in (1, 2)
    )  # fmt: skip
    return Ground(velocity, acceleration)


def shake(
    crane: Constants, state: State, head: Head, turning: Body, drift: Vector, end: Carried, ground: Ground,
    drives: Drives,
) -> Shaken:  # fmt: skip
    """What the acceleration of the ground, and floors that move against it, do to the tower; and the power.

    On what turns it acts as gravity does, with which it is felt. Where weight softens the tower, so does a ground
    that rises. The power is that of the inertia forces -a_g m on all velocities relative to the ground.

    Parameters
    ----------
    turning : Body
        What turns, without trolley.
    drift : tuple of 3
        Rate of its first moments in the head's axes.
    end : Carried
        The trolley.
    """
    (x, y, z), rates, q = ground.acceleration, state.rates, state.coordinates
    floors = floors_of(crane, drives)
    forces: list[Any] = [0.0] * crane.coordinates
    power: Any = 0.0
    for axis, (kind, along) in enumerate((("tower_x", x), ("tower_y", y))):
        for i in crane.part(kind):
            pulled = dot(crane.floor_pull[:, i], [floor[axis] for floor in floors])
            forces[i] = z * dot(crane.softening[i], q) - along * crane.tower_mass[i] + pulled
            power = power + forces[i] * rates[i]
    mass, (rx, ry, rz) = crane.trolley_mass, end.velocity
    (sx, sy, sz), swept = head.top, cross(head.spin, turning.first)
    momentum = (
        turning.mass * sx + swept[0] + drift[0] + mass * rx,
        turning.mass * sy + swept[1] + drift[1] + mass * ry,
        turning.mass * sz + swept[2] + drift[2] + mass * rz,
    )
    return Shaken(forces, power - dot(momentum, head.to_head(ground.acceleration)))


def floors_of(crane: Constants, drives: Drives) -> list[tuple[Any, Any]]:
    """Displacement of each floor against the ground along the first two axes of the coordinates [m]."""
    return [floor_of(crane, drives, number) for number in range(len(crane.floor_pull))]


def floor_of(crane: Constants, drives: Drives, number: int, order: int = 0) -> tuple[Any, Any]:
    """Displacement of a floor, the lowest is 0, or its rate; none where floors move with the ground."""
    if not len(crane.floor_pull):
        return 0.0, 0.0
    first, c, s = crane.ground + 3 + 2 * number, crane.plane_cosine, crane.plane_sine
    east, north = (drives[first + axis][order] for axis in (0, 1))
    return c * east + s * north, c * north - s * east

"""A jib that pivots in the head: its axes and their motion, and what it is to the head.

Its axes are e1 along the chord from foot to head, e2 as the head's, e3 square to both; lambda is the chord's angle
over the head's e1. Seen from its foot the jib is a head of its own: what is said of a jib that is clamped holds with
its own angular velocity, angular acceleration and the acceleration of its foot.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from towercrane.cranes.tower.equations.body import Body
from towercrane.cranes.tower.equations.head import Head
from towercrane.kernels.algebra import Vector, cross, dot

if TYPE_CHECKING:
    from towercrane.kernels.algebra import Row


class Pivot(NamedTuple):
    """Angle of a jib over the head's e1: its cosine and sine, and its rate."""

    c: Any
    s: Any
    rate: Any

    def to_jib(self, vector: Vector) -> Vector:
        """A vector along the head's axes in the jib's."""
        x, y, z = vector
        return self.c * x + self.s * z, y, self.c * z - self.s * x

    def to_head(self, vector: Vector) -> Vector:
        """A vector along the jib's axes in the head's."""
        x, y, z = vector
        return self.c * x - self.s * z, y, self.s * x + self.c * z


def pivot_at(angle: Any, rate: Any = 0.0) -> Pivot:
    """A jib at an angle."""
    return Pivot(np.cos(angle), np.sin(angle), rate)


def raised(vector: Vector) -> Vector:
    """What a rate of the angle moves a point at this place from the foot, in the jib's axes."""
    x, _, z = vector
    return -z, 0.0, x


class Foot(NamedTuple):
    """Foot of a jib in the head's axes, and its acceleration in the jib's while no rate changes."""

    place: Vector
    bias: Vector


def foot_of(head: Head, pivot: Pivot, at: Row) -> tuple[Head, Foot]:
    """The jib as a head of its own, moving with its foot; and the foot.

    With Om = R^T w - lambda' e2 and al = R^T al0 + lambda' e2 x (R^T w) for angular velocity w and acceleration al0
    of the head, R turning by lambda about -e2.
    """
    place = at[0], 0.0, at[1]
    (wx, wy, wz), (ax, ay, az) = pivot.to_jib(head.spin), pivot.to_jib(head.spin_bias)
    x, y, z = (pivot.to_jib(row) for row in head.rows)
    swept = cross(head.spin, place)
    top = tuple(own + more for own, more in zip(head.top, swept, strict=True))
    turned = cross(head.spin_bias, place), cross(head.spin, swept)
    bias = tuple(a + b for a, b in zip(*turned, strict=True))
    frame = Head(
        rotation=(*x, *y, *z),
        turn_x=pivot.to_jib(head.turn_x),
        turn_y=pivot.to_jib(head.turn_y),
        spin=(wx, wy - pivot.rate, wz),
        spin_bias=(ax + pivot.rate * wz, ay, az - pivot.rate * wx),
        top=pivot.to_jib((top[0], top[1], top[2])),
    )
    return frame, Foot(place, pivot.to_jib((bias[0], bias[1], bias[2])))


class Coupled(NamedTuple):
    """Sums of a coordinate's motion over the jib's mass: momentum, and moment of momentum about an origin."""

    momentum: Vector
    moment: Vector

    def seen_from_head(self, pivot: Pivot, foot: Vector) -> Coupled:
        """From about the foot along the jib's axes to about the tower's top along the head's."""
        momentum = pivot.to_head(self.momentum)
        x, y, z = pivot.to_head(self.moment)
        u, v, w = cross(foot, momentum)
        return Coupled(momentum, (x + u, y + v, z + w))


def seen_from_head(body: Body, pivot: Pivot, foot: Vector) -> Body:
    """A body about its foot along the jib's axes as one about the tower's top along the head's."""
    (ixx, ixy, ixz, iyy, iyz, izz), (c, s, _), (fx, _, fz), mass = body.inertia, pivot, foot, body.mass
    sx, sy, sz = pivot.to_head(body.first)
    # About the foot.
    ixx, ixz, izz = (
        c * c * ixx - 2.0 * c * s * ixz + s * s * izz,
        c * s * (ixx - izz) + (c * c - s * s) * ixz,
        s * s * ixx + 2.0 * c * s * ixz + c * c * izz,
    )
    ixy, iyz = c * ixy - s * iyz, s * ixy + c * iyz
    # About the top.
    inertia = (
        ixx + 2.0 * fz * sz + mass * fz * fz,
        ixy - fx * sy,
        ixz - fx * sz - fz * sx - mass * fx * fz,
        iyy + 2.0 * (fx * sx + fz * sz) + mass * (fx * fx + fz * fz),
        iyz - fz * sy,
        izz + 2.0 * fx * sx + mass * fx * fx,
    )
    force, moment = Coupled(body.force, body.moment).seen_from_head(pivot, foot)
    return Body(mass, (sx + mass * fx, sy, sz + mass * fz), inertia, force, moment)


def rigid_body(mass: Any, first: Vector, inertia: tuple[Any, ...], head: Head, felt: Vector) -> Body:
    """A rigid part of the head; felt is the acceleration against gravity of the tower's top."""
    ixx, ixy, ixz, iyy, iyz, izz = inertia
    rows = (ixx, ixy, ixz), (ixy, iyy, iyz), (ixz, iyz, izz)
    swept = cross(head.spin, cross(head.spin, first))
    turned = cross(head.spin_bias, first)
    x, y, z = (-(a + b + mass * g) for a, b, g in zip(turned, swept, felt, strict=True))
    momentum = dot(rows[0], head.spin), dot(rows[1], head.spin), dot(rows[2], head.spin)
    parts = zip(rows, cross(head.spin, momentum), cross(first, felt), strict=True)
    rolling, pitching, turning = (-(dot(row, head.spin_bias) + gyric + weight) for row, gyric, weight in parts)
    return Body(mass, first, inertia, (x, y, z), (rolling, pitching, turning))


def joined(one: Body, other: Body) -> Body:
    """Two bodies about one point as one."""
    first, force, moment = (
        (a[0] + b[0], a[1] + b[1], a[2] + b[2])
        for a, b in ((one.first, other.first), (one.force, other.force), (one.moment, other.moment))
    )
    inertia = tuple(a + b for a, b in zip(one.inertia, other.inertia, strict=True))
    return Body(one.mass + other.mass, first, inertia, force, moment)

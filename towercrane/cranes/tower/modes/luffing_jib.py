"""What a jib that pivots has beside its beam: foot, ropes, and the bodies of the head that it stands on."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, inf, sin
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from modal.beams.beam import EndBody
from modal.checks import check_fields
from towercrane.cranes.tower.modes.chord_shapes import quadrature

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from modal.beams.beam import Beam

    Floats = NDArray[np.float64]

Point = tuple[float, float]
"""Place in the jib's plane from the tower's top: forward and up [m]."""


class Turning(Protocol):
    """What turns beside a jib and the bodies of the head: the counter-jib, see
    :class:`towercrane.cranes.tower.modes.parameters.TowerCrane`."""

    @property
    def uniform_jib(self) -> Beam:
        """The jib."""

    @property
    def counter_mass(self) -> float:
        """Mass of the counter-jib with its weight."""

    @property
    def counter_moment(self) -> float:
        """Its first moment about the tower's axis."""

    @property
    def counter_inertia(self) -> float:
        """Its moment of inertia."""

    @property
    def roll_inertia(self) -> float:
        """That of all about the jib's axis."""


class RigidSums(NamedTuple):
    """Sums over mass about the tower's top: first moments forward and up, moments of inertia, -sum m x z."""

    mass: float
    forward: float
    up: float
    xx: float
    yy: float
    zz: float
    xz: float

    def with_points(self, mass: Floats, x: Floats, z: Floats) -> RigidSums:
        """With points of mass forward and up [kg, m]."""
        xx, zz = mass @ z**2, mass @ x**2
        more = mass.sum(), mass @ x, mass @ z, xx, xx + zz, zz, -mass @ (x * z)
        return RigidSums(*(own + float(other) for own, other in zip(self, more, strict=True)))


@dataclass(frozen=True, slots=True)
class HeadBody:
    """Point mass on the head.

    Parameters
    ----------
    mass : float
        [kg]
    place : tuple of 2 float
        Forward and up from the tower's top [m].
    """

    mass: float
    place: Point


@dataclass(frozen=True, slots=True)
class LuffingJib:
    """A jib that pivots at its foot and is held by a rope at its head.

    Parameters
    ----------
    foot, frame_head, winch : tuple of 2 float
        Pivot of the jib, upper end of the luffing rope and hoist winch: forward and up from the tower's top [m].
    attachment : float
        Height of the luffing rope's other end above the chord, at the jib's head [m].
    rope_stiffness : float
        E A of the luffing rope, all its falls together [N].
    falls : int
        Of the hoist rope below the jib's head.
    reference_angle : float
        Angle of the jib at which the winch's rope length is the length below the head [rad].
    highest_angle : float
        Of the jib's stop [rad].
    tip_mass : float
        Of sheaves at the jib's head [kg].
    axial_stiffness : float
        E A of the jib [N].
    bodies : tuple of HeadBody
        What else is on the head.

    Raises
    ------
    ValueError
        If a stiffness or the number of falls is not positive, or a mass negative.
    """

    foot: Point
    frame_head: Point
    winch: Point
    attachment: float
    rope_stiffness: float
    falls: int
    reference_angle: float
    highest_angle: float
    tip_mass: float = 0.0
    axial_stiffness: float = inf
    bodies: tuple[HeadBody, ...] = ()

    def __post_init__(self) -> None:
        check_fields(self, positive=("rope_stiffness", "falls"), not_negative=("tip_mass",))

    def head(self, length: float, angle: float, above: float = 0.0) -> Point:
        """A point above the chord at the head of a straight jib, from the tower's top [m]."""
        x, z = self.foot
        c, s = cos(angle), sin(angle)
        return x + length * c - above * s, z + length * s + above * c

    def hoist_way(self, length: float, angle: float) -> float:
        """Way of the hoist rope from its winch to the head of a straight jib [m]."""
        return float(np.hypot(*np.subtract(self.head(length, angle), self.winch)))

    def below(self, length: float, angle: float, rope: float) -> float:
        """Length of rope below the head of a straight jib whose hoist winch is set to a length of its own [m]."""
        way = self.hoist_way(length, angle) - self.hoist_way(length, self.reference_angle)
        return rope - way / self.falls

    def lever(self, length: float, angle: float) -> float:
        """Arm of the luffing rope about the foot, positive where it lifts a straight jib [m]."""
        tied = np.array(self.head(length, angle, self.attachment))
        (x, z), (u, w) = tied - self.foot, np.array(self.frame_head) - tied
        return float((x * w - z * u) / np.hypot(u, w))

    def points_of(self, jib: Beam) -> tuple[Floats, Floats]:
        """Places along a jib and masses there [m, kg], whose sums are those of the jib with what is at its head."""
        along, weights = quadrature(jib.length)
        return np.append(along, jib.length), np.append(jib.mass_per_length * weights, self.tip_mass)

    def rest_sums(self, crane: Turning) -> RigidSums:
        """Of what turns beside the jib."""
        inertia, roll = crane.counter_inertia, crane.roll_inertia
        counter = RigidSums(crane.counter_mass, crane.counter_moment, 0.0, roll, inertia, inertia, 0.0)
        x, z = np.reshape([body.place for body in self.bodies], (-1, 2)).T
        return counter.with_points(np.array([body.mass for body in self.bodies]), x, z)

    def standing_sums(self, crane: Turning) -> RigidSums:
        """Of all that turns, the jib straight at its reference angle."""
        along, mass = self.points_of(crane.uniform_jib)
        (x, z), angle = self.foot, self.reference_angle
        return self.rest_sums(crane).with_points(mass, x + along * cos(angle), z + along * sin(angle))

    def standing_body(self, crane: Turning) -> EndBody:
        """All that turns as the tower's end body, for the tower's shapes: any would do, this one needs few."""
        sums = self.standing_sums(crane)
        offset = sums.up / sums.mass
        return EndBody(sums.mass, sums.yy - sums.mass * offset**2, offset)

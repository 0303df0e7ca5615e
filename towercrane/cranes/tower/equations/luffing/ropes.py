"""Ropes over the head of a jib that pivots: where it is as the jib bends, and how long their ways to it are.

The head of a bent jib is nearer to its foot by half the sum of its squared slopes, which pulls and pushes it as beams
under tension and compression are. A rope that is tied above the chord turns with the slope there.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from towercrane.cranes.tower.equations.luffing.pivot import Pivot, pivot_at, raised
from towercrane.kernels.algebra import Row, Vector, dot, form

if TYPE_CHECKING:
    from towercrane.cranes.tower.equations.luffing.constants import Luffing


class Tied(NamedTuple):
    """A point of the jib's head, from the foot along the jib's axes.

    Place, its rate, its acceleration while no rate changes, and what each of the jib's modes moves it.
    """

    place: Vector
    rate: Vector
    bias: Vector
    moved: list[Vector]


class Way(NamedTuple):
    """Length of a rope's way over the head, its rate, its acceleration while no rate changes.

    ``moved`` is what each of the jib's modes, then its angle, adds to the length; ``direction`` is towards the jib's
    head, along the jib's axes.
    """

    length: Any
    rate: Any
    bias: Any
    moved: list[Any]
    direction: Vector


def tied_at(own: Luffing, q: Row, qd: Row, above: Any) -> Tied:
    """The point so far above the chord at the jib's head; q and qd of the jib's modes."""
    shortened = [dot(row, q) for row in own.shortening]
    slope, slope_rate = dot(own.tip_slopes, q), dot(own.tip_slopes, qd)
    place = (
        own.length - 0.5 * dot(q, shortened) - above * slope,
        dot(own.tip_shapes, q),
        above * (1.0 - 0.5 * slope * slope),
    )
    rate = -dot(qd, shortened) - above * slope_rate, dot(own.tip_shapes, qd), -above * slope * slope_rate
    bias = -form(qd, own.shortening, qd), 0.0, -above * slope_rate * slope_rate
    moved = [
        (-along - above * tangent, across, -above * slope * tangent)
        for along, tangent, across in zip(shortened, own.tip_slopes, own.tip_shapes, strict=True)
    ]
    return Tied(place, rate, bias, moved)


def way_to(own: Luffing, anchor: Row, tied: Tied, pivot: Pivot) -> Way:
    """From a point of the head to one of the jib's."""
    turn, (x, _, z) = pivot.rate, tied.place
    gap = from_anchor(own, anchor, pivot)
    reach = x + gap[0], tied.place[1], z + gap[1]
    length = np.sqrt(dot(reach, reach))
    direction = reach[0] / length, reach[1] / length, reach[2] / length
    lifted, (u, _, w) = raised(tied.place), tied.rate
    rates = [turn * up + rate for up, rate in zip(lifted, tied.rate, strict=True)]
    biases = [
        tied.bias[0] - turn * (turn * x + 2.0 * w),
        tied.bias[1],
        tied.bias[2] - turn * (turn * z - 2.0 * u),
    ]
    rate = dot(direction, rates)
    bias = dot(direction, biases) + (dot(rates, rates) - rate * rate) / length
    return Way(length, rate, bias, [dot(direction, moved) for moved in (*tied.moved, lifted)], direction)


def from_anchor(own: Luffing, anchor: Row, pivot: Pivot) -> tuple[Any, Any]:
    """The foot from a point of the head, along the jib's e1 and e3."""
    x, _, z = pivot.to_jib((own.foot[0] - anchor[0], 0.0, own.foot[1] - anchor[1]))
    return x, z


class Straight(NamedTuple):
    """Luffing rope to a straight jib: its way and that per angle; squared cosine to the jib, and that per angle."""

    way: Any
    per_angle: Any
    slant: Any
    slant_per_angle: Any


def straight_rope(own: Luffing, pivot: Pivot) -> Straight:
    """The luffing rope to a straight jib at an angle."""
    gx, gz = from_anchor(own, own.frame_head, pivot)
    x, z = own.length + gx, own.attachment + gz
    way = np.sqrt(x * x + z * z)
    per_angle, cosine = (own.length * gz - own.attachment * gx) / way, x / way
    return Straight(way, per_angle, cosine * cosine, 2.0 * cosine * (gz - cosine * per_angle) / way)


class Held(NamedTuple):
    """The luffing rope that holds the jib.

    Tension; forces on the jib's modes, then on its angle; elastic energy, the jib's compression with it; power of its
    winch.
    """

    tension: Any
    forces: list[Any]
    energy: Any
    power: Any


def hold(own: Luffing, way: Way, pivot: Pivot, commanded: Row) -> Held:
    """The luffing rope: its winch has left it as long as the way to a straight jib at the commanded angle.

    The compression of the jib is added to the stretch of the rope, as the rope sees it: by the squared cosine of the
    angle between them. It stores energy like the rope.
    """
    angle, rate, _ = commanded
    unstretched, now = straight_rope(own, pivot_at(angle)), straight_rope(own, pivot)
    length = unstretched.way
    flexibility = length / own.rope_stiffness + own.axial_flexibility * now.slant
    tension = (way.length - length) / flexibility
    forces = [-tension * moved for moved in way.moved]
    forces[-1] = forces[-1] + 0.5 * tension * tension * own.axial_flexibility * now.slant_per_angle
    power = -(tension + 0.5 * tension * tension / own.rope_stiffness) * (unstretched.per_angle * rate)
    return Held(tension, forces, 0.5 * tension * tension * flexibility, power)

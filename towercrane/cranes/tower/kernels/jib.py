"""Compiled bending of a jib in one direction, seen in the axes of the head that it is clamped to."""

from __future__ import annotations

from operator import add
from typing import TYPE_CHECKING, Any

from modal.compiler.compiled import kernel
from modal.compiler.traced import traced
from towercrane.cranes.tower.kernels import layout as at
from towercrane.kernels.payload import FORCE, MASS

if TYPE_CHECKING:
    from towercrane.cranes.tower.kernels.head import Vector


Sums = tuple[float, ...]
"""At the trolley the deflection, its rate, its acceleration without q'', its slope; A = a.q and its rate, B = b.q and
its rate; q.N q, q'.N q, and the same with the other direction's second q: twelve in all."""


@traced
def carry(total: float, i: int, m: int, place: int, y: Any, matrices: Any) -> float:
    """Add the mass that mode m at this place of the state couples to mode i."""
    return total + matrices[at.OWN, i, m] * y[place]


@traced
def bend_mode(
    sums: Sums, i: int, rate: int, n: int, side: float, spin: Vector, turning: tuple[float, float], weight: float,
    xd: float, xdd: float, shapes: Vector, coupled: Vector, y: Any, vectors: Any, work: Any,
) -> Sums:  # fmt: skip
    """Force on one mode; returns the sums with its part."""
    (wx, own_spin, other_spin), (roll, turn) = spin, turning
    (shape, tangent, half_second), (carried, crossed, crossed_rate) = shapes, coupled
    q, qd, a, b = y[i], y[rate], vectors[at.JIB_MASS, i], vectors[at.JIB_MOMENT, i]
    parts = (
        shape * q,
        shape * qd + xd * tangent * q,
        2.0 * xd * tangent * qd + (xdd * tangent + 2.0 * xd * xd * half_second) * q,
        tangent * q,
        a * q, a * qd, b * q, b * qd,
        carried * q, carried * qd, crossed * q, crossed * qd,
    )  # fmt: skip
    square_spin = wx * wx + own_spin * own_spin + other_spin * other_spin
    along = wx * b + own_spin * carried + other_spin * crossed
    inertia = turn * b + own_spin * along - square_spin * carried + side * (roll * crossed + 2.0 * wx * crossed_rate)
    work[FORCE, i] = -inertia - a * weight
    work[n + (MASS + at.SHAPE), i] = shape
    work[n + (MASS + at.ACROSS), i] = crossed
    return tuple(map(add, sums, parts))


@kernel()
def bend_jib(
    first: int,
    last: int,
    other: int,
    other_last: int,
    side: float,
    spin: Vector,
    turning: tuple[float, float],
    weight: float,
    xd: float,
    xdd: float,
    xi: float,
    cell: int,
    jib: int,
    rates: int,
    y: Any,
    vectors: Any,
    matrices: Any,
    tables: Any,
    work: Any,
) -> Sums:
    """Force on the modes of one direction, and sums over its deflection.

    Parameters
    ----------
    first, last : int
        Coordinates of this direction.
    other, other_last : int
        Coordinates of the other direction.
    side : float
        -1 for the modes to the left, 1 for those up: their cross products differ by this sign.
    spin, turning : tuples of 3 and 2 floats
        Angular velocity of the head about e1, about the axis along this direction and about the other; its angular
        acceleration while all rates are constant about e1 and, counted as it moves the jib this way, the other.
    weight : float
        Gravity along this direction [m/s^2].
    xd, xdd : float
        Speed and acceleration of the trolley.
    xi, cell : float, int
        Its place in the table of shapes.
    jib, rates : int
        First coordinate of the jib, and where the rates begin.
    y, vectors, matrices, tables, work
        As everywhere; FORCE, and the rows SHAPE and ACROSS, are written for these modes.

    Returns
    -------
    tuple of 12 floats
    """
    n = vectors.shape[1]
    sums = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    for i in range(first, last):
        shape, tangent, half_second = 0.0, 0.0, 0.0
        for c in range(tables.shape[2] - 1, -1, -1):
            half_second = half_second * xi + tangent
            tangent = tangent * xi + shape
            shape = shape * xi + tables[cell, i - jib, c]
        carried, crossed, crossed_rate = 0.0, 0.0, 0.0
        for m in range(first, last):
            carried = carry(carried, i, m, m, y, matrices)
        for m in range(other, other_last):
            crossed = carry(crossed, i, m, m, y, matrices)
            crossed_rate = carry(crossed_rate, i, m, rates + m, y, matrices)
        sums = bend_mode(
            sums, i, rates + i, n, side, spin, turning, weight, xd, xdd, (shape, tangent, half_second),
            (carried, crossed, crossed_rate), y, vectors, work,
        )  # fmt: skip
    return sums

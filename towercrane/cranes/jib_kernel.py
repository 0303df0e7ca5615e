"""Compiled bending of a jib in one direction, seen in the axes of the head that it is clamped to."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from modal.compiled import kernel
from towercrane.cranes import flexible_layout as at
from towercrane.payload import FORCE, MASS

if TYPE_CHECKING:
    from towercrane.cranes.head_kernel import Vector


@kernel(inline=True)
def bend_jib(
    first: int,
    last: int,
    other: int,
    other_last: int,
    side: float,
    spin: Vector,
    turning: Vector,
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
) -> tuple[float, float, float, float, float, float, float, float, float, float, float, float]:
    """Force on the modes of one direction, and sums over its deflection.

    Parameters
    ----------
    first, last : int
        Coordinates of this direction.
    other, other_last : int
        Coordinates of the other direction.
    side : float
        -1 for the modes to the left, 1 for those up: their cross products differ by this sign.
    spin, turning : tuple of 3 floats
        Angular velocity of the head, and its angular acceleration while all rates are constant.
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
    tuple of float
        At the trolley the deflection, its rate, its acceleration without q'', its slope; A = a.q and its rate,
        B = b.q and its rate; q.N q, q'.N q, and the same with the other direction's second q.
    """
    n = vectors.shape[1]
    shapes, across = MASS + n + at.SHAPE, MASS + n + at.ACROSS
    wx, own_spin, other_spin = spin
    roll, pitch, turn = turning
    if side > 0.0:
        own_spin, other_spin, turn = other_spin, own_spin, -pitch
    square_spin = wx * wx + own_spin * own_spin + other_spin * other_spin
    deflection, rate, bias, slope = 0.0, 0.0, 0.0, 0.0
    mass, mass_rate, moment, moment_rate = 0.0, 0.0, 0.0, 0.0
    square, square_rate, mixed, mixed_rate = 0.0, 0.0, 0.0, 0.0
    for i in range(first, last):
        shape, tangent, half_second = 0.0, 0.0, 0.0
        for c in range(tables.shape[2] - 1, -1, -1):
            half_second = half_second * xi + tangent
            tangent = tangent * xi + shape
            shape = shape * xi + tables[cell, i - jib, c]
        carried, crossed, crossed_rate = 0.0, 0.0, 0.0
        for m in range(first, last):
            carried += matrices[at.OWN, i, m] * y[m]
        for m in range(other, other_last):
            crossed += matrices[at.OWN, i, m] * y[m]
            crossed_rate += matrices[at.OWN, i, m] * y[rates + m]
        q, qd, a, b = y[i], y[rates + i], vectors[at.JIB_MASS, i], vectors[at.JIB_MOMENT, i]
        deflection += shape * q
        rate += shape * qd + xd * tangent * q
        bias += 2.0 * xd * tangent * qd + (xdd * tangent + 2.0 * xd * xd * half_second) * q
        slope += tangent * q
        mass += a * q
        mass_rate += a * qd
        moment += b * q
        moment_rate += b * qd
        square += carried * q
        square_rate += carried * qd
        mixed += crossed * q
        mixed_rate += crossed * qd
        along = wx * b + own_spin * carried + other_spin * crossed
        inertia = (
            turn * b + own_spin * along - square_spin * carried + side * (roll * crossed + 2.0 * wx * crossed_rate)
        )
        work[FORCE, i] = -inertia - a * weight
        work[shapes, i] = shape
        work[across, i] = crossed
    return (
        deflection, rate, bias, slope, mass, mass_rate, moment, moment_rate, square, square_rate, mixed, mixed_rate,
    )  # fmt: skip

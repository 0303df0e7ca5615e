"""Compiled structure of the crane in radial motion: tower, jib and trolley in the jib's vertical plane.

Source: Gao et al. (2023), Eq. 1-20, derived anew because several printed terms are dimensionally wrong and the
coupling of tower tilt and jib bending is absent there. Coordinates are the amplitudes of tower modes, then of jib
modes. With tip displacement u, tilt gamma (positive: jib tip down) and the tilted axes e1 (along the jib) and e3
(across it, up), the trolley stands at r = u e_x + x e1 + W(x) e3.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from modal.compiled import kernel
from towercrane.payload import (
    ACCELERATION,
    BIAS,
    DIRECTION,
    FORCE,
    HINGE,
    JACOBIAN,
    MASS,
    VELOCITY,
    hang_load,
)
from towercrane.polynomial import polynomial
from towercrane.system import rhs_signature

(TROLLEY_MASS, GRAVITY, SELF_GRAVITY, STATIC_MOMENT, JIB_LENGTH, TILT_LIMIT,
 LOAD_MASS, DRAG, HINGE_DAMPING) = range(9)  # fmt: skip
"""Entries of ``numbers``. SELF_GRAVITY is zero where the structure's own weight is left out."""

TIP, SLOPE, JIB_MASS, JIB_MOMENT, DAMPING = range(5)
"""Rows of ``vectors``: tower modes and their slopes at the top, int m phi and int m x phi of the jib modes (each
zero for the other kind), viscous damping."""

BASE, STIFFNESS = range(2)
"""Entries of ``matrices``: mass matrix of the undeformed structure without trolley; stiffness."""

TROLLEY, ROPE = range(2)
"""Rows of ``inputs``."""

TENSION, INNER_END, OUTER_END, TILT = range(4)
"""Guards: rope tension [N], way to either end of the jib [m], way to the tilt limit [rad]."""


@kernel()
def structure(
    d: int,
    t: float,
    y: Any,
    inputs: Any,
    numbers: Any,
    vectors: Any,
    matrices: Any,
    tables: Any,
    work: Any,
) -> tuple[float, float, float, float, float]:
    """Fill ``work`` with mass matrix, forces and the suspension point's motion, without the load.

    Parameters
    ----------
    d : int
        Axes of space, vertical last.
    t, y, inputs, numbers, vectors, matrices, tables, work
        As in :func:`towercrane.system.rhs_signature`; ``tables`` (cells, jib modes, 8) holds the jib's mode shapes
        as polynomials about the middle of equal cells.

    Returns
    -------
    tuple of float
        Trolley position [m]; its rate along the deflected jib, outward and up [m/s]; tilt gamma [rad]; damping
        power [W].
    """
    n = vectors.shape[1]
    tower = n - tables.shape[1]
    rates = n + d
    up = d - 1
    x, xd, xdd = polynomial(inputs, TROLLEY, t)

    ud, gamma, gammad = 0.0, 0.0, 0.0
    for i in range(tower):
        ud += vectors[TIP, i] * y[rates + i]
        gamma += vectors[SLOPE, i] * y[i]
        gammad += vectors[SLOPE, i] * y[rates + i]
    sg, cg = np.sin(gamma), np.cos(gamma)

    # Jib at the trolley: deflection, slope, curvature and their rates from the modal rates alone.
    cells = tables.shape[0]
    width = numbers[JIB_LENGTH] / cells
    cell = min(max(int(x / width), 0), cells - 1)
    xi = x - (cell + 0.5) * width
    w, slope, curvature, w_modal, slope_modal = 0.0, 0.0, 0.0, 0.0, 0.0
    moment, moment_rate, square, square_rate = 0.0, 0.0, 0.0, 0.0
    for b in range(n - tower):
        i = tower + b
        shape, first, half_second = 0.0, 0.0, 0.0
        for c in range(tables.shape[2] - 1, -1, -1):
            half_second = half_second * xi + first
            first = first * xi + shape
            shape = shape * xi + tables[cell, b, c]
        w += shape * y[i]
        slope += first * y[i]
        curvature += 2.0 * half_second * y[i]
        w_modal += shape * y[rates + i]
        slope_modal += first * y[rates + i]
        moment += vectors[JIB_MASS, i] * y[i]
        moment_rate += vectors[JIB_MASS, i] * y[rates + i]
        carried = 0.0
        for m in range(tower, n):
            carried += matrices[BASE, i, m] * y[m]
        square += carried * y[i]
        square_rate += carried * y[rates + i]
        # N q_b is kept in the force for the centrifugal term.
        work[FORCE, i] = gammad * gammad * carried
        work[JACOBIAN, i] = sg * shape
        work[JACOBIAN + up, i] = cg * shape
    wd = w_modal + xd * slope

    bias_1 = xdd + 2.0 * wd * gammad - x * gammad * gammad
    bias_3 = 2.0 * xd * slope_modal + xdd * slope + xd * xd * curvature - 2.0 * xd * gammad - w * gammad * gammad
    for k in range(d):
        work[VELOCITY, k] = 0.0
        work[BIAS, k] = 0.0
    work[VELOCITY, 0] = ud + (xd + w * gammad) * cg + (wd - x * gammad) * sg
    work[VELOCITY, up] = -(xd + w * gammad) * sg + (wd - x * gammad) * cg
    work[BIAS, 0] = bias_1 * cg + bias_3 * sg
    work[BIAS, up] = -bias_1 * sg + bias_3 * cg

    static, weight = numbers[STATIC_MOMENT], numbers[SELF_GRAVITY]
    coupling = -static * sg + moment * cg
    forward = gammad * (-static * gammad * cg + 2.0 * moment_rate * cg - moment * gammad * sg)
    turning = 2.0 * gammad * square_rate - weight * (static * cg + moment * sg)
    for i in range(tower):
        work[FORCE, i] = -vectors[TIP, i] * forward - vectors[SLOPE, i] * turning
        work[JACOBIAN, i] = vectors[TIP, i] + (w * cg - x * sg) * vectors[SLOPE, i]
        work[JACOBIAN + up, i] = -(w * sg + x * cg) * vectors[SLOPE, i]
    trolley, gravity = numbers[TROLLEY_MASS], numbers[GRAVITY]
    damping_power = 0.0
    for i in range(n):
        if d == 3:
            work[JACOBIAN + 1, i] = 0.0
        elastic = vectors[DAMPING, i] * y[rates + i]
        damping_power -= elastic * y[rates + i]
        for m in range(n):
            elastic += matrices[STIFFNESS, i, m] * y[m]
        jx, jz = work[JACOBIAN, i], work[JACOBIAN + up, i]
        force = work[FORCE, i] - elastic - weight * cg * vectors[JIB_MASS, i]
        work[FORCE, i] = force - trolley * (jx * work[BIAS, 0] + jz * (work[BIAS, up] + gravity))
        ui, gi = vectors[TIP, i], vectors[SLOPE, i]
        for m in range(i + 1):
            um, gm = vectors[TIP, m], vectors[SLOPE, m]
            mass = matrices[BASE, i, m] + square * gi * gm + coupling * (ui * gm + gi * um)
            mass += sg * (vectors[JIB_MASS, i] * um + ui * vectors[JIB_MASS, m])
            work[MASS + i, m] = mass + trolley * (jx * work[JACOBIAN, m] + jz * work[JACOBIAN + up, m])
    return x, xd * (cg + slope * sg), xd * (-sg + slope * cg), gamma, damping_power


@kernel(rhs_signature())
def rhs(
    t: float,
    y: Any,
    dy: Any,
    inputs: Any,
    numbers: Any,
    vectors: Any,
    matrices: Any,
    tables: Any,
    work: Any,
    guards: Any,
) -> None:
    """Right-hand side of the crane in radial motion; guards: rope tension, trolley on the jib, tilt."""
    n = vectors.shape[1]
    d = (y.size - 1) // 2 - n
    up = d - 1
    x, along, across, gamma, damping_power = structure(d, t, y, inputs, numbers, vectors, matrices, tables, work)
    length, rate, acceleration = polynomial(inputs, ROPE, t)
    gravity, trolley = numbers[GRAVITY], numbers[TROLLEY_MASS]
    tension = hang_load(
        y, dy, n, d, length, rate, acceleration,
        numbers[LOAD_MASS], gravity, numbers[DRAG], numbers[HINGE_DAMPING], 0.0, 0.0, work,
    )  # fmt: skip

    # Power of the trolley drive: its force along the deflected jib, which the prescribed motion takes.
    fx = trolley * work[ACCELERATION, 0] - tension * work[DIRECTION, 0] + work[HINGE, 0]
    fz = trolley * (work[ACCELERATION, up] + gravity) - tension * work[DIRECTION, up] + work[HINGE, up]
    dy[y.size - 1] += damping_power + along * fx + across * fz

    guards[TENSION] = tension
    guards[INNER_END] = x
    guards[OUTER_END] = numbers[JIB_LENGTH] - x
    guards[TILT] = numbers[TILT_LIMIT] - abs(gamma)

"""Compiled structure of the flexible crane in space: tower, slewing head, jib and trolley, without the load.

Coordinates are amplitudes of tower modes along the fixed axes x and y, of torsion modes, the slewing angle where a
drive turns it, and amplitudes of jib modes to the left and up; any of them may be absent. A planar scene has the
x modes of the tower and the vertical modes of the jib. Everything that hangs on the tower's top is seen in the
head's axes of :mod:`towercrane.cranes.head_kernel`: a point of the jib is at s = (x, W_y(x), W_z(x)) there, and

    a = R^T u'' + w' x s + w x (w x s) + 2 w x s' + s''

is its acceleration. Summed over the mass of the jib this leaves products of the mass sums of
:mod:`towercrane.cranes.mass_sums` with the coordinates, nothing to be integrated. Gao et al. (2023) set the
coordinates up; the equations are derived anew.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import types

from modal.compiled import kernel
from towercrane.cranes import flexible_layout as at
from towercrane.cranes.head_kernel import ROTATION, SPIN, SPIN_BIAS, TOP_VELOCITY, TURN_X, TURN_Y, move_head
from towercrane.cranes.jib_kernel import bend_jib
from towercrane.cranes.projection_kernel import project_head, project_jib
from towercrane.payload import BIAS, FORCE, MASS, VELOCITY, WIND
from towercrane.polynomial import polynomial

_one, _two, _three = types.float64[::1], types.float64[:, ::1], types.float64[:, :, ::1]


@kernel()
def move_top(d: int, t: float, y: Any, inputs: Any, numbers: Any, vectors: Any, work: Any) -> None:
    """Write the head's row of ``work`` from the coordinates of tower and slewing."""
    n = vectors.shape[1]
    rates, head = n + d, MASS + n + at.HEAD
    to_y = int(numbers[at.TOWER_X])
    to_turn = to_y + int(numbers[at.TOWER_Y])
    to_jib = to_turn + int(numbers[at.TORSION]) + int(numbers[at.DRIVEN])
    ux, uy, tx, ty, txd, tyd = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    turn, turning, turn_acceleration = 0.0, 0.0, 0.0
    for i in range(to_y):
        ux += vectors[at.TIP, i] * y[rates + i]
        ty += vectors[at.SLOPE, i] * y[i]
        tyd += vectors[at.SLOPE, i] * y[rates + i]
    for i in range(to_y, to_turn):
        uy += vectors[at.TIP, i] * y[rates + i]
        tx -= vectors[at.SLOPE, i] * y[i]
        txd -= vectors[at.SLOPE, i] * y[rates + i]
    if numbers[at.SLEWING_CHANNEL] >= 0.0 and numbers[at.DRIVEN] == 0.0:
        turn, turning, turn_acceleration = polynomial(inputs, at.SLEWING, t)
    for i in range(to_turn, to_jib):
        turn += vectors[at.TWIST, i] * y[i]
        turning += vectors[at.TWIST, i] * y[rates + i]
    move_head(tx, ty, txd, tyd, turn, turning, turn_acceleration, ux, uy, work, head)
    work[head, at.TILT_ANGLE] = np.sqrt(tx * tx + ty * ty)


@kernel()
def weigh_head(
    left: tuple[float, ...], up: tuple[float, ...], numbers: Any, work: Any, head: int, body: int
) -> None:
    """Write mass, moments, force and moment of what turns, without trolley, into the body's row.

    The force is minus the inertia with second derivatives zero, minus the weight. ``left`` and ``up`` are the sums
    over the jib of :func:`towercrane.cranes.jib_kernel.bend_jib`.
    """
    wx, wy, wz = work[head, SPIN], work[head, SPIN + 1], work[head, SPIN + 2]
    alx, aly, alz = work[head, SPIN_BIAS], work[head, SPIN_BIAS + 1], work[head, SPIN_BIAS + 2]
    spin, weight = wx * wx + wy * wy + wz * wz, numbers[at.SELF_GRAVITY]
    gx, gy, gz = (weight * work[head, ROTATION + 6], weight * work[head, ROTATION + 7],
                  weight * work[head, ROTATION + 8])  # fmt: skip
    _, _, _, _, sy, ayd, by, byd, qyy, eyy, qyz, eyz = left
    _, _, _, _, sz, azd, bz, bzd, qzz, ezz, _, ezy = up
    mass, sx = numbers[at.SLEWING_MASS], numbers[at.STATIC_MOMENT]
    ixx, ixy, ixz = numbers[at.ROLL] + qyy + qzz, -by, -bz
    iyy, iyz, izz = numbers[at.PITCH] + qzz, -qyz, numbers[at.YAW] + qyy
    along = wx * sx + wy * sy + wz * sz
    work[body, at.PUSH] = -(aly * sz - alz * sy + wx * along - spin * sx + 2.0 * (wy * azd - wz * ayd) + mass * gx)
    work[body, at.PUSH + 1] = -(alz * sx - alx * sz + wy * along - spin * sy - 2.0 * wx * azd + mass * gy)
    work[body, at.PUSH + 2] = -(alx * sy - aly * sx + wz * along - spin * sz + 2.0 * wx * ayd + mass * gz)
    lx, ly, lz = ixx * wx + ixy * wy + ixz * wz, ixy * wx + iyy * wy + iyz * wz, ixz * wx + iyz * wy + izz * wz
    mx = ixx * alx + ixy * aly + ixz * alz + wy * lz - wz * ly + sy * gz - sz * gy
    my = ixy * alx + iyy * aly + iyz * alz + wz * lx - wx * lz + sz * gx - sx * gz
    mz = ixz * alx + iyz * aly + izz * alz + wx * ly - wy * lx + sx * gy - sy * gx
    # Coriolis moment 2 sum m s x (w x s').
    mx += 2.0 * (eyy + ezz) * wx
    my += 2.0 * ((eyy + ezz) * wy - byd * wx - eyy * wy - eyz * wz)
    mz += 2.0 * ((eyy + ezz) * wz - bzd * wx - ezy * wy - ezz * wz)
    work[body, at.TORQUE], work[body, at.TORQUE + 1], work[body, at.TORQUE + 2] = -mx, -my, -mz
    work[body, at.WEIGHED] = mass
    work[body, at.STATIC], work[body, at.STATIC + 1], work[body, at.STATIC + 2] = sx, sy, sz
    work[body, at.INERTIA], work[body, at.INERTIA + 1], work[body, at.INERTIA + 2] = ixx, ixy, ixz
    work[body, at.INERTIA + 3], work[body, at.INERTIA + 4], work[body, at.INERTIA + 5] = iyy, iyz, izz


@kernel()
def press_wind(d: int, t: float, y: Any, inputs: Any, numbers: Any, vectors: Any, work: Any) -> None:
    """Add the wind's pressure on tower, jib and counter-jib, which stand still for it, and its power."""
    n = vectors.shape[1]
    rates, head, body = n + d, MASS + n + at.HEAD, MASS + n + at.BODY
    to_y = int(numbers[at.TOWER_X])
    to_turn = to_y + int(numbers[at.TOWER_Y])
    to_jib = to_turn + int(numbers[at.TORSION]) + int(numbers[at.DRIVEN])
    to_vertical = to_jib + int(numbers[at.LATERAL])
    breeze = int(numbers[at.WIND_CHANNEL])
    x, _, _ = polynomial(inputs, breeze, t)
    y_, _, _ = polynomial(inputs, breeze + 1, t)
    z, _, _ = polynomial(inputs, breeze + 2, t)
    work[WIND, 0] = x
    work[WIND, 1] = y_
    work[WIND, d - 1] = z
    speed, power = np.sqrt(x * x + y_ * y_ + z * z), 0.0
    for i in range(to_turn):
        force = speed * (x if i < to_y else y_) * vectors[at.EXPOSURE, i]
        work[FORCE, i] += force
        power += force * y[rates + i]
    normal = x * work[head, ROTATION + 1] + y_ * work[head, ROTATION + 4] + z * work[head, ROTATION + 7]
    press, rolling = abs(normal) * normal, 0.0
    for i in range(to_jib, to_vertical):
        work[FORCE, i] += vectors[at.EXPOSURE, i] * press
        power += vectors[at.EXPOSURE, i] * press * y[rates + i]
    for i in range(to_vertical, n):
        rolling -= vectors[at.EXPOSURE, i] * y[i] * press
    side, turning = numbers[at.HEAD_AREA] * press, numbers[at.HEAD_AREA_MOMENT] * press
    work[body, at.PUSH + 1] += side
    work[body, at.TORQUE] += rolling
    work[body, at.TORQUE + 2] += turning
    power += side * work[head, TOP_VELOCITY + 1] + rolling * work[head, SPIN] + turning * work[head, SPIN + 2]
    work[head, at.POWER] += power


@kernel()
def carry_trolley(
    d: int, x: float, xd: float, xdd: float, left: tuple[float, ...], up: tuple[float, ...], numbers: Any, work: Any,
    head: int, body: int,
) -> None:  # fmt: skip
    """Write the motion of the rope's upper end, and add force and inertia of the trolley to the body's row."""
    wx, wy, wz = work[head, SPIN], work[head, SPIN + 1], work[head, SPIN + 2]
    alx, aly, alz = work[head, SPIN_BIAS], work[head, SPIN_BIAS + 1], work[head, SPIN_BIAS + 2]
    r00, r01, r02 = work[head, ROTATION], work[head, ROTATION + 1], work[head, ROTATION + 2]
    r10, r11, r12 = work[head, ROTATION + 3], work[head, ROTATION + 4], work[head, ROTATION + 5]
    r20, r21, r22 = work[head, ROTATION + 6], work[head, ROTATION + 7], work[head, ROTATION + 8]
    dy, dyd, ry, py = left[0], left[1], left[2], left[3]
    dz, dzd, rz, pz = up[0], up[1], up[2], up[3]
    spin, along = wx * wx + wy * wy + wz * wz, wx * x + wy * dy + wz * dz
    bx = aly * dz - alz * dy + wx * along - spin * x + 2.0 * (wy * dzd - wz * dyd) + xdd
    by = alz * x - alx * dz + wy * along - spin * dy + 2.0 * (wz * xd - wx * dzd) + ry
    bz = alx * dy - aly * x + wz * along - spin * dz + 2.0 * (wx * dyd - wy * xd) + rz
    vx = work[head, TOP_VELOCITY] + wy * dz - wz * dy + xd
    vy = work[head, TOP_VELOCITY + 1] + wz * x - wx * dz + dyd
    vz = work[head, TOP_VELOCITY + 2] + wx * dy - wy * x + dzd
    work[VELOCITY, 0] = r00 * vx + r01 * vy + r02 * vz
    work[BIAS, 0] = r00 * bx + r01 * by + r02 * bz
    # In a plane the second axis is the vertical.
    work[VELOCITY, 1] = r10 * vx + r11 * vy + r12 * vz
    work[BIAS, 1] = r10 * bx + r11 * by + r12 * bz
    work[VELOCITY, d - 1] = r20 * vx + r21 * vy + r22 * vz
    work[BIAS, d - 1] = r20 * bx + r21 * by + r22 * bz

    mass, gravity = numbers[at.TROLLEY_MASS], numbers[at.GRAVITY]
    fx, fy, fz = -mass * (bx + gravity * r20), -mass * (by + gravity * r21), -mass * (bz + gravity * r22)
    work[body, at.PULL], work[body, at.PULL + 1], work[body, at.PULL + 2] = fx, fy, fz
    work[body, at.PUSH] += fx
    work[body, at.PUSH + 1] += fy
    work[body, at.PUSH + 2] += fz
    work[body, at.TORQUE] += dy * fz - dz * fy
    work[body, at.TORQUE + 1] += dz * fx - x * fz
    work[body, at.TORQUE + 2] += x * fy - dy * fx
    work[body, at.WEIGHED] += mass
    work[body, at.STATIC] += mass * x
    work[body, at.STATIC + 1] += mass * dy
    work[body, at.STATIC + 2] += mass * dz
    work[body, at.INERTIA] += mass * (dy * dy + dz * dz)
    work[body, at.INERTIA + 1] -= mass * x * dy
    work[body, at.INERTIA + 2] -= mass * x * dz
    work[body, at.INERTIA + 3] += mass * (x * x + dz * dz)
    work[body, at.INERTIA + 4] -= mass * dy * dz
    work[body, at.INERTIA + 5] += mass * (x * x + dy * dy)
    work[body, at.PLACE], work[body, at.PLACE + 1], work[body, at.PLACE + 2] = x, dy, dz
    work[head, at.TROLLEY_RATE] = xd
    work[head, at.PATH] = r00 + r01 * py + r02 * pz
    work[head, at.PATH + 1] = r10 + r11 * py + r12 * pz
    work[head, at.PATH + 2] = r20 + r21 * py + r22 * pz


@kernel(types.void(types.int64, types.float64, _one, _two, _one, _two, _three, _three, _two))
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
) -> None:
    """Fill ``work`` with mass matrix, forces and the suspension point's motion, without the load.

    Parameters
    ----------
    d : int
        Axes of space for the load, vertical last; with 2 the coordinates must leave the crane in its plane.
    t, y, inputs, numbers, vectors, matrices, tables, work
        As in :func:`towercrane.system.rhs_signature`; ``tables`` (cells, jib modes, 8) holds the jib's mode shapes
        as polynomials about the middle of equal cells.
    """
    n = vectors.shape[1]
    rates, head, body = n + d, MASS + n + at.HEAD, MASS + n + at.BODY
    jib = int(numbers[at.TOWER_X] + numbers[at.TOWER_Y] + numbers[at.TORSION] + numbers[at.DRIVEN])
    middle = jib + int(numbers[at.LATERAL])
    move_top(d, t, y, inputs, numbers, vectors, work)

    x, xd, xdd = polynomial(inputs, at.TROLLEY, t)
    cells = tables.shape[0]
    width = numbers[at.JIB_LENGTH] / cells
    cell = min(max(int(x / width), 0), cells - 1)
    xi = x - (cell + 0.5) * width
    left_weight = numbers[at.SELF_GRAVITY] * work[head, ROTATION + 7]
    up_weight = numbers[at.SELF_GRAVITY] * work[head, ROTATION + 8]
    left = bend_jib(
        jib, middle, middle, n, -1.0, left_weight, x, xd, xdd, xi, cell, jib, rates, y, vectors, matrices, tables, work
    )
    up = bend_jib(
        middle, n, jib, middle, 1.0, up_weight, x, xd, xdd, xi, cell, jib, rates, y, vectors, matrices, tables, work
    )
    weigh_head(left, up, numbers, work, head, body)
    power = 0.0
    for i in range(n):
        loss = vectors[at.DAMPING, i] * y[rates + i]
        power -= loss * y[rates + i]
        force = -loss
        for m in range(n):
            force -= matrices[at.STIFFNESS, i, m] * y[m]
        work[FORCE, i] = force + (work[FORCE, i] if i >= jib else 0.0)
    work[head, at.POWER] = power
    if numbers[at.WIND_CHANNEL] >= 0.0:
        press_wind(d, t, y, inputs, numbers, vectors, work)
    carry_trolley(d, x, xd, xdd, left, up, numbers, work, head, body)
    project_head(d, numbers, vectors, matrices, work)
    project_jib(d, numbers, vectors, matrices, work)

"""Compiled equations of the flexible crane in space: tower, slewing head, jib, trolley, and the load on its rope.

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
from towercrane.cranes.drive_kernel import coupling_torque
from towercrane.cranes.head_kernel import ROTATION, SIZE, SPIN, SPIN_BIAS, TOP_VELOCITY, TURN_X, TURN_Y, move_head
from towercrane.payload import (
    ACCELERATION,
    BIAS,
    DIRECTION,
    FORCE,
    HINGE,
    JACOBIAN,
    MASS,
    VELOCITY,
    WIND,
    hang_load,
)
from towercrane.polynomial import polynomial
from towercrane.system import rhs_signature

(TOWER_X, TOWER_Y, TORSION, DRIVEN, LATERAL, VERTICAL, TROLLEY_MASS, GRAVITY, SELF_GRAVITY, SLEWING_MASS,
 STATIC_MOMENT, ROLL, PITCH, YAW, JIB_LENGTH, TILT_LIMIT, LOAD_MASS, DRAG, HINGE_DAMPING,
 SLEWING_CHANNEL, WIND_CHANNEL, SOFT, STIFF, CORNER, DRIVE_DAMPING, FRICTION_TORQUE, FRICTION_RATE,
 HEAD_AREA, HEAD_AREA_MOMENT, NUMBERS) = range(30)  # fmt: skip
"""Entries of ``numbers``, and how many they are. The first six count coordinates. SELF_GRAVITY is zero where the structure's own weight is
left out; a channel is -1 where there is none."""

TIP, SLOPE, TWIST, JIB_MASS, JIB_MOMENT, DAMPING, EXPOSURE, CAP = range(8)
"""Rows of ``vectors``, zero where they do not apply: tower modes at the top, their slopes, twist of the head (1 for
the slewing angle), int m phi and int m x phi of the jib modes, viscous damping, int c phi of tower and jib modes with
the drag c per squared speed, mass added to the coordinate itself where its frequency is capped."""

OWN, STIFFNESS = range(2)
"""Entries of ``matrices``: mass of the tower alone, of the drive, and int m phi_i phi_j of all jib modes, lateral with
vertical too; stiffness."""

TROLLEY, ROPE = range(2)
"""Rows of ``inputs`` that are always there."""

(TENSION, INNER_END, OUTER_END, TILT, INSIDE, OUTSIDE, SLEWING_TORQUE, TROLLEY_FORCE) = range(8)
"""Guards: rope tension [N], way to either end of the jib [m], way to the tilt limit [rad], way to the corner of the
drive's coupling from inside and from outside [rad]. Outputs beside them: torque of the slewing drive [N m] and force
of the trolley's [N]."""

HEAD, SHAPE, ACROSS, ACROSS_RATE = range(4)
"""Rows of scratch after the mass matrix: head; jib modes at the trolley; N q of the other direction, and its rate."""

_TILT, _POWER, _X, _X_RATE, _PATH, _TURN_COLUMN, _TURN_ROW, _TURN_FORCE = (
    SIZE, SIZE + 1, SIZE + 2, SIZE + 3, SIZE + 4, SIZE + 7, SIZE + 10, SIZE + 15,
)  # fmt: skip
WIDTH = SIZE + 16
"""Columns of the scratch array, at least: the head's row also holds tilt, power of the losses, position and rate of
the trolley, its path (3) and motion per slewing (3), and the slewing row of mass (5) and force."""

_one, _two, _three = types.float64[::1], types.float64[:, ::1], types.float64[:, :, ::1]


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
    rates = n + d
    up = d - 1
    to_y = int(numbers[TOWER_X])
    to_turn = to_y + int(numbers[TOWER_Y])
    to_jib = to_turn + int(numbers[TORSION]) + int(numbers[DRIVEN])
    to_vertical = to_jib + int(numbers[LATERAL])
    head, shapes, across, across_rate = MASS + n + HEAD, MASS + n + SHAPE, MASS + n + ACROSS, MASS + n + ACROSS_RATE

    ux, uy, tx, ty, txd, tyd = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    turn, turning, turn_acceleration = 0.0, 0.0, 0.0
    for i in range(to_y):
        ux += vectors[TIP, i] * y[rates + i]
        ty += vectors[SLOPE, i] * y[i]
        tyd += vectors[SLOPE, i] * y[rates + i]
    for i in range(to_y, to_turn):
        uy += vectors[TIP, i] * y[rates + i]
        tx -= vectors[SLOPE, i] * y[i]
        txd -= vectors[SLOPE, i] * y[rates + i]
    slewing = int(numbers[SLEWING_CHANNEL])
    if slewing >= 0 and numbers[DRIVEN] == 0.0:
        turn, turning, turn_acceleration = polynomial(inputs, slewing, t)
    for i in range(to_turn, to_jib):
        turn += vectors[TWIST, i] * y[i]
        turning += vectors[TWIST, i] * y[rates + i]
    move_head(tx, ty, txd, tyd, turn, turning, turn_acceleration, ux, uy, work, head)
    work[head, _TILT] = np.sqrt(tx * tx + ty * ty)
    wx, wy, wz = work[head, SPIN], work[head, SPIN + 1], work[head, SPIN + 2]
    alx, aly, alz = work[head, SPIN_BIAS], work[head, SPIN_BIAS + 1], work[head, SPIN_BIAS + 2]
    r00, r01, r02 = work[head, ROTATION], work[head, ROTATION + 1], work[head, ROTATION + 2]
    r10, r11, r12 = work[head, ROTATION + 3], work[head, ROTATION + 4], work[head, ROTATION + 5]
    r20, r21, r22 = work[head, ROTATION + 6], work[head, ROTATION + 7], work[head, ROTATION + 8]
    spin = wx * wx + wy * wy + wz * wz

    # Jib at the trolley, and sums over its deflected mass.
    x, xd, xdd = polynomial(inputs, TROLLEY, t)
    cells = tables.shape[0]
    width = numbers[JIB_LENGTH] / cells
    cell = min(max(int(x / width), 0), cells - 1)
    xi = x - (cell + 0.5) * width
    weight = numbers[SELF_GRAVITY]
    dy, dyd, ry, py = 0.0, 0.0, 0.0, 0.0  # deflection, its rate, acceleration without q'', slope
    ay, ayd, by, byd, qyy, eyy, qyz, eyz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    dz, dzd, rz, pz = 0.0, 0.0, 0.0, 0.0
    az, azd, bz, bzd, qzz, ezz, ezy = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(to_jib, n):
        shape, first, half_second = 0.0, 0.0, 0.0
        for c in range(tables.shape[2] - 1, -1, -1):
            half_second = half_second * xi + first
            first = first * xi + shape
            shape = shape * xi + tables[cell, i - to_jib, c]
        work[shapes, i] = shape
        q, qd, a, b = y[i], y[rates + i], vectors[JIB_MASS, i], vectors[JIB_MOMENT, i]
        rate = shape * qd + xd * first * q
        extra = 2.0 * xd * first * qd + (xdd * first + 2.0 * xd * xd * half_second) * q
        carried, crossed, crossed_rate = 0.0, 0.0, 0.0
        if i < to_vertical:
            for m in range(to_jib, to_vertical):
                carried += matrices[OWN, i, m] * y[m]
            for m in range(to_vertical, n):
                crossed += matrices[OWN, i, m] * y[m]
                crossed_rate += matrices[OWN, i, m] * y[rates + m]
            dy += shape * q
            dyd += rate
            ry += extra
            py += first * q
            ay += a * q
            ayd += a * qd
            by += b * q
            byd += b * qd
            qyy += carried * q
            eyy += carried * qd
            qyz += crossed * q
            eyz += crossed * qd
            along = wx * b + wy * carried + wz * crossed
            bias = alz * b - alx * crossed + wy * along - spin * carried - 2.0 * wx * crossed_rate
            work[FORCE, i] = -bias - a * weight * r21
        else:
            for m in range(to_jib, to_vertical):
                crossed += matrices[OWN, i, m] * y[m]
                crossed_rate += matrices[OWN, i, m] * y[rates + m]
            for m in range(to_vertical, n):
                carried += matrices[OWN, i, m] * y[m]
            dz += shape * q
            dzd += rate
            rz += extra
            pz += first * q
            az += a * q
            azd += a * qd
            bz += b * q
            bzd += b * qd
            qzz += carried * q
            ezz += carried * qd
            ezy += crossed * qd
            along = wx * b + wy * crossed + wz * carried
            bias = alx * crossed - aly * b + wz * along - spin * carried + 2.0 * wx * crossed_rate
            work[FORCE, i] = -bias - a * weight * r22
        work[across, i] = crossed
        work[across_rate, i] = crossed_rate

    # Force and moment of what turns, without trolley: minus inertia with second derivatives zero, minus weight.
    mass, sx, sy, sz = numbers[SLEWING_MASS], numbers[STATIC_MOMENT], ay, az
    ixx, ixy, ixz = numbers[ROLL] + qyy + qzz, -by, -bz
    iyy, iyz, izz = numbers[PITCH] + qzz, -qyz, numbers[YAW] + qyy
    gx, gy, gz = weight * r20, weight * r21, weight * r22
    along = wx * sx + wy * sy + wz * sz
    fx = -(aly * sz - alz * sy + wx * along - spin * sx + 2.0 * (wy * azd - wz * ayd) + mass * gx)
    fy = -(alz * sx - alx * sz + wy * along - spin * sy - 2.0 * wx * azd + mass * gy)
    fz = -(alx * sy - aly * sx + wz * along - spin * sz + 2.0 * wx * ayd + mass * gz)
    lx, ly, lz = ixx * wx + ixy * wy + ixz * wz, ixy * wx + iyy * wy + iyz * wz, ixz * wx + iyz * wy + izz * wz
    swell = 2.0 * (eyy + ezz)
    mx = ixx * alx + ixy * aly + ixz * alz + wy * lz - wz * ly + sy * gz - sz * gy + swell * wx
    my = ixy * alx + iyy * aly + iyz * alz + wz * lx - wx * lz + sz * gx - sx * gz + swell * wy
    mz = ixz * alx + iyz * aly + izz * alz + wx * ly - wy * lx + sx * gy - sy * gx + swell * wz
    mx = -mx
    my = -my + 2.0 * (byd * wx + eyy * wy + eyz * wz)
    mz = -mz + 2.0 * (bzd * wx + ezy * wy + ezz * wz)

    # Wind across jib and counter-jib, which stand still for it.
    power = 0.0
    breeze = int(numbers[WIND_CHANNEL])
    wind_x, wind_y, wind_speed, press = 0.0, 0.0, 0.0, 0.0
    if breeze >= 0:
        wind_x, _, _ = polynomial(inputs, breeze, t)
        wind_y, _, _ = polynomial(inputs, breeze + 1, t)
        wind_z, _, _ = polynomial(inputs, breeze + 2, t)
        work[WIND, 0] = wind_x
        work[WIND, 1] = wind_y
        work[WIND, up] = wind_z
        wind_speed = np.sqrt(wind_x * wind_x + wind_y * wind_y + wind_z * wind_z)
        normal = wind_x * r01 + wind_y * r11 + wind_z * r21
        press = abs(normal) * normal
        rolling = 0.0
        for i in range(to_jib, to_vertical):
            work[FORCE, i] += vectors[EXPOSURE, i] * press
            power += vectors[EXPOSURE, i] * press * y[rates + i]
        for i in range(to_vertical, n):
            rolling += vectors[EXPOSURE, i] * y[i]
        side = numbers[HEAD_AREA] * press
        fy += side
        mx -= rolling * press
        mz += numbers[HEAD_AREA_MOMENT] * press
        power += side * work[head, TOP_VELOCITY + 1] - rolling * press * wx
        power += numbers[HEAD_AREA_MOMENT] * press * wz

    # Trolley: motion of the point that the rope hangs from, then its force, moment and inertia.
    along = wx * x + wy * dy + wz * dz
    bx = aly * dz - alz * dy + wx * along - spin * x + 2.0 * (wy * dzd - wz * dyd) + xdd
    b_y = alz * x - alx * dz + wy * along - spin * dy + 2.0 * (wz * xd - wx * dzd) + ry
    b_z = alx * dy - aly * x + wz * along - spin * dz + 2.0 * (wx * dyd - wy * xd) + rz
    vx = work[head, TOP_VELOCITY] + wy * dz - wz * dy + xd
    vy = work[head, TOP_VELOCITY + 1] + wz * x - wx * dz + dyd
    vz = work[head, TOP_VELOCITY + 2] + wx * dy - wy * x + dzd
    work[VELOCITY, 0] = r00 * vx + r01 * vy + r02 * vz
    work[BIAS, 0] = r00 * bx + r01 * b_y + r02 * b_z
    if d == 3:
        work[VELOCITY, 1] = r10 * vx + r11 * vy + r12 * vz
        work[BIAS, 1] = r10 * bx + r11 * b_y + r12 * b_z
    work[VELOCITY, up] = r20 * vx + r21 * vy + r22 * vz
    work[BIAS, up] = r20 * bx + r21 * b_y + r22 * b_z

    trolley, gravity = numbers[TROLLEY_MASS], numbers[GRAVITY]
    px, p_y, p_z = -trolley * (bx + gravity * r20), -trolley * (b_y + gravity * r21), -trolley * (b_z + gravity * r22)
    fx += px
    fy += p_y
    fz += p_z
    mx += dy * p_z - dz * p_y
    my += dz * px - x * p_z
    mz += x * p_y - dy * px
    mass += trolley
    sx += trolley * x
    sy += trolley * dy
    sz += trolley * dz
    ixx += trolley * (dy * dy + dz * dz)
    ixy -= trolley * x * dy
    ixz -= trolley * x * dz
    iyy += trolley * (x * x + dz * dz)
    iyz -= trolley * dy * dz
    izz += trolley * (x * x + dy * dy)

    # Columns of the head's rotation: 1 and 2 by tilting, e3 by slewing; their moments of inertia and of mass.
    j1x, j1y, j1z = work[head, TURN_X], work[head, TURN_X + 1], work[head, TURN_X + 2]
    j2x, j2y, j2z = work[head, TURN_Y], work[head, TURN_Y + 1], work[head, TURN_Y + 2]
    c1x, c1y, c1z = sy * r02 - sz * r01, sz * r00 - sx * r02, sx * r01 - sy * r00
    c2x, c2y, c2z = sy * r12 - sz * r11, sz * r10 - sx * r12, sx * r11 - sy * r10
    l1x, l1y, l1z = (ixx * j1x + ixy * j1y + ixz * j1z, ixy * j1x + iyy * j1y + iyz * j1z,
                     ixz * j1x + iyz * j1y + izz * j1z)  # fmt: skip
    l2x, l2y, l2z = (ixx * j2x + ixy * j2y + ixz * j2z, ixy * j2x + iyy * j2y + iyz * j2z,
                     ixz * j2x + iyz * j2y + izz * j2z)  # fmt: skip
    h_x1, h_x2 = j1x * c1x + j1y * c1y + j1z * c1z, j2x * c1x + j2y * c1y + j2z * c1z
    h_y1, h_y2 = j1x * c2x + j1y * c2y + j1z * c2z, j2x * c2x + j2y * c2y + j2z * c2z
    h_11, h_12 = j1x * l1x + j1y * l1y + j1z * l1z, j1x * l2x + j1y * l2y + j1z * l2z
    h_22 = j2x * l2x + j2y * l2y + j2z * l2z
    force_x, force_y = r00 * fx + r01 * fy + r02 * fz, r10 * fx + r11 * fy + r12 * fz
    moment_1, moment_2 = j1x * mx + j1y * my + j1z * mz, j2x * mx + j2y * my + j2z * mz
    # Motion of the suspension point with the two tilts and with slewing, in fixed axes.
    vx, vy, vz = j1y * dz - j1z * dy, j1z * x - j1x * dz, j1x * dy - j1y * x
    k1x, k1y, k1z = r00 * vx + r01 * vy + r02 * vz, r10 * vx + r11 * vy + r12 * vz, r20 * vx + r21 * vy + r22 * vz
    vx, vy, vz = j2y * dz - j2z * dy, j2z * x - j2x * dz, j2x * dy - j2y * x
    k2x, k2y, k2z = r00 * vx + r01 * vy + r02 * vz, r10 * vx + r11 * vy + r12 * vz, r20 * vx + r21 * vy + r22 * vz
    k3x, k3y, k3z = r01 * x - r00 * dy, r11 * x - r10 * dy, r21 * x - r20 * dy

    for i in range(to_y):
        ui, gi = vectors[TIP, i], vectors[SLOPE, i]
        work[FORCE, i] = ui * force_x + gi * moment_2 + wind_speed * wind_x * vectors[EXPOSURE, i]
        power += wind_speed * wind_x * vectors[EXPOSURE, i] * y[rates + i]
        work[JACOBIAN, i] = ui + gi * k2x
        if d == 3:
            work[JACOBIAN + 1, i] = gi * k2y
        work[JACOBIAN + up, i] = gi * k2z
        lean, tip = ui * h_x2 + gi * h_22, ui * mass + gi * h_x2
        for m in range(i + 1):
            work[MASS + i, m] = matrices[OWN, i, m] + tip * vectors[TIP, m] + lean * vectors[SLOPE, m]
    for i in range(to_y, to_turn):
        ui, gi = vectors[TIP, i], -vectors[SLOPE, i]
        work[FORCE, i] = ui * force_y + gi * moment_1 + wind_speed * wind_y * vectors[EXPOSURE, i]
        power += wind_speed * wind_y * vectors[EXPOSURE, i] * y[rates + i]
        work[JACOBIAN, i] = gi * k1x
        if d == 3:
            work[JACOBIAN + 1, i] = ui + gi * k1y
        work[JACOBIAN + up, i] = gi * k1z
        lean, tip = ui * h_y2 + gi * h_12, gi * h_x1
        for m in range(to_y):
            work[MASS + i, m] = tip * vectors[TIP, m] + lean * vectors[SLOPE, m]
        lean, tip = ui * h_y1 + gi * h_11, ui * mass + gi * h_y1
        for m in range(to_y, i + 1):
            work[MASS + i, m] = matrices[OWN, i, m] + tip * vectors[TIP, m] - lean * vectors[SLOPE, m]
    for i in range(to_turn, to_jib):
        ti = vectors[TWIST, i]
        work[FORCE, i] = ti * mz
        work[JACOBIAN, i] = ti * k3x
        if d == 3:
            work[JACOBIAN + 1, i] = ti * k3y
        work[JACOBIAN + up, i] = ti * k3z
        for m in range(to_y):
            work[MASS + i, m] = ti * (c1z * vectors[TIP, m] + l2z * vectors[SLOPE, m])
        for m in range(to_y, to_turn):
            work[MASS + i, m] = ti * (c2z * vectors[TIP, m] - l1z * vectors[SLOPE, m])
        for m in range(to_turn, i + 1):
            work[MASS + i, m] = matrices[OWN, i, m] + ti * izz * vectors[TWIST, m]
    for i in range(to_jib, n):
        shape = work[shapes, i]
        a, b = vectors[JIB_MASS, i] + trolley * shape, vectors[JIB_MOMENT, i] + trolley * shape * x
        first = to_jib
        if i < to_vertical:
            crossed = work[across, i] + trolley * shape * dz
            tip_x, tip_y = a * r01, a * r11
            lean_1, lean_2, twist = b * j1z - crossed * j1x, b * j2z - crossed * j2x, b
            work[FORCE, i] += shape * p_y
            ex, ey, ez = r01, r11, r21
        else:
            crossed = work[across, i] + trolley * shape * dy
            tip_x, tip_y = a * r02, a * r12
            lean_1, lean_2, twist = crossed * j1x - b * j1y, crossed * j2x - b * j2y, 0.0
            work[FORCE, i] += shape * p_z
            ex, ey, ez = r02, r12, r22
            first = to_vertical
            for m in range(to_jib, to_vertical):
                work[MASS + i, m] = 0.0
        work[JACOBIAN, i] = shape * ex
        if d == 3:
            work[JACOBIAN + 1, i] = shape * ey
        work[JACOBIAN + up, i] = shape * ez
        for m in range(to_y):
            work[MASS + i, m] = tip_x * vectors[TIP, m] + lean_2 * vectors[SLOPE, m]
        for m in range(to_y, to_turn):
            work[MASS + i, m] = tip_y * vectors[TIP, m] - lean_1 * vectors[SLOPE, m]
        for m in range(to_turn, to_jib):
            work[MASS + i, m] = twist * vectors[TWIST, m]
        for m in range(first, i + 1):
            work[MASS + i, m] = matrices[OWN, i, m] + trolley * shape * work[shapes, m]

    for i in range(n):
        work[MASS + i, i] += vectors[CAP, i]
        loss = vectors[DAMPING, i] * y[rates + i]
        power -= loss * y[rates + i]
        elastic = loss
        for m in range(n):
            elastic += matrices[STIFFNESS, i, m] * y[m]
        work[FORCE, i] -= elastic
    work[head, _POWER] = power
    work[head, _X] = x
    work[head, _X_RATE] = xd
    work[head, _PATH] = r00 + r01 * py + r02 * pz
    work[head, _PATH + 1] = r10 + r11 * py + r12 * pz
    work[head, _PATH + 2] = r20 + r21 * py + r22 * pz
    work[head, _TURN_COLUMN] = k3x
    work[head, _TURN_COLUMN + 1] = k3y
    work[head, _TURN_COLUMN + 2] = k3z
    work[head, _TURN_ROW] = c1z
    work[head, _TURN_ROW + 1] = c2z
    work[head, _TURN_ROW + 2] = l1z
    work[head, _TURN_ROW + 3] = l2z
    work[head, _TURN_ROW + 4] = izz
    work[head, _TURN_FORCE] = mz


@kernel(types.float64(types.float64, _one, _two, _one, _two))
def drive(t: float, y: Any, inputs: Any, numbers: Any, work: Any) -> float:
    """Add the drive's torque to the slewing coordinate's force and its power to the losses'; returns the torque."""
    rates = (y.size - 1) // 2
    at = int(numbers[TOWER_X] + numbers[TOWER_Y] + numbers[TORSION])
    n = at + 1 + int(numbers[LATERAL] + numbers[VERTICAL])
    shaft, shaft_rate, _ = polynomial(inputs, int(numbers[SLEWING_CHANNEL]), t)
    twist, slip = y[at] - shaft, y[rates + at] - shaft_rate
    torque = -coupling_torque(twist, numbers[SOFT], numbers[STIFF], numbers[CORNER]) - numbers[DRIVE_DAMPING] * slip
    friction = -numbers[FRICTION_TORQUE] * np.tanh(y[rates + at] / numbers[FRICTION_RATE])
    work[FORCE, at] += torque + friction
    # What the shaft puts in is stored in the coupling, turns the head or is lost between them.
    power = torque * shaft_rate - numbers[DRIVE_DAMPING] * slip * slip + friction * y[rates + at]
    work[MASS + n + HEAD, _POWER] += power
    return torque


@kernel(types.float64(types.int64, types.float64, _one, _one, _two, _two))
def holding_torque(d: int, tension: float, dy: Any, numbers: Any, vectors: Any, work: Any) -> float:
    """Torque that the prescribed slewing takes: the equation of the coordinate that is not free."""
    n = vectors.shape[1]
    rates = n + d
    to_y = int(numbers[TOWER_X])
    to_turn = to_y + int(numbers[TOWER_Y])
    to_jib = to_turn + int(numbers[TORSION]) + int(numbers[DRIVEN])
    to_vertical = to_jib + int(numbers[LATERAL])
    head, shapes = MASS + n + HEAD, MASS + n + SHAPE
    torque = -work[head, _TURN_FORCE]
    for i in range(to_y):
        row = work[head, _TURN_ROW] * vectors[TIP, i] + work[head, _TURN_ROW + 3] * vectors[SLOPE, i]
        torque += row * dy[rates + i]
    for i in range(to_y, to_turn):
        row = work[head, _TURN_ROW + 1] * vectors[TIP, i] - work[head, _TURN_ROW + 2] * vectors[SLOPE, i]
        torque += row * dy[rates + i]
    for i in range(to_turn, to_jib):
        torque += work[head, _TURN_ROW + 4] * vectors[TWIST, i] * dy[rates + i]
    hung = numbers[TROLLEY_MASS] * work[head, _X]
    for i in range(to_jib, to_vertical):
        torque += (vectors[JIB_MOMENT, i] + hung * work[shapes, i]) * dy[rates + i]
    for k in range(d):
        axis = k if k < d - 1 else 2
        torque -= work[head, _TURN_COLUMN + axis] * (tension * work[DIRECTION, k] - work[HINGE, k])
    return torque


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
    """Right-hand side of the flexible crane."""
    n = vectors.shape[1]
    d = (y.size - 1) // 2 - n
    head = MASS + n + HEAD
    structure(d, t, y, inputs, numbers, vectors, matrices, tables, work)
    driven = numbers[DRIVEN] > 0.0
    torque, beyond = 0.0, 0.0
    if driven:
        torque = drive(t, y, inputs, numbers, work)
    length, rate, acceleration = polynomial(inputs, ROPE, t)
    gravity = numbers[GRAVITY]
    tension = hang_load(
        y, dy, n, d, length, rate, acceleration,
        numbers[LOAD_MASS], gravity, numbers[DRAG], numbers[HINGE_DAMPING], 0.0, 0.0, work,
    )  # fmt: skip
    power = work[head, _POWER]
    slewing = int(numbers[SLEWING_CHANNEL])
    if driven:
        shaft, _, _ = polynomial(inputs, slewing, t)
        at = int(numbers[TOWER_X] + numbers[TOWER_Y] + numbers[TORSION])
        beyond = abs(y[at] - shaft) - numbers[CORNER]
    elif d == 3:
        torque = holding_torque(d, tension, dy, numbers, vectors, work)
        if slewing >= 0:
            _, turning, _ = polynomial(inputs, slewing, t)
            power += torque * turning
    # The trolley's drive acts along the deflected jib.
    force = 0.0
    for k in range(d):
        axis = k if k < d - 1 else 2
        pull = numbers[TROLLEY_MASS] * work[ACCELERATION, k] - tension * work[DIRECTION, k] + work[HINGE, k]
        if axis == 2:
            pull += numbers[TROLLEY_MASS] * gravity
        force += work[head, _PATH + axis] * pull
    dy[y.size - 1] += power + force * work[head, _X_RATE]

    guards[TENSION] = tension
    guards[INNER_END] = work[head, _X]
    guards[OUTER_END] = numbers[JIB_LENGTH] - work[head, _X]
    guards[TILT] = numbers[TILT_LIMIT] - work[head, _TILT]
    guards[INSIDE] = -beyond
    guards[OUTSIDE] = beyond
    guards[SLEWING_TORQUE] = torque
    guards[TROLLEY_FORCE] = force

"""Compiled structure of the flexible crane in space: tower, slewing head, jib and trolley, without the load.

Coordinates are amplitudes of tower modes along the fixed axes x and y, of torsion modes, the slewing angle where a
drive turns it, and amplitudes of jib modes to the left and up; any of them may be absent. A planar scene has the
x modes of the tower and the vertical modes of the jib. Everything that hangs on the tower's top is seen in the
head's axes of :mod:`towercrane.cranes.tower.kernels.head`: a point of the jib is at s = (x, W_y(x), W_z(x)) there,
and

    a = R^T u'' + w' x s + w x (w x s) + 2 w x s' + s''

is its acceleration. Summed over the mass of the jib this leaves products of the mass sums of
:mod:`towercrane.cranes.tower.modes.mass_sums` with the coordinates, nothing to be integrated. Gao et al. (2023) set
the coordinates up; the equations are derived anew.
"""

from __future__ import annotations

from operator import add
from typing import Any

import numpy as np
from numba import types

from modal.compiler.compiled import kernel
from modal.compiler.traced import traced
from towercrane.cranes.tower.kernels import layout as at
from towercrane.cranes.tower.kernels.head import Head, Vector, move_head, tilt_functions
from towercrane.cranes.tower.kernels.jib import bend_jib
from towercrane.cranes.tower.kernels.projection import Body, SlewingRow, dot, project_head, project_jib
from towercrane.kernels.choices import nth
from towercrane.kernels.payload import BIAS, FORCE, VELOCITY, WIND
from towercrane.kernels.polynomial import polynomial
from towercrane.simulation.system import rhs_signature

_t, _y, _, *_constants, _ = rhs_signature().args
"""Arguments of a right-hand side but what it writes."""


@traced
def add_motion(motion: tuple[float, ...], i: int, rate: int, y: Any, vectors: Any) -> tuple[float, ...]:
    """Tilt (2) and turn of the head, velocity of the tower's top (2) and rates of tilt (2) and turn, with the part of
    one more coordinate."""
    q, qd = y[i], y[rate]
    weights = tuple(vectors[motion, i] for motion in range(at.MOTIONS))
    added = (*(weight * q for weight in weights[at.TILT_X :]), *(weight * qd for weight in weights))
    return tuple(map(add, motion, added))


@kernel(inline=True)
def move_top(d: int, t: float, y: Any, inputs: Any, numbers: Any, vectors: Any) -> tuple[Head, float]:
    """Head as the coordinates of tower and slewing move it, and its tilt [rad]."""
    rates, driven, jib = vectors.shape[1] + d, int(numbers[at.DRIVEN]), int(numbers[at.LATERAL])
    motion = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    for i in range(jib):
        motion = add_motion(motion, i, rates + i, y, vectors)
    tx, ty, turn, ux, uy, txd, tyd, turning = motion
    turn_acceleration = 0.0
    slewing = int(numbers[at.SLEWING_CHANNEL]) >= 0 and driven == jib
    if slewing:
        angle, rate, turn_acceleration = polynomial(inputs, at.SLEWING, t)
        turn += angle
        turning += rate
    c, s = 1.0, 0.0
    if slewing or int(numbers[at.TORSION]) < jib:
        c, s = np.cos(turn), np.sin(turn)
    square = tx * tx + ty * ty
    head = move_head((tx, ty, txd, tyd), tilt_functions(square), c, s, turning, turn_acceleration, ux, uy)
    return head, np.sqrt(square)


@traced
def weigh_head(head: Head, left: tuple[float, ...], up: tuple[float, ...], numbers: Any) -> Body:
    """Mass, moments, force and moment of what turns, without trolley.

    The force is minus the inertia with second derivatives zero, minus the weight. ``left`` and ``up`` are the sums
    over the jib of :func:`towercrane.cranes.tower.kernels.jib.bend_jib`.
    """
    wx, wy, wz = head[3]
    alx, aly, alz = head[4]
    spin, weight = wx * wx + wy * wy + wz * wz, numbers[at.SELF_GRAVITY]
    gx, gy, gz = weight * head[0][6], weight * head[0][7], weight * head[0][8]
    _, _, _, _, sy, ayd, by, byd, qyy, eyy, qyz, eyz = left
    _, _, _, _, sz, azd, bz, bzd, qzz, ezz, _, ezy = up
    mass, sx = numbers[at.SLEWING_MASS], numbers[at.STATIC_MOMENT]
    ixx, ixy, ixz = numbers[at.ROLL] + qyy + qzz, -by, -bz
    iyy, iyz, izz = numbers[at.PITCH] + qzz, -qyz, numbers[at.YAW] + qyy
    along = wx * sx + wy * sy + wz * sz
    fx = -(aly * sz - alz * sy + wx * along - spin * sx + 2.0 * (wy * azd - wz * ayd) + mass * gx)
    fy = -(alz * sx - alx * sz + wy * along - spin * sy - 2.0 * wx * azd + mass * gy)
    fz = -(alx * sy - aly * sx + wz * along - spin * sz + 2.0 * wx * ayd + mass * gz)
    lx, ly, lz = ixx * wx + ixy * wy + ixz * wz, ixy * wx + iyy * wy + iyz * wz, ixz * wx + iyz * wy + izz * wz
    mx = ixx * alx + ixy * aly + ixz * alz + wy * lz - wz * ly + sy * gz - sz * gy
    my = ixy * alx + iyy * aly + iyz * alz + wz * lx - wx * lz + sz * gx - sx * gz
    mz = ixz * alx + iyz * aly + izz * alz + wx * ly - wy * lx + sx * gy - sy * gx
    # Coriolis moment 2 sum m s x (w x s').
    mx += 2.0 * (eyy + ezz) * wx
    my += 2.0 * ((eyy + ezz) * wy - byd * wx - eyy * wy - eyz * wz)
    mz += 2.0 * ((eyy + ezz) * wz - bzd * wx - ezy * wy - ezz * wz)
    return mass, (sx, sy, sz), (ixx, ixy, ixz, iyy, iyz, izz), (fx, fy, fz), (-mx, -my, -mz)


@traced
def blow(vertical: int, wind: Vector, head: Head, work: Any) -> tuple[float, float]:
    """Write the wind for the load; returns its squared speed, and its speed square to the jib."""
    rotation = head[0]
    work[WIND, 0] = wind[0]
    # In a plane the second axis is the vertical.
    work[WIND, 1] = wind[1]
    work[WIND, vertical] = wind[2]
    return dot(wind, wind), dot(wind, (rotation[1], rotation[4], rotation[7]))


@traced
def push(i: int, rate: int, pressure: float, y: Any, vectors: Any, work: Any) -> float:
    """Add the wind's force on one mode; returns its power."""
    force = pressure * vectors[at.EXPOSURE, i]
    work[FORCE, i] = work[FORCE, i] + force
    return force * y[rate]


@traced
def press_head(
    press: float, rolling: float, power: float, head: Head, numbers: Any
) -> tuple[float, float, float, float]:
    """Force of the wind on the head along e2, its moments about e1 and e3, and power with that of the modes."""
    side, turning = numbers[at.HEAD_AREA] * press, numbers[at.HEAD_AREA_MOMENT] * press
    return side, rolling, turning, power + (side * head[5][1] + rolling * head[3][0] + turning * head[3][2])


@kernel(inline=True)
def press_wind(
    d: int, t: float, y: Any, head: Head, inputs: Any, numbers: Any, vectors: Any, work: Any
) -> tuple[float, float, float, float]:
    """Add the wind's pressure on tower and jib modes, all of which stand still for it.

    Returns
    -------
    tuple of float
        Force on the head along e2, moments on it about e1 and e3, and power.
    """
    n = vectors.shape[1]
    rates = n + d
    to_y, to_turn, to_jib = int(numbers[at.ALONG_Y]), int(numbers[at.TORSION]), int(numbers[at.LATERAL])
    to_vertical = int(numbers[at.VERTICAL])
    breeze = int(numbers[at.WIND_CHANNEL])
    east, north = polynomial(inputs, breeze, t)[0], polynomial(inputs, breeze + 1, t)[0]
    c, s = numbers[at.PLANE_COSINE], numbers[at.PLANE_SINE]
    wind = (c * east + s * north, c * north - s * east, polynomial(inputs, breeze + 2, t)[0])
    square, normal = blow(d - 1, wind, head, work)
    speed, press = np.sqrt(square), abs(normal) * normal
    power, rolling = 0.0, 0.0
    for i in range(to_turn):
        power += push(i, rates + i, speed * (wind[0] if i < to_y else wind[1]), y, vectors, work)
    for i in range(to_jib, to_vertical):
        power += push(i, rates + i, press, y, vectors, work)
    for i in range(to_vertical, n):
        rolling -= vectors[at.EXPOSURE, i] * y[i] * press
    return press_head(press, rolling, power, head, numbers)


@traced
def carry_trolley(
    vertical: int, head: Head, x: float, xd: float, xdd: float, left: tuple[float, ...], up: tuple[float, ...],
    trolley: float, gravity: float, work: Any,
) -> Vector:  # fmt: skip
    """Write the motion of the rope's upper end; returns the force that the trolley puts on the jib."""
    r00, r01, r02, r10, r11, r12, r20, r21, r22 = head[0]
    wx, wy, wz = head[3]
    alx, aly, alz = head[4]
    dy, dyd, ry = left[0], left[1], left[2]
    dz, dzd, rz = up[0], up[1], up[2]
    spin, along = wx * wx + wy * wy + wz * wz, wx * x + wy * dy + wz * dz
    bx = aly * dz - alz * dy + wx * along - spin * x + 2.0 * (wy * dzd - wz * dyd) + xdd
    by = alz * x - alx * dz + wy * along - spin * dy + 2.0 * (wz * xd - wx * dzd) + ry
    bz = alx * dy - aly * x + wz * along - spin * dz + 2.0 * (wx * dyd - wy * xd) + rz
    vx, vy, vz = (
        head[5][0] + wy * dz - wz * dy + xd,
        head[5][1] + wz * x - wx * dz + dyd,
        head[5][2] + wx * dy - wy * x + dzd,
    )
    work[VELOCITY, 0] = r00 * vx + r01 * vy + r02 * vz
    work[BIAS, 0] = r00 * bx + r01 * by + r02 * bz
    # In a plane the second axis is the vertical.
    work[VELOCITY, 1] = r10 * vx + r11 * vy + r12 * vz
    work[BIAS, 1] = r10 * bx + r11 * by + r12 * bz
    work[VELOCITY, vertical] = r20 * vx + r21 * vy + r22 * vz
    work[BIAS, vertical] = r20 * bx + r21 * by + r22 * bz
    return -trolley * (bx + gravity * r20), -trolley * (by + gravity * r21), -trolley * (bz + gravity * r22)


@traced
def with_trolley(body: Body, mass: float, place: Vector, pull: Vector) -> Body:
    """What turns, with a trolley of this mass at this place and this force on it."""
    own, (sx, sy, sz), (ixx, ixy, ixz, iyy, iyz, izz), (fx, fy, fz), (mx, my, mz) = body
    x, y, z = place
    px, py, pz = pull
    first = (sx + mass * x, sy + mass * y, sz + mass * z)
    inertia = (ixx + mass * (y * y + z * z), ixy - mass * x * y, ixz - mass * x * z, iyy + mass * (x * x + z * z),
               iyz - mass * y * z, izz + mass * (x * x + y * y))  # fmt: skip
    moment = (mx + y * pz - z * py, my + z * px - x * pz, mz + x * py - y * px)
    return own + mass, first, inertia, (fx + px, fy + py, fz + pz), moment


@traced
def path_of(rotation: tuple[float, ...], left: float, up: float) -> Vector:
    """Direction of the trolley's path, per way along the jib, from the jib's slopes."""
    return (
        rotation[0] + rotation[1] * left + rotation[2] * up,
        rotation[3] + rotation[4] * left + rotation[5] * up,
        rotation[6] + rotation[7] * left + rotation[8] * up,
    )


@kernel(python_entry=(types.int64, _t, _y, *_constants))
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
) -> tuple[float, float, float, float, Vector, SlewingRow]:
    """Fill ``work`` with mass matrix, forces and the suspension point's motion, without the load.

    Parameters
    ----------
    d : int
        Axes of space for the load, vertical last; with 2 the coordinates must leave the crane in its plane.
    t, y, inputs, numbers, vectors, matrices, tables, work
        As in :func:`towercrane.simulation.system.rhs_signature`; ``tables`` (cells, jib modes, 8) holds the jib's
        mode shapes as polynomials about the middle of equal cells.

    Returns
    -------
    tuple
        Trolley position and speed [m, m/s]; tilt [rad]; power of damping and wind [W]; direction of the trolley's
        path per way along the jib; what belongs to the slewing.
    """
    n = vectors.shape[1]
    rates = n + d
    jib, middle = int(numbers[at.LATERAL]), int(numbers[at.VERTICAL])
    head, tilt = move_top(d, t, y, inputs, numbers, vectors)
    rotation = head[0]

    x, xd, xdd = polynomial(inputs, at.TROLLEY, t)
    cells = tables.shape[0]
    width = numbers[at.JIB_LENGTH] / cells
    cell = nth(x / width, cells)
    xi, weight = x - (cell + 0.5) * width, numbers[at.SELF_GRAVITY]
    (wx, wy, wz), (roll, pitch, turn) = head[3], head[4]
    left = bend_jib(
        jib, middle, middle, n, -1.0, (wx, wy, wz), (roll, turn), weight * rotation[7], xd, xdd, xi, cell, jib, rates,
        y, vectors, matrices, tables, work,
    )  # fmt: skip
    up = bend_jib(
        middle, n, jib, middle, 1.0, (wx, wz, wy), (roll, -pitch), weight * rotation[8], xd, xdd, xi, cell, jib,
        rates, y, vectors, matrices, tables, work,
    )  # fmt: skip
    power = 0.0
    for i in range(n):
        loss = vectors[at.DAMPING, i] * y[rates + i]
        power -= loss * y[rates + i]
        force = work[FORCE, i] - loss if i >= jib else -loss
        for m in range(n):
            force -= matrices[at.STIFFNESS, i, m] * y[m]
        work[FORCE, i] = force
    trolley, place = numbers[at.TROLLEY_MASS], (x, left[0], up[0])
    pull = carry_trolley(d - 1, head, x, xd, xdd, left, up, trolley, numbers[at.GRAVITY], work)
    mass, first, inertia, push, moment = with_trolley(weigh_head(head, left, up, numbers), trolley, place, pull)
    if int(numbers[at.WIND_CHANNEL]) >= 0:
        side, rolling, turning, wind_power = press_wind(d, t, y, head, inputs, numbers, vectors, work)
        push = (push[0], push[1] + side, push[2])
        moment = (moment[0] + rolling, moment[1], moment[2] + turning)
        power += wind_power
    body = (mass, first, inertia, push, moment)
    slewing = project_head(d, head, body, place, numbers, vectors, matrices, work)
    project_jib(d, head, pull, place, numbers, vectors, matrices, work)
    return x, xd, tilt, power, path_of(rotation, left[3], up[3]), slewing

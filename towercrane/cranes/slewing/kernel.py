"""Compiled structure of lumped cranes: point masses on chains of turned arms, springs, a drive and friction.

The horizontal position of a point is a sum of links, each an arm that turns about the vertical with one of the
coordinates: in complex notation W = sum_l exp(i phi_l) (a_l + i b_l) with a_l and b_l linear in the coordinates. Its
height is linear in them. With e = exp(i phi) a link r = a + i b gives the columns e dr/dq and i e r, and the bias
acceleration e (2 i phi' r' - phi'^2 r). Marinovic, Sprecic and Jerman (2012), Eq. 2-13, are of this kind.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import types

from modal.compiler.compiled import kernel
from towercrane.cranes.tower.kernels.drive import coupling_torque
from towercrane.kernels.choices import below, choose
from towercrane.kernels.payload import BIAS, DIRECTION, FORCE, HINGE, JACOBIAN, MASS, VELOCITY, hang_load
from towercrane.kernels.polynomial import polynomial
from towercrane.simulation.system import rhs_signature

(GRAVITY, LOAD_MASS, DRAG, HINGE_DAMPING, ROPE_STIFFNESS, ROPE_LOSS, LINKS, POINTS, SUSPENSION, DRIVEN,
 SOFT, STIFF, CORNER, DRIVE_DAMPING, FRICTION_LAW, FRICTION_TORQUE, FRICTION_RATE,
 FRICTION_STATE) = range(18)  # fmt: skip
"""Entries of ``numbers``. DRIVEN is the coordinate that drive and friction act on."""

NO_FRICTION, TANH, STICK_SLIP = 0.0, 1.0, 2.0
"""Friction laws: none, regularised, set-valued."""

KNOWN = (LINKS, POINTS, SUSPENSION, DRIVEN, FRICTION_LAW)
"""Entries of ``numbers`` that the equations count and choose with."""

SLIP_BACK, STICK, SLIP_AHEAD, BY_RATE = -1.0, 0.0, 1.0, 2.0
"""States of set-valued friction; BY_RATE reads it off the rate, which is exactly zero while it sticks."""

INERTIA, STEADY_FORCE = range(2)
"""Rows of ``vectors``."""

STIFFNESS, DAMPING = range(2)
"""Entries of ``matrices``."""

AHEAD, ACROSS, OWNER = range(3)
"""Rows of a link in ``tables``: a and b with their constants last; its point and its angle (-1: fixed axes)."""

HEIGHT, PROPERTIES = range(2)
"""Rows of a point in ``tables``, after the links: height with its constant last; mass [kg] and drag per squared speed
along the arm of its last link, across it and up [kg/m]."""

SHAFT, ROPE = range(2)
"""Rows of ``inputs``."""

TENSION, INSIDE, OUTSIDE, SLIDING, HOLDING, NEEDED = range(6)
"""Guards: rope tension [N]; way to the drive's corner from inside and from outside [rad]; rate in the direction of
slip [rad/s]; torque that friction can still take, and the torque that holds the coordinate at rest [N m]."""

_one, _two, _three = types.float64[::1], types.float64[:, ::1], types.float64[:, :, ::1]


@kernel()
def point_motion(p: int, y: Any, numbers: Any, tables: Any, n: int, rates: int, work: Any, jacobian: int) -> float:
    """Velocity, bias acceleration and Jacobian of a point into ``work``; returns the angle of its last link's arm."""
    links = int(numbers[LINKS])
    for k in range(3):
        work[VELOCITY, k] = 0.0
        work[BIAS, k] = 0.0
        for i in range(n):
            work[jacobian + k, i] = 0.0
    angle = 0.0
    for link in range(links):
        if int(tables[link, OWNER, 0]) != p:
            continue
        turned = int(tables[link, OWNER, 1])
        angle, turning = 0.0, 0.0
        if turned >= 0:
            angle, turning = y[turned], y[rates + turned]
        c, s = np.cos(angle), np.sin(angle)
        a, b = tables[link, AHEAD, n], tables[link, ACROSS, n]
        ad, bd = 0.0, 0.0
        for i in range(n):
            ai, bi = tables[link, AHEAD, i], tables[link, ACROSS, i]
            if ai != 0.0 or bi != 0.0:
                a += ai * y[i]
                b += bi * y[i]
                ad += ai * y[rates + i]
                bd += bi * y[rates + i]
                work[jacobian, i] += c * ai - s * bi
                work[jacobian + 1, i] += s * ai + c * bi
        if turned >= 0:
            work[jacobian, turned] += -s * a - c * b
            work[jacobian + 1, turned] += c * a - s * b
        along = -2.0 * turning * bd - turning * turning * a
        across = 2.0 * turning * ad - turning * turning * b
        work[BIAS, 0] += c * along - s * across
        work[BIAS, 1] += s * along + c * across
        vx, vy = ad - turning * b, bd + turning * a
        work[VELOCITY, 0] += c * vx - s * vy
        work[VELOCITY, 1] += s * vx + c * vy
    for i in range(n):
        h = tables[links + p, HEIGHT, i]
        work[jacobian + 2, i] = h
        work[VELOCITY, 2] += h * y[rates + i]
    return angle


@kernel(types.float64(types.float64, _one, _two, _one, _two, _three, _three, _two))
def structure(
    t: float, y: Any, inputs: Any, numbers: Any, vectors: Any, matrices: Any, tables: Any, work: Any
) -> float:
    """Fill ``work`` with mass matrix, forces and the suspension point's motion, without the load and friction.

    Parameters
    ----------
    t, y, inputs, numbers, vectors, matrices, tables, work
        As in :func:`towercrane.simulation.system.rhs_signature`.

    Returns
    -------
    float
        Power of shaft, dampers and drag [W].
    """
    n = vectors.shape[1]
    rates = (y.size - 1) // 2
    links, points = int(numbers[LINKS]), int(numbers[POINTS])
    own = MASS + n  # rows of the point that is being added
    power = 0.0
    for i in range(n):
        force = vectors[STEADY_FORCE, i]
        for m in range(n):
            force -= matrices[STIFFNESS, i, m] * y[m] + matrices[DAMPING, i, m] * y[rates + m]
            power -= y[rates + i] * matrices[DAMPING, i, m] * y[rates + m]
            work[MASS + i, m] = 0.0
        work[FORCE, i] = force
        work[MASS + i, i] = vectors[INERTIA, i]
    for p in range(points):
        angle = point_motion(p, y, numbers, tables, n, rates, work, own)
        c, s = np.cos(angle), np.sin(angle)
        mass = tables[links + p, PROPERTIES, 0]
        vx, vy, vz = work[VELOCITY, 0], work[VELOCITY, 1], work[VELOCITY, 2]
        speed = np.sqrt(vx * vx + vy * vy + vz * vz)
        along = -tables[links + p, PROPERTIES, 1] * speed * (c * vx + s * vy)
        across = -tables[links + p, PROPERTIES, 2] * speed * (c * vy - s * vx)
        fx, fy = c * along - s * across, s * along + c * across
        fz = -tables[links + p, PROPERTIES, 3] * speed * vz
        power += fx * vx + fy * vy + fz * vz
        fx -= mass * work[BIAS, 0]
        fy -= mass * work[BIAS, 1]
        fz -= mass * (work[BIAS, 2] + numbers[GRAVITY])
        for i in range(n):
            jx, jy, jz = work[own, i], work[own + 1, i], work[own + 2, i]
            work[FORCE, i] += jx * fx + jy * fy + jz * fz
            jx, jy, jz = mass * jx, mass * jy, mass * jz
            for m in range(i + 1):
                work[MASS + i, m] += jx * work[own, m] + jy * work[own + 1, m] + jz * work[own + 2, m]
    point_motion(int(numbers[SUSPENSION]), y, numbers, tables, n, rates, work, JACOBIAN)

    shaft, shaft_rate, _ = polynomial(inputs, SHAFT, t)
    driven = int(numbers[DRIVEN])
    twist, slip = y[driven] - shaft, y[rates + driven] - shaft_rate
    spring = coupling_torque(twist, numbers[SOFT], numbers[STIFF], numbers[CORNER])
    torque = -spring - numbers[DRIVE_DAMPING] * slip
    work[FORCE, driven] += torque
    # What the shaft puts in is stored in the coupling, turns the platform or is lost between them.
    return power + torque * shaft_rate - numbers[DRIVE_DAMPING] * slip * slip


@kernel(rhs_signature(), at_once=False)
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
    """Right-hand side of a lumped crane with its load in space."""
    n = vectors.shape[1]
    rates = (y.size - 1) // 2
    power = structure(t, y, inputs, numbers, vectors, matrices, tables, work)
    driven = int(numbers[DRIVEN])
    rate, limit, law = y[rates + driven], numbers[FRICTION_TORQUE], numbers[FRICTION_LAW]
    friction, state, sticks = 0.0, 0.0, 0.0
    if law == TANH:
        friction = -limit * np.tanh(rate / numbers[FRICTION_RATE])
    if law == STICK_SLIP:
        state = numbers[FRICTION_STATE]
        state = choose(below(SLIP_AHEAD, state), np.sign(rate), state)
        friction = -limit * state
        sticks = below(abs(state), SLIP_AHEAD)
    work[FORCE, driven] += friction
    held, held_force = MASS + n, 0.0
    if law == STICK_SLIP:
        # The row of a coordinate at rest is taken out of the equations and kept: it gives the torque that holds it.
        for i in range(n):
            row, column = max(i, driven), min(i, driven)
            work[held, i] = work[MASS + row, column]
            work[MASS + row, column] = choose(sticks, 0.0, work[MASS + row, column])
        work[MASS + driven, driven] = choose(sticks, 1.0, work[MASS + driven, driven])
        held_force = work[FORCE, driven]
        work[FORCE, driven] = choose(sticks, 0.0, held_force)
        for k in range(3):
            work[held + 1, k] = work[JACOBIAN + k, driven]
            work[JACOBIAN + k, driven] = choose(sticks, 0.0, work[JACOBIAN + k, driven])
    length, haul, acceleration = polynomial(inputs, ROPE, t)
    tension = hang_load(
        y, dy, n, 3, length, haul, acceleration, numbers[LOAD_MASS], numbers[GRAVITY], numbers[DRAG],
        numbers[HINGE_DAMPING], numbers[ROPE_STIFFNESS], numbers[ROPE_LOSS], work,
    )  # fmt: skip
    dy[y.size - 1] += power + friction * rate

    sliding, holding, needed = np.inf, np.inf, 0.0
    if law == STICK_SLIP:
        needed = -held_force
        for i in range(n):
            needed += work[held, i] * dy[rates + i]
        for k in range(3):
            needed -= work[held + 1, k] * (tension * work[DIRECTION, k] - work[HINGE, k])
        sliding = state * rate
        holding, needed = choose(sticks, limit - abs(needed), np.inf), choose(sticks, needed, 0.0)
    shaft, _, _ = polynomial(inputs, SHAFT, t)
    beyond = abs(y[driven] - shaft) - numbers[CORNER]
    guards[TENSION] = tension
    guards[INSIDE] = -beyond
    guards[OUTSIDE] = beyond
    guards[SLIDING] = sliding
    guards[HOLDING] = holding
    guards[NEEDED] = needed

"""Compiled right-hand side of the flexible crane: its structure, its drives, and the load on its rope."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import types

from modal.compiled import kernel
from towercrane.cranes import flexible_layout as at
from towercrane.cranes.drive_kernel import coupling_torque
from towercrane.cranes.flexible_kernel import structure
from towercrane.payload import ACCELERATION, DIRECTION, FORCE, HINGE, MASS, hang_load
from towercrane.polynomial import polynomial
from towercrane.system import rhs_signature

_one, _two = types.float64[::1], types.float64[:, ::1]


@kernel(types.float64(types.float64, _one, _two, _one, _two))
def drive(t: float, y: Any, inputs: Any, numbers: Any, work: Any) -> float:
    """Add the drive's torque to the slewing coordinate's force, and its power; returns the coupling's torque."""
    rates = (y.size - 1) // 2
    turned = int(numbers[at.TOWER_X] + numbers[at.TOWER_Y] + numbers[at.TORSION])
    n = turned + 1 + int(numbers[at.LATERAL] + numbers[at.VERTICAL])
    shaft, shaft_rate, _ = polynomial(inputs, at.SLEWING, t)
    angle, rate = y[turned], y[rates + turned]
    slip = rate - shaft_rate
    spring = coupling_torque(angle - shaft, numbers[at.SOFT], numbers[at.STIFF], numbers[at.CORNER])
    torque = -spring - numbers[at.DRIVE_DAMPING] * slip
    friction = -numbers[at.FRICTION_TORQUE] * np.tanh(rate / numbers[at.FRICTION_RATE])
    work[FORCE, turned] += torque + friction
    # What the shaft puts in is stored in the coupling, turns the head or is lost between them.
    power = torque * shaft_rate - numbers[at.DRIVE_DAMPING] * slip * slip + friction * rate
    work[MASS + n + at.HEAD, at.POWER] += power
    return torque


@kernel()
def holding_torque(d: int, tension: float, dy: Any, numbers: Any, vectors: Any, work: Any) -> float:
    """Torque that the prescribed slewing takes: the equation of the coordinate that is not free."""
    n = vectors.shape[1]
    rates = n + d
    to_y = int(numbers[at.TOWER_X])
    to_turn = to_y + int(numbers[at.TOWER_Y])
    to_jib = to_turn + int(numbers[at.TORSION]) + int(numbers[at.DRIVEN])
    head, body, shapes = MASS + n + at.HEAD, MASS + n + at.BODY, MASS + n + at.SHAPE
    torque = -work[head, at.TURN_FORCE]
    for i in range(to_y):
        row = work[head, at.TURN_ROW] * vectors[at.TIP, i] + work[head, at.TURN_ROW + 3] * vectors[at.SLOPE, i]
        torque += row * dy[rates + i]
    for i in range(to_y, to_turn):
        row = work[head, at.TURN_ROW + 1] * vectors[at.TIP, i] - work[head, at.TURN_ROW + 2] * vectors[at.SLOPE, i]
        torque += row * dy[rates + i]
    for i in range(to_turn, to_jib):
        torque += work[head, at.TURN_ROW + 4] * vectors[at.TWIST, i] * dy[rates + i]
    hung = numbers[at.TROLLEY_MASS] * work[body, at.PLACE]
    for i in range(to_jib, to_jib + int(numbers[at.LATERAL])):
        torque += (vectors[at.JIB_MOMENT, i] + hung * work[shapes, i]) * dy[rates + i]
    for k in range(d):
        axis = k if k < d - 1 else 2
        torque -= work[head, at.TURN_COLUMN + axis] * (tension * work[DIRECTION, k] - work[HINGE, k])
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
    head, body = MASS + n + at.HEAD, MASS + n + at.BODY
    structure(d, t, y, inputs, numbers, vectors, matrices, tables, work)
    driven = numbers[at.DRIVEN] > 0.0
    torque, beyond = 0.0, 0.0
    if driven:
        torque = drive(t, y, inputs, numbers, work)
    length, rate, acceleration = polynomial(inputs, at.ROPE, t)
    gravity, trolley = numbers[at.GRAVITY], numbers[at.TROLLEY_MASS]
    tension = hang_load(
        y, dy, n, d, length, rate, acceleration,
        numbers[at.LOAD_MASS], gravity, numbers[at.DRAG], numbers[at.HINGE_DAMPING], 0.0, 0.0, work,
    )  # fmt: skip
    power = work[head, at.POWER]
    if driven:
        shaft, _, _ = polynomial(inputs, at.SLEWING, t)
        turned = int(numbers[at.TOWER_X] + numbers[at.TOWER_Y] + numbers[at.TORSION])
        beyond = abs(y[turned] - shaft) - numbers[at.CORNER]
    elif d == 3:
        torque = holding_torque(d, tension, dy, numbers, vectors, work)
        if numbers[at.SLEWING_CHANNEL] >= 0.0:
            _, turning, _ = polynomial(inputs, at.SLEWING, t)
            power += torque * turning
    # The trolley's drive acts along the deflected jib.
    force = work[head, at.PATH + 2] * trolley * gravity
    for k in range(d):
        axis = k if k < d - 1 else 2
        pull = trolley * work[ACCELERATION, k] - tension * work[DIRECTION, k] + work[HINGE, k]
        force += work[head, at.PATH + axis] * pull
    dy[y.size - 1] += power + force * work[head, at.TROLLEY_RATE]

    guards[at.TENSION] = tension
    guards[at.INNER_END] = work[body, at.PLACE]
    guards[at.OUTER_END] = numbers[at.JIB_LENGTH] - work[body, at.PLACE]
    guards[at.TILT] = numbers[at.TILT_LIMIT] - work[head, at.TILT_ANGLE]
    guards[at.INSIDE] = -beyond
    guards[at.OUTSIDE] = beyond
    guards[at.SLEWING_TORQUE] = torque
    guards[at.TROLLEY_FORCE] = force

"""Compiled right-hand side of the flexible crane: its structure, its drives, and the load on its rope."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from modal.compiled import kernel
from towercrane.cranes import flexible_layout as at
from towercrane.cranes.drive_kernel import coupling_torque
from towercrane.cranes.flexible_kernel import structure
from towercrane.lane_choices import whole
from towercrane.payload import ACCELERATION, DIRECTION, FORCE, HINGE, MASS, hang_load
from towercrane.polynomial import polynomial
from towercrane.system import rhs_signature

if TYPE_CHECKING:
    from towercrane.cranes.projection_kernel import SlewingRow


@kernel()
def drive(t: float, y: Any, inputs: Any, numbers: Any, work: Any) -> tuple[float, float, float]:
    """Add the drive's torque to the slewing coordinate's force.

    Returns
    -------
    tuple of float
        Torque of the coupling with its damper [N m], power of shaft, damper and friction [W], and way beyond the
        coupling's corner [rad].
    """
    rates = (y.size - 1) // 2
    turned = whole(numbers[at.TOWER_X] + numbers[at.TOWER_Y] + numbers[at.TORSION])
    shaft, shaft_rate, _ = polynomial(inputs, at.SLEWING, t)
    angle, rate = y[turned], y[rates + turned]
    slip = rate - shaft_rate
    spring = coupling_torque(angle - shaft, numbers[at.SOFT], numbers[at.STIFF], numbers[at.CORNER])
    torque = -spring - numbers[at.DRIVE_DAMPING] * slip
    friction = -numbers[at.FRICTION_TORQUE] * np.tanh(rate / numbers[at.FRICTION_RATE])
    work[FORCE, turned] += torque + friction
    # What the shaft puts in is stored in the coupling, turns the head or is lost between them.
    power = torque * shaft_rate - numbers[at.DRIVE_DAMPING] * slip * slip + friction * rate
    return torque, power, abs(angle - shaft) - numbers[at.CORNER]


@kernel(inline=True)
def holding_torque(
    d: int, tension: float, x: float, slewing: SlewingRow, dy: Any, numbers: Any, vectors: Any, work: Any
) -> float:
    """Torque that the prescribed slewing takes: the equation of the coordinate that is not free."""
    n = vectors.shape[1]
    rates = n + d
    to_y = whole(numbers[at.TOWER_X])
    to_turn = to_y + whole(numbers[at.TOWER_Y])
    to_jib = to_turn + whole(numbers[at.TORSION]) + whole(numbers[at.DRIVEN])
    column_x, column_y, column_z, with_x, with_y, with_tilt_x, with_tilt_y, own, moment = slewing
    torque = -moment
    for i in range(to_y):
        torque += (with_x * vectors[at.TIP, i] + with_tilt_y * vectors[at.SLOPE, i]) * dy[rates + i]
    for i in range(to_y, to_turn):
        torque += (with_y * vectors[at.TIP, i] - with_tilt_x * vectors[at.SLOPE, i]) * dy[rates + i]
    for i in range(to_turn, to_jib):
        torque += own * vectors[at.TWIST, i] * dy[rates + i]
    hung = numbers[at.TROLLEY_MASS] * x
    for i in range(to_jib, to_jib + whole(numbers[at.LATERAL])):
        torque += (vectors[at.JIB_MOMENT, i] + hung * work[MASS + n + at.SHAPE, i]) * dy[rates + i]
    torque -= column_x * (tension * work[DIRECTION, 0] - work[HINGE, 0])
    torque -= column_y * (tension * work[DIRECTION, 1] - work[HINGE, 1])
    return torque - column_z * (tension * work[DIRECTION, d - 1] - work[HINGE, d - 1])


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
    structured = structure(d, t, y, inputs, numbers, vectors, matrices, tables, work)
    x, xd, tilt, power, path_x, path_y, path_z = structured[:7]
    torque, beyond = 0.0, 0.0
    if whole(numbers[at.DRIVEN]) > 0:
        torque, drive_power, beyond = drive(t, y, inputs, numbers, work)
        power += drive_power
    length, rate, acceleration = polynomial(inputs, at.ROPE, t)
    gravity, trolley = numbers[at.GRAVITY], numbers[at.TROLLEY_MASS]
    tension = hang_load(
        y, dy, n, d, length, rate, acceleration,
        numbers[at.LOAD_MASS], gravity, numbers[at.DRAG], numbers[at.HINGE_DAMPING], 0.0, 0.0, work,
    )  # fmt: skip
    if whole(numbers[at.DRIVEN]) == 0 and d == 3:
        torque = holding_torque(d, tension, x, structured[7:], dy, numbers, vectors, work)
        if whole(numbers[at.SLEWING_CHANNEL]) >= 0:
            _, turning, _ = polynomial(inputs, at.SLEWING, t)
            power += torque * turning
    # The trolley's drive acts along the deflected jib.
    force = path_x * (trolley * work[ACCELERATION, 0] - tension * work[DIRECTION, 0] + work[HINGE, 0])
    if d == 3:
        force += path_y * (trolley * work[ACCELERATION, 1] - tension * work[DIRECTION, 1] + work[HINGE, 1])
    up = d - 1
    force += path_z * (trolley * (work[ACCELERATION, up] + gravity) - tension * work[DIRECTION, up] + work[HINGE, up])
    dy[y.size - 1] += power + force * xd

    guards[at.TENSION] = tension
    guards[at.INNER_END] = x
    guards[at.OUTER_END] = numbers[at.JIB_LENGTH] - x
    guards[at.TILT] = numbers[at.TILT_LIMIT] - tilt
    guards[at.INSIDE] = -beyond
    guards[at.OUTSIDE] = beyond
    guards[at.SLEWING_TORQUE] = torque
    guards[at.TROLLEY_FORCE] = force

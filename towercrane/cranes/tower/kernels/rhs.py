"""Compiled right-hand side of the flexible crane: its structure, its drives, and the load on its rope."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from modal.compiler.compiled import kernel
from modal.compiler.traced import traced
from towercrane.cranes.tower.kernels import layout as at
from towercrane.cranes.tower.kernels.drive import drive
from towercrane.cranes.tower.kernels.projection import dot
from towercrane.cranes.tower.kernels.structure import structure
from towercrane.kernels.payload import ACCELERATION, DIRECTION, HINGE, MASS, hang_load
from towercrane.kernels.polynomial import polynomial
from towercrane.simulation.system import rhs_signature

if TYPE_CHECKING:
    from towercrane.cranes.tower.kernels.head import Vector
    from towercrane.cranes.tower.kernels.projection import Motions, SlewingRow


@traced
def turned_by(i: int, row: Motions, vectors: Any) -> float:
    """Share of a coordinate of tower or slewing in the momentum that this row of the mass matrix belongs to."""
    return dot(row, [vectors[motion, i] for motion in range(at.MOTIONS)])


@traced
def load_along(direction: Vector, up: int, tension: float, work: Any) -> float:
    """Force of rope and hinge, for the motion of the rope's upper end in this direction."""
    return dot(direction, [tension * work[DIRECTION, axis] - work[HINGE, axis] for axis in (0, 1, up)])


@traced
def trolley_force(path: Vector, up: int, trolley: float, gravity: float, tension: float, work: Any) -> float:
    """Force of the trolley's drive, which acts along the deflected jib."""
    axes = 0, 1, up
    rises = work[ACCELERATION, 0], work[ACCELERATION, 1], work[ACCELERATION, up] + gravity
    return dot(
        path, [trolley * a - tension * work[DIRECTION, k] + work[HINGE, k] for a, k in zip(rises, axes, strict=True)]
    )


@traced
def write_guards(
    tension: float, x: float, tilt: float, beyond: float, torque: float, force: float, numbers: Any, guards: Any
) -> None:
    """Write the guards, and the outputs beside them."""
    guards[at.TENSION] = tension
    guards[at.INNER_END] = x
    guards[at.OUTER_END] = numbers[at.JIB_LENGTH] - x
    guards[at.TILT] = numbers[at.TILT_LIMIT] - tilt
    guards[at.INSIDE] = -beyond
    guards[at.OUTSIDE] = beyond
    guards[at.SLEWING_TORQUE] = torque
    guards[at.TROLLEY_FORCE] = force


@kernel(inline=True)
def holding_torque(
    d: int, tension: float, x: float, slewing: SlewingRow, dy: Any, numbers: Any, vectors: Any, work: Any
) -> float:
    """Torque that the prescribed slewing takes: the equation of the coordinate that is not free."""
    n, to_jib = vectors.shape[1], int(numbers[at.LATERAL])
    rates = n + d
    column, row, moment = slewing
    torque = -moment
    for i in range(to_jib):
        torque += turned_by(i, row, vectors) * dy[rates + i]
    hung = numbers[at.TROLLEY_MASS] * x
    for i in range(to_jib, int(numbers[at.VERTICAL])):
        torque += (vectors[at.JIB_MOMENT, i] + hung * work[MASS + n + at.SHAPE, i]) * dy[rates + i]
    return torque - load_along(column, d - 1, tension, work)


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
    """Right-hand side of the flexible crane."""
    n = vectors.shape[1]
    d = (y.size - 1) // 2 - n
    x, xd, tilt, power, path, slewing = structure(d, t, y, inputs, numbers, vectors, matrices, tables, work)
    torque, beyond = 0.0, 0.0
    driven = int(numbers[at.LATERAL]) > int(numbers[at.DRIVEN])
    if driven:
        torque, drive_power, beyond = drive(t, y, inputs, numbers, work)
        power += drive_power
    length, rate, acceleration = polynomial(inputs, at.ROPE, t)
    gravity = numbers[at.GRAVITY]
    tension = hang_load(
        y, dy, n, d, length, rate, acceleration,
        numbers[at.LOAD_MASS], gravity, numbers[at.DRAG], numbers[at.HINGE_DAMPING], 0.0, 0.0, work,
    )  # fmt: skip
    if d == 3 and not driven:
        torque = holding_torque(d, tension, x, slewing, dy, numbers, vectors, work)
        if int(numbers[at.SLEWING_CHANNEL]) >= 0:
            _, turning, _ = polynomial(inputs, at.SLEWING, t)
            power += torque * turning
    force = trolley_force(path, d - 1, numbers[at.TROLLEY_MASS], gravity, tension, work)
    dy[y.size - 1] += power + force * xd
    write_guards(tension, x, tilt, beyond, torque, force, numbers, guards)

"""Compiled projection of what turns on a tower onto the coordinates that move it.

The head has five motions of its own: u_x and u_y of the tower's top, th_x and th_y of its tilt, and its turning.
A tower mode along x moves u_x and th_y, one along y moves u_y and -th_x, torsion and slewing turn. In those motions
and the jib's modes the mass matrix is that of a rigid body with deflections.
"""

from __future__ import annotations

from functools import reduce
from operator import add, mul
from typing import TYPE_CHECKING, Any

from modal.compiler.compiled import kernel
from modal.compiler.traced import traced
from towercrane.cranes.tower.kernels import layout as at
from towercrane.cranes.tower.kernels.head import Head, Vector
from towercrane.kernels.payload import FORCE, JACOBIAN, MASS

if TYPE_CHECKING:
    from collections.abc import Sequence

Body = tuple[float, Vector, tuple[float, ...], Vector, Vector]
"""What turns, in the head's axes: mass, first moments, moments of inertia (xx, xy, xz, yy, yz, zz), force, moment."""

Motions = tuple[float, float, float, float, float]
"""A number for each of the head's own motions u_x, u_y, th_x, th_y and turning."""

Share = tuple[float, tuple[Vector, Vector], tuple[Vector, Vector, Vector], Motions, tuple[Vector, Vector, Vector]]
"""What turns, in the head's own motions: mass; its couplings of u_x and of u_y with th_x, th_y and turning; inertia
of these three; forces; and what these three do to the rope's upper end, in fixed axes (x, y, z by row)."""

SlewingRow = tuple[Vector, Motions, float]
"""What belongs to the slewing: motion of the rope's upper end with it, in fixed axes; its row of the mass matrix;
its moment."""


def cross(a: Vector, b: Vector) -> Vector:
    """Cross product."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def dot(a: Sequence[float], b: Sequence[float]) -> float:
    """Sum of products."""
    return reduce(add, map(mul, a, b))


@traced
def share_of(head: Head, body: Body, place: Vector) -> Share:
    """What turns, with the rope's upper end at this place in the head's axes, in the head's own motions."""
    (r00, r01, r02, r10, r11, r12, r20, r21, r22), turn_x, turn_y = head[:3]
    mass, first, (ixx, ixy, ixz, iyy, iyz, izz), force, moment = body
    along_x, along_y, along_z = (r00, r01, r02), (r10, r11, r12), (r20, r21, r22)
    inertia = (ixx, ixy, ixz), (ixy, iyy, iyz), (ixz, iyz, izz)
    momentum_x, momentum_y = ([dot(row, turn) for row in inertia] for turn in (turn_x, turn_y))
    across = dot(turn_x, momentum_y)
    turned = (
        (dot(turn_x, momentum_x), across, momentum_x[2]),
        (across, dot(turn_y, momentum_y), momentum_y[2]),
        (momentum_x[2], momentum_y[2], izz),
    )
    arm_x, arm_y = cross(first, along_x), cross(first, along_y)
    slid = (
        (dot(turn_x, arm_x), dot(turn_y, arm_x), arm_x[2]),
        (dot(turn_x, arm_y), dot(turn_y, arm_y), arm_y[2]),
    )
    forces = dot(along_x, force), dot(along_y, force), dot(turn_x, moment), dot(turn_y, moment), moment[2]
    swept_x, swept_y = cross(turn_x, place), cross(turn_y, place)
    end_x, end_y, end_z = (
        (dot(along, swept_x), dot(along, swept_y), along[1] * place[0] - along[0] * place[1])
        for along in (along_x, along_y, along_z)
    )
    return mass, slid, turned, forces, (end_x, end_y, end_z)


def _write_jacobian(work: Any, i: int, up: int, end: Vector) -> None:
    work[JACOBIAN, i] = end[0]
    # In a plane the second axis is the vertical.
    work[JACOBIAN + 1, i] = end[1]
    work[up + JACOBIAN, i] = end[2]


@traced
def project_motion(i: int, up: int, share: Share, vectors: Any, work: Any) -> Motions:
    """Add the force and write the Jacobian of the rope's upper end for one coordinate of tower or slewing.

    Returns
    -------
    tuple of 5 floats
        The coordinate's share in the momenta of the head's motions.
    """
    mass, (slid_x, slid_y), turned, forces, (end_x, end_y, end_z) = share
    x, y, *turns = [vectors[motion, i] for motion in range(at.MOTIONS)]
    work[FORCE, i] = work[FORCE, i] + dot(forces, (x, y, *turns))
    _write_jacobian(work, i, up, (x + dot(end_x, turns), y + dot(end_y, turns), dot(end_z, turns)))
    rolled, pitched, twisted = (slid_x[k] * x + slid_y[k] * y + dot(turned[k], turns) for k in range(3))
    return mass * x + dot(slid_x, turns), mass * y + dot(slid_y, turns), rolled, pitched, twisted


@traced
def couple(i: int, m: int, row: Motions, vectors: Any, matrices: Any, work: Any) -> None:
    """Write the mass matrix of a coordinate, with this share in the head's momenta, and one of tower or slewing."""
    moved = [vectors[motion, m] for motion in range(at.MOTIONS)]
    work[i + MASS, m] = matrices[at.OWN, i, m] + dot(row, moved)


@traced
def cap(i: int, vectors: Any, work: Any) -> None:
    """Add the mass of a coordinate whose frequency is capped."""
    work[i + MASS, i] = work[i + MASS, i] + vectors[at.CAP, i]


@traced
def slewing_row(share: Share) -> SlewingRow:
    """What of it belongs to the slewing."""
    _, (slid_x, slid_y), turned, forces, (end_x, end_y, end_z) = share
    return (end_x[2], end_y[2], end_z[2]), (slid_x[2], slid_y[2], *turned[2]), forces[4]


@kernel(inline=True)
def project_head(
    d: int, head: Head, body: Body, place: Vector, numbers: Any, vectors: Any, matrices: Any, work: Any
) -> SlewingRow:
    """Add forces, and write mass matrix and Jacobian of the rope's upper end, for tower and slewing.

    ``place`` is where the rope's upper end is in the head's axes.
    """
    share = share_of(head, body, place)
    for i in range(int(numbers[at.LATERAL])):
        row = project_motion(i, d - 1, share, vectors, work)
        for m in range(i + 1):
            couple(i, m, row, vectors, matrices, work)
        cap(i, vectors, work)
    return slewing_row(share)


def _project_bending(
    i: int, n: int, up: int, axis: int, across: float, head: Head, pull: Vector, place: Vector, trolley: float,
    vectors: Any, work: Any,
) -> tuple[float, float, float, float]:  # fmt: skip
    """Force and Jacobian of one jib mode along an axis of the head, ``across`` the trolley's place along the other.

    Returns
    -------
    tuple of 4 floats
        Mass along the fixed axes x and y, moment b, and c, all with the trolley's.
    """
    rotation = head[0]
    shape = work[n + (MASS + at.SHAPE), i]
    mass, moment = vectors[at.JIB_MASS, i] + trolley * shape, vectors[at.JIB_MOMENT, i] + trolley * shape * place[0]
    work[FORCE, i] = work[FORCE, i] + shape * pull[axis]
    _write_jacobian(work, i, up, (shape * rotation[axis], shape * rotation[3 + axis], shape * rotation[6 + axis]))
    crossed = work[n + (MASS + at.ACROSS), i] + trolley * shape * across
    return mass * rotation[axis], mass * rotation[3 + axis], moment, crossed


@traced
def project_lateral(
    i: int, n: int, up: int, head: Head, pull: Vector, place: Vector, trolley: float, vectors: Any, work: Any
) -> Motions:
    """Add the trolley's force and write the Jacobian of the rope's upper end for one jib mode along e2.

    It turns about b e3 - c e1; returns as :func:`project_motion`.
    """
    along_x, along_y, b, c = _project_bending(i, n, up, 1, place[2], head, pull, place, trolley, vectors, work)
    lean_x, lean_y = (b * turn[2] - c * turn[0] for turn in (head[1], head[2]))
    return along_x, along_y, lean_x, lean_y, b


@traced
def project_vertical(
    i: int, n: int, up: int, head: Head, pull: Vector, place: Vector, trolley: float, vectors: Any, work: Any
) -> Motions:
    """Add the trolley's force and write the Jacobian of the rope's upper end for one jib mode along e3.

    It turns about c e1 - b e2; returns as :func:`project_motion`.
    """
    along_x, along_y, b, c = _project_bending(i, n, up, 2, place[1], head, pull, place, trolley, vectors, work)
    lean_x, lean_y = (c * turn[0] - b * turn[1] for turn in (head[1], head[2]))
    return along_x, along_y, lean_x, lean_y, 0.0


@traced
def join(i: int, m: int, n: int, trolley: float, matrices: Any, work: Any) -> None:
    """Write the mass matrix of two jib modes of one direction."""
    carried = trolley * work[n + (MASS + at.SHAPE), i] * work[n + (MASS + at.SHAPE), m]
    work[i + MASS, m] = matrices[at.OWN, i, m] + carried


@kernel(inline=True)
def project_jib(
    d: int, head: Head, pull: Vector, place: Vector, numbers: Any, vectors: Any, matrices: Any, work: Any
) -> None:
    """Add the trolley's force, and write mass matrix and Jacobian of the rope's upper end, for the jib's modes.

    ``pull`` is the force on the trolley and ``place`` where it is, in the head's axes.
    """
    n, trolley = vectors.shape[1], numbers[at.TROLLEY_MASS]
    to_jib, to_vertical = int(numbers[at.LATERAL]), int(numbers[at.VERTICAL])
    for i in range(to_jib, n):
        first = to_jib
        if i < to_vertical:
            row = project_lateral(i, n, d - 1, head, pull, place, trolley, vectors, work)
        else:
            row = project_vertical(i, n, d - 1, head, pull, place, trolley, vectors, work)
            first = to_vertical
            for m in range(to_jib, to_vertical):
                work[MASS + i, m] = 0.0
        for m in range(to_jib):
            couple(i, m, row, vectors, matrices, work)
        for m in range(first, i + 1):
            join(i, m, n, trolley, matrices, work)
        cap(i, vectors, work)

"""Compiled projection of what turns on a tower onto the coordinates that move it.

The head has five motions of its own: u_x and u_y of the tower's top, th_x and th_y of its tilt, and its turning.
A tower mode along x moves u_x and th_y, one along y moves u_y and -th_x, torsion and slewing turn. In those motions
and the jib's modes the mass matrix is that of a rigid body with deflections; each coordinate has one or two of them.
"""

from __future__ import annotations

from typing import Any

from modal.compiled import kernel
from towercrane.cranes import flexible_layout as at
from towercrane.cranes.head_kernel import Head, Vector
from towercrane.lane_choices import whole
from towercrane.payload import FORCE, JACOBIAN, MASS

Body = tuple[float, Vector, tuple[float, ...], Vector, Vector]
"""What turns, in the head's axes: mass, first moments, moments of inertia (xx, xy, xz, yy, yz, zz), force, moment."""

SlewingRow = tuple[float, float, float, float, float, float, float, float, float]
"""What belongs to the slewing: motion of the rope's upper end with it, in fixed axes (3); its row of the mass matrix
with u_x, u_y, th_x, th_y and itself (5); its moment."""


@kernel(inline=True)
def project_head(
    d: int, head: Head, body: Body, place: Vector, numbers: Any, vectors: Any, matrices: Any, work: Any
) -> SlewingRow:
    """Add forces, and write mass matrix and Jacobian of the rope's upper end, for tower and slewing.

    ``place`` is where the rope's upper end is in the head's axes.
    """
    up = d - 1
    to_y = whole(numbers[at.TOWER_X])
    to_turn = to_y + whole(numbers[at.TOWER_Y])
    to_jib = to_turn + whole(numbers[at.TORSION]) + whole(numbers[at.DRIVEN])
    r00, r01, r02, r10, r11, r12, r20, r21, r22 = head[0]
    j1x, j1y, j1z = head[1]
    j2x, j2y, j2z = head[2]
    mass, (sx, sy, sz), (ixx, ixy, ixz, iyy, iyz, izz), (fx, fy, fz), (mx, my, mz) = body
    x, dy, dz = place

    # S x (R^T e_x) and S x (R^T e_y); inertia times what th_x and th_y turn.
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
    # Motion of the rope's upper end with the two tilts and with slewing, in fixed axes.
    vx, vy, vz = j1y * dz - j1z * dy, j1z * x - j1x * dz, j1x * dy - j1y * x
    k1x, k1y, k1z = r00 * vx + r01 * vy + r02 * vz, r10 * vx + r11 * vy + r12 * vz, r20 * vx + r21 * vy + r22 * vz
    vx, vy, vz = j2y * dz - j2z * dy, j2z * x - j2x * dz, j2x * dy - j2y * x
    k2x, k2y, k2z = r00 * vx + r01 * vy + r02 * vz, r10 * vx + r11 * vy + r12 * vz, r20 * vx + r21 * vy + r22 * vz
    k3x, k3y, k3z = r01 * x - r00 * dy, r11 * x - r10 * dy, r21 * x - r20 * dy

    for i in range(to_y):
        ui, gi = vectors[at.TIP, i], vectors[at.SLOPE, i]
        work[FORCE, i] += ui * force_x + gi * moment_2
        work[JACOBIAN, i] = ui + gi * k2x
        # In a plane the second axis is the vertical.
        work[JACOBIAN + 1, i] = gi * k2y
        work[JACOBIAN + up, i] = gi * k2z
        lean, tip = ui * h_x2 + gi * h_22, ui * mass + gi * h_x2
        for m in range(i + 1):
            work[MASS + i, m] = matrices[at.OWN, i, m] + tip * vectors[at.TIP, m] + lean * vectors[at.SLOPE, m]
        work[MASS + i, i] += vectors[at.CAP, i]
    for i in range(to_y, to_turn):
        ui, gi = vectors[at.TIP, i], -vectors[at.SLOPE, i]
        work[FORCE, i] += ui * force_y + gi * moment_1
        work[JACOBIAN, i] = gi * k1x
        work[JACOBIAN + 1, i] = ui + gi * k1y
        work[JACOBIAN + up, i] = gi * k1z
        lean, tip = ui * h_y2 + gi * h_12, gi * h_x1
        for m in range(to_y):
            work[MASS + i, m] = tip * vectors[at.TIP, m] + lean * vectors[at.SLOPE, m]
        lean, tip = ui * h_y1 + gi * h_11, ui * mass + gi * h_y1
        for m in range(to_y, i + 1):
            work[MASS + i, m] = matrices[at.OWN, i, m] + tip * vectors[at.TIP, m] - lean * vectors[at.SLOPE, m]
        work[MASS + i, i] += vectors[at.CAP, i]
    for i in range(to_turn, to_jib):
        ti = vectors[at.TWIST, i]
        work[FORCE, i] += ti * mz
        work[JACOBIAN, i] = ti * k3x
        work[JACOBIAN + 1, i] = ti * k3y
        work[JACOBIAN + up, i] = ti * k3z
        for m in range(to_y):
            work[MASS + i, m] = ti * (c1z * vectors[at.TIP, m] + l2z * vectors[at.SLOPE, m])
        for m in range(to_y, to_turn):
            work[MASS + i, m] = ti * (c2z * vectors[at.TIP, m] - l1z * vectors[at.SLOPE, m])
        for m in range(to_turn, i + 1):
            work[MASS + i, m] = matrices[at.OWN, i, m] + ti * izz * vectors[at.TWIST, m]
        work[MASS + i, i] += vectors[at.CAP, i]
    return k3x, k3y, k3z, c1z, c2z, l1z, l2z, izz, mz


@kernel(inline=True)
def project_jib(
    d: int, head: Head, pull: Vector, place: Vector, numbers: Any, vectors: Any, matrices: Any, work: Any
) -> None:
    """Add the trolley's force, and write mass matrix and Jacobian of the rope's upper end, for the jib's modes.

    ``pull`` is the force on the trolley and ``place`` where it is, in the head's axes.
    """
    n = vectors.shape[1]
    up, rotation, turn_x, turn_y = d - 1, head[0], head[1], head[2]
    shapes, across = MASS + n + at.SHAPE, MASS + n + at.ACROSS
    to_y = whole(numbers[at.TOWER_X])
    to_turn = to_y + whole(numbers[at.TOWER_Y])
    to_jib = to_turn + whole(numbers[at.TORSION]) + whole(numbers[at.DRIVEN])
    to_vertical = to_jib + whole(numbers[at.LATERAL])
    trolley, x = numbers[at.TROLLEY_MASS], place[0]
    for i in range(to_jib, n):
        shape = work[shapes, i]
        a, b = vectors[at.JIB_MASS, i] + trolley * shape, vectors[at.JIB_MOMENT, i] + trolley * shape * x
        if i < to_vertical:
            # Along e2, turning about b e3 - c e1.
            first, twist, ex, ey, ez = to_jib, b, rotation[1], rotation[4], rotation[7]
            crossed = work[across, i] + trolley * shape * place[2]
            lean_x, lean_y = b * turn_x[2] - crossed * turn_x[0], b * turn_y[2] - crossed * turn_y[0]
            work[FORCE, i] += shape * pull[1]
        else:
            # Along e3, turning about c e1 - b e2.
            first, twist, ex, ey, ez = to_vertical, 0.0, rotation[2], rotation[5], rotation[8]
            crossed = work[across, i] + trolley * shape * place[1]
            lean_x, lean_y = crossed * turn_x[0] - b * turn_x[1], crossed * turn_y[0] - b * turn_y[1]
            work[FORCE, i] += shape * pull[2]
            for m in range(to_jib, to_vertical):
                work[MASS + i, m] = 0.0
        work[JACOBIAN, i] = shape * ex
        work[JACOBIAN + 1, i] = shape * ey
        work[JACOBIAN + up, i] = shape * ez
        for m in range(to_y):
            work[MASS + i, m] = a * ex * vectors[at.TIP, m] + lean_y * vectors[at.SLOPE, m]
        for m in range(to_y, to_turn):
            work[MASS + i, m] = a * ey * vectors[at.TIP, m] - lean_x * vectors[at.SLOPE, m]
        for m in range(to_turn, to_jib):
            work[MASS + i, m] = twist * vectors[at.TWIST, m]
        for m in range(first, i + 1):
            work[MASS + i, m] = matrices[at.OWN, i, m] + trolley * shape * work[shapes, m]
        work[MASS + i, i] += vectors[at.CAP, i]

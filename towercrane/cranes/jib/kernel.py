"""Compiled structure of the jib crane: a post that slews, a primary boom that luffs, a secondary boom that folds.

Source: Al-Ajmi, Abu-El Yazied, Abu-El-Hagag, Makady, Dynamic modeling and load sway simulation of jib cranes,
Eq. 2 and 6-16, derived anew. Of what is printed, Eq. 2, 8, J_11, J_22 and J_33 hold; J_23 repeats J_22, D_33 has
sin(theta_23) for the cosine, and the load's velocity w and hence A_11, A_14, A_15, A_45 carry wrong signs. The
load is not in this file: :func:`towercrane.kernels.payload.hang_load` adds it.

The joint angles theta are slew about the vertical, elevation of the primary boom above the horizontal, and
elevation of the secondary boom relative to the primary one. Axes are inertial, z up, the origin at the post's foot.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import types

from modal.compiler.compiled import kernel
from towercrane.kernels.payload import BIAS, DIRECTION, FORCE, HINGE, JACOBIAN, MASS, VELOCITY, hang_load
from towercrane.kernels.polynomial import polynomial
from towercrane.simulation.system import rhs_signature

JOINTS = 3
AXES = 3

(POST_HEIGHT, POST_INERTIA, PRIMARY_LENGTH, PRIMARY_DENSITY, SECONDARY_LENGTH, SECONDARY_DENSITY, GRAVITY,
 LOAD_MASS, DRAG, HINGE_DAMPING, STIFFNESS, DAMPING, HEAVE) = range(13)  # fmt: skip
"""Entries of ``numbers``. Densities are masses per length; STIFFNESS and DAMPING are the gains that hold the joints
to their plan; HEAVE is 0 where the linear sway leaves out the suspension point's vertical acceleration, else 1."""

ROPE = 3
"""Row of ``inputs`` after those of the three joints."""

TENSION, TORQUE, PLANNED_TENSION = 0, 1, 4
"""Guards: rope tension [N]; from TORQUE on three joint torques [N m], only recorded; tension in the plan [N]."""

ANGLES, RATES, ACCELERATIONS, TORQUES, ROWS = range(MASS + JOINTS, MASS + JOINTS + 5)
"""Rows of the scratch array after the kernel's own, one entry per joint; and their end."""

PLAN = 2 * (JOINTS + AXES) + 1
"""First state of the planned load where a driven crane runs beside its plan."""

_one, _two, _three = types.float64[::1], types.float64[:, ::1], types.float64[:, :, ::1]


@kernel(types.UniTuple(types.float64, 3)(_one, _one, _one, _two))
def structure(angles: Any, rates: Any, numbers: Any, work: Any) -> tuple[float, float, float]:
    """Fill ``work`` with mass matrix, forces without torques, and the suspension point's motion.

    Parameters
    ----------
    angles, rates : ndarray, shape (3,)
        Joint angles [rad] and their rates [rad/s].
    numbers : ndarray, shape (13,)
    work : ndarray, shape (ROWS, 3)
        FORCE, VELOCITY, BIAS, JACOBIAN and the lower triangle of MASS are written.

    Returns
    -------
    tuple of float
        Horizontal reach [m] and height [m] of the suspension point; potential energy of the booms [J], zero level
        at the post's foot.
    """
    a2, a3 = numbers[PRIMARY_LENGTH], numbers[SECONDARY_LENGTH]
    m2, m3 = numbers[PRIMARY_DENSITY] * a2, numbers[SECONDARY_DENSITY] * a3
    gravity = numbers[GRAVITY]
    c1, s1 = np.cos(angles[0]), np.sin(angles[0])
    c2, s2 = np.cos(angles[1]), np.sin(angles[1])
    c3, s3 = np.cos(angles[2]), np.sin(angles[2])
    c23, s23 = np.cos(angles[1] + angles[2]), np.sin(angles[1] + angles[2])
    slew, luff, fold = rates[0], rates[1], rates[2]
    both = luff + fold

    # Booms: inertia about the post, its derivatives by the two elevations, and the coupling of the elevations.
    inertia = m2 * a2 * a2 * c2 * c2 / 3.0 + m3 * (a3 * a3 * c23 * c23 / 3.0 + a2 * a3 * c2 * c23 + a2 * a2 * c2 * c2)
    by_fold = -m3 * (2.0 / 3.0 * a3 * a3 * c23 * s23 + a2 * a3 * c2 * s23)
    by_luff = by_fold - 2.0 / 3.0 * m2 * a2 * a2 * c2 * s2 - m3 * (a2 * a3 * s2 * c23 + 2.0 * a2 * a2 * c2 * s2)
    bend = 0.5 * m3 * a2 * a3 * s3
    work[MASS, 0] = numbers[POST_INERTIA] + inertia
    work[MASS + 1, 0] = 0.0
    work[MASS + 1, 1] = m2 * a2 * a2 / 3.0 + m3 * (a3 * a3 / 3.0 + a2 * a2 + a2 * a3 * c3)
    work[MASS + 2, 0] = 0.0
    work[MASS + 2, 1] = m3 * (a3 * a3 / 3.0 + 0.5 * a2 * a3 * c3)
    work[MASS + 2, 2] = m3 * a3 * a3 / 3.0
    weight_3 = 0.5 * gravity * m3 * a3 * c23
    weight_2 = gravity * (0.5 * m2 + m3) * a2 * c2 + weight_3
    work[FORCE, 0] = -(by_luff * luff + by_fold * fold) * slew
    work[FORCE, 1] = 0.5 * by_luff * slew * slew + bend * (2.0 * luff + fold) * fold - weight_2
    work[FORCE, 2] = 0.5 * by_fold * slew * slew - bend * luff * luff - weight_3

    # Suspension point, outward, sideways (towards growing slew) and up, then turned into the inertial axes.
    reach, rise = a2 * c2 + a3 * c23, a2 * s2 + a3 * s23
    reach_rate = -a2 * s2 * luff - a3 * s23 * both
    outward = -a2 * c2 * luff * luff - a3 * c23 * both * both - reach * slew * slew
    sideways = 2.0 * reach_rate * slew
    work[BIAS, 0] = outward * c1 - sideways * s1
    work[BIAS, 1] = outward * s1 + sideways * c1
    work[BIAS, 2] = -a2 * s2 * luff * luff - a3 * s23 * both * both
    work[JACOBIAN, 0], work[JACOBIAN + 1, 0], work[JACOBIAN + 2, 0] = -reach * s1, reach * c1, 0.0
    work[JACOBIAN, 1], work[JACOBIAN + 1, 1], work[JACOBIAN + 2, 1] = -rise * c1, -rise * s1, reach
    work[JACOBIAN, 2], work[JACOBIAN + 1, 2], work[JACOBIAN + 2, 2] = -a3 * s23 * c1, -a3 * s23 * s1, a3 * c23
    for k in range(AXES):
        work[VELOCITY, k] = 0.0
        for i in range(JOINTS):
            work[VELOCITY, k] += work[JACOBIAN + k, i] * rates[i]

    post = numbers[POST_HEIGHT]
    potential = gravity * (m2 * (post + 0.5 * a2 * s2) + m3 * (post + a2 * s2 + 0.5 * a3 * s23))
    return reach, post + rise, potential


@kernel()
def plan(t: float, inputs: Any, numbers: Any, work: Any) -> None:
    """Structure on its prescribed path: as :func:`structure`, with BIAS the whole acceleration."""
    for i in range(JOINTS):
        work[ANGLES, i], work[RATES, i], work[ACCELERATIONS, i] = polynomial(inputs, i, t)
    structure(work[ANGLES], work[RATES], numbers, work)
    for k in range(AXES):
        for i in range(JOINTS):
            work[BIAS, k] += work[JACOBIAN + k, i] * work[ACCELERATIONS, i]


@kernel()
def planned(t: float, y: Any, dy: Any, inputs: Any, numbers: Any, work: Any) -> tuple[float, float]:
    """Load on a crane that follows its plan; fills TORQUES by inverse dynamics.

    With structure and load on their paths, tau = M theta'' + h + g + J^T H - J^T n T.

    Returns
    -------
    tuple of float
        Rope tension [N] and power of the joints [W].
    """
    plan(t, inputs, numbers, work)
    tension = hang(t, y, dy, 0, inputs, numbers, work)
    power = 0.0
    for i in range(JOINTS):
        torque = -work[FORCE, i]
        for m in range(JOINTS):
            torque += work[MASS + max(i, m), min(i, m)] * work[ACCELERATIONS, m]
        for k in range(AXES):
            torque += work[JACOBIAN + k, i] * (work[HINGE, k] - tension * work[DIRECTION, k])
        work[TORQUES, i] = torque
        power += torque * work[RATES, i]
    return tension, power


@kernel()
def hang(t: float, y: Any, dy: Any, joints: int, inputs: Any, numbers: Any, work: Any) -> float:
    """The shared payload kernel with this crane's rope and load; returns the tension [N]."""
    length, rate, acceleration = polynomial(inputs, ROPE, t)
    return hang_load(
        y, dy, joints, AXES, length, rate, acceleration,
        numbers[LOAD_MASS], numbers[GRAVITY], numbers[DRAG], numbers[HINGE_DAMPING], 0.0, 0.0, work,
    )  # fmt: skip


@kernel()
def driven(t: float, y: Any, dy: Any, inputs: Any, numbers: Any, work: Any) -> float:
    """Crane and load under the torques in TORQUES; returns the tension [N]."""
    structure(y[:JOINTS], y[JOINTS + AXES : 2 * JOINTS + AXES], numbers, work)
    power = 0.0
    for i in range(JOINTS):
        work[FORCE, i] += work[TORQUES, i]
        power += work[TORQUES, i] * y[JOINTS + AXES + i]
    # The kernel takes the whole of what it is given for its state; a plan that is followed stands behind it.
    tension = hang(t, y[:PLAN], dy[:PLAN], JOINTS, inputs, numbers, work)
    dy[PLAN - 1] += power
    return tension


@kernel(rhs_signature(), at_once=False)
def planned_rhs(
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
    """Right-hand side with prescribed joints; y = (n, p, work)."""
    guards[TENSION], power = planned(t, y, dy, inputs, numbers, work)
    dy[2 * AXES] += power
    for i in range(JOINTS):
        guards[TORQUE + i] = work[TORQUES, i]


@kernel(rhs_signature(), at_once=False)
def driven_rhs(
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
    """Right-hand side with given torques; y = (theta, n, theta', p, work)."""
    for i in range(JOINTS):
        work[TORQUES, i] = polynomial(inputs, i, t)[0]
        guards[TORQUE + i] = work[TORQUES, i]
    guards[TENSION] = driven(t, y, dy, inputs, numbers, work)


@kernel(rhs_signature(), at_once=False)
def tracking_rhs(
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
    """Right-hand side under the torques of a plan; y = (theta, n, theta', p, work, then n, p, work of the plan)."""
    guards[PLANNED_TENSION], power = planned(t, y[PLAN:], dy[PLAN:], inputs, numbers, work)
    dy[PLAN + 2 * AXES] += power
    for i in range(JOINTS):
        late = y[i] - work[ANGLES, i]
        fast = y[JOINTS + AXES + i] - work[RATES, i]
        work[TORQUES, i] -= numbers[STIFFNESS] * late + numbers[DAMPING] * fast
        guards[TORQUE + i] = work[TORQUES, i]
    guards[TENSION] = driven(t, y, dy, inputs, numbers, work)


@kernel(rhs_signature(), at_once=False)
def linear_sway_rhs(
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
    """Right-hand side of small sway: l xi'' + 2 l' xi' + (g + a_z) xi = -(a_x, a_y); y = (xi, xi')."""
    plan(t, inputs, numbers, work)
    length, rate, _ = polynomial(inputs, ROPE, t)
    fall = numbers[GRAVITY] + numbers[HEAVE] * work[BIAS, 2]
    for k in range(2):
        dy[k] = y[2 + k]
        dy[2 + k] = -(work[BIAS, k] + 2.0 * rate * y[2 + k] + fall * y[k]) / length


@kernel(types.void(_two, _two, _one, _two, _two, _one, _two))
def survey(angles: Any, rates: Any, numbers: Any, positions: Any, velocities: Any, energies: Any, work: Any) -> None:
    """Suspension point and energy of the booms at many poses.

    Parameters
    ----------
    angles, rates : ndarray, shape (p, 3)
        Joint angles [rad] and rates [rad/s].
    numbers, work : ndarray
        As in :func:`structure`.
    positions, velocities : ndarray, shape (p, 3)
        Written: suspension point from the post's foot [m] and its velocity [m/s].
    energies : ndarray, shape (p,)
        Written: kinetic and potential energy of post and booms [J].
    """
    for row in range(angles.shape[0]):
        reach, height, energies[row] = structure(angles[row], rates[row], numbers, work)
        positions[row, 0] = reach * np.cos(angles[row, 0])
        positions[row, 1] = reach * np.sin(angles[row, 0])
        positions[row, 2] = height
        for i in range(JOINTS):
            velocities[row, i] = work[VELOCITY, i]
            energies[row] += 0.5 * work[MASS + i, i] * rates[row, i] ** 2
            for m in range(i):
                energies[row] += work[MASS + i, m] * rates[row, i] * rates[row, m]

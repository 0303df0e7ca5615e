"""Equations of the jib crane: a post that slews, a primary boom that luffs, a secondary boom that folds.

Source: Al-Ajmi, Abu-El Yazied, Abu-El-Hagag, Makady, Dynamic modeling and load sway simulation of jib cranes,
Eq. 2 and 6-16, derived anew. Of what is printed, Eq. 2, 8, J_11, J_22 and J_33 hold; J_23 repeats J_22, D_33 has
sin(theta_23) for the cosine, and the load's velocity w and hence A_11, A_14, A_15, A_45 carry wrong signs. The
load is not in this file: :func:`towercrane.kernels.hanging.hang_load` adds it.

The joint angles theta are slew about the vertical, elevation of the primary boom above the horizontal, and
elevation of the secondary boom relative to the primary one. Axes are inertial, z up, the origin at the post's foot.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from towercrane.kernels.algebra import dot
from towercrane.kernels.hanging import hang_load
from towercrane.kernels.payload import Rope, Structure, slopes, state_of
from towercrane.kernels.polynomial import polynomial

if TYPE_CHECKING:
    from collections.abc import Sequence

    from towercrane.cranes.jib.parameters import JibCrane
    from towercrane.kernels.load import Load

JOINTS = 3
AXES = 3

ROPE = 3
"""Row of ``inputs`` after those of the three joints."""

TENSION, TORQUE, PLANNED_TENSION = 0, 1, 4
"""Guards: rope tension [N]; from TORQUE on three joint torques [N m], only recorded; tension in the plan [N]."""

PLAN = 2 * (JOINTS + AXES) + 1
"""First state of the planned load where a driven crane runs beside its plan."""


@dataclass(frozen=True, slots=True)
class Constants:
    """Crane and load; gains that hold the joints to their plan; whether small sway feels a_z."""

    crane: JibCrane
    load: Load
    stiffness: float = 0.0
    damping: float = 0.0
    heave: bool = True


class Joints(NamedTuple):
    """Angles of the joints, rates and accelerations."""

    angles: Sequence[Any]
    rates: Sequence[Any]
    accelerations: Sequence[Any]


def structure(crane: JibCrane, angles: Any, rates: Any) -> Structure:
    """Crane without load and torques.

    Parameters
    ----------
    crane : JibCrane
    angles, rates : sequence of 3
        Joint angles [rad] and their rates [rad/s]: numbers, or arrays of many poses.
    """
    a2, a3, m2, m3 = crane.primary_length, crane.secondary_length, crane.primary_mass, crane.secondary_mass
    slew, luff, fold = rates
    both = luff + fold
    c1, s1 = np.cos(angles[0]), np.sin(angles[0])
    c2, s2 = np.cos(angles[1]), np.sin(angles[1])
    c3, s3 = np.cos(angles[2]), np.sin(angles[2])
    c23, s23 = np.cos(angles[1] + angles[2]), np.sin(angles[1] + angles[2])

    # Booms: inertia about the post, its derivatives by the two elevations, and the coupling of the elevations.
    inertia = m2 * a2 * a2 * c2 * c2 / 3.0 + m3 * (a3 * a3 * c23 * c23 / 3.0 + a2 * a3 * c2 * c23 + a2 * a2 * c2 * c2)
    by_fold = -m3 * (2.0 / 3.0 * a3 * a3 * c23 * s23 + a2 * a3 * c2 * s23)
    by_luff = by_fold - 2.0 / 3.0 * m2 * a2 * a2 * c2 * s2 - m3 * (a2 * a3 * s2 * c23 + 2.0 * a2 * a2 * c2 * s2)
    bend = 0.5 * m3 * a2 * a3 * s3
    weight_3 = 0.5 * crane.gravity * m3 * a3 * c23
    weight_2 = crane.gravity * (0.5 * m2 + m3) * a2 * c2 + weight_3

    # Suspension point, outward, sideways (towards growing slew) and up, then turned into the inertial axes.
    reach, rise = a2 * c2 + a3 * c23, a2 * s2 + a3 * s23
    outward = -a2 * c2 * luff * luff - a3 * c23 * both * both - reach * slew * slew
    sideways = 2.0 * (-a2 * s2 * luff - a3 * s23 * both) * slew
    jacobian = [
        [-reach * s1, -rise * c1, -a3 * s23 * c1],
        [reach * c1, -rise * s1, -a3 * s23 * s1],
        [0.0, reach, a3 * c23],
    ]
    return Structure(
        place=[reach * c1, reach * s1, crane.post_height + rise],
        mass=[
            [crane.post_inertia + inertia],
            [0.0, m2 * a2 * a2 / 3.0 + m3 * (a3 * a3 / 3.0 + a2 * a2 + a2 * a3 * c3)],
            [0.0, m3 * (a3 * a3 / 3.0 + 0.5 * a2 * a3 * c3), m3 * a3 * a3 / 3.0],
        ],
        force=[
            -(by_luff * luff + by_fold * fold) * slew,
            0.5 * by_luff * slew * slew + bend * (2.0 * luff + fold) * fold - weight_2,
            0.5 * by_fold * slew * slew - bend * luff * luff - weight_3,
        ],
        velocity=[dot(row, rates) for row in jacobian],
        bias=[
            outward * c1 - sideways * s1,
            outward * s1 + sideways * c1,
            -a2 * s2 * luff * luff - a3 * s23 * both * both,
        ],
        jacobian=jacobian,
    )


def planned(own: Constants, t: Any, y: Any, inputs: Any) -> tuple[list[Any], list[Any]]:
    """Slopes of y = (n, p, work) with prescribed joints; guards are tension and torques.

    With structure and load on their paths, tau = M theta'' + h + g + J^T (H - n T).
    """
    plan, state = _planned_joints(t, inputs), state_of(y, 0, AXES)
    booms = structure(own.crane, plan.angles, plan.rates)
    held = Structure([], [], booms.place, booms.velocity, _suspension(booms, plan), [[]] * AXES)
    hung = hang_load(held, state, _rope(t, inputs), own.load, own.crane.gravity)
    torques = []
    for i in range(JOINTS):
        torque = -booms.force[i]
        for m in range(JOINTS):
            torque = torque + booms.mass[max(i, m)][min(i, m)] * plan.accelerations[m]
        for k in range(AXES):
            torque = torque - booms.jacobian[k][i] * hung.pull(k)
        torques.append(torque)
    return slopes(state, hung, hung.power + dot(torques, plan.rates)), [
        hung.tension, *torques, *hung.guards,
    ]  # fmt: skip


def driven(own: Constants, t: Any, y: Any, inputs: Any) -> tuple[list[Any], list[Any]]:
    """Slopes of y = (theta, n, theta', p, work) under given torques; guards are tension and torques."""
    return _moved(own, t, y, inputs, [polynomial(row, t)[0] for row in inputs[:JOINTS]])


def tracking(own: Constants, t: Any, y: Any, inputs: Any) -> tuple[list[Any], list[Any]]:
    """Slopes of y = (theta, n, theta', p, work, then n, p, work of the plan) under the torques of the plan.

    Guards are tension, torques and the tension in the plan.
    """
    planned_slopes, (planned_tension, *torques) = planned(own, t, y[PLAN:], inputs)
    plan, state = _planned_joints(t, inputs), state_of(y[:PLAN], JOINTS, AXES)
    for i in range(JOINTS):
        late, fast = state.coordinates[i] - plan.angles[i], state.rates[i] - plan.rates[i]
        torques[i] = torques[i] - (own.stiffness * late + own.damping * fast)
    moved, guards = _moved(own, t, y[:PLAN], inputs, torques)
    return [*moved, *planned_slopes], [*guards, planned_tension]


def linear_sway(own: Constants, t: Any, y: Any, inputs: Any) -> tuple[list[Any], list[Any]]:
    """Slopes of small sway y = (xi, xi'): l xi'' + 2 l' xi' + (g + a_z) xi = -(a_x, a_y)."""
    plan, rope = _planned_joints(t, inputs), _rope(t, inputs)
    suspension = _suspension(structure(own.crane, plan.angles, plan.rates), plan)
    fall = own.crane.gravity + suspension[2] if own.heave else own.crane.gravity
    swing = [-(suspension[k] + 2.0 * rope.rate * y[2 + k] + fall * y[k]) / rope.length for k in range(2)]
    return [*y[2:], *swing], []


def _planned_joints(t: Any, inputs: Any) -> Joints:
    return Joints(*zip(*(polynomial(row, t) for row in inputs[:JOINTS]), strict=True))


def _rope(t: Any, inputs: Any) -> Rope:
    return Rope(*polynomial(inputs[ROPE], t))


def _suspension(booms: Structure, plan: Joints) -> list[Any]:
    """Acceleration of the suspension point."""
    moved = (1.0, *plan.accelerations)
    return [dot((bias, *row), moved) for bias, row in zip(booms.bias, booms.jacobian, strict=True)]


def _moved(own: Constants, t: Any, y: Any, inputs: Any, torques: Sequence[Any]) -> tuple[list[Any], list[Any]]:
    """Slopes and guards of a driven crane under these torques."""
    state = state_of(y, JOINTS, AXES)
    booms = structure(own.crane, state.coordinates, state.rates)
    booms = booms._replace(force=[force + torque for force, torque in zip(booms.force, torques, strict=True)])
    hung = hang_load(booms, state, _rope(t, inputs), own.load, own.crane.gravity)
    return slopes(state, hung, hung.power + dot(torques, state.rates)), [hung.tension, *torques, *hung.guards]

"""What an engineer reads off a jib-crane run: sway, torques, tension and energy over time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.jib import kernel
from towercrane.results.recording import Quantity, load_places

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.kernels.payload import Load
    from towercrane.motions.motion import Motion

    Floats = NDArray[np.float64]

JOINT_CHANNELS = ("slew", "luff", "fold")

SWAY_IN_PLANE = (
    "swing in the booms' vertical plane, positive outward: atan2(n.e_r, -n_z) of the rope's direction n, "
    "e_r the horizontal direction of the booms"
)
SWAY_LATERAL = (
    "swing out of the booms' vertical plane, positive towards growing slew: atan2(n.e_t, hypot(n.e_r, n_z)) of the "
    "rope's direction n, e_t the horizontal normal of that plane"
)


@dataclass(frozen=True, eq=False)
class Rows:
    """Joints and rope over time.

    Parameters
    ----------
    angles, rates : ndarray, shape (p, 3)
        Joint angles [rad] and rates [rad/s].
    direction, swing : ndarray, shape (p, 3)
        Rope's unit vector in inertial axes and its rate [1/s].
    work : ndarray, shape (p,)
        Work put in since the start [J].
    """

    angles: Floats
    rates: Floats
    direction: Floats
    swing: Floats
    work: Floats


def driven_rows(states: Floats) -> Rows:
    """Rows of states (theta, n, theta', p, work, ...)."""
    edges = np.cumsum([kernel.JOINTS, kernel.AXES, kernel.JOINTS, kernel.AXES])
    angles, direction, rates, swing = np.split(states[:, : edges[-1]], edges[:-1], axis=1)
    return Rows(angles, rates, direction, swing, states[:, edges[-1]])


def planned_joints(motions: dict[str, Motion], times: Floats) -> tuple[Floats, Floats]:
    """Joint angles [rad] and rates [rad/s] of a plan; shapes (p, 3)."""
    angles, rates = (
        np.stack([motions[channel](times, derivative) for channel in JOINT_CHANNELS], axis=1) for derivative in (0, 1)
    )
    return angles, rates


def joint_error(motions: dict[str, Motion], times: Floats, states: Floats) -> Quantity:
    """How far the joints are off their plan."""
    error = states[:, : kernel.JOINTS] - planned_joints(motions, times)[0]
    return Quantity(("time", "joint"), error, "rad", "joint angles less those of the plan")


def sway_angles(slew: Floats, direction: Floats) -> tuple[Floats, Floats]:
    """In-plane and lateral swing of a rope's direction; shapes (p,) [rad].

    Parameters
    ----------
    slew : ndarray, shape (p,)
        Direction of the booms about the vertical [rad].
    direction : ndarray, shape (p, 3)
    """
    outward = direction[:, 0] * np.cos(slew) + direction[:, 1] * np.sin(slew)
    sideways = -direction[:, 0] * np.sin(slew) + direction[:, 1] * np.cos(slew)
    down = -direction[:, 2]
    return np.arctan2(outward, down), np.arctan2(sideways, np.hypot(outward, down))


def observe(
    numbers: Floats, load: Load, motions: dict[str, Motion], times: Floats, rows: Rows, guards: Floats
) -> dict[str, Quantity]:
    """Outputs of a run.

    Parameters
    ----------
    numbers : ndarray
        Constants of the compiled structure.
    load : Load
    motions : dict
        With "rope".
    times : ndarray, shape (p,)
    rows : Rows
    guards : ndarray, shape (p, g)
        Tension and joint torques.

    Returns
    -------
    dict of str to Quantity
    """
    length, hauling = motions["rope"](times), motions["rope"](times, 1)
    positions, velocities = np.empty((2, len(times), kernel.AXES))
    energies = np.empty(len(times))
    kernel.survey(
        np.ascontiguousarray(rows.angles), np.ascontiguousarray(rows.rates), numbers,
        positions, velocities, energies, np.zeros((kernel.ROWS, kernel.JOINTS)),
    )  # fmt: skip
    place = positions + length[:, None] * rows.direction
    speed = velocities + hauling[:, None] * rows.direction + length[:, None] * rows.swing
    energies += load.mass * (0.5 * (speed**2).sum(axis=1) + numbers[kernel.GRAVITY] * place[:, 2])
    in_plane, lateral = sway_angles(rows.angles[:, 0], rows.direction)
    torque = guards[:, kernel.TORQUE : kernel.TORQUE + kernel.JOINTS]
    return {
        "joint_angle": Quantity(
            ("time", "joint"),
            rows.angles,
            "rad",
            "slew about the vertical; elevation of the primary boom; the secondary boom's elevation from it",
        ),
        "rope_length": Quantity(("time",), length, "m", "rope length"),
        "sway_in_plane": Quantity(("time",), in_plane, "rad", SWAY_IN_PLANE),
        "sway_lateral": Quantity(("time",), lateral, "rad", SWAY_LATERAL),
        "joint_torque": Quantity(
            ("time", "joint"), torque, "N m", "torque of each joint's drive; at a jump the right limit"
        ),
        "rope_tension": Quantity(("time",), guards[:, kernel.TENSION], "N", "rope tension"),
        **load_places(place, rows.angles[:, 0], "the post's foot"),
        "total_energy": Quantity(
            ("time",), energies, "J", "kinetic and potential energy, zero level at the post's foot"
        ),
        "input_work": Quantity(
            ("time",), rows.work, "J", "work of joints and winch less what damping and drag took, since the start"
        ),
    }

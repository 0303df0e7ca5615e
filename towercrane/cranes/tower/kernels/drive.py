"""Compiled torque of a slewing drive and of its coupling."""

from __future__ import annotations

from typing import Any

import numpy as np

from modal.compiler.compiled import kernel
from towercrane.cranes.tower.kernels import layout as at
from towercrane.kernels.choices import below, choose
from towercrane.kernels.payload import FORCE
from towercrane.kernels.polynomial import polynomial


@kernel(inline=True)
def coupling_torque(twist: float, soft: float, stiff: float, corner: float) -> float:
    """Torque of the three straight lines of the drive's coupling, odd in the twist (Marinovic et al., Eq. 17)."""
    beyond = np.sign(twist) * (soft * corner + stiff * (abs(twist) - corner))
    return choose(below(corner, abs(twist)), beyond, soft * twist)


@kernel(inline=True)
def drive(t: float, y: Any, inputs: Any, numbers: Any, work: Any) -> tuple[float, float, float]:
    """Add the drive's torque to the slewing coordinate's force.

    Returns
    -------
    tuple of float
        Torque of the coupling with its damper [N m], power of shaft, damper and friction [W], and way beyond the
        coupling's corner [rad].
    """
    rates = (y.size - 1) // 2
    turned = int(numbers[at.DRIVEN])
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

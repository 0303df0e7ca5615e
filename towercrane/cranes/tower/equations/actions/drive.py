"""Torque of a slewing drive on the head, through a coupling with a corner."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from towercrane.cranes.parts.coupling import coupling_torque
from towercrane.cranes.tower.equations.constants import SLEWING

if TYPE_CHECKING:
    from towercrane.cranes.tower.equations.constants import Constants, Drives
    from towercrane.kernels.payload import State


class Driven(NamedTuple):
    """Torques of coupling with damper and of friction [N m]; their power with the shaft's [W]; way beyond the corner
    [rad]."""

    torque: Any
    friction: Any
    power: Any
    beyond: Any


def drive(crane: Constants, state: State, drives: Drives) -> Driven:
    """What the drive does to the slewing coordinate."""
    own, (turned,) = crane.drive, crane.part("slewing")
    assert own is not None
    shaft, shaft_rate, _ = drives[SLEWING]
    angle, rate = state.coordinates[turned], state.rates[turned]
    slip = rate - shaft_rate
    torque = -coupling_torque(angle - shaft, own.soft, own.stiff, own.corner) - own.damping * slip
    friction: Any = 0.0
    if own.friction == "tanh":
        friction = -own.friction_torque * np.tanh(rate / own.friction_rate)
    # What the shaft puts in is stored in the coupling, turns the head or is lost between them.
    power = torque * shaft_rate - own.damping * slip * slip + friction * rate
    return Driven(torque, friction, power, abs(angle - shaft) - own.corner)

"""Torque of a slewing drive on the head, through a coupling with a corner, or of a brake on a head that is free."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from towercrane.cranes.parts.coupling import coupling_torque
from towercrane.cranes.parts.friction import slip
from towercrane.cranes.tower.equations.constants import SLEWING

if TYPE_CHECKING:
    from towercrane.cranes.tower.equations.constants import Constants, Drives
    from towercrane.kernels.payload import State


class Driven(NamedTuple):
    """Torques of coupling with damper and of friction [N m]; their power with the shaft's [W]; way beyond the corner
    [rad]; of a brake direction of slip and whether it sticks."""

    torque: Any
    friction: Any
    power: Any
    beyond: Any
    way: Any = 0.0
    sticks: Any = 0.0


def drive(crane: Constants, state: State, drives: Drives) -> Driven:
    """What the drive does to the slewing coordinate."""
    own, (turned,) = crane.drive, crane.part("slewing")
    assert own is not None
    if crane.slewing == "free":
        return _braked(own.friction_torque, crane.friction_state, state.rates[turned])
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


def _braked(limit: Any, friction_state: Any, rate: Any) -> Driven:
    """What a brake does to a head that nothing drives."""
    way, sticks = slip(friction_state, rate)
    return Driven(0.0, -limit * way, -limit * way * rate, 0.0, way, sticks)

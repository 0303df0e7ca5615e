"""Tables that crane files of several families have."""

from __future__ import annotations

from typing import Literal

from towercrane.schema.fields import Corner, HingeDamping, RotaryStiffness, Table, TorqueOrNone, TurningOrNone


class Drive(Table):
    """Coupling of shaft and platform: soft up to the corner, stiff beyond it."""

    soft_stiffness: RotaryStiffness
    stiff_stiffness: RotaryStiffness
    corner: Corner
    damping: HingeDamping = 0.0


class Friction(Table):
    """Friction of the slewing bearing; the rate is the platform's at which tanh bends."""

    law: Literal["tanh", "stick-slip", "none"]
    torque: TorqueOrNone = 0.0
    rate: TurningOrNone = 0.0

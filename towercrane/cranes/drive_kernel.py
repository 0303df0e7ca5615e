"""Compiled torque of a slewing drive's coupling."""

from __future__ import annotations

import numpy as np

from modal.compiled import kernel
from towercrane.lane_choices import below, choose


@kernel(inline=True)
def coupling_torque(twist: float, soft: float, stiff: float, corner: float) -> float:
    """Torque of the three straight lines of the drive's coupling, odd in the twist (Marinovic et al., Eq. 17)."""
    beyond = np.sign(twist) * (soft * corner + stiff * (abs(twist) - corner))
    return choose(below(corner, abs(twist)), beyond, soft * twist)

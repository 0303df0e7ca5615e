"""Coupling of a shaft and what it drives: three straight lines, odd in the twist (Marinovic et al., Eq. 17)."""

from __future__ import annotations

from typing import Any

import numpy as np

from towercrane.kernels.choices import below, choose


def coupling_torque(twist: Any, soft: Any, stiff: Any, corner: Any) -> Any:
    """Torque at a twist [rad], with the stiffness up to the corner and beyond it [N m/rad]; [N m]."""
    beyond = np.sign(twist) * (soft * corner + stiff * (abs(twist) - corner))
    return choose(below(corner, abs(twist)), beyond, soft * twist)


def coupling_energy(twist: Any, soft: Any, stiff: Any, corner: Any) -> Any:
    """Energy of the same [J]."""
    size = abs(twist)
    is_beyond = below(corner, size)
    beyond, within = choose(is_beyond, size - corner, 0.0), choose(is_beyond, corner, size)
    return 0.5 * soft * (within * within) + soft * corner * beyond + 0.5 * stiff * (beyond * beyond)

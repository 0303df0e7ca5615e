"""Poses of a jib crane, whose post and booms are rigid."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.parts.poses import Poses, sampled

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import NDArray

    from towercrane.cranes.jib.model import PlannedJibCrane
    from towercrane.cranes.jib.tables import JibCase

    Floats = NDArray[np.float64]


def jib_poses(model: PlannedJibCrane, tables: JibCase, result: xr.Dataset, times: Floats) -> Poses:
    """Poses of a jib crane."""
    crane, angles = model.crane, sampled(result, "joint_angle", times)
    slew, luff = angles[:, 0], angles[:, 1]
    foot, hinge = np.zeros((2, len(times), 3))
    hinge[:, 2] = crane.post_height
    elbow = hinge + crane.primary_length * _towards(slew, luff)
    tip = elbow + crane.secondary_length * _towards(slew, luff + angles[:, 2])
    members = {
        "post": np.stack([foot, hinge], axis=1),
        "booms": np.stack([hinge, elbow, tip], axis=1),
        "suspension": tip[:, None],
    }
    return Poses(times, slew, members, members, sampled(result, "payload_position", times))


def _towards(azimuth: Floats, elevation: Floats) -> Floats:
    """Unit vectors; shape (f, 3)."""
    return np.stack(
        [np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)], axis=-1
    )

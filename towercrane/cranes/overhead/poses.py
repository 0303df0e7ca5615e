"""Poses of an overhead crane, seen along its runway."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.parts.poses import Poses, sampled

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import NDArray

    from towercrane.cranes.overhead.model import OverheadModel
    from towercrane.cranes.overhead.tables import OverheadCase

    Floats = NDArray[np.float64]

POINTS = 41
"""Of the bent bridge."""


def overhead_poses(model: OverheadModel, tables: OverheadCase, result: xr.Dataset, times: Floats) -> Poses:
    """Poses of an overhead crane; its heading is along the bridge."""
    height, length, span = model.crane.runway_height, model.crane.runway_length, model.crane.bridge_span
    bridge, trolley = sampled(result, "bridge_position", times), sampled(result, "trolley_position", times)
    uplift = -sampled(result, "bridge_deflection", times)
    rails = {}
    for name, y in (("first rail", 0.0), ("second rail", span)):
        ends = ((0.0, 0.0), (0.0, height), (length, height), (length, 0.0))
        line = np.array([[x, y, z] for x, z in ends])
        rails[name] = np.broadcast_to(line, (len(times), *line.shape))

    def across(places: Floats, bent: Floats) -> Floats:
        """Points of the bridge; shape (f, points, 3)."""
        x, y = np.broadcast_arrays(bridge[:, None], places)
        return np.stack([x, y, height + bent[:, None] * np.sin(np.pi * y / span)], axis=-1)

    def crane(bent: Floats) -> dict[str, Floats]:
        places = np.linspace(0.0, span, POINTS)[None]
        return {**rails, "bridge": across(places, bent), "suspension": across(trolley[:, None], bent)}

    heading = np.full(len(times), 0.5 * np.pi)
    load = sampled(result, "payload_position", times)
    return Poses(times, heading, crane(uplift), crane(np.zeros_like(uplift)), load)

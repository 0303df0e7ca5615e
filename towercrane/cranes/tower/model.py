"""Flexible tower crane with its load: its equations of motion in chosen modes, and what a run of it shows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.tower.equations.flexible import Equations

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.motions.motion import Motion
    from towercrane.results.recording import Quantity

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class FlexibleModel(Equations):
    """A flexible crane with its load as a simulation asks for it; its parameters are those of
    :class:`towercrane.cranes.tower.equations.coordinates.Coordinates`."""

    def observe(
        self, motions: dict[str, Motion], times: Floats, states: Floats, guards: Floats
    ) -> dict[str, Quantity]:
        """Outputs over time, see :func:`towercrane.cranes.tower.outputs.observed.observe`."""
        from towercrane.cranes.tower.outputs.observed import observe

        return observe(self, motions, times, states, guards)

    def provenance(self) -> dict[str, Any]:
        """Crane, modes and load, for a result's attributes."""
        modes = {f"{kind}_modes": count for kind, count in self.counts.items() if kind != "slewing"}
        return {
            "crane": self.crane.name,
            **modes,
            "frequency_cap": self.cap if np.isfinite(self.cap) else 0.0,
            "payload_mass": self.load.mass,
            "gravity": self.crane.gravity,
        }

"""Lumped cranes as a simulation asks for them: their equations of motion, and what a run shows."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from towercrane.cranes.slewing import kernel
from towercrane.cranes.slewing.equations import Equations

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from towercrane.motions.motion import Motion
    from towercrane.results.recording import Quantity

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class LumpedModel(Equations):
    """A lumped crane with its load, always in space; its parameters are those of
    :class:`towercrane.cranes.slewing.equations.Equations`."""

    def observe(
        self, motions: dict[str, Motion], times: Floats, states: Floats, guards: Floats
    ) -> dict[str, Quantity]:
        """Outputs over time, see :func:`towercrane.cranes.slewing.outputs.observe`."""
        from towercrane.cranes.slewing.outputs import observe

        return observe(self, motions, times, states, guards[:, kernel.TENSION])

    def provenance(self) -> dict[str, Any]:
        """Crane and load, for a result's attributes."""
        return {
            "crane": self.crane.name,
            "coordinates": ", ".join(self.crane.coordinates),
            "payload_mass": self.load.mass,
            "gravity": self.crane.gravity,
        }

    def with_drive(self, **changes: Any) -> LumpedModel:
        """The same model with a changed drive, such as ``friction="stick-slip"``."""
        drive = replace(self.crane.drive, **changes)
        return replace(self, crane=replace(self.crane, drive=drive))

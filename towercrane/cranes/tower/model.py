"""Flexible tower crane with its load: its equations of motion in chosen modes, and what a run of it shows."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from towercrane.cranes.tower.equations.coordinates import ANGLES
from towercrane.cranes.tower.equations.flexible import Equations
from towercrane.cranes.tower.outputs.cut_sums import NONE, Cuts
from towercrane.cranes.tower.outputs.observed import about, outputs
from towercrane.cranes.tower.outputs.seen import Seen, seen_of
from towercrane.simulation.observed import observe

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import NDArray

    from towercrane.kernels.load import Load
    from towercrane.motions.motion import Motion
    from towercrane.results.recording import Quantity
    from towercrane.simulation.observed import About, Instant

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class FlexibleModel(Equations):
    """A flexible crane with its load as a simulation asks for it; its parameters are those of
    :class:`towercrane.cranes.tower.equations.coordinates.Coordinates`, and named sections whose loads it shows."""

    cuts: Cuts = NONE

    @property
    def outputs(self) -> Callable[[Seen, Instant], Mapping[str, Any]]:
        """See :mod:`towercrane.cranes.tower.outputs.observed`."""
        return outputs

    @cached_property
    def seen(self) -> Seen:
        """Constants of the outputs."""
        return seen_of(self, self.cuts)

    @cached_property
    def about(self) -> Mapping[str, About]:
        """What the outputs are."""
        return about(self, self.cuts)

    def with_load(self, load: Load) -> Self:
        """The same crane with another load, see :class:`towercrane.cranes.tower.equations.flexible.Equations`."""
        other = super().with_load(load)
        vars(other)["seen"] = replace(self.seen, crane=other.constants)
        return other

    def observe(
        self, motions: dict[str, Motion], times: Floats, states: Floats, slopes: Floats, guards: Floats
    ) -> dict[str, Quantity]:
        """Outputs over time."""
        return observe(self, motions, times, states, slopes, guards)

    def provenance(self) -> dict[str, Any]:
        """Crane, modes and load, for a result's attributes."""
        modes = {f"{kind}_modes": count for kind, count in self.counts.items() if kind not in ANGLES}
        return {
            "crane": self.crane.name,
            **modes,
            "frequency_cap": self.cap if np.isfinite(self.cap) else 0.0,
            "payload_mass": self.load.mass,
            "gravity": self.crane.gravity,
        }

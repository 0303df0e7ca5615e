"""Lumped cranes as a simulation asks for them: their equations of motion, and what a run shows."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from towercrane.cranes.slewing.outputs import about_of, lumped_outputs, seen_of
from towercrane.cranes.slewing.system import LumpedSystem
from towercrane.simulation.observed import observe

if TYPE_CHECKING:
    from towercrane.cranes.slewing.outputs import Seen
    from towercrane.simulation.observed import About


@dataclass(frozen=True, eq=False)
class LumpedModel(LumpedSystem):
    """A lumped crane with its load, always in space; its parameters are those of
    :class:`towercrane.cranes.slewing.system.LumpedSystem`."""

    outputs = staticmethod(lumped_outputs)
    observe = observe

    @cached_property
    def about(self) -> dict[str, About]:
        """What the outputs are, by name."""
        return about_of(self.crane, self.carried, wind=bool(self.wind))

    @cached_property
    def seen(self) -> Seen:
        """What outputs are told beside the instant."""
        return seen_of(self.crane, self.constants)

    def provenance(self) -> dict[str, Any]:
        """Crane and load, for a result's attributes."""
        return {
            "crane": self.crane.name,
            "coordinates": ", ".join(self.crane.coordinates),
            "payload_mass": self.load.mass,
            "gravity": self.crane.gravity,
        }

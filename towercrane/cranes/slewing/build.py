"""What the checked tables of a slewing crane's case describe."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from towercrane.cranes.parts.load import load_of
from towercrane.cranes.parts.parameters import flat
from towercrane.cranes.slewing import models
from towercrane.cranes.slewing.model import LumpedModel
from towercrane.cranes.slewing.parameters import PARAMETERS

if TYPE_CHECKING:
    from collections.abc import Callable

    from towercrane.cranes.slewing.parameters import SlewingParameters
    from towercrane.cranes.slewing.tables import SlewingCase, SlewingCrane

CRANES: dict[str, Callable[[Any], Any]] = {
    "multi-mass": models.multi_mass,
    "enhanced": models.enhanced,
    "basic": models.basic,
}
"""What makes the crane of each kind of its parameters."""


def parameters_of(crane: SlewingCrane) -> SlewingParameters:
    """Parameters of a slewing crane, of its kind's class; each is named by its table and its key."""
    return PARAMETERS[crane.kind](**flat(crane))


def builder_of(tables: SlewingCase) -> Callable[[Any], LumpedModel]:
    """Model of a slewing case from a parameter set that may differ from the case's own."""
    crane, load, as_rod = CRANES[tables.crane.kind], load_of(tables.payload), tables.rope.slack == "rod"
    return lambda parameters: LumpedModel(crane(parameters), load, as_rod)


def model_of(tables: SlewingCase) -> LumpedModel:
    """Model of a slewing crane's case."""
    return builder_of(tables)(parameters_of(tables.crane))

"""What the checked tables of a slewing crane's case describe."""

from __future__ import annotations

from math import pi, sqrt
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.parts.load import ground_of, load_of
from towercrane.cranes.parts.parameters import flat
from towercrane.cranes.parts.turbulence.field import Places
from towercrane.cranes.slewing import models
from towercrane.cranes.slewing.model import LumpedModel
from towercrane.cranes.slewing.parameters import PARAMETERS

if TYPE_CHECKING:
    from collections.abc import Callable

    from towercrane.cranes.slewing.parameters import SlewingParameters
    from towercrane.cranes.slewing.tables import SlewingCase, SlewingCrane

CRANES: dict[str, Callable[[Any, float], Any]] = {
    "multi-mass": lambda parameters, _: models.multi_mass(parameters),
    "enhanced": lambda parameters, _: models.enhanced(parameters),
    "basic": models.basic,
}
"""What makes the crane of each kind of its parameters and the rope's length at the start."""


def parameters_of(crane: SlewingCrane) -> SlewingParameters:
    """Parameters of a slewing crane, of its kind's class; each is named by its table and its key."""
    return PARAMETERS[crane.kind](**flat(crane))


def builder_of(tables: SlewingCase) -> Callable[[Any], LumpedModel]:
    """Model of a slewing case from a parameter set that may differ from the case's own."""
    load = load_of(tables.payload, tables.rope, ground_of(tables), hook=tables.hook, slings=tables.slings)
    make, as_rod = CRANES[tables.crane.kind], tables.rope.slack == "rod"

    def build(parameters: Any) -> LumpedModel:
        crane, wind = make(parameters, tables.rope.length), tables.wind
        return LumpedModel(crane, load, as_rod, 0 if wind is None else len(crane.points) + 1 if wind.differs else 1)

    return build


def places_of(tables: SlewingCase) -> Places:
    """Where a wind that differs blows, of a crane that stands undeformed along x: its points, and the load."""
    crane = CRANES[tables.crane.kind](parameters_of(tables.crane), tables.rope.length)
    points = {
        name: (sum(link.ahead.get("", 0.0) for link in point.links), 0.0, point.height.get("", 0.0))
        for name, point in crane.points.items()
    }
    hung = np.array(points[crane.suspension])
    load = hung - (0.0, 0.0, tables.rope.length)
    return Places(np.array([*points.values(), load]), hung[2], 2.0 * pi * sqrt(tables.rope.length / crane.gravity))


def model_of(tables: SlewingCase) -> LumpedModel:
    """Model of a slewing crane's case."""
    return builder_of(tables)(parameters_of(tables.crane))

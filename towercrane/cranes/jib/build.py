"""What the checked tables of a jib crane's case describe."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from towercrane.cranes.parts.load import ground_of, load_of
from towercrane.cranes.parts.parameters import flat

if TYPE_CHECKING:
    from towercrane.cranes.jib.model import PlannedJibCrane
    from towercrane.cranes.jib.tables import JibCase, JibCrane


def parameters_of(crane: JibCrane) -> dict[str, Any]:
    """Name, gravity, lengths, masses per length and inertia of a jib crane."""
    return {name.replace("_boom_", "_"): value for name, value in flat(crane).items()}


def model_of(tables: JibCase) -> PlannedJibCrane:
    """Model of a jib crane's case."""
    from towercrane.cranes.jib.model import PlannedJibCrane
    from towercrane.cranes.jib.parameters import JibCrane

    crane = JibCrane(**parameters_of(tables.crane))
    load = load_of(tables.payload, tables.rope, ground_of(tables), hook=tables.hook, slings=tables.slings)
    return PlannedJibCrane(crane, load, rope_as_rod=tables.rope.slack == "rod")

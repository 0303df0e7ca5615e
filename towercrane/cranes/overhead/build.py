"""What the checked tables of an overhead crane's case describe."""

from __future__ import annotations

from typing import TYPE_CHECKING

from towercrane.cranes.overhead.model import OverheadModel
from towercrane.cranes.overhead.parameters import OverheadCrane
from towercrane.cranes.parts.load import ground_of, load_of
from towercrane.cranes.parts.parameters import flat

if TYPE_CHECKING:
    from towercrane.cranes.overhead.tables import OverheadCase


def model_of(tables: OverheadCase) -> OverheadModel:
    """Model of an overhead crane's case."""
    crane = OverheadCrane(**flat(tables.crane))
    load = load_of(tables.payload, tables.rope, ground_of(tables), hook=tables.hook, slings=tables.slings)
    return OverheadModel(crane, load, rope_as_rod=tables.rope.slack == "rod")


def lengths_of(model: OverheadModel) -> dict[str, float]:
    """Length of what deflects [m]."""
    return {"bridge_deflection": model.crane.bridge_span}

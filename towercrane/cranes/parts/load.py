"""The load of a case."""

from __future__ import annotations

from typing import TYPE_CHECKING

from towercrane.kernels.payload import AIR_DENSITY, Load

if TYPE_CHECKING:
    from towercrane.schema.fields import Payload


def load_of(payload: Payload) -> Load:
    """The load and its rope's losses."""
    drag_area = payload.drag_area or 2.0 * payload.drag / AIR_DENSITY
    return Load(mass=payload.mass, rope_damping=payload.rope_damping, drag_area=drag_area)

"""What a radial case asks to be shown, its defaults filled in."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from towercrane.cranes.tower.file.case_tables import MapRequest, ModesRequest, RadialCase
    from towercrane.motions.motion import Motion


def modes_of(tables: RadialCase, trolley: Motion) -> ModesRequest:
    """What to show of the modes; positions of the trolley default to both ends of its way."""
    modes = tables.modes
    if modes.trolley_positions:
        return modes
    return modes.model_copy(update={"trolley_positions": tuple(dict.fromkeys(trolley.range()))})


def map_of(tables: RadialCase) -> MapRequest:
    """Where the frequency map is taken."""
    asked, jib, load = tables.map, tables.crane.jib.length, tables.payload.mass
    steps = asked.position_count - 1
    positions = asked.trolley_positions or tuple(jib * i / steps for i in range(steps + 1))
    masses = asked.payload_masses or (0.5 * load, load, 2.0 * load)
    return asked.model_copy(update={"trolley_positions": positions, "payload_masses": masses})

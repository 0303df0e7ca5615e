"""What an engineer reads off an overhead crane: positions, deflection, sway, forces and energy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.overhead.equations import AXES, BRIDGE, ROPE, SECOND_RAIL, TROLLEY
from towercrane.cranes.parts.base import BASE, NONE, Reaction, rope_on_crane
from towercrane.cranes.parts.points import Point
from towercrane.kernels.payload import state_of
from towercrane.simulation.observed import About

if TYPE_CHECKING:
    from towercrane.cranes.overhead.equations import Constants
    from towercrane.kernels.algebra import Row
    from towercrane.simulation.observed import Instant

RUNWAY = {name: BASE[name] for name in ("base_force_x", "base_force_y", "base_force_z", "base_shear")}
"""Outputs of the base: forces alone, since a runway is nothing that a crane could overturn."""

SWAYS = {
    "sway_along_runway": About("rad", "sway along the runway, atan2(along, down)"),
    "sway_along_bridge": About("rad", "sway along the bridge, atan2(along, down)"),
}

ABOUT = {
    "bridge_position": About("m", "bridge along the runway"),
    "bridge_speed": About("m/s", "speed of the bridge"),
    "trolley_position": About("m", "trolley along the bridge, from the first rail"),
    "trolley_speed": About("m/s", "speed of the trolley along the bridge"),
    "bridge_deflection": About(
        "m", "deflection of the bridge at mid-span from the straight one without weight, positive down"
    ),
    "trolley_drop": About("m", "deflection of the bridge under the trolley, positive down"),
    "rope_length": About("m", "rope length"),
    **SWAYS,
    "hoist_rope_force": About("N", "rope tension"),
    "bridge_force": About("N", "force of the bridge's drive; at a jump the right limit"),
    "trolley_force": About("N", "force of the trolley's drive; at a jump the right limit"),
    "first_rail_load": About("N", "wheel loads of the bridge on the rail where the trolley's zero is"),
    "second_rail_load": About("N", "wheel loads of the bridge on the other rail"),
    **{name: shown for name, (_, shown) in RUNWAY.items()},
    "payload_position": About(
        "m",
        "load from the floor where runway and first rail begin: along the runway, along the bridge, up",
        ("fixed_axis",),
        3,
    ),
    "total_energy": About("J", "kinetic and potential energy, zero level at the floor"),
    "input_work": About("J", "work of drives and winch less what damping and drag took, since the start"),
}
"""What the outputs are."""


@dataclass(frozen=True, slots=True)
class Seen:
    """The crane as its equations know it."""

    crane: Constants


def overhead_outputs(seen: Seen, instant: Instant) -> dict[str, Any]:
    """Outputs at an instant, see :data:`ABOUT`."""
    crane, state = seen.crane, state_of(instant.state, 1, AXES)
    (bridge, bridge_rate, _), (trolley, trolley_rate, trolley_more), (length, hauling, _) = (
        instant.drives[row] for row in (BRIDGE, TROLLEY, ROPE)
    )
    tension, bridge_force, trolley_force, first_rail, second_rail = instant.guards[: SECOND_RAIL + 1]
    (uplift,), (rate,), height = state.coordinates, state.rates, crane.runway_height
    wave = np.pi / crane.span
    shape, tilt = np.sin(wave * trolley), wave * np.cos(wave * trolley)
    suspension = Point(
        [bridge, trolley, height + shape * uplift],
        [bridge_rate, trolley_rate, shape * rate + tilt * trolley_rate * uplift],
    )
    carried = suspension.carry(crane.load, state, length, hauling, instant.guards)

    def sways(along: Row) -> dict[str, Any]:
        return dict(zip(SWAYS, (np.arctan2(along[k], -along[2]) for k in range(2)), strict=True))

    energy = 0.5 * (crane.girder_mass + crane.carriage_mass) * bridge_rate * bridge_rate
    energy = energy + 0.25 * crane.girder_mass * rate * rate + 0.5 * crane.stiffness * uplift * uplift
    energy = energy + crane.gravity * crane.girder_mass * (height + 2.0 / np.pi * uplift)
    energy = energy + suspension.energy(crane.trolley_mass, crane.gravity)
    pull, _ = rope_on_crane(tension, *carried.rope)
    runway = -bridge_force, pull[1] - crane.trolley_mass * trolley_more, -(first_rail + second_rail)
    return {
        "bridge_position": bridge,
        "bridge_speed": bridge_rate,
        "trolley_position": trolley,
        "trolley_speed": trolley_rate,
        "bridge_deflection": -uplift,
        "trolley_drop": -shape * uplift,
        "rope_length": length,
        **sways(carried.along),
        **carried.sling_sways(state, sways),
        "hoist_rope_force": tension,
        **carried.shown,
        "bridge_force": bridge_force,
        "trolley_force": trolley_force,
        "first_rail_load": first_rail,
        "second_rail_load": second_rail,
        **{name: read(Reaction(runway, NONE)) for name, (read, _) in RUNWAY.items()},
        "payload_position": carried.load.place,
        "total_energy": energy + carried.energy(crane.load, crane.gravity) + carried.stored,
        "input_work": instant.state[-1],
    }

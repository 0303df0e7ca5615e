"""Overhead cranes: a bridge that travels on a runway, a trolley that travels on the bridge."""

from __future__ import annotations

from functools import partial
from math import pi
from typing import TYPE_CHECKING

from towercrane.cranes.kind import Drives, Kind, Panel, Signals, Track, later
from towercrane.cranes.overhead.tables import OverheadCase
from towercrane.cranes.parts.height import summed
from towercrane.schema.ranges import LENGTHS, Range, si_at

if TYPE_CHECKING:
    from towercrane.cranes.kind import Pictures

SWAYS = {"sway_along_runway": "along the runway", "sway_along_bridge": "along the bridge"}
WAYS = {"bridge_position": "bridge", "trolley_position": "trolley", "rope_length": "rope"}
SPEEDS = {"bridge_speed": "bridge", "trolley_speed": "trolley"}
DROPS = {"bridge_deflection": "at mid-span", "trolley_drop": "under the trolley"}
FORCES = {"bridge_force": "bridge", "trolley_force": "trolley"}
RAILS = {"first_rail_load": "first rail", "second_rail_load": "second rail"}
TENSION = Panel("rope tension [kN]", 1e-3, {"hoist_rope_force": "rope tension"})

PICTURES: Pictures = {
    "overview.png": (
        "Run",
        (
            Panel("length [m]", 1.0, WAYS),
            Panel("speed [m/s]", 1.0, SPEEDS),
            Panel("sway [deg]", 180.0 / pi, SWAYS),
            Panel("deflection [mm]", 1e3, DROPS),
            TENSION,
        ),
    ),
    "forces.png": ("Forces", (Panel("drive [kN]", 1e-3, FORCES), Panel("load of a rail [kN]", 1e-3, RAILS), TENSION)),
}


OVERHEAD = Kind(
    name="overhead",
    tables=OverheadCase,
    drives=Drives(
        summed("crane.runway.height"), "the height of the runway",
        (
            Track("bridge", partial(si_at, key="crane.runway.length", unit="m"), "runway"),
            Track("trolley", partial(si_at, key="crane.bridge.span", unit="m"), "bridge"),
        ),
    ),
    ranges=(
        Range("crane.runway.height", "m", 1, 200, LENGTHS),
        Range("crane.runway.length", "m", 1, 5000, LENGTHS),
        Range("crane.bridge.span", "m", 1, 200, LENGTHS),
        Range("crane.bridge.end_carriage_mass", "kg", 5, 1e6, ("t", "g")),
        Range("crane.bridge.damping_ratio", "1", 1e-6, 0.3, ("%",)),
        Range("crane.trolley.mass", "kg", 5, 500e3, ("t", "g")),
    ),
    build=later("towercrane.cranes.overhead.build", "model_of"),
    poses=later("towercrane.cranes.overhead.poses", "overhead_poses"),
    lengths=later("towercrane.cranes.overhead.build", "lengths_of"),
    signals=Signals("bridge_deflection", ("sway_along_runway",)),
    pictures=PICTURES,
    sways=SWAYS,
)  # fmt: skip

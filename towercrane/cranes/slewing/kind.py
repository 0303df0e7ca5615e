"""Lumped slewing cranes: the multi-mass model and two smaller ones, whose crane files differ."""

from __future__ import annotations

from typing import TYPE_CHECKING

from towercrane.cranes.kind import Drives, Kind, Signals, later
from towercrane.cranes.parts.height import summed
from towercrane.cranes.parts.turbulence.checks import check_wind
from towercrane.cranes.slewing.tables import BasicCase, EnhancedCase, MultiMassCase
from towercrane.schema.ranges import SPRINGS, Range

if TYPE_CHECKING:
    from towercrane.cranes.slewing.tables import SlewingCase

PRESSED = {
    **{f"crane.drag.{point}": "N s^2/m^2" for point in ("tower_top", "jib_tip", "counterweight")},
    "payload.drag_area": "m^2",
    "payload.drag": "N s^2/m^2",
}
"""What the wind may press on, and its unit."""

HEIGHT = summed("crane.geometry.tower_height", "crane.geometry.top_height")


def _kind(name: str, tables: type[SlewingCase], *ranges: Range) -> Kind:
    """A kind of slewing crane, which differs from the others by its parameters."""
    return Kind(
        name=name,
        tables=tables,
        drives=Drives(HEIGHT, "the height of the tower with its top", joints=(("shaft",),), wind=True),
        checks=(lambda tree: check_wind(tree, PRESSED),),
        wind_places=later("towercrane.cranes.slewing.build", "places_of"),
        ranges=ranges,
        build=later("towercrane.cranes.slewing.build", "model_of"),
        poses=later("towercrane.cranes.slewing.poses", "slewing_poses"),
        signals=Signals("jib_moment_vertical", ("sway_radial",)),
        pictures="slewing",
        sways={"sway_radial": "along the jib", "sway_tangential": "across the jib"},
    )


MULTI_MASS = _kind("multi-mass", MultiMassCase)
ENHANCED = _kind("enhanced", EnhancedCase)
BASIC = _kind(
    "basic",
    BasicCase,
    Range("crane.stiffness.jib_lateral", "N/m", 500, 1e12, SPRINGS),
    Range("crane.damping.jib_lateral", "N s/m", 1e-3, 1e9, ("kN s/m",)),
)
SLEWING = (MULTI_MASS, ENHANCED, BASIC)

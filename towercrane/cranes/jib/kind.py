"""Jib cranes: a post that slews, a boom that luffs and a boom that folds."""

from __future__ import annotations

from towercrane.cranes.jib.tables import JibCase
from towercrane.cranes.kind import Drives, Kind, Signals, later
from towercrane.cranes.parts.height import summed

HEIGHT = summed("crane.post.height", "crane.primary_boom.length", "crane.secondary_boom.length")


JIB = Kind(
    name="jib",
    tables=JibCase,
    drives=Drives(HEIGHT, "post and booms upright", joints=(("slew",), ("luff",), ("fold",))),
    build=later("towercrane.cranes.jib.build", "model_of"),
    poses=later("towercrane.cranes.jib.poses", "jib_poses"),
    signals=Signals("sway_in_plane", ("sway_in_plane",)),
    pictures="jib",
    sways={"sway_in_plane": "along the booms", "sway_lateral": "across the booms"},
)

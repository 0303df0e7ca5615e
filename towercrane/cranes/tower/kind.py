"""Tower cranes: in the plane of the jib, and in space."""

from __future__ import annotations

from towercrane.cranes.kind import Drives, Kind, Signals, Track, later
from towercrane.cranes.tower.file.case_tables import RadialCase, SpaceCase
from towercrane.cranes.tower.file.checks import check_tower, tower_height
from towercrane.cranes.tower.file.space_checks import check_space
from towercrane.cranes.tower.targets import RADIAL as RADIAL_TARGETS
from towercrane.cranes.tower.targets import SPACE as SPACE_TARGETS

TRACKS = (Track("trolley", "crane.jib.length", "jib"),)

FASTEST_SLEWING = 0.5
"""Largest plausible speed of a tower crane's head whose motion states none [rad/s]; they turn at 0.1 or less."""

RADIAL = Kind(
    name="radial",
    family="tower",
    words=("plane", "planar", "in-plane"),
    tables=RadialCase,
    drives=Drives(tower_height, "the height of the tower", TRACKS),
    checks=(check_tower,),
    build=later("towercrane.cranes.tower.file.build", "radial_model"),
    poses=later("towercrane.cranes.tower.poses", "radial_poses"),
    idle=later("towercrane.cranes.tower.file.idle", "idle_in_plane"),
    kernels=later("towercrane.cranes.tower.file.kernels", "radial_kernels"),
    natural=later("towercrane.cranes.tower.file.natural", "natural_in_plane"),
    lengths=later("towercrane.cranes.tower.file.natural", "lengths_in_plane"),
    signals=Signals("tower_tip_displacement", "swing_angle"),
    pictures="radial",
    targets=RADIAL_TARGETS,
    modes={"tower_modes": "tower", "jib_modes": "jib"},
    sways={"swing_angle": "along the jib"},
    serves=frozenset({"modes", "map", "lattice", "compare", "verify", "shape", "lanes", "members"}),
)

SPACE = Kind(
    name="space",
    family="tower",
    tables=SpaceCase,
    drives=Drives(
        tower_height, "the height of the tower", TRACKS,
        joints=(("shaft", "slewing"),), fastest_turn=FASTEST_SLEWING, wind=True,
    ),
    checks=(check_tower, check_space),
    build=later("towercrane.cranes.tower.file.build", "space_model"),
    poses=later("towercrane.cranes.tower.poses", "space_poses"),
    idle=later("towercrane.cranes.tower.file.idle", "idle_in_space"),
    kernels=later("towercrane.cranes.tower.file.kernels", "space_kernels"),
    natural=later("towercrane.cranes.tower.file.natural", "natural_in_space"),
    lengths=later("towercrane.cranes.tower.file.natural", "lengths_in_space"),
    signals=Signals("tower_tip_displacement", "sway_tangential"),
    pictures="space",
    targets=SPACE_TARGETS,
    modes={
        "tower_modes": "tower",
        "torsion_modes": "torsion",
        "jib_lateral_modes": "lateral",
        "jib_vertical_modes": "vertical",
    },
    sways={"sway_radial": "along the jib", "sway_tangential": "across the jib"},
    serves=frozenset({"modes", "compare", "verify", "shape"}),
)  # fmt: skip

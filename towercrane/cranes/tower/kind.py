"""Tower cranes. Whether one moves in the plane of its jib or in space follows from its scene."""

from __future__ import annotations

from towercrane.cranes.kind import Drives, Kind, Signals, Track, later
from towercrane.cranes.parts.hoisting.release_table import check_release
from towercrane.cranes.parts.hoisting.release_table import refused as no_release
from towercrane.cranes.tower.file.case_tables import TowerCase
from towercrane.cranes.tower.file.checks.free import check_free, refused_free
from towercrane.cranes.tower.file.checks.jib import check_jibs, jib_length
from towercrane.cranes.tower.file.checks.luffing import check_luffing, head_height, limits, pivots, refused
from towercrane.cranes.tower.file.checks.rope import check_elastic
from towercrane.cranes.tower.file.checks.rope import refused as refused_on_elastic
from towercrane.cranes.tower.file.checks.scene import check_scene
from towercrane.cranes.tower.file.checks.sections import check_sections
from towercrane.cranes.tower.file.checks.ties import check_ties
from towercrane.cranes.tower.file.checks.ties import refused as refused_on_ties
from towercrane.cranes.tower.file.checks.tower import check_tower, tower_height

TRACKS = (Track("trolley", jib_length, "jib"),)

FASTEST_SLEWING = 0.5
"""Largest plausible speed of a tower crane's head whose motion states none [rad/s]; they turn at 0.1 or less."""

FIXED = Drives(
    tower_height, "the height of the tower", TRACKS,
    joints=(("shaft", "slewing"),), fastest_turn=FASTEST_SLEWING, wind=True, earthquake=True,
)  # fmt: skip

PIVOTING = Drives(
    head_height, "the height of the jib's head",
    joints=(("luffing",), ("shaft", "slewing")), fastest_turn=FASTEST_SLEWING, wind=True, limits={"luffing": limits},
)  # fmt: skip
"""Of a crane whose jib pivots."""

TOWER = Kind(
    name="tower",
    tables=TowerCase,
    drives=FIXED,
    drives_in=lambda tree: PIVOTING if pivots(tree) else FIXED,
    checks=(
        check_tower, check_jibs, check_luffing, check_ties, check_sections, check_scene, check_elastic, check_free,
        check_release,
    ),
    build=later("towercrane.cranes.tower.file.build", "tower_model"),
    poses=later("towercrane.cranes.tower.poses", "tower_poses"),
    computed=later("towercrane.cranes.tower.file.lattices.torsion", "computed"),
    idle=later("towercrane.cranes.tower.file.idle", "idle"),
    natural=later("towercrane.cranes.tower.file.natural", "natural"),
    lengths=later("towercrane.cranes.tower.file.natural", "lengths"),
    targets=later("towercrane.cranes.tower.file.requests", "targets_of"),
    outputs=later("towercrane.cranes.tower.outputs.luffing", "names"),
    made_of=later("towercrane.cranes.tower.sharing", "made_of"),
    plain=later("towercrane.cranes.tower.sharing", "plain"),
    signals=Signals("tower_tip_displacement", ("sway_tangential", "sway_radial")),
    pictures="tower",
    modes=later("towercrane.cranes.tower.file.requests", "modes_that_move"),
    left_out=later("towercrane.cranes.tower.file.requests", "left_out"),
    notices=later("towercrane.cranes.tower.file.requests", "notices"),
    sways={"sway_radial": "along the jib", "sway_tangential": "across the jib"},
    wind_places=later("towercrane.cranes.tower.file.wind", "places_of"),
    refuses=lambda tables: (
        refused_on_elastic(tables) | refused(tables) | refused_on_ties(tables) | refused_free(tables)
        | no_release(tables.release)
    ),
    serves=frozenset({"modes", "map", "lattice", "compare", "verify", "shape", "members", "lift"}),
)  # fmt: skip

"""Outputs of a tower crane's run whose error can be asked for, with their units, and those that a plane has not."""

from towercrane.cranes.tower.modes.collars import MOST_COLLARS
from towercrane.cranes.tower.modes.tied.bars import MOST_TIES

FORETOLD = {"tower_tip_displacement": "m", "jib_tip_deflection": "m", "sway_radial": "rad", "hoist_rope_force": "N"}
"""Those whose error small motions in the jib's plane foretell, without a run."""

MOTIONS = {
    "payload_position": "m",
    "sway_radial": "rad",
    "sway_tangential": "rad",
    "tower_tip_displacement": "m",
    "tower_tip_displacement_sideways": "m",
    "tower_tip_twist": "rad",
    "jib_tip_deflection": "m",
    "jib_tip_deflection_sideways": "m",
}
"""Motions, wherever the crane moves."""

LUFFING_MOTIONS = {"luffing_angle": "rad", "jib_deflection": "m"}
"""Those of a jib that pivots."""

LUFFING_FORCES = {"luffing_rope_force": "N"}

TENSIONS = {
    member: {f"{member}_tie_{k}_tension": "N" for k in range(1, MOST_TIES + 1)} for member in ("jib", "counter_jib")
}
"""Those of ties, by what hangs on them, from the tower's axis outward."""

COMPRESSION = {"jib_compression": "N"}
"""Of a jib that pivots or hangs on ties."""

ANY_MOTION = MOTIONS | LUFFING_MOTIONS

ALL = ANY_MOTION | {
    "hoist_rope_force": "N",
    "trolley_force": "N",
    "slewing_torque": "N m",
    "jib_root_moment": "N m",
    "jib_root_moment_sideways": "N m",
    "base_moment_x": "N m",
    "base_moment_y": "N m",
    "base_torque": "N m",
    **LUFFING_FORCES,
    **COMPRESSION,
    **TENSIONS["jib"],
    **TENSIONS["counter_jib"],
}
"""Motions, forces and moments."""

NOT_LUFFING = ("jib_tip_deflection", "trolley_force", "jib_root_moment")
"""Outputs that a crane whose jib pivots has not."""

NOT_TIED = ("jib_root_moment", "jib_root_moment_sideways")
"""Outputs that a crane on ties has not."""

OUT_OF_PLANE = (
    "slewing_speed",
    "slewing_torque",
    "sway_tangential",
    "sling_sway_tangential",
    "tower_tip_displacement_sideways",
    "tower_tip_roll",
    "tower_tip_twist",
    "jib_tip_deflection_sideways",
    "jib_root_moment_sideways",
    "counter_jib_tip_deflection_sideways",
    "counter_jib_root_moment_sideways",
    "base_torque",
    *(f"collar_{k}_torque" for k in range(1, MOST_COLLARS + 1)),
)
"""Outputs that stay zero in a scene in the jib's plane."""

OUT_OF_X = (
    "slewing_angle",
    "base_moment_x",
    "base_force_y",
    "ground_acceleration_y",
    "payload_in_crane_axes",
    "tower_y_coordinate",
    *(f"collar_{k}_{what}" for k in range(1, MOST_COLLARS + 1) for what in ("force_y", "moment_x")),
)
"""Outputs that tell nothing where that plane is the one of the fixed x axis: they stay zero or say what others do."""


def absent(heading: float) -> tuple[str, ...]:
    """Outputs that a scene in a plane at this angle from the x axis [rad] does not have."""
    return OUT_OF_PLANE if heading else OUT_OF_PLANE + OUT_OF_X


def lacking(pivots: bool, jib_ties: int, counter_jib_ties: int) -> frozenset[str]:
    """Outputs of `ALL` that a crane does not have, by whether its jib pivots and by how many ties it has."""
    counts = {"jib": jib_ties, "counter_jib": counter_jib_ties}
    found = {name for member, names in TENSIONS.items() for name in list(names)[counts[member] :]}
    found |= {*NOT_LUFFING} if pivots else {*LUFFING_MOTIONS, *LUFFING_FORCES}
    if jib_ties:
        found |= {*NOT_TIED}
    if not pivots and not jib_ties:
        found |= {*COMPRESSION}
    return frozenset(found)

"""Outputs of a tower crane's run whose error can be asked for, with their units, and those that a plane has not."""

from towercrane.cranes.tower.modes.collars import MOST_COLLARS

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

ALL = MOTIONS | {
    "hoist_rope_force": "N",
    "trolley_force": "N",
    "slewing_torque": "N m",
    "jib_root_moment": "N m",
    "jib_root_moment_sideways": "N m",
    "base_moment_x": "N m",
    "base_moment_y": "N m",
    "base_torque": "N m",
}
"""Motions, forces and moments."""

OUT_OF_PLANE = (
    "slewing_speed",
    "slewing_torque",
    "sway_tangential",
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

"""Outputs of a tower crane's run whose error can be asked for."""

RADIAL = {"tower_tip_displacement": "m", "jib_tip_deflection": "m", "swing_angle": "rad", "rope_tension": "N"}
"""Outputs of a run in the plane, and their units."""


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
"""Outputs of a run in space that are motions."""


SPACE = MOTIONS | {
    "rope_tension": "N",
    "trolley_force": "N",
    "slewing_torque": "N m",
    "jib_root_moment": "N m",
    "jib_root_moment_sideways": "N m",
    "base_moment_x": "N m",
    "base_moment_y": "N m",
    "base_torque": "N m",
}
"""Outputs of a run in space."""

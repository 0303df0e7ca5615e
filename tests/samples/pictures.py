"""Made-up recordings for pictures: every value is different."""

import json

import numpy as np

from towercrane.results.recording import Quantity, Recording

ROWS = 90
TIMES = np.cumsum(np.random.default_rng(3).uniform(0.05, 0.15, ROWS))
DEGREE = 180.0 / np.pi


def made(names, seed=1, **attrs):
    """A run whose every value is different; names of vectors end in ``:`` and their dimension."""
    random, found = np.random.default_rng(seed), {}
    for k, name in enumerate(names):
        name, _, dimension = name.partition(":")
        shape = (ROWS, 3) if dimension else (ROWS,)
        values = (k + 2.0) * random.uniform(0.1, 1.0, shape) * (-1.0) ** k
        found[name] = Quantity(("time", dimension) if dimension else ("time",), values, "1", f"what {name} is")
    about = {"crane": "Some crane", "case": "folder/some-case", "payload_mass": 777.0, "outcome": "finished",
             "end_time": TIMES[-1], "assumed": json.dumps([["a.key", "3 m", "why"]])}  # fmt: skip
    return Recording(TIMES, found, {**about, **attrs}).dataset()


RADIAL = made(
    ["trolley_position", "trolley_speed", "rope_length", "sway_radial", "swing_rate", "tower_tip_displacement",
     "jib_tip_deflection", "hoist_rope_force"]
)  # fmt: skip
SLEWING = made(
    ["shaft_speed", "rope_length", "sway_tangential", "sway_radial", "jib_moment_horizontal", "jib_moment_vertical",
     "drive_torque", "drive_torque_elastic", "hoist_rope_force", "platform_angle", "shaft_angle",
     "payload_position:axis"]
)  # fmt: skip
SPACE = made(
    ["slewing_angle", "shaft_angle", "trolley_position", "rope_length", "sway_radial", "sway_tangential",
     "slewing_torque", "trolley_force", "hoist_rope_force", "tower_tip_displacement",
     "tower_tip_displacement_sideways", "tower_tip_twist", "tower_tip_tilt", "tower_tip_roll",
     "jib_tip_deflection", "jib_tip_deflection_sideways",
     "jib_root_moment", "jib_root_moment_sideways", "counter_jib_tip_deflection",
     "counter_jib_tip_deflection_sideways", "counter_jib_root_moment", "counter_jib_root_moment_sideways",
     "base_moment_x", "base_moment_y", "base_torque",
     "wind_x", "wind_y", "wind_z", "payload_position:axis"]
)  # fmt: skip
JIB = made(
    ["joint_angle:joint", "rope_length", "sway_in_plane", "sway_lateral", "joint_torque:joint", "hoist_rope_force",
     "payload_position:axis"]
)  # fmt: skip

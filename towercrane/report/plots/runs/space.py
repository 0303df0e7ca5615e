"""Pictures of runs in space: sway, torques, tower top, moments on the base, wind, ground, collars, path."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.kind import Panel
from towercrane.cranes.tower.modes.collars import MOST_COLLARS
from towercrane.cranes.tower.modes.tied.bars import MOST_TIES
from towercrane.report.plots.runs.panels import BASE

if TYPE_CHECKING:
    import xarray as xr

    from towercrane.cranes.kind import Pictures

DEGREES = 180.0 / np.pi

SWAY = Panel("sway [deg]", DEGREES, {"sway_radial": "along the jib", "sway_tangential": "across the jib"})
TORQUE = Panel("torque [kN m]", 1e-3, {"slewing_torque": "slewing drive on the head"})
TOP = Panel(
    "tower top [mm]",
    1e3,
    {"tower_tip_displacement": "along the jib", "tower_tip_displacement_sideways": "across the jib"},
)
TWIST = Panel(
    "tower top [mrad]", 1e3, {"tower_tip_twist": "twist", "tower_tip_tilt": "tilt", "tower_tip_roll": "roll"}
)
TENSION = Panel(
    "rope tension [kN]",
    1e-3,
    {"hoist_rope_force": "rope tension", "luffing_rope_force": "tension of the luffing rope"},
)
GROUND = Panel(
    "ground [m/s^2]",
    1.0,
    {"ground_acceleration_x": "along x", "ground_acceleration_y": "along y", "ground_acceleration_z": "up"},
)
COLLARS = tuple(
    Panel(
        f"collars along {axis} [kN]",
        1e-3,
        {f"collar_{k}_force_{axis}": f"force on collar {k}" for k in range(1, MOST_COLLARS + 1)},
    )
    for axis in "xy"
)
TIES = tuple(
    Panel(
        f"ties of the {said} [kN]",
        1e-3,
        {f"{side}_tie_{k}_tension": f"tension of tie {k}" for k in range(1, MOST_TIES + 1)},
    )
    for side, said in (("jib", "jib"), ("counter_jib", "counter-jib"))
)
WIND = (
    Panel("wind [m/s]", 1.0, {"wind_x": "along x", "wind_y": "along y", "wind_z": "up"}),
    Panel("wind speed [m/s]", 1.0, {"wind_speed_load": "at the load", "wind_speed_tip": "at the jib's tip"}),
)

PICTURES: Pictures = {
    "overview.png": (
        "Run",
        (
            Panel(
                "angle [deg]",
                DEGREES,
                {"slewing_angle": "head", "shaft_angle": "shaft of its drive", "luffing_angle": "jib over the head"},
            ),
            Panel("length [m]", 1.0, {"trolley_position": "trolley on the jib", "rope_length": "rope"}),
            SWAY,
            TORQUE,
            TOP,
            TENSION,
        ),
    ),
    "sway.png": (
        "Sway of the load",
        tuple(Panel(f"{where} [deg]", DEGREES, {name: f"sway {where}"}) for name, where in SWAY.lines.items()),
    ),
    "torque.png": (
        "Forces of the drives",
        (
            TORQUE,
            Panel("trolley force [kN]", 1e-3, {"trolley_force": "trolley drive along the jib"}),
            TENSION,
        ),
    ),
    "tower.png": ("Top of the tower", (TOP, TWIST)),
    "jib.png": (
        "Jib",
        (
            Panel(
                "jib tip [mm]",
                1e3,
                {"jib_tip_deflection": "up", "jib_tip_deflection_sideways": "in the turning sense"},
            ),
            Panel("jib's middle [mm]", 1e3, {"jib_deflection": "up from the chord"}),
            Panel("compression [kN]", 1e-3, {"jib_compression": "of the jib at its foot"}),
            Panel(
                "jib root [kN m]",
                1e-3,
                {"jib_root_moment": "moment under loads", "jib_root_moment_sideways": "moment that turns the jib"},
            ),
        ),
    ),
    "counter-jib.png": (
        "Counter-jib",
        (
            Panel(
                "counter-jib tip [mm]",
                1e3,
                {"counter_jib_tip_deflection": "up", "counter_jib_tip_deflection_sideways": "in the turning sense"},
            ),
            Panel(
                "counter-jib root [kN m]",
                1e-3,
                {
                    "counter_jib_root_moment": "moment under ballast",
                    "counter_jib_root_moment_sideways": "moment that turns the jib",
                },
            ),
        ),
    ),
    **BASE,
}
"""Title and panels of each picture of a run in space, but for those of what only some runs have."""

MOST_SECTIONS = 6
"""Named sections in one picture; the files hold all."""

SOME: Pictures = {
    "wind.png": ("Wind", WIND),
    "ground.png": ("Earthquake", (GROUND,)),
    "collars.png": ("Forces on the collars", COLLARS),
    "ties.png": ("Tie bars", TIES),
}
"""Pictures of what only some runs have."""


def pictures_of(result: xr.Dataset) -> Pictures:
    """Pictures of a run by the names of their files."""
    some = SOME | {"sections.png": ("Moments in sections", _sections(result))}
    shown = {name: {line for panel in panels for line in panel.lines} for name, (_, panels) in some.items()}
    return PICTURES | {
        name: picture for name, picture in some.items() if not shown[name].isdisjoint(result.data_vars)
    }


def _sections(result: xr.Dataset) -> tuple[Panel, ...]:
    """A panel for each section that the case names."""
    names = [str(name).removesuffix("_moment") for name in result.data_vars if str(name).endswith("_moment")]
    return tuple(
        Panel(
            f"{name.removeprefix('section_').replace('_', ' ')} [kN m]",
            1e-3,
            {
                f"{name}_moment": "moment",
                f"{name}_moment_sideways": "sideways",
                f"{name}_moment_x": "about x",
                f"{name}_moment_y": "about y",
                f"{name}_torque": "torque",
            },
        )
        for name in names
        if name.startswith("section_")
    )[:MOST_SECTIONS]

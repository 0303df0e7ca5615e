"""Pictures of a tower crane's run: in the plane those of the source, in space those of all that moves."""

from __future__ import annotations

from typing import TYPE_CHECKING

from towercrane.report.plots.runs import panels, plane, space

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

BOTH = (
    "torque.png",
    "counter-jib.png",
    "base.png",
    "wind.png",
    "ground.png",
    "collars.png",
    "ties.png",
    "sections.png",
)
"""Pictures of space that a run in the plane has too, as far as it has their outputs."""


def run_pictures(result: xr.Dataset) -> dict[str, Figure]:
    """All pictures of one run by file name."""
    chosen = space.pictures_of(result)
    if "sway_tangential" in result or "luffing_angle" in result:
        return panels.run_pictures(result, chosen)
    in_plane = {name: picture for name, picture in chosen.items() if name in BOTH}
    return plane.run_pictures(result) | panels.over_times(result, in_plane)

"""A run as a moving picture: the crane from the side and from above, true to scale, and the load's sway below.

The crane is drawn three times: a thin dashed line without deformation, its drives where they are at that time; a
broad pale line where it really is; and a blue line whose points are ``magnification`` times as far from the dashed
line as they really are. Rope, load and the load's path are the true ones and hang from the pale crane: a magnified
crane has no true rope, and a load that moved with it would swing as no load does.
"""

from __future__ import annotations

from math import ceil, log10
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.lines import Line2D

from towercrane.cranes.parts.poses import sampled
from towercrane.report.film.panels import ABOVE, ALONG, LOAD, Sway, View
from towercrane.report.plots.style import figure_of, footnote, run_title
from towercrane.runs.summary import assumed

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from towercrane.cranes.parts.poses import Poses
    from towercrane.report.film.playback import Playback

SIZE = (9.6, 5.4)
"""Of the picture [inch]."""

DOTS_PER_INCH = 100


class Film:
    """Frames of one picture: what stands still is drawn once, the rest anew for each frame.

    Parameters
    ----------
    result : xarray.Dataset
    poses : Poses
        One for each frame.
    playback : Playback
    magnification : float
        Of the deformation.
    """

    def __init__(self, result: xr.Dataset, poses: Poses, playback: Playback, magnification: float) -> None:
        self.poses = poses
        self.figure = figure_of(*SIZE)
        self.figure.set_dpi(DOTS_PER_INCH)
        self._canvas: Any = FigureCanvasAgg(self.figure)
        self._background: Any = None
        side, above, below = _panels(self.figure, poses.planar)
        self._views = _views(side, above, poses, playback, magnification)
        _put_ground(side, result, poses)
        self._sway = Sway(below, result, playback)
        corner: dict[str, Any] = {"transform": side.transAxes, "ha": "right", "va": "top", "animated": True}
        self._clock = side.text(0.985, 0.96, "", fontsize=12, family="monospace", **corner)
        self._ending = side.text(0.985, 0.86, "", fontsize=9, color=LOAD, **corner)
        self._decimals = _decimals(playback.step)
        early = result.attrs["outcome"] != "finished" and poses.times[-1] >= result["time"].values[-1]
        self._last_words = f"ended: {result.attrs['outcome']}" if early else ""
        speed = "in real time" if playback.speed == 1.0 else f"at {playback.speed:g} × real time"
        side.set_title(f"played {speed}", fontsize=8, loc="right")
        _legend(self.figure, self._views[0], run_title([result]), None if poses.deformation == 0.0 else magnification)
        footnote(self.figure, assumed(result), "towercrane run")
        self.show(0)

    @property
    def frames(self) -> int:
        """Number of frames."""
        return len(self.poses.times)

    def show(self, frame: int) -> None:
        """Move everything to where it is in a frame, counted from 0."""
        time = self.poses.times[frame]
        for view in self._views:
            view.show(frame)
        self._sway.show(time)
        self._clock.set_text(f"{time:.{self._decimals}f} s")
        self._ending.set_text(self._last_words if frame == self.frames - 1 else "")

    def pixels(self, frame: int) -> NDArray[np.uint8]:
        """Red, green, blue and opacity of a frame, valid until the next; shape (rows, columns, 4)."""
        self.show(frame)
        if self._background is None:
            self._canvas.draw()
            # The parts have found their places; what moves may not push them about.
            self.figure.set_layout_engine("none")
            self._background = self._canvas.copy_from_bbox(self.figure.bbox)
        self._canvas.restore_region(self._background)
        for artist in self._moving:
            self.figure.draw_artist(artist)
        return np.asarray(self._canvas.buffer_rgba())

    @property
    def _moving(self) -> list[Artist]:
        artists = [artist for view in self._views for artist in view.moving]
        return [*artists, *self._sway.moving, self._clock, self._ending]


def _decimals(step: float) -> int:
    """Digits after the point that tell frames a step [s] apart."""
    first = max(1, ceil(-log10(step)))
    return first if (step * 10**first).is_integer() else first + 1


def _panels(figure: Figure, planar: bool) -> tuple[Axes, Axes | None, Axes]:
    """Side view, view from above where there is something to see, and the strip below."""
    if planar:
        side, below = figure.subplots(2, 1, height_ratios=(3.0, 1.0))
        return side, None, below
    grid = figure.add_gridspec(2, 2, width_ratios=(1.25, 1.0), height_ratios=(2.4, 1.0))
    return figure.add_subplot(grid[0, 0]), figure.add_subplot(grid[:, 1]), figure.add_subplot(grid[1, 0])


def _views(side: Axes, above: Axes | None, poses: Poses, playback: Playback, magnification: float) -> list[View]:
    cranes, load = (poses.undeformed, poses.members, poses.magnified(magnification)), poses.hanging
    look: dict[str, Any] = {"shaded": magnification != 1.0 and poses.deformation > 0.0, "playback": playback}
    seen = [{name: poses.turned_back(line) for name, line in lines.items()} for lines in cranes]
    views = [View(side, ALONG, *seen, load=poses.turned_back(load), **look)]
    turns = float(np.ptp(poses.heading)) > 0.0
    side.set_title("from the side, turning with the crane" if turns else "from the side", fontsize=9, loc="left")
    side.set(xlabel="outward [m]", ylabel="height [m]")
    if above is not None:
        views.append(View(above, ABOVE, *cranes, load=load, **look))
        above.set_title("from above", fontsize=9, loc="left")
        above.set(xlabel="x [m]", ylabel="y [m]")
    return views


def _put_ground(side: Axes, result: xr.Dataset, poses: Poses) -> None:
    """Draw the ground that the load stands on in some frame: it need not be where the crane stands."""
    if "load_ground_force" not in result:
        return
    stands = np.flatnonzero(sampled(result, "load_ground_force", poses.times) > 0.0)
    if len(stands):
        height = float(poses.load[stands[0], 2])
        side.axhline(height, color="0.45", ls=(0, (6, 2)), lw=0.8, zorder=0.5)
        where: Any = {"xy": (0.0, height), "xycoords": ("axes fraction", "data"), "textcoords": "offset points"}
        side.annotate("ground under the load", xytext=(4, 2), fontsize=7, color="0.35", **where)


def _legend(figure: Figure, view: View, title: str, magnification: float | None) -> None:
    """Name the run and its lines, and state what is magnified; None for a rigid crane."""
    if magnification is None:
        named = [(view.crane, "rigid crane, to scale")]
    elif magnification == 1.0:
        named = [(view.crane, "crane, to scale"), (view.still, "undeformed")]
    else:
        named = [
            (view.crane, f"deformation × {magnification:g}"),
            (view.true, "shaded: true scale"),
            (view.still, "undeformed"),
        ]
    named += [(view.collars, "collars at rest")] if view.held else []
    named += [(view.rope, "rope"), (view.trace[0], "path of the load")]
    handles = []
    for line, label in named:
        handle = Line2D([], [], label=label)
        handle.update_from(line)
        handle.set(animated=False, label=label)
        handles.append(handle)
    figure.legend(
        handles=handles, loc="outside upper center", ncols=len(named), fontsize=8, frameon=False,
        title=title, title_fontsize=10,
    )  # fmt: skip

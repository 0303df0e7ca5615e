"""What a film is made of: a crane from one side, and the load's sway over time, with the artists that move."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.patches import Rectangle

from towercrane.cranes.registry import KINDS
from towercrane.report.plots.style import COLOURS, steady

if TYPE_CHECKING:
    from collections.abc import Mapping

    import xarray as xr
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D
    from numpy.typing import NDArray

    from towercrane.report.film.playback import Playback

    Floats = NDArray[np.float64]

FADES = ((0.0, 1.0), (1.0, 0.7), (2.5, 0.45), (5.0, 0.28), (10.0, 0.16))
"""Age of the load's path in the film [s] from which it is drawn with this opacity."""

CRANE, LOAD, ROPE, TRUE, STILL = COLOURS[0], COLOURS[1], "0.15", "0.82", "0.45"

ALONG, ABOVE = (0, 2), (0, 1)
"""Coordinates that are seen from the side and from above."""


POINTS = "suspension", "joints", "ballast", "collars"
"""Members that are no lines."""


class View:
    """A crane from one side.

    Parameters
    ----------
    axes : Axes
    seen : tuple of int
        Coordinates to the right and up in the picture.
    undeformed, true, drawn : mapping of str to ndarray, shapes (frames, points, 3)
        As in :class:`towercrane.cranes.parts.poses.Poses`; ``drawn`` is magnified.
    load : ndarray, shape (frames, bodies, 3)
        What hangs on the rope from above, the load the last.
    shaded : bool
        Whether the true crane is drawn beside the magnified one.
    playback : Playback
    """

    def __init__(
        self,
        axes: Axes,
        seen: tuple[int, int],
        undeformed: Mapping[str, Floats],
        true: Mapping[str, Floats],
        drawn: Mapping[str, Floats],
        *,
        load: Floats,
        shaded: bool,
        playback: Playback,
    ) -> None:
        def line(color: str, **look: Any) -> Line2D:
            return axes.plot([], [], animated=True, color=color, solid_capstyle="round", **look)[0]

        # In the order in which they are drawn.
        self.true = line(TRUE, lw=6.0, visible=shaded)
        weight = line(TRUE, marker="s", ms=11, ls="", visible=shaded)
        self.still = line(STILL, lw=0.9, dashes=(4, 3))
        self.crane = line(CRANE, lw=2.0)
        counterweight = line(CRANE, marker="s", ms=8, ls="")
        joints = line(CRANE, marker="o", ms=3.0, ls="")
        self.collars = line(STILL, marker="s", ms=9.0, mfc="none", ls="")
        hook = line(CRANE, marker="o", ms=4.5, mfc="white", ls="", visible=shaded)
        self.trace = [line(LOAD, lw=1.4, alpha=alpha) for _, alpha in FADES]
        self.rope = line(ROPE, lw=0.9)
        trolley = line(ROPE, marker="o", ms=4.5, ls="")
        block = line(LOAD, marker="s", ms=8, mec="black", mew=0.6, ls="")
        self.moving: list[Artist] = [
            self.true, weight, self.still, self.collars, self.crane, joints, counterweight, hook,
            *self.trace[::-1], self.rope, trolley, block,
        ]  # fmt: skip

        places = [
            (self.true, _wire(true)),
            (self.still, _wire(undeformed)),
            (self.crane, _wire(drawn)),
            (hook, drawn["suspension"]),
            (self.rope, np.concatenate([true["suspension"], load], axis=1)),
            (trolley, np.concatenate([true["suspension"], load[:, :-1]], axis=1)),
            (block, load[:, -1:]),
        ]
        if "ballast" in true:
            places += [(weight, true["ballast"]), (counterweight, drawn["ballast"])]
        if "joints" in true:
            places.append((joints, drawn["joints"]))
        self.held = "collars" in true
        if self.held:
            places.append((self.collars, true["collars"]))
        self._places = [(artist, points[..., seen]) for artist, points in places]
        self._load = load[:, -1][:, seen]
        self._ages = [round(age * playback.frames_per_second) for age, _ in FADES]
        self._frame(axes, seen)

    def _frame(self, axes: Axes, seen: tuple[int, int]) -> None:
        """Limits that hold all frames, the ground, and equal scales."""
        points = np.concatenate([places.reshape(-1, 2) for _, places in self._places])
        low, high = np.nanmin(points, axis=0), np.nanmax(points, axis=0)
        margin = 0.05 * float((high - low).max())
        axes.update_datalim([low - margin, high + margin])
        axes.margins(0.0)
        axes.autoscale_view()
        axes.set_aspect("equal", adjustable="datalim")
        axes.tick_params(labelsize=8)
        axes.grid(color="0.94", lw=0.6)
        axes.set_axisbelow(True)
        if seen == ABOVE:
            axes.plot(0.0, 0.0, "+", color="0.3", ms=9, zorder=0.5)
            return
        # A crane whose load hangs lower than its foot does not stand on a plain.
        if low[1] >= 0.0:
            wide = 100.0 * float((high - low).max())
            axes.add_artist(Rectangle((-wide, -wide), 2.0 * wide, wide, color="0.94", lw=0.0, zorder=0))
        axes.axhline(0.0, color="0.6", lw=0.8, zorder=0.5)

    def show(self, frame: int) -> None:
        """Move the lines to their places in a frame."""
        for artist, places in self._places:
            artist.set_data(*places[frame].T)
        starts = [max(frame - age, 0) for age in self._ages]
        for line, newest, oldest in zip(self.trace, starts, [*starts[1:], 0], strict=True):
            line.set_data(*self._load[oldest : newest + 1].T)


class Sway:
    """The load's sway over time: all of it pale, what has been strong."""

    def __init__(self, axes: Axes, result: xr.Dataset, playback: Playback) -> None:
        time = result["time"].values
        rows = (time >= playback.start) & (time <= playback.end)
        self._time, self._lines = time[rows], []
        # What results of all kinds call the load's sway, and what that is.
        known = {name: way for kind in KINDS.values() for name, way in kind.sways.items() if name in result}
        for colour, (name, way) in zip((LOAD, COLOURS[2]), known.items(), strict=False):
            values = np.rad2deg(result[name].values[rows])
            axes.plot(self._time, values, color=colour, lw=0.8, alpha=0.3)
            line: Line2D = axes.plot([], [], color=colour, lw=1.3, animated=True, label=way)[0]
            self._lines.append((line, values))
        self._now = axes.axvline(playback.start, color="0.3", lw=0.8, animated=True)
        axes.set(xlim=(playback.start, playback.end), xlabel="time [s]", ylabel="sway [deg]")
        axes.tick_params(labelsize=8)
        axes.grid(color="0.94", lw=0.6)
        legend = axes.legend(
            loc="lower right", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.1, ncols=2, fontsize=8, frameon=False
        )
        steady(axes)
        for shown in legend.get_lines():
            shown.set_animated(False)
        self.moving: list[Artist] = [self._now, *(line for line, _ in self._lines)]

    def show(self, time: float) -> None:
        """Draw the sway up to a time [s]."""
        past = int(np.searchsorted(self._time, time, side="right"))
        for line, values in self._lines:
            line.set_data(self._time[:past], values[:past])
        self._now.set_xdata([time, time])


def _wire(members: Mapping[str, Floats]) -> Floats:
    """All lines as one, broken between members; shape (frames, points, 3)."""
    lines = [line for name, line in members.items() if name not in POINTS]
    gap = np.full((len(lines[0]), 1, 3), np.nan)
    return np.concatenate([part for line in lines for part in (line, gap)], axis=1)

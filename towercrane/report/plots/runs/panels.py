"""Pictures of runs that a kind of crane states as panels over time, and the load's path from above."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.report.plots.runs.slewing import path_from_above
from towercrane.report.plots.style import COLOURS, DASHES, figure_of, footnote, legend, run_title
from towercrane.runs.summary import assumed

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

    from towercrane.cranes.kind import Panel, Pictures

FEW = 3
"""Panels that are drawn higher than more of them are."""

ROUNDING = 1e-9
"""Part of the largest value of one unit in a picture below which a panel shows none."""


def over_time(result: xr.Dataset, title: str, panels: tuple[Panel, ...]) -> Figure:
    """Panels over time, one below the other; lines that the result does not have drop out."""
    figure = figure_of(9.0, len(panels) * (2.0 if len(panels) > FEW else 2.8))
    rows = np.atleast_1d(figure.subplots(len(panels), 1, sharex=True))
    sizes = [_size(result, panel) for panel in panels]
    for axes, panel, size in zip(rows, panels, sizes, strict=True):
        shown = [name for name in panel.lines if name in result]
        for i, name in enumerate(shown):
            axes.plot(
                result["time"], panel.factor * result[name], color=COLOURS[i], ls=DASHES[i], lw=1.2,
                label=panel.lines[name],
            )  # fmt: skip
        of_its_unit = (other for other, beside in zip(sizes, panels, strict=True) if _unit(beside) == _unit(panel))
        if size < ROUNDING * max(of_its_unit):
            # A scale of its own would make a motion of what is nothing but rounding.
            axes.set_ylim(-0.05, 0.05)
        axes.set_ylabel(panel.label)
        axes.grid(axis="y", color="0.9", lw=0.6)
        legend(axes)
    rows[-1].set_xlabel("time [s]")
    figure.suptitle(f"{title}, {run_title([result])}", fontsize=10)
    footnote(figure, assumed(result))
    return figure


def _size(result: xr.Dataset, panel: Panel) -> float:
    """Largest value of a panel's lines."""
    return max((float(abs(panel.factor * result[name]).max()) for name in panel.lines if name in result), default=0.0)


def _unit(panel: Panel) -> str:
    return panel.label.rpartition("[")[2]


def run_pictures(result: xr.Dataset, pictures: Pictures) -> dict[str, Figure]:
    """All pictures of one run by file name."""
    return {**over_times(result, pictures), "path.png": path_from_above([result])}


def over_times(result: xr.Dataset, pictures: Pictures) -> dict[str, Figure]:
    """Pictures of panels over time, those that the result has no line of left out."""
    drawn = {}
    for name, (title, panels) in pictures.items():
        if shown := tuple(panel for panel in panels if any(line in result for line in panel.lines)):
            drawn[name] = over_time(result, title, shown)
    return drawn

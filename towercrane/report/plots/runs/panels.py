"""Pictures of runs that a kind of crane states as panels over time, and the load's path from above."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.kind import Panel
from towercrane.report.plots.runs.slewing import path_from_above
from towercrane.report.plots.style import COLOURS, DASHES, figure_of, footnote, legend, run_title
from towercrane.runs.summary import assumed

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from towercrane.cranes.kind import Pictures

BASE: Pictures = {
    "base.png": (
        "Loads on the base",
        (
            Panel(
                "overturning [kN m]",
                1e-3,
                {"base_moment_x": "about x", "base_moment_y": "about y", "overturning_moment": "resultant"},
            ),
            Panel("torque [kN m]", 1e-3, {"base_torque": "about the vertical"}),
            Panel(
                "horizontal [kN]",
                1e-3,
                {"base_force_x": "along x", "base_force_y": "along y", "base_shear": "resultant"},
            ),
            Panel("vertical [kN]", 1e-3, {"base_force_z": "up"}),
        ),
    ),
}
"""What a crane does to its base."""

FEW = 3
"""Panels that are drawn higher than more of them are."""

ROUNDING = 1e-9
"""Part of the largest value of one unit in a picture below which a panel shows none."""


def over_time(result: xr.Dataset, title: str, panels: tuple[Panel, ...]) -> Figure:
    """Panels over time, one below the other; lines that the result does not have drop out."""
    figure = figure_of(9.0, len(panels) * (2.0 if len(panels) > FEW else 2.8))
    rows = np.atleast_1d(figure.subplots(len(panels), 1, sharex=True))
    sizes, loads = [_size(result, panel) for panel in panels], json.loads(result.attrs.get("loads", "{}"))
    released = json.loads(result.attrs.get("release", "null"))
    for axes, panel, size in zip(rows, panels, sizes, strict=True):
        shown = [name for name in panel.lines if name in result]
        for i, name in enumerate(shown):
            axes.plot(
                result["time"], panel.factor * result[name], color=COLOURS[i], ls=DASHES[i], lw=1.2,
                label=panel.lines[name],
            )  # fmt: skip
            _mark(axes, loads.get(name), panel, name, COLOURS[i])
        of_its_unit = (other for other, beside in zip(sizes, panels, strict=True) if _unit(beside) == _unit(panel))
        if size < ROUNDING * max(of_its_unit):
            # A scale of its own would make a motion of what is nothing but rounding.
            axes.set_ylim(-0.05, 0.05)
        if released:
            axes.axvline(released["time_s"], color="0.3", ls="--", lw=1.0, label=f"{released['mass_kg']:g} kg let go")
        axes.set_ylabel(panel.label)
        axes.grid(axis="y", color="0.9", lw=0.6)
        legend(axes)
    rows[-1].set_xlabel("time [s]")
    figure.suptitle(f"{title}, {run_title([result])}", fontsize=10)
    footnote(figure, assumed(result))
    return figure


def _mark(axes: Axes, load: dict[str, Any] | None, panel: Panel, name: str, colour: str) -> None:
    """Mark the largest value of a load, and draw what it is at rest where it has a dynamic factor."""
    if load is None:
        return
    factor, most = panel.factor, load[load["largest"]]
    axes.plot(most["time_s"], factor * most["value"], "o", ms=4, color=colour)
    if load["dynamic_factor"]:
        label = f"{panel.lines[name]}, at rest there; factor {load['dynamic_factor']:.3g}"
        axes.axhline(factor * load["static"], color=colour, ls=(0, (1, 3)), lw=1.0, label=label)


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

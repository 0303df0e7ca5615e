"""Picture of a comparison of models: paths of the load side by side, and how far each is from the richest."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from towercrane.report.plots.style import COLOURS, DASHES, figure_of, footnote
from towercrane.studies.comparison import ONE_OF_EACH, OWN, RICHEST, gaps

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

MOST_PATHS = 5
"""Paths side by side."""


def paths(report: dict[str, Any], results: dict[str, xr.Dataset]) -> Figure:
    """Paths of the load, from above in space and from the side in the plane; below, distances from the richest."""
    names = _shown(report, results)
    in_space = len(report["rows"][0]["sway"]) > 1
    rows, labels = ((0, 1), ("x [m]", "y [m]")) if in_space else ((0, 2), ("outward [m]", "up [m]"))
    figure = figure_of(3.0 * len(names) + 1.0, 7.6)
    upper, lower = figure.subfigures(2, 1, height_ratios=(1.5, 1.0), squeeze=False)[:, 0]
    panels = upper.subplots(1, len(names), sharex=True, sharey=True, squeeze=False)[0]
    best = results[RICHEST]["payload_position"].values
    for i, (axes, name) in enumerate(zip(panels, names, strict=True)):
        place = results[name]["payload_position"].values
        axes.plot(*best[:, rows].T, color="0.75", lw=2.0, label=RICHEST)
        axes.plot(*place[:, rows].T, color=COLOURS[i], lw=1.0, label=name)
        row = next(row for row in report["rows"] if row["name"] == name)
        error = row["relative_error"]
        axes.set_title(row["outcome"] if error is None else f"error {error:.2g}", fontsize=9)
        axes.set(xlabel=labels[0])
        if in_space:
            axes.set_aspect("equal")
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.18), fontsize=8, frameon=False)
    panels[0].set_ylabel(labels[1])
    for axes, column, label in zip(lower.subplots(1, 2), (0, 1), ("horizontal", "vertical"), strict=True):
        for i, name in enumerate(names):
            gap = gaps(results[name], results[RICHEST])[:, column]
            axes.plot(
                results[name]["time"].values[: len(gap)], gap, color=COLOURS[i], ls=DASHES[i % 4], lw=1.0, label=name
            )
        axes.set(xlabel="time [s]", ylabel=f"{label} distance [m]")
        axes.grid(axis="y", color="0.9", lw=0.6)
    lower.legend(
        *axes.get_legend_handles_labels(), loc="outside upper center", ncols=len(names), fontsize=8, frameon=False
    )
    figure.suptitle(f"{report['crane']}, {report['case']}: path of the load in simpler models, grey the richest")
    footnote(figure, [(entry["key"], entry["value"], entry["why"]) for entry in report["assumed"]])
    return figure


def _shown(report: dict[str, Any], results: dict[str, xr.Dataset]) -> list[str]:
    """No modes, the best crane that lacks one kind of them, what is recommended, one mode of each, the case's own."""
    rows = [row for row in report["rows"] if row["relative_error"] is not None]
    most = len(report["kinds_of_modes"])
    lacking = [row for row in rows if sum(count > 0 for count in row["modes"].values()) == most - 1]
    nearest = min(lacking, key=lambda row: row["relative_error"], default=None)
    wanted = [report["rows"][0]["name"], nearest and nearest["name"], report["recommended"], ONE_OF_EACH, OWN]
    return [name for name in dict.fromkeys(wanted) if name in results][:MOST_PATHS]

"""The look that all pictures share: units, names, colours that every eye tells apart, and what was assumed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.results.files import replacing
from towercrane.runs.summary import assumed

if TYPE_CHECKING:
    from os import PathLike
    from pathlib import Path

    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
"""Okabe and Ito's palette, distinguishable with every common colour vision."""

DASHES = ("-", "--", "-.", ":")
"""Lines differ in dash as well, for print in grey."""

MARKERS = "osD^v<>Px*"
"""Points differ in shape as well."""

ROUNDING = 1e-9
"""Part of a line's size, or of one in the unit that it is drawn in, below which it stands still."""

MOST_NOTES = 6
"""Assumed values that are named under a figure one by one."""

SPEEDS = ("trolley_speed", "slewing_speed", "shaft_speed")
"""Speeds that name a run."""


def save(figure: Figure, path: str | PathLike[str]) -> None:
    """Write a figure whole or not at all."""
    with replacing(path) as temporary:
        put(figure, temporary)


def put(figure: Figure, path: Path) -> None:
    """Write a figure to a file that nobody reads yet."""
    for axes in figure.axes:
        steady(axes)
    figure.savefig(path, dpi=150)


def steady(axes: Axes) -> None:
    """Let lines that stand still look so: no scale that makes a motion of their rounding, no offset over the axes."""
    from matplotlib.ticker import ScalarFormatter

    if isinstance(formatter := axes.yaxis.get_major_formatter(), ScalarFormatter):
        formatter.set_useOffset(False)
    heights = [np.ravel(own.get_ydata()) for own in axes.get_lines() if own.get_transform() == axes.transData]
    values = np.concatenate([*heights, np.empty(0)]).astype(float)
    values = values[np.isfinite(values)]
    if not len(values) or not axes.get_autoscaley_on():
        return
    low, high = float(values.min()), float(values.max())
    size = max(abs(low), abs(high))
    if high - low <= ROUNDING * max(size, 1.0):
        half = 0.05 * (size if size > ROUNDING else 1.0)
        axes.set_ylim(low - half, high + half)


def figure_of(width: float, height: float) -> Figure:
    """Empty figure of a size [inch] whose parts keep out of each other's way, and whose text is text."""
    from towercrane.report.plots.literal import LiteralFigure

    return LiteralFigure(figsize=(width, height), layout="constrained")


def over_time(results: list[xr.Dataset], name: str, factor: float, label: str, title: str) -> Figure:
    """One variable of several runs over time; ``factor`` brings it to the unit of the label."""
    figure = figure_of(8.0, 4.4)
    axes: Axes = figure.subplots()
    for i, result in enumerate(results):
        axes.plot(result["time"], factor * result[name], **line(i, result))
    axes.set(xlabel="time [s]", ylabel=label)
    axes.grid(axis="y", color="0.9", lw=0.6)
    legend(axes)
    return titled(figure, title, results)


def legend(axes: Axes) -> None:
    """Name the lines above the axes, where no curve can be hidden."""
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), borderaxespad=0.2, ncols=2, fontsize=8, frameon=False)


def line(i: int, result: xr.Dataset) -> dict[str, Any]:
    """Look and name of the i-th run's line."""
    # Matplotlib hides names that begin with an underscore.
    label = run_label(result)
    return {
        "color": COLOURS[i % 6],
        "ls": DASHES[i % 4],
        "lw": 1.2,
        "label": f" {label}" if label.startswith("_") else label,
    }


def run_label(result: xr.Dataset) -> str:
    """Case, speed of the drive, load and rope of a run, and how it ended if it did not finish."""
    name = result.attrs.get("case", result.attrs["crane"]).rpartition("/")[2]
    first, last = result["rope_length"].values[[0, -1]]
    rope = f"{first:.4g} m" if abs(last - first) < 1e-6 else f"{first:.4g} to {last:.4g} m"
    known = [s for s in SPEEDS if s in result and not (s == "slewing_speed" and "shaft_speed" in result)]
    fastest = ((float(abs(result[s]).max()), result[s].attrs["units"]) for s in known)
    speeds = (f"{speed:.3g} {unit}, " for speed, unit in fastest if speed > ROUNDING)
    label = f"{name}: {''.join(speeds)}{result.attrs['payload_mass']:g} kg, rope {rope}"
    if result.attrs["outcome"] != "finished":
        label += f" ({result.attrs['outcome']} at {result.attrs['end_time']:.2f} s)"
    return label


def run_title(results: list[xr.Dataset]) -> str:
    """Crane, and the run if there is only one."""
    crane = results[0].attrs["crane"]
    return f"{crane}, {run_label(results[0])}" if len(results) == 1 else f"{crane}"


def titled(figure: Figure, title: str, results: list[xr.Dataset]) -> Figure:
    """Put a title above and the assumed values of all runs below."""
    figure.suptitle(f"{title}, {results[0].attrs['crane']}", wrap=True)
    notes: dict[str, tuple[str, str, str]] = {}
    for result in results:
        for note in assumed(result):
            notes.setdefault(note[0] + note[1], note)
    footnote(figure, list(notes.values()))
    return figure


def footnote(figure: Figure, notes: list[tuple[str, str, str]], lists_them: str = "the JSON file") -> None:
    """Name the assumed values that a picture rests on; many are counted, and it is said what lists them."""
    if len(notes) > MOST_NOTES:
        text = f"{len(notes)} values that this rests on are assumed, given by no source; {lists_them} lists them"
        figure.supxlabel(text, fontsize=6.5, color="0.35")
    elif notes:
        text = "assumed, given by no source: " + ", ".join(f"{key} = {value}" for key, value, _ in notes)
        figure.supxlabel(text, fontsize=6.5, color="0.35", wrap=True)

"""Pictures of cycles: how often ranges occur, and about which means."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.report.plots.style import COLOURS, DASHES, figure_of, footnote, legend

if TYPE_CHECKING:
    from collections.abc import Iterator

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from towercrane.studies.fatigue.study import Fatigue

    Floats = NDArray[np.float64]

MOST_OUTPUTS = 6
"""Outputs that are shown, those first named; the files hold all."""

BINS = 40

UNITS = {"N": "kN", "N m": "kN m"}


def histogram(found: Fatigue) -> Figure:
    """Numbers of cycles over their ranges, with the equivalent ranges."""
    figure = _figure(found, "Cycles")
    for axes, name, cycles in _panels(figure, found):
        sizes, counts = 1e-3 * cycles[:, 0], cycles[:, 2]
        axes.hist(sizes, bins=BINS, weights=counts, color=COLOURS[0])
        for i, spectrum in enumerate(found.report["outputs"][name]["spectra"]):
            axes.axvline(
                1e-3 * spectrum["equivalent_range"], color=COLOURS[1 + i % 5], ls=DASHES[i % 4], lw=1.2,
                label=f"m = {spectrum['exponent']:g}: s = {spectrum['s']:.2g}, {spectrum['class']}",
            )  # fmt: skip
        axes.set(yscale="log", xlabel=f"range of {_words(name)} [{UNITS[found.units[name]]}]", ylabel="cycles")
        axes.set_xlim(left=0.0)
        legend(axes)
    return figure


def range_mean(found: Fatigue) -> Figure:
    """Ranges over means, each as large as it occurs often."""
    figure = _figure(found, "Ranges and means of cycles")
    for axes, name, cycles in _panels(figure, found):
        order = np.argsort(cycles[:, 2], kind="stable")
        sizes, means, counts = cycles[order].T
        largest, least = counts.max(), counts.min()
        often = np.log(counts / least) / np.log(largest / least) if largest > least else np.ones(len(counts))
        points = axes.scatter(1e-3 * means, 1e-3 * sizes, s=12 + 40 * often, c=counts, cmap="viridis", norm="log")
        unit = UNITS[found.units[name]]
        axes.set(xlabel=f"mean of {_words(name)} [{unit}]", ylabel=f"range [{unit}]")
        axes.set_ylim(bottom=0.0)
        axes.grid(color="0.9", lw=0.6)
        figure.colorbar(points, ax=axes, label="cycles")
    return figure


def _figure(found: Fatigue, title: str) -> Figure:
    shown = min(len(found.cycles), MOST_OUTPUTS)
    figure = figure_of(10.0 if shown > 1 else 6.0, 3.2 * -(-shown // 2) + 0.8)
    left_out = len(found.cycles) - shown
    more = f"; {left_out} more outputs in the files" if left_out else ""
    crane = found.report["operations"][0]["crane"]
    figure.suptitle(
        f"{title}, {crane}, {found.report['days']:g} {'day' if found.report['days'] == 1.0 else 'days'}{more}",
        fontsize=10,
    )
    footnote(figure, [(own["key"], own["value"], own["why"]) for own in found.report["assumed"]])
    return figure


def _panels(figure: Figure, found: Fatigue) -> Iterator[tuple[Axes, str, Floats]]:
    """A panel for each of the outputs shown."""
    names = list(found.cycles)[:MOST_OUTPUTS]
    drawn: Any = np.atleast_1d(figure.subplots(-(-len(names) // 2), 2 if len(names) > 1 else 1)).ravel()
    for axes in drawn[len(names) :]:
        axes.set_visible(False)
    for axes, name in zip(drawn, names, strict=False):
        yield axes, name, found.cycles[name]


def _words(name: str) -> str:
    return name.replace("_", " ")

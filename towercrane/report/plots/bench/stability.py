"""Pictures of the long run: energy drift, one hour, error growth, failure map."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.report.plots.style import COLOURS, MARKERS, figure_of
from towercrane.simulation.methods.method import NAMED, SPAN

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FLOOR = 1e-14
"""What a smaller change is drawn as: the energy itself is rounded."""


def drift(subject: dict[str, Any]) -> Figure:
    """Energy change over the tolerance, one line a method; filled: gained."""
    figure = figure_of(9.0, 4.8)
    panels = figure.subplots(1, 2, sharey=True)
    methods = list(dict.fromkeys(r["method"] for r in subject["records"]))
    for axes, modes in zip(panels, dict.fromkeys(m for r in subject["records"] for m in r["changes"]), strict=False):
        for number, method in enumerate(methods):
            rows = [r for r in subject["records"] if r["method"] == method and modes in r["changes"]]
            known = [(r["rtol"], r["changes"][modes]) for r in rows if np.isfinite(r["changes"][modes])]
            if not known:
                continue
            rtol, change = np.array(known).T
            label = method if axes is panels[0] else None
            own = not method.startswith("scipy")
            axes.plot(
                rtol, abs(change), color=COLOURS[number], lw=2.2 if own else 1.0, ls="-" if own else "--", label=label
            )
            for sign, face in ((1.0, COLOURS[number]), (-1.0, "white")):
                mine = np.sign(change) == sign
                axes.plot(
                    rtol[mine], abs(change[mine]), MARKERS[number], ms=6, color=COLOURS[number], markerfacecolor=face
                )
        axes.axhline(NAMED, color="0.5", ls=":", lw=1.0)
        axes.set(xscale="log", yscale="log", xlabel="rtol [1], atol = rtol / 100", title=f"{modes} modes")
        axes.grid(which="major", color="0.9", lw=0.6)
    panels[0].set_ylabel(f"relative change of the energy in {SPAN:g} s [1]")
    figure.legend(loc="outside lower center", ncols=6, fontsize=8, frameon=False)
    figure.suptitle(
        "Energy of undamped free vibration; filled: gained, open: lost; dotted: named by a run", fontsize=10
    )
    return figure


def one_hour(subject: dict[str, Any]) -> Figure:
    """Size of the energy's change over an hour, a panel for each model and tolerance."""
    figure = figure_of(9.6, 6.6)
    models, rtols = (sorted({r[key] for r in subject["records"]}) for key in ("modes", "rtol"))
    panels = figure.subplots(len(models), len(rtols), sharex=True, sharey=True, squeeze=False)
    methods = list(dict.fromkeys(r["method"] for r in subject["records"]))
    for (i, model), (j, rtol) in product(enumerate(models), enumerate(reversed(rtols))):
        axes: Axes = panels[i, j]
        for record in (r for r in subject["records"] if (r["modes"], r["rtol"]) == (model, rtol)):
            number = methods.index(record["method"])
            own = not record["method"].startswith("scipy")
            axes.loglog(
                record["curve"]["time_s"][1:], np.maximum(np.abs(record["curve"]["change"][1:]), FLOOR),
                color=COLOURS[number], lw=3.2 if own else 1.2, ls="-" if own else "--",
                label=record["method"] if i == j == 0 else None,
            )  # fmt: skip
        axes.set_title(f"{model} modes, rtol {rtol:.0e}", fontsize=9)
        axes.grid(which="major", color="0.9", lw=0.6)
    for axes in panels[-1]:
        axes.set_xlabel("time [s]")
    for axes in panels[:, 0]:
        axes.set_ylabel("size of the energy's relative change [1]", fontsize=8)
    figure.legend(loc="outside lower center", ncols=len(methods), fontsize=8, frameon=False)
    figure.suptitle("Energy of undamped free vibration during one hour, atol = rtol / 100", fontsize=10)
    return figure


def error_growth(subject: dict[str, Any]) -> Figure:
    """Largest error so far over time."""
    figure = figure_of(7.6, 4.6)
    axes: Axes = figure.subplots()
    for number, record in enumerate(subject["records"]):
        name = f"{record['method']}, rtol {record['rtol']:.0e}: ~ t^{record['exponent']:.2f}"
        axes.loglog(
            record["curve"]["time_s"], record["curve"]["error"], lw=1.4, color=COLOURS[number % 6],
            ls="-" if record["method"] == "dop853" else "--", label=name,
        )  # fmt: skip
    axes.set(xlabel="time [s]", ylabel="largest error so far, of each output's peak [1]")
    axes.grid(which="major", color="0.9", lw=0.6)
    axes.legend(fontsize=8, frameon=False)
    figure.suptitle("Growth of the error in free vibration, 2+3 modes", fontsize=10)
    return figure


def failure_map(subject: dict[str, Any]) -> Figure:
    """Energy change by tolerance and highest frequency, a panel for each method."""
    from matplotlib.colors import Normalize

    figure = figure_of(11.0, 6.0)
    records = subject["records"]
    methods = list(dict.fromkeys(r["method"] for r in records))
    tolerances = list(dict.fromkeys(r["rtol"] for r in records))
    columns = list(dict.fromkeys((r["modes"], r["frequency_hz"]) for r in records))
    panels = figure.subplots(2, 3, sharex=True, sharey=True)
    for axes, method in zip(panels.flat, methods, strict=True):
        for r in (r for r in records if r["method"] == method):
            column, row = columns.index((r["modes"], r["frequency_hz"])), tolerances.index(r["rtol"])
            colour = "white" if _size(r["change"]) > -1.5 else "black"
            axes.text(column, row, _cell(r["change"]), ha="center", va="center", fontsize=7, color=colour)
        sizes = np.array(
            [
                [_size(r["change"]) for r in records if (r["method"], r["rtol"]) == (method, rtol)]
                for rtol in tolerances
            ]
        )
        image = axes.imshow(sizes, cmap="YlOrRd", norm=Normalize(-8.0, 0.0), aspect="auto")
        axes.set_facecolor("0.93")
        axes.set_title(method, fontsize=9)
        axes.set_xticks(
            range(len(columns)), [f"{modes}\n{frequency:.3g} Hz" for modes, frequency in columns], fontsize=7
        )
        axes.set_yticks(range(len(tolerances)), [f"{rtol:.0e}" for rtol in tolerances], fontsize=7)
    for axes in panels[:, 0]:
        axes.set_ylabel("rtol [1]")
    for axes in panels[-1]:
        axes.set_xlabel("modes and highest frequency")
    bar = figure.colorbar(image, ax=panels, shrink=0.8)
    bar.set_label("log10 of the energy's relative change [1]")
    figure.suptitle(
        "Failure map: energy after 60 s of free vibration; + gained, - lost, grey not measured", fontsize=10
    )
    return figure


def _cell(change: float | None) -> str:
    if change is None:
        return ""
    return "failed" if np.isinf(change) else f"{change:+.0e}"


def _size(change: float | None) -> float:
    """Colour of a cell; not a number where nothing was measured."""
    if change is None:
        return np.nan
    return 0.0 if np.isinf(change) else float(np.log10(max(abs(change), 1e-16)))

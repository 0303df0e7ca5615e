"""Pictures of the benchmark: work against precision, exact frequencies, growth of the cost."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.report.plots.bench.stability import drift, error_growth, failure_map, one_hour
from towercrane.report.plots.style import COLOURS, MARKERS, figure_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.axes import Axes
    from matplotlib.axis import XAxis, YAxis
    from matplotlib.figure import Figure

EPSILON = 1e-16
"""What an error of zero is drawn as."""


def pictures(report: dict[str, Any]) -> dict[str, Figure]:
    """Figure of every subject that has one, by file name."""
    draw = {
        "roots": frequencies, "tower": frequencies, "map": frequencies, "lattice": lattice,
        "growth": growth, "drift": drift, "one-hour": one_hour,
        "error-growth": error_growth, "failure-map": failure_map,
    }  # fmt: skip
    figures = {}
    for subject in report["subjects"]:
        if subject["name"] in draw:
            figures[f"{subject['name']}.png"] = draw[subject["name"]](subject)
        elif "within" in subject:
            figures[f"{subject['name']}.png"] = work_precision(subject)
    return figures


def work_precision(subject: dict[str, Any]) -> Figure:
    """CPU time against error, a line for each solver."""
    figure = figure_of(8.6, 5.2)
    axes: Axes = figure.subplots()
    families = list(dict.fromkeys(r["family"] for r in subject["records"] if "error" in r))
    for number, family in enumerate(families):
        runs = sorted(
            (r["error"], r["cpu_seconds"]) for r in subject["records"] if r["family"] == family and "error" in r
        )
        errors, seconds = np.array(runs).T
        own = family.startswith("towercrane")
        axes.plot(
            errors, 1e3 * seconds, color=COLOURS[number % 6], marker=MARKERS[number % 10], ms=5,
            lw=2.2 if own else 1.0, ls="-" if own else "--", label=family,
        )  # fmt: skip
    wanted = subject["within"]["error"]
    axes.axvline(wanted, color="0.6", lw=0.8, ls=":")
    axes.set(xscale="log", yscale="log", xlabel="error, of each output's peak [1]", ylabel="CPU time [ms]")
    axes.invert_xaxis()
    _plain_numbers(axes.yaxis)
    axes.grid(which="major", color="0.9", lw=0.6)
    failed = [f"{r['family']}: {r['failure']}" for r in subject["records"] if "failure" in r]
    if failed:
        figure.supxlabel("; ".join(failed), fontsize=6.5, color="0.35", wrap=True)
    figure.legend(loc="outside right center", fontsize=7, frameon=False)
    figure.suptitle(subject["title"].partition(": error")[0], fontsize=10)
    return figure


def frequencies(subject: dict[str, Any]) -> Figure:
    """Time against error of exact frequencies and of finite elements, one colour for each family."""
    figure = figure_of(7.6, 4.4)
    axes: Axes = figure.subplots()
    families = list(dict.fromkeys(r["family"] for r in subject["records"]))
    for family, colour, marker in zip(families, COLOURS, MARKERS, strict=False):
        rows = [r for r in subject["records"] if r["family"] == family and r["error"] is not None]
        errors, times = [max(r["error"], EPSILON) for r in rows], [r["milliseconds"] for r in rows]
        axes.plot(errors, times, marker, ls="-" if len(rows) > 2 else "", lw=1.0, ms=7, color=colour, label=family)
        for row, error, time in zip(rows, errors, times, strict=True):
            axes.annotate(
                _point(row["method"]), (error, time), (0, 7), textcoords="offset points", fontsize=7, ha="center"
            )
    axes.set(xscale="log", yscale="log", xlabel="relative error of the worst frequency [1]", ylabel="wall time [ms]")
    axes.margins(0.12, 0.2)
    axes.invert_xaxis()
    _plain_numbers(axes.yaxis)
    axes.grid(which="major", color="0.9", lw=0.6)
    figure.legend(loc="outside lower center", ncols=len(families), fontsize=8, frameon=False)
    figure.suptitle(subject["title"].partition(":")[0], fontsize=10)
    return figure


def _point(method: str) -> str:
    """What tells a point from the others of its family: the number of elements, or what follows the comma."""
    number, elements, _ = method.partition(" elements")
    return f"n = {number}" if elements else method.partition(", ")[2].replace(", ", ",\n")


def lattice(subject: dict[str, Any]) -> Figure:
    """Time against error of the beams that stand for a lattice, a colour for each beam."""
    figure = figure_of(11.0, 4.2)
    panels = figure.subplots(1, 3, sharey=True)
    truss, *beams = subject["records"]
    reads: tuple[tuple[str, Callable[[dict[str, Any]], float | None]], ...] = (
        ("two frequencies with slewing part,\nagainst the truss [1]", lambda r: r["errors"]["loaded"]),
        ("static flexibility,\nagainst the truss [1]", lambda r: r["errors"]["flexibility"]),
        ("four frequencies, against\nthe same beam exactly [1]", lambda r: r["own_error"]),
    )
    for axes, (label, read) in zip(panels, reads, strict=True):
        first = axes is panels[0]
        axes.axhline(1e3 * truss["cpu_seconds"], color="0.4", lw=1.0, ls=":", label="truss" if first else None)
        for colour, model in zip(COLOURS, dict.fromkeys(r["model"] for r in beams), strict=False):
            exact, *elements = (r for r in beams if r["model"] == model)
            for rows, look, name in (
                ([exact], {"marker": "*", "ms": 11, "ls": ""}, "dynamic stiffness"),
                (elements, {"marker": "o", "ms": 4, "lw": 1.0}, "finite elements"),
            ):
                known = [(error, 1e3 * r["cpu_seconds"]) for r in rows if (error := read(r)) is not None]
                axes.plot(
                    [max(error, EPSILON) for error, _ in known], [time for _, time in known], color=colour, **look,
                    label=f"{model}, {name}" if first else None,
                )  # fmt: skip
        axes.set(xscale="log", yscale="log", xlabel=label)
        axes.margins(0.12, 0.12)
        axes.invert_xaxis()
        axes.grid(which="major", color="0.9", lw=0.6)
    panels[0].set_ylabel("CPU time [ms]")
    _plain_numbers(panels[0].yaxis)
    figure.legend(loc="outside lower center", ncols=4, fontsize=8, frameon=False)
    numbers = [r["elements"] for r in beams if r["elements"]]
    figure.suptitle(
        f"Lattice tower as beams: worst relative error; {min(numbers)} to {max(numbers)} elements", fontsize=10
    )
    return figure


def _plain_numbers(axis: XAxis | YAxis) -> None:
    """Label a logarithmic axis with 1, 2, 5, 10: whole powers of ten are too few where it spans little."""
    from matplotlib.ticker import LogLocator, NullFormatter

    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_major_formatter("{x:g}")
    axis.set_minor_formatter(NullFormatter())


def growth(subject: dict[str, Any]) -> Figure:
    """CPU time against simulated time; evaluations and their cost against the number of modes."""
    figure = figure_of(10.5, 3.8)
    over_time, over_frequency, over_size = figure.subplots(1, 3)
    exponents = subject["exponents"]
    for axes, rows, x, y, factor, labels, power in (
        (over_time, "spans", "seconds", "cpu_seconds", 1e3, ("simulated time [s]", "CPU time [ms]"), "time"),
        (over_frequency, "modes", "frequency_hz", "evaluations", 1.0,
         ("highest frequency [Hz]", "evaluations in 30 s"), "frequency"),
        (over_size, "modes", "states", "nanoseconds", 1.0, ("states", "CPU time per evaluation [ns]"), "size"),
    ):  # fmt: skip
        across = np.array([r[x] for r in subject[rows]], dtype=float)
        up = factor * np.array([r[y] for r in subject[rows]], dtype=float)
        axes.loglog(across, up, "o", color=COLOURS[0], label="measured")
        fit = np.exp(np.mean(np.log(up) - exponents[power] * np.log(across))) * across ** exponents[power]
        axes.loglog(across, fit, color=COLOURS[1], lw=1.2, label=f"~ x^{exponents[power]:.2f}")
        axes.set(xlabel=labels[0], ylabel=labels[1])
        for axis in (axes.xaxis, axes.yaxis):
            _plain_numbers(axis)
        axes.tick_params(labelsize=8)
        axes.grid(which="major", color="0.9", lw=0.6)
        axes.legend(fontsize=8, frameon=False)
    figure.suptitle("Growth of the cost, free vibration of the QTZ5613 at rtol 1e-6", fontsize=10)
    return figure

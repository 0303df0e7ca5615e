"""Pictures of motions beside each other: what they leave of the sway, and how the drives move."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.report.plots.style import COLOURS, DASHES, figure_of, footnote, legend
from towercrane.studies.candidates import HORIZONTAL

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from towercrane.studies.rest_study import RestStudy, Row

    Notes = list[tuple[str, str, str]]

SMALLEST = 1e-4
"""Residual below which none is told apart [m]."""

DRAWN = ("commanded", "zv", "boxes", "minimum-jerk")
"""Motions that are drawn beside the recommended one."""

ROWS = 400
"""Points of a curve."""


def residuals(study: RestStudy, crane: str, notes: Notes) -> Figure:
    """Residual of every motion over the length of the rope, and over the tower's torsional stiffness."""
    has_torsion = any(row.torsions for row in study.rows)
    figure = figure_of(8.0, 5.2)
    panels = np.atleast_1d(figure.subplots(1, 1 + has_torsion, sharey=True, width_ratios=(3, 2)[: 1 + has_torsion]))
    for i, row in enumerate(study.rows):
        torsions = {**row.torsions, 1.0: row.nominal}
        for axes, trials in zip(panels, (row.ropes, torsions), strict=False):
            factors = sorted(trials)
            left = [trials[factor].residual for factor in factors]
            heights = [np.nan if value is None else max(value, SMALLEST) for value in left]
            axes.set_xticks(factors)
            axes.plot(factors, heights, marker="o", ms=3.5, **_look(i, study, row))
    panels[0].set(xlabel="rope length [of the planned]", ylabel="load's distance from its rest [m]", yscale="log")
    if has_torsion:
        panels[1].set_xlabel("torsional stiffness [of the model's]")
    for axes in panels:
        axes.axhline(study.allowed, color="0.6", lw=0.8, ls=":")
        axes.grid(axis="y", color="0.9", lw=0.6)
    panels[0].annotate(
        f"allowed, {study.allowed:g} m", (0.01, study.allowed), xycoords=("axes fraction", "data"), fontsize=7,
        color="0.4", xytext=(0, 2), textcoords="offset points",
    )  # fmt: skip
    return _titled(figure, panels[0], f"Sway that is left after the last motion, {crane}", notes)


def profiles(study: RestStudy, crane: str, notes: Notes) -> Figure:
    """Speed and acceleration of the drives that were planned, over time."""
    drives = [c for c in study.rows[0].candidate.motions if c in HORIZONTAL and _moves(study, c)]
    figure = figure_of(8.0, 1.0 + 3.6 * len(drives))
    panels = np.atleast_2d(figure.subplots(2 * len(drives), 1, sharex=True)).reshape(len(drives), 2)
    for channel, (speeds, accelerations) in zip(drives, panels, strict=True):
        turns = channel != "trolley"
        factor, unit = (180.0 / np.pi, "deg") if turns else (1.0, "m")
        for i, row in enumerate(study.rows):
            if row.candidate.name not in (*DRAWN, study.recommended.candidate.name):
                continue
            motion = row.candidate.motions[channel]
            # Just before and at each switch time, so that jumps are upright.
            knots = motion.switch_times
            t = np.unique(np.concatenate([np.linspace(0.0, motion.duration, ROWS), knots, knots - 1e-6]))
            t = t[t >= 0.0]
            speeds.plot(t, factor * motion(t, 1), **_look(i, study, row))
            accelerations.plot(t, factor * motion(t, 2), **_look(i, study, row))
        speeds.set_ylabel(f"{channel} speed\n[{unit}/s]")
        accelerations.set_ylabel(f"{channel} acceleration\n[{unit}/s²]")
    for axes in panels.flat:
        axes.grid(axis="y", color="0.9", lw=0.6)
    panels[-1, -1].set_xlabel("time [s]")
    return _titled(figure, panels[0, 0], f"Motions of the drives, {crane}", notes)


def _moves(study: RestStudy, channel: str) -> bool:
    return study.rows[0].candidate.motions[channel].range(1) != (0.0, 0.0)


def _look(i: int, study: RestStudy, row: Row) -> dict[str, Any]:
    chosen = row is study.recommended
    label = f"{row.candidate.title}, {row.candidate.duration:.1f} s" + (" (recommended)" if chosen else "")
    colour = COLOURS[(i - 1) % 6] if i else "0.2"
    return {"color": colour, "ls": "-" if chosen else DASHES[i % 4], "lw": 2.0 if chosen else 1.1, "label": label}


def _titled(figure: Figure, named: Axes, title: str, notes: Notes) -> Figure:
    figure.suptitle(title)
    legend(named)
    footnote(figure, notes)
    return figure

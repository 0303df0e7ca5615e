"""Pictures of the natural modes of a crane in space: the whole crane from two sides, frequencies over its drives."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.tower.equations.small_motions import MOTION_KINDS
from towercrane.report.plots.style import COLOURS, figure_of, footnote
from towercrane.studies.space_shapes import crane_lines

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.figure import Figure

    from towercrane.cranes.tower.equations.small_motions import NaturalMode
    from towercrane.cranes.tower.model import FlexibleModel
    from towercrane.studies.space_modes import Place

MOST_SHAPES = 8
"""Modes in one picture."""

LARGEST = 0.12
"""Largest displacement that is drawn, of the longest member."""

MARKS = ("o", "s", "^", "D", "v", "P", "X", "*")
"""Of the kinds of modes, for print in grey."""

SWEEPS = {
    "trolley_position": ("trolley from the tower's axis [m]", 1.0),
    "luffing_angle": ("jib's angle, as its winch has it [deg]", 180.0 / np.pi),
    "rope_length": ("rope length [m]", 1.0),
    "slewing_angle": ("slewing angle [deg]", 180.0 / np.pi),
}

Notes = list[tuple[str, str, str]]


def shapes(
    model: FlexibleModel, modes: Sequence[NaturalMode], place: Place, counter_jib: float, title: str, notes: Notes
) -> Figure:
    """Modes of the whole crane, undeformed in grey, from the side and from above; the displacement not to scale."""
    chosen = list(modes)[:MOST_SHAPES]
    pairs = -(-len(chosen) // 2)
    figure = figure_of(13.0, 1.7 * pairs + 1.0)
    panels = figure.subplots(pairs, 4, squeeze=False)
    for axes in panels.ravel()[2 * len(chosen) :]:
        axes.set_visible(False)
    size = max(model.crane.tower_height, model.crane.jib_length)
    still = crane_lines(model, chosen[0], place, counter_jib) if chosen else {}
    for k, mode in enumerate(chosen):
        unit = crane_lines(model, mode, place, counter_jib, 1.0)
        largest = max(float(np.abs(unit[name] - still[name]).max()) for name in still)
        moved = crane_lines(model, mode, place, counter_jib, LARGEST * size / largest)
        colour = COLOURS[MOTION_KINDS.index(mode.kind) % len(COLOURS)]
        side, above = panels.ravel()[2 * k : 2 * k + 2]
        for axes, rows, label in ((side, (0, 2), "height [m]"), (above, (0, 1), "across [m]")):
            for name, line in still.items():
                axes.plot(*line[:, rows].T, color="0.75", lw=1.0)
                axes.plot(*moved[name][:, rows].T, color=colour, lw=1.4)
            axes.plot(*moved["rope"][-1, list(rows)], "o", color=colour, ms=4)
            axes.set(ylabel=label, aspect="equal")
            axes.tick_params(labelsize=7)
        above.set_ylim(-0.2 * size, 0.2 * size)
        shares = sorted(mode.shares.items(), key=lambda item: -item[1])[:2]
        energy = ", ".join(f"{kind} {share:.0%}" for kind, share in shares if share >= 0.005)
        side.set_title(f"mode {k + 1}, {mode.frequency_hz:.4g} Hz, from the side", fontsize=8)
        above.set_title(f"from above; energy {energy}", fontsize=8)
    for axes in panels[-1] if pairs else ():
        axes.set_xlabel("along the jib [m]")
    figure.suptitle(title, fontsize=10)
    footnote(figure, notes)
    return figure


def frequencies(sweeps: dict[str, list[dict[str, Any]]], title: str, notes: Notes) -> Figure:
    """Frequencies over each drive, the others standing; a colour and a mark per kind of mode."""
    from matplotlib.lines import Line2D
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    figure = figure_of(12.0, 5.5)
    panels = figure.subplots(1, len(sweeps), sharey=True)
    for axes, name in zip(panels, sweeps, strict=True):
        label, factor = SWEEPS[name]
        rows = [row for row in sweeps[name] if row["frequencies_hz"]]
        at = [factor * row["value"] for row in rows]
        for k in range(min((len(row["frequencies_hz"]) for row in rows), default=0)):
            axes.plot(at, [row["frequencies_hz"][k] for row in rows], color="0.8", lw=0.8, zorder=1)
        for row, x in zip(rows, at, strict=True):
            for kind, frequency in zip(row["kinds"], row["frequencies_hz"], strict=True):
                number = MOTION_KINDS.index(kind)
                axes.plot(x, frequency, MARKS[number], color=COLOURS[number % len(COLOURS)], ms=3)
        axes.set(xlabel=label, yscale="log")
        axes.grid(which="both", color="0.92", lw=0.6)
        if not rows:
            axes.text(0.5, 0.5, "no equilibrium", ha="center", transform=axes.transAxes)
    panels[0].set_ylabel("natural frequency [Hz]")
    panels[0].yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    panels[0].yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    panels[0].yaxis.set_minor_formatter(NullFormatter())
    handles = [
        Line2D([], [], color=COLOURS[i % len(COLOURS)], marker=MARKS[i], ls="", label=kind)
        for i, kind in enumerate(MOTION_KINDS)
    ]
    figure.legend(handles=handles, loc="outside right upper", fontsize=8, frameon=False)
    figure.suptitle(title, fontsize=10)
    footnote(figure, notes)
    return figure

"""Picture of lift-off: dynamic factors against hoisting speed."""

from __future__ import annotations

from textwrap import wrap
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.report.plots.style import COLOURS, DASHES, MARKERS, figure_of, footnote
from towercrane.report.tables.lift import SECTIONS, stated

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LABELS = {
    "rope": "rope: max T / (m g)",
    "base": "overturning moment at the base",
    "jib_root": "moment at the jib's root",
}


def factors(report: dict[str, Any]) -> Figure:
    """A panel for each output: a line for each place of the trolley, formulas by hand, classes as steps of grey."""
    known = [name for name in SECTIONS if any(name in row["dynamic_factor"] for row in report["runs"])]
    figure = figure_of(3.6 * max(len(known), 1) + 2.2, 4.8)
    # Narrower than the panels, so that it ends before the legend.
    words = wrap("; ".join(stated(report).values()), 40 * max(len(known), 1))
    figure.suptitle("\n".join([f"Lift-off of {report['payload_kg']:g} kg, {report['crane']}", *words]), fontsize=9)
    drawn: Any = np.atleast_1d(figure.subplots(1, max(len(known), 1), sharex=True))
    for axes, name in zip(drawn, known, strict=False):
        _panel(axes, report, name)
    if known:
        handles, labels = drawn[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside right upper", fontsize=8, frameon=False)
    footnote(figure, [(own["key"], own["value"], own["why"]) for own in report["assumed"]])
    return figure


def _panel(axes: Axes, report: dict[str, Any], name: str) -> None:
    fastest = max(report["speeds_m_s"])
    limits = 0.0, 1.05 * fastest
    creep = report["creep_m_s"] or np.inf
    speeds = np.unique(np.r_[np.linspace(limits[0], limits[1], 50), min(creep, limits[1])])
    slow = np.minimum(speeds, creep)
    lower = np.ones(len(speeds))
    for number, (label, own) in enumerate(report["hoisting_classes"].items()):
        upper = own["phi2min"] + own["beta2_s_m"] * slow
        axes.fill_between(speeds, lower, upper, color=str(0.97 - 0.05 * number), lw=0)
        axes.annotate(label, (limits[1], upper[-1]), xytext=(-3, -2), textcoords="offset points", fontsize=7,
                      ha="right", va="top", color="0.35")  # fmt: skip
        lower = upper
    springs = {"k, rope alone": (report["rope_spring_n_m"], "0.15")}
    for i, own in enumerate(report["positions"]):
        springs[f"k_eff at {own['trolley_position_m']:g} m"] = (own["k_eff_n_m"], COLOURS[i % 6])
    for label, (spring, colour) in springs.items():
        axes.plot(
            speeds, 1.0 + slow / report["gravity_m_s2"] * np.sqrt(spring / report["payload_kg"]),
            color=colour, ls=":", lw=1.1, label=f"by hand, {label}",
        )  # fmt: skip
    for i, own in enumerate(report["positions"]):
        here = [row for row in report["runs"] if row["trolley_position_m"] == own["trolley_position_m"]]
        shown = [(row["speed_m_s"], row["dynamic_factor"][name]["value"]) for row in here if row["dynamic_factor"]]
        axes.plot(
            *np.transpose(shown or [(np.nan, np.nan)]), color=COLOURS[i % 6], ls=DASHES[i % 3],
            marker=MARKERS[i % len(MARKERS)], ms=4, lw=1.3, label=f"trolley at {own['trolley_position_m']:g} m",
        )  # fmt: skip
    axes.set(xlim=limits, xlabel="hoisting speed [m/s]", ylabel="dynamic factor [-]")
    axes.set_ylim(bottom=1.0)
    axes.set_title(LABELS[name], fontsize=9)

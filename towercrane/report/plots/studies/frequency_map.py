"""Pictures of a frequency map, and of the modes of the plane crane to scale."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.report.plots.style import COLOURS, DASHES, figure_of, footnote
from towercrane.runs.summary import assumed
from towercrane.studies.plane_modes import MEMBERS

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from towercrane.studies.plane_modes import PlaneModes

    Floats = NDArray[np.float64]

LARGEST = 0.12
"""Largest displacement of a drawn mode, as a part of the crane's size."""


def frequencies(data: xr.Dataset) -> Figure:
    """Frequency over trolley position: a colour per branch, a dash per payload."""
    from matplotlib.lines import Line2D

    figure = figure_of(9.0, 6.5)
    axes: Axes = figure.subplots()
    pivots = data["position"].attrs["units"] == "rad"
    positions = np.degrees(data["position"].values) if pivots else data["position"].values
    marker = "o" if positions.size == 1 else ""
    stable = [i for i, outcome in enumerate(data["outcome"].values) if outcome == "finished"]
    for dash, i in enumerate(stable):
        for k in range(data.sizes["mode"]):
            look: dict[str, Any] = {
                "color": COLOURS[k % 6],
                "ls": DASHES[dash % 4],
                "lw": 1.0 + 0.5 * (dash // 4),
                "marker": marker,
            }
            axes.plot(positions, data["frequency"].values[i, :, k], **look)
    branches = [Line2D([], [], color=COLOURS[k % 6], label=str(name)) for k, name in enumerate(data["branch"].values)]
    payloads = [
        Line2D([], [], color="0.3", ls=DASHES[dash % 4], lw=1.0 + 0.5 * (dash // 4), label=_payload_label(data, i))
        for dash, i in enumerate(stable)
    ]
    lost = [i for i in range(data.sizes["payload"]) if i not in stable]
    payloads += [Line2D([], [], ls="", label=_payload_label(data, i)) for i in lost]
    along = (
        "angle of the jib, as its winch has it [deg]"
        if pivots
        else "distance of the trolley from the tower's axis [m]"
    )
    axes.set(xlabel=along, ylabel="natural frequency [Hz]", yscale="log")
    if stable:
        _plain_ticks(axes)
    else:
        axes.text(0.5, 0.5, "the crane stands under no payload", ha="center", transform=axes.transAxes)
    axes.grid(which="both", color="0.92", lw=0.6)
    figure.legend(handles=[*branches, *payloads], loc="outside right upper", fontsize=8, frameon=False)
    tower = f"tower {'softened' if data.attrs['weight_softening'] else 'not softened'} by its weight"
    axes.set_title(f"{data.attrs['crane']}: rope {data.attrs['rope_length']:g} m, {tower}", fontsize=10)
    footnote(figure, assumed(data))
    return figure


def _payload_label(data: xr.Dataset, i: int) -> str:
    mass, factor = float(data["payload"][i]), float(data["buckling_factor"][i])
    outcome = str(data["outcome"].values[i])
    ending = f"buckles at {factor:.3g} x" if outcome == "finished" else f"{outcome} ({factor:.3g} x)"
    return f"load {mass:g} kg; {ending}"


def _plain_ticks(axes: Axes) -> None:
    """Frequencies as plain decimals, one, two and five of every decade."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.yaxis.set_minor_formatter(NullFormatter())


def shapes(modes: PlaneModes, title: str, notes: list[tuple[str, str, str]]) -> Figure:
    """Modes of the plane crane, undeformed and deformed, the crane to scale and the displacement not."""
    count = len(modes.frequencies)
    columns = min(count, 3)
    rows = -(-count // columns)
    figure = figure_of(4.2 * columns, 2.6 * rows + 0.8)
    panels = np.atleast_1d(figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)).ravel()
    for k, axes in enumerate(panels):
        axes.set_visible(k < count)
        if k >= count:
            continue
        lines = _drawn(modes, k, 0.0)
        moved = _drawn(modes, k, 1.0)
        largest = max(float(np.abs(m - s).max()) for m, s in zip(moved, lines, strict=True))
        crane = modes.crane
        size = max(crane.frame.tower.length, crane.jib.length)
        for still, deformed in zip(lines, _drawn(modes, k, LARGEST * size / largest), strict=True):
            axes.plot(*still, color="0.75", lw=1.0)
            axes.plot(*deformed, color=COLOURS[k % 6], lw=1.4)
        axes.plot(*_drawn(modes, k, LARGEST * size / largest)[-1][:, -1:], "o", color=COLOURS[k % 6], ms=4)
        most = sorted(zip(modes.energy_shares[k], MEMBERS, strict=True), reverse=True)[:2]
        energy = ", ".join(f"{member} {share:.0%}" for share, member in most if share >= 0.005)
        axes.set_title(f"mode {k + 1}, {modes.frequencies[k]:.4g} Hz; energy {energy}", fontsize=8)
        axes.set_aspect("equal")
    for axes in panels[::columns]:
        axes.set_ylabel("height [m]")
    for axes in panels[max(count - columns, 0) : count]:
        axes.set_xlabel("distance from the tower's axis [m]")
        axes.tick_params(labelbottom=True)
    figure.suptitle(title, fontsize=10)
    footnote(figure, notes)
    return figure


def _drawn(modes: PlaneModes, k: int, scale: float) -> list[Floats]:
    """Lines of tower, jibs and rope (its end the load) moved by a mode times a scale, shape (2, points) each [m]."""
    crane, parts = modes.crane, modes.modes.parts
    height = crane.frame.tower.length
    along = np.linspace(0.0, height, 100)
    lines = [np.stack([scale * parts["tower"].evaluate(along)[k], along])]
    top = scale * float(parts["tower"].evaluate(height)[k])
    for name, side in (("jib", 1.0), ("counter-jib", -1.0)):
        if name in parts:
            out = np.linspace(0.0, parts[name].ends[-1], 100)
            lines.append(np.stack([top + side * out, height + scale * parts[name].evaluate(out)[k]]))
    rises = scale * float(parts["jib"].evaluate(modes.position)[k])
    hook = modes.position + top, height + rises
    load = modes.position + scale * modes.modes.vectors[k, -1], height + rises - crane.frame.rope_length
    lines.append(np.array([[hook[0], load[0]], [hook[1], load[1]]]))
    return lines

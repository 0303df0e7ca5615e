"""Pictures of slewing cranes: sway, moments, drive torque, angles, and the load's path seen from above."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.report.plots.style import COLOURS, DASHES, figure_of, footnote, legend, line, run_title, titled
from towercrane.runs.summary import assumed

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

DEGREES = 180.0 / np.pi


def overview(result: xr.Dataset) -> Figure:
    """Drive, sway, moments and rope tension, one below the other."""
    time = result["time"]
    known: tuple[tuple[str, float, tuple[str, ...]], ...] = (
        ("speed [rad/s]", 1.0, ("shaft_speed",)),
        ("sway [deg]", DEGREES, ("sway_tangential", "sway_radial")),
        ("jib moment [N m]", 1.0, ("jib_moment_horizontal", "jib_moment_vertical")),
        ("drive torque [N m]", 1.0, ("drive_torque", "drive_torque_elastic")),
        ("rope tension [N]", 1.0, ("hoist_rope_force",)),
        ("wind [m/s]", 1.0, ("wind_x", "wind_y", "wind_z")),
    )
    panels = [panel for panel in known if any(name in result for name in panel[2])]
    figure = figure_of(9.0, 2.0 * len(panels))
    rows = figure.subplots(len(panels), 1, sharex=True)
    for axes, (label, factor, names) in zip(rows, panels, strict=True):
        for i, name in enumerate(n for n in names if n in result):
            text = name.replace("_", " ")
            axes.plot(time, factor * result[name], color=COLOURS[i], ls=DASHES[i], label=text)
        axes.set_ylabel(label)
        legend(axes)
    rows[-1].set_xlabel("time [s]")
    figure.suptitle(run_title([result]))
    footnote(figure, assumed(result))
    return figure


def sway(results: list[xr.Dataset]) -> Figure:
    """Tangential and radial sway over time."""
    return _stacked(
        results,
        (("sway_tangential", "tangential sway [deg]"), ("sway_radial", "radial sway [deg]")),
        DEGREES,
        "Sway of the load",
    )


def moments(results: list[xr.Dataset]) -> Figure:
    """Bending moments of the jib over time."""
    names = (("jib_moment_horizontal", "horizontal moment [N m]"), ("jib_moment_vertical", "vertical moment [N m]"))
    return _stacked(results, names, 1.0, "Moments of the jib")


def torque(results: list[xr.Dataset]) -> Figure:
    """Torque through the drive's coupling over time: with its damper, and its spring alone."""
    names = (("drive_torque", "total torque [N m]"), ("drive_torque_elastic", "elastic torque [N m]"))
    return _stacked(results, names, 1.0, "Drive torque")


def angles(results: list[xr.Dataset]) -> Figure:
    """Angle of the platform, and how far it is behind its shaft."""
    figure = figure_of(8.0, 6.4)
    rows = figure.subplots(2, 1, sharex=True)
    for i, result in enumerate(results):
        platform, shaft = result["platform_angle"], result["shaft_angle"]
        rows[0].plot(result["time"], DEGREES * platform, **line(i, result))
        rows[1].plot(result["time"], DEGREES * (platform - shaft), **line(i, result))
    rows[0].set_ylabel("platform angle [deg]")
    rows[1].set(xlabel="time [s]", ylabel="platform less shaft [deg]")
    legend(rows[0])
    return titled(figure, "Platform and shaft", results)


def path_from_above(results: list[xr.Dataset]) -> Figure:
    """Path of the load in the horizontal plane, to scale."""
    figure = figure_of(7.0, 6.6)
    axes = figure.subplots()
    for i, result in enumerate(results):
        place = result["payload_position"].values
        axes.plot(place[:, 0], place[:, 1], **line(i, result))
        axes.plot(place[0, 0], place[0, 1], "o", color=COLOURS[i % 6], ms=5)
        axes.plot(place[-1, 0], place[-1, 1], "s", color=COLOURS[i % 6], ms=5)
    axes.plot(0.0, 0.0, "+", color="black", ms=9)
    axes.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    legend(axes)
    return titled(figure, "Load from above, o start, square end", results)


def run_pictures(result: xr.Dataset) -> dict[str, Figure]:
    """All pictures of one run by file name."""
    one = [result]
    return {
        "overview.png": overview(result),
        "sway.png": sway(one),
        "moments.png": moments(one),
        "torque.png": torque(one),
        "angles.png": angles(one),
        "path.png": path_from_above(one),
    }


def _stacked(results: list[xr.Dataset], names: tuple[tuple[str, str], ...], factor: float, title: str) -> Figure:
    figure = figure_of(8.0, 3.2 * len(names))
    rows = figure.subplots(len(names), 1, sharex=True)
    for axes, (name, label) in zip(rows, names, strict=True):
        for i, result in enumerate(results):
            axes.plot(result["time"], factor * result[name], **line(i, result))
        axes.set_ylabel(label)
    legend(rows[0])
    rows[-1].set_xlabel("time [s]")
    return titled(figure, title, results)

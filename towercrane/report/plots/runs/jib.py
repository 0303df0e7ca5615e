"""Pictures of the jib crane: plan of its joints, sway, torques, and the load's path from above and from the side."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.report.plots.style import COLOURS, DASHES, figure_of, footnote, legend, line, run_title, titled
from towercrane.runs.summary import assumed

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

DEGREES = 180.0 / np.pi


def plan(result: xr.Dataset) -> Figure:
    """Angles of the joints and length of the rope over time."""
    figure = figure_of(8.0, 6.0)
    rows = figure.subplots(2, 1, sharex=True)
    for i, joint in enumerate(result["joint"].values):
        angle = DEGREES * result["joint_angle"].sel(joint=joint)
        rows[0].plot(result["time"], angle, color=COLOURS[i], ls=DASHES[i], label=str(joint))
    rows[1].plot(result["time"], result["rope_length"], color=COLOURS[3], label="rope")
    rows[0].set_ylabel("joint angle [deg]")
    rows[1].set(xlabel="time [s]", ylabel="rope length [m]")
    for axes in rows:
        legend(axes)
    return titled(figure, "Plan", [result])


def sway(results: list[xr.Dataset]) -> Figure:
    """Sway in the plane of the booms and across it over time."""
    figure = figure_of(8.0, 6.0)
    rows = figure.subplots(2, 1, sharex=True)
    names = (("sway_in_plane", "in plane [mrad]"), ("sway_lateral", "lateral [mrad]"))
    for axes, (name, label) in zip(rows, names, strict=True):
        for i, result in enumerate(results):
            axes.plot(result["time"], 1e3 * result[name], **line(i, result))
        axes.set_ylabel(label)
    legend(rows[0])
    rows[-1].set_xlabel("time [s]")
    return titled(figure, "Sway of the load", results)


def torques(result: xr.Dataset) -> Figure:
    """Torques that the joints need, with right limits at jumps, and the rope's tension."""
    figure = figure_of(8.0, 6.4)
    rows = figure.subplots(2, 1, sharex=True)
    for i, joint in enumerate(result["joint"].values):
        torque = 1e-3 * result["joint_torque"].sel(joint=joint)
        rows[0].plot(result["time"], torque, color=COLOURS[i], ls=DASHES[i], label=str(joint))
    rows[1].plot(result["time"], 1e-3 * result["hoist_rope_force"], color=COLOURS[4], label="rope tension")
    rows[0].set_ylabel("joint torque [kN m]")
    rows[1].set(xlabel="time [s]", ylabel="rope tension [kN]")
    for axes in rows:
        legend(axes)
    return titled(figure, "Joint torques", [result])


def path(result: xr.Dataset) -> Figure:
    """Path of the load from above, and its height over its reach, both to scale."""
    figure = figure_of(9.0, 5.0)
    above, side = figure.subplots(1, 2)
    place = result["payload_position"].values
    reach = np.hypot(place[:, 0], place[:, 1])
    for axes, x, y in ((above, place[:, 0], place[:, 1]), (side, reach, place[:, 2])):
        axes.plot(x, y, color=COLOURS[0], label="load")
        axes.plot(x[:1], y[:1], "o", color="black", ms=4, label="start")
        axes.plot(x[-1:], y[-1:], "s", color="black", ms=4, label="end")
        axes.set_aspect("equal", adjustable="datalim")
        legend(axes)
    above.set(xlabel="x [m]", ylabel="y [m]")
    side.set(xlabel="reach [m]", ylabel="height [m]")
    figure.suptitle(run_title([result]))
    footnote(figure, assumed(result))
    return figure


def run_pictures(result: xr.Dataset) -> dict[str, Figure]:
    """All pictures of one run by file name."""
    return {
        "plan.png": plan(result),
        "sway.png": sway([result]),
        "torques.png": torques(result),
        "path.png": path(result),
    }

"""Pictures of a tower crane in its jib's plane; Fig. 4 to 11 of Gao et al. (2023) are comparisons of two runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.report.plots.style import (
    COLOURS,
    DASHES,
    figure_of,
    footnote,
    legend,
    line,
    over_time,
    run_title,
    titled,
)
from towercrane.results.spectrum import amplitude_spectrum, spectrum_peaks
from towercrane.runs.summary import assumed

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

    from modal import Modes
    from modal.structures.chain_modes import ChainModes

MOST_SHAPES = 6
"""Mode shapes in one picture; more could not be told apart."""


def modes(
    tower: Modes | ChainModes,
    jib: Modes | ChainModes,
    notes: list[tuple[str, str, str]] | None = None,
    counter_jib: Modes | ChainModes | None = None,
) -> Figure:
    """Mode shapes of tower, jib and a counter-jib that bends, each scaled to a largest deflection of one."""
    panels = [("Tower with slewing part, without weight", tower), ("Jib, clamped at the tower", jib)]
    if counter_jib is not None:
        panels.append(("Counter-jib, clamped at the tower", counter_jib))
    figure = figure_of(4.5 * len(panels), 6.0)
    all_axes = figure.subplots(1, len(panels), width_ratios=(1.0, *[1.4] * (len(panels) - 1)))
    for axes, (title, shapes) in zip(all_axes, panels, strict=True):
        along, upright = np.linspace(0.0, shapes.length, 400), shapes is tower
        for i, deflection in enumerate(shapes(along)[:MOST_SHAPES]):
            deflection = deflection / max(abs(deflection).max(), 1e-300)
            line = {"color": COLOURS[i % 6], "ls": DASHES[i % 4]}
            name = f"mode {i + 1}: {shapes.frequencies_hz[i]:.4g} Hz"
            axes.plot(*((deflection, along) if upright else (along, deflection)), label=name, **line)
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=2, fontsize=8, frameon=False)
        places, deflections = "height [m]" if upright else "distance from tower axis [m]", "deflection / largest [1]"
        if upright:
            axes.axvline(0.0, color="0.6", lw=0.8)
            axes.set(title=title, xlabel=deflections, ylabel=places)
        else:
            axes.axhline(0.0, color="0.6", lw=0.8)
            axes.set(title=title, xlabel=places, ylabel=deflections)
    footnote(figure, notes or [])
    return figure


def overview(result: xr.Dataset) -> Figure:
    """What the drives, the load, the tower and the jib do, one below the other."""
    time = result["time"]
    series = [
        ("trolley_position", 1.0, "trolley [m]"),
        ("sway_radial", 180.0 / np.pi, "swing [deg]"),
        ("tower_tip_displacement", 1e3, "tower top [mm]"),
        ("jib_tip_deflection", 1e3, "jib tip [mm]"),
        ("hoist_rope_force", 1e-3, "rope tension [kN]"),
    ]
    if np.ptp(result["rope_length"].values) > 0.0:
        series.insert(1, ("rope_length", 1.0, "rope [m]"))
    figure = figure_of(9.0, 2.0 * len(series))
    rows = figure.subplots(len(series), 1, sharex=True)
    for i, (axes, (name, factor, label)) in enumerate(zip(rows, series, strict=True)):
        axes.plot(time, factor * result[name], color=COLOURS[i % 6], label=result[name].attrs["long_name"])
        axes.set_ylabel(label)
        legend(axes)
    rows[-1].set_xlabel("time [s]")
    figure.suptitle(run_title([result]))
    footnote(figure, assumed(result))
    return figure


def motion(results: list[xr.Dataset]) -> Figure:
    """Trolley position, speed and acceleration (Gao et al. 2023, Fig. 4)."""
    figure = figure_of(8.0, 7.0)
    rows = figure.subplots(3, 1, sharex=True)
    for i, result in enumerate(results):
        time, speed = result["time"].values, result["trolley_speed"].values
        acceleration = np.gradient(speed, time) if len(time) > 1 else np.zeros_like(speed)
        for axes, values in zip(rows, (result["trolley_position"], speed, acceleration), strict=True):
            axes.plot(time, values, **line(i, result))
    for axes, label in zip(rows, ("position [m]", "speed [m/s]", "acceleration [m/s²]"), strict=True):
        axes.set_ylabel(label)
    legend(rows[0])
    rows[-1].set_xlabel("time [s]")
    return titled(figure, "Trolley motion", results)


def swing(results: list[xr.Dataset]) -> Figure:
    """Swing angle over time (Fig. 5 and 9)."""
    return over_time(results, "sway_radial", 180.0 / np.pi, "swing angle [deg]", "Swing of the load")


def tower(results: list[xr.Dataset]) -> Figure:
    """Displacement of the tower top over time (Fig. 7, 10 and 11)."""
    return over_time(results, "tower_tip_displacement", 1e3, "displacement of the tower top [mm]", "Tower top")


def jib(results: list[xr.Dataset]) -> Figure:
    """Deflection of the jib tip over time."""
    return over_time(results, "jib_tip_deflection", 1e3, "deflection of the jib tip [mm]", "Jib tip")


def phase(results: list[xr.Dataset]) -> Figure:
    """Swing rate over swing angle with the ends of the drive's ramps marked (Fig. 6)."""
    figure = figure_of(4.2 * len(results) + 1.0, 5.0)
    panels = np.atleast_1d(figure.subplots(1, len(results)))
    degrees = 180.0 / np.pi
    for i, (axes, result) in enumerate(zip(panels, results, strict=True)):
        angle, rate = degrees * result["sway_radial"].values, degrees * result["swing_rate"].values
        axes.plot(angle, rate, **line(i, result))
        for letter, row in _ramp_ends(result):
            axes.plot(angle[row], rate[row], "o", color="black", ms=4)
            axes.annotate(letter, (angle[row], rate[row]), xytext=(5, 5), textcoords="offset points")
        axes.set_xlabel("swing angle [deg]")
        legend(axes)
    panels[0].set_ylabel("swing rate [deg/s]")
    return titled(figure, "Phase path; A start, B full speed, C braking, D stop", results)


def spectrum(results: list[xr.Dataset]) -> Figure:
    """Amplitude spectrum of the tower top with its peaks (Fig. 8)."""
    figure = figure_of(8.0, 4.8)
    axes = figure.subplots()
    drawn = False
    for i, result in enumerate(results):
        time, values = result["time"].values, result["tower_tip_displacement"].values
        frequencies, amplitudes = amplitude_spectrum(time, values)
        drawn = drawn or len(amplitudes) > 0
        axes.plot(frequencies, 1e3 * amplitudes, **line(i, result))
        for at in spectrum_peaks(time, values, most=3):
            height = 1e3 * np.interp(at, frequencies, amplitudes)
            axes.annotate(
                f"{at:.3f} Hz", (at, height), xytext=(4, 4 + 9 * i), textcoords="offset points", fontsize=7,
                color=COLOURS[i % 6],
            )  # fmt: skip
    axes.set(xlim=(0.0, 1.2), xlabel="frequency [Hz]", ylabel="amplitude of the tower top [mm]")
    if drawn:
        axes.set_yscale("log")
        top = axes.get_ylim()[1]
        axes.set_ylim(1e-5 * top, 2.0 * top)
    else:
        axes.text(0.5, 0.5, "the tower top does not vibrate", ha="center", transform=axes.transAxes)
    legend(axes)
    return titled(figure, "Spectrum of the tower top", results)


def run_pictures(result: xr.Dataset) -> dict[str, Figure]:
    """All pictures of one run by file name."""
    one = [result]
    return {
        "overview.png": overview(result),
        "motion.png": motion(one),
        "swing.png": swing(one),
        "phase.png": phase(one),
        "tower.png": tower(one),
        "jib.png": jib(one),
        "spectrum.png": spectrum(one),
    }


def source_figures(conditions: dict[int, xr.Dataset]) -> dict[str, Figure]:
    """Fig. 4 to 11 of Gao et al. (2023) from the corrected model, by file name; conditions 1 to 4."""
    c = conditions
    return {
        "figure-04-motion.png": motion([c[1], c[2]]),
        "figure-05-swing-speed.png": swing([c[1], c[2]]),
        "figure-06-phase.png": phase([c[1], c[2]]),
        "figure-07-tower-speed.png": tower([c[1], c[2]]),
        "figure-08-spectrum.png": spectrum([c[1], c[2]]),
        "figure-09-swing-rope.png": swing([c[3], c[4]]),
        "figure-10-tower-rope.png": tower([c[3], c[4]]),
        "figure-11-tower-mass.png": tower([c[2], c[3]]),
    }


def _ramp_ends(result: xr.Dataset) -> list[tuple[str, int]]:
    """Rows at which the trolley starts, reaches its speed, brakes and stops, as far as the run came."""
    speed = abs(result["trolley_speed"].values)
    if not speed.max() > 0.0:
        return []
    moving, full = np.flatnonzero(speed > 0.0), np.flatnonzero(speed > (1.0 - 1e-9) * speed.max())
    last = len(speed) - 1
    ends = [("A", max(moving[0] - 1, 0))]
    if full[0] < last:
        ends.append(("B", full[0]))
    if full[-1] < last:
        ends.append(("C", full[-1]))
    if moving[-1] < last:
        ends.append(("D", moving[-1] + 1))
    return [(letter, int(row)) for letter, row in ends]

"""Pictures that an engineer would print: every axis with its unit, every line named, safe for colour-blind eyes.

Each function draws one or several results into one figure; the source's Fig. 4 to 11 are comparisons of two.
Values that no source gives are named under every figure that depends on them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.results import replacing
from towercrane.spectrum import amplitude_spectrum, spectrum_peaks
from towercrane.summary import assumed

if TYPE_CHECKING:
    from os import PathLike

    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from modal import Modes

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
"""Okabe and Ito's palette, distinguishable with every common colour vision."""

MOST_SHAPES = 6
"""Mode shapes in one picture; more could not be told apart."""

DASHES = ("-", "--", "-.", ":")
"""Lines differ in dash as well, for print in grey."""


def save(figure: Figure, path: str | PathLike[str]) -> None:
    """Write a figure whole or not at all."""
    with replacing(path) as temporary:
        figure.savefig(temporary, dpi=150)


def modes(tower: Modes, jib: Modes, notes: list[tuple[str, str, str]] | None = None) -> Figure:
    """Mode shapes of tower and jib, each scaled to a largest deflection of one."""
    figure = _figure(9.0, 6.0)
    left, right = figure.subplots(1, 2, width_ratios=(1, 1.4))
    for axes, shapes, upright in ((left, tower, True), (right, jib, False)):
        along = np.linspace(0.0, shapes.beam.length, 400)
        for i, deflection in enumerate(shapes(along)[:MOST_SHAPES]):
            deflection = deflection / max(abs(deflection).max(), 1e-300)
            line = {"color": COLOURS[i % 6], "ls": DASHES[i % 4]}
            name = f"mode {i + 1}: {shapes.frequencies_hz[i]:.4g} Hz"
            axes.plot(*((deflection, along) if upright else (along, deflection)), label=name, **line)
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=2, fontsize=8, frameon=False)
    left.axvline(0.0, color="0.6", lw=0.8)
    right.axhline(0.0, color="0.6", lw=0.8)
    left.set(title="Tower with slewing part", xlabel="deflection / largest [1]", ylabel="height [m]")
    right.set(
        title="Jib, clamped at the tower",
        xlabel="distance from tower axis [m]",
        ylabel="deflection / largest [1]",
    )
    _footnote(figure, notes or [])
    return figure


def overview(result: xr.Dataset) -> Figure:
    """What the drives, the load, the tower and the jib do, one below the other."""
    time = result["time"]
    series = [
        ("trolley_position", 1.0, "trolley [m]"),
        ("swing_angle", 180.0 / np.pi, "swing [deg]"),
        ("tower_tip_displacement", 1e3, "tower top [mm]"),
        ("jib_tip_deflection", 1e3, "jib tip [mm]"),
        ("rope_tension", 1e-3, "rope tension [kN]"),
    ]
    if np.ptp(result["rope_length"].values) > 0.0:
        series.insert(1, ("rope_length", 1.0, "rope [m]"))
    figure = _figure(9.0, 2.0 * len(series))
    rows = figure.subplots(len(series), 1, sharex=True)
    for i, (axes, (name, factor, label)) in enumerate(zip(rows, series, strict=True)):
        axes.plot(time, factor * result[name], color=COLOURS[i % 6], label=result[name].attrs["long_name"])
        axes.set_ylabel(label)
        _legend(axes)
    rows[-1].set_xlabel("time [s]")
    figure.suptitle(_title([result]))
    _footnote(figure, assumed(result))
    return figure


def motion(results: list[xr.Dataset]) -> Figure:
    """Trolley position, speed and acceleration (Gao et al. 2023, Fig. 4)."""
    figure = _figure(8.0, 7.0)
    rows = figure.subplots(3, 1, sharex=True)
    for i, result in enumerate(results):
        time, speed = result["time"].values, result["trolley_speed"].values
        acceleration = np.gradient(speed, time) if len(time) > 1 else np.zeros_like(speed)
        for axes, values in zip(rows, (result["trolley_position"], speed, acceleration), strict=True):
            axes.plot(time, values, **_line(i, result))
    for axes, label in zip(rows, ("position [m]", "speed [m/s]", "acceleration [m/s²]"), strict=True):
        axes.set_ylabel(label)
    _legend(rows[0])
    rows[-1].set_xlabel("time [s]")
    return _titled(figure, "Trolley motion", results)


def swing(results: list[xr.Dataset]) -> Figure:
    """Swing angle over time (Fig. 5 and 9)."""
    return _over_time(results, "swing_angle", 180.0 / np.pi, "swing angle [deg]", "Swing of the load")


def tower(results: list[xr.Dataset]) -> Figure:
    """Displacement of the tower top over time (Fig. 7, 10 and 11)."""
    return _over_time(results, "tower_tip_displacement", 1e3, "displacement of the tower top [mm]", "Tower top")


def jib(results: list[xr.Dataset]) -> Figure:
    """Deflection of the jib tip over time."""
    return _over_time(results, "jib_tip_deflection", 1e3, "deflection of the jib tip [mm]", "Jib tip")


def phase(results: list[xr.Dataset]) -> Figure:
    """Swing rate over swing angle with the ends of the drive's ramps marked (Fig. 6)."""
    figure = _figure(4.2 * len(results) + 1.0, 5.0)
    panels = np.atleast_1d(figure.subplots(1, len(results)))
    degrees = 180.0 / np.pi
    for i, (axes, result) in enumerate(zip(panels, results, strict=True)):
        angle, rate = degrees * result["swing_angle"].values, degrees * result["swing_rate"].values
        axes.plot(angle, rate, **_line(i, result))
        for letter, row in _ramp_ends(result):
            axes.plot(angle[row], rate[row], "o", color="black", ms=4)
            axes.annotate(letter, (angle[row], rate[row]), xytext=(5, 5), textcoords="offset points")
        axes.set_xlabel("swing angle [deg]")
        _legend(axes)
    panels[0].set_ylabel("swing rate [deg/s]")
    return _titled(figure, "Phase path; A start, B full speed, C braking, D stop", results)


def spectrum(results: list[xr.Dataset]) -> Figure:
    """Amplitude spectrum of the tower top with its peaks (Fig. 8)."""
    figure = _figure(8.0, 4.8)
    axes = figure.subplots()
    drawn = False
    for i, result in enumerate(results):
        time, values = result["time"].values, result["tower_tip_displacement"].values
        frequencies, amplitudes = amplitude_spectrum(time, values)
        drawn = drawn or len(amplitudes) > 0
        axes.plot(frequencies, 1e3 * amplitudes, **_line(i, result))
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
    _legend(axes)
    return _titled(figure, "Spectrum of the tower top", results)


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


def _figure(width: float, height: float) -> Figure:
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def _over_time(results: list[xr.Dataset], name: str, factor: float, label: str, title: str) -> Figure:
    figure = _figure(8.0, 4.4)
    axes: Axes = figure.subplots()
    for i, result in enumerate(results):
        axes.plot(result["time"], factor * result[name], **_line(i, result))
    axes.set(xlabel="time [s]", ylabel=label)
    axes.grid(axis="y", color="0.9", lw=0.6)
    _legend(axes)
    return _titled(figure, title, results)


def _legend(axes: Axes) -> None:
    """Name the lines above the axes, where no curve can be hidden."""
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), borderaxespad=0.2, ncols=2, fontsize=8, frameon=False)


def _line(i: int, result: xr.Dataset) -> dict[str, Any]:
    return {"color": COLOURS[i % 6], "ls": DASHES[i % 4], "lw": 1.2, "label": _label(result)}


def _label(result: xr.Dataset) -> str:
    name = result.attrs.get("case", result.attrs["crane"]).rpartition("/")[2]
    speed, first, last = float(abs(result["trolley_speed"]).max()), *result["rope_length"].values[[0, -1]]
    rope = f"{first:.4g} m" if abs(last - first) < 1e-6 else f"{first:.4g} to {last:.4g} m"
    label = f"{name}: {speed:.2g} m/s, {result.attrs['payload_mass']:.4g} kg, rope {rope}"
    if result.attrs["outcome"] != "finished":
        label += f" ({result.attrs['outcome']} at {result.attrs['end_time']:.2f} s)"
    return label


def _title(results: list[xr.Dataset]) -> str:
    crane = results[0].attrs["crane"]
    return f"{crane}, {_label(results[0])}" if len(results) == 1 else f"{crane}"


def _titled(figure: Figure, title: str, results: list[xr.Dataset]) -> Figure:
    figure.suptitle(f"{title}, {results[0].attrs['crane']}")
    notes: dict[str, tuple[str, str, str]] = {}
    for result in results:
        for note in assumed(result):
            notes.setdefault(note[0] + note[1], note)
    _footnote(figure, list(notes.values()))
    return figure


def _footnote(figure: Figure, notes: list[tuple[str, str, str]]) -> None:
    if notes:
        text = "assumed, given by no source: " + ", ".join(f"{key} = {value}" for key, value, _ in notes)
        figure.supxlabel(text, fontsize=6.5, color="0.35", wrap=True)


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

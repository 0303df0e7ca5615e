"""Motions as case files describe them, and the CSV tables they may come from."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from towercrane.faults import CaseError, Fault, shown
from towercrane.schema import MODEL
from towercrane.schema_motions import (
    MinimumJerk,
    Points,
    Rest,
    SCurve,
    Sequence,
    Shaped,
    SmoothRamps,
    SpeedTrapezoid,
    Trapezoid,
)

if TYPE_CHECKING:
    from pathlib import Path

    from towercrane.plans import Move, Plan
    from towercrane.schema_motions import AnyMotion

SHOWN_FAULTS = 5
"""At most so many faulty lines of one CSV file are reported."""


def plan(described: AnyMotion, start: float, folder: Path, unit: str = "m") -> Plan:
    """What a case tells a drive to do.

    Parameters
    ----------
    described : table of the case
    start : float
        Value at which the motion begins [m or rad]; a CSV table brings its own.
    folder : Path
        Where a CSV file's name is relative to.
    unit : str
        "m", or "rad" for a turn.

    Raises
    ------
    CaseError
        If a CSV table cannot be used.
    """
    from towercrane.motion import rest, s_curve, smooth_ramps, speed_trapezoid, table, trapezoid
    from towercrane.plans import Move, Shaping
    from towercrane.shaping import DESIGNS, minimum_jerk

    shaping = None
    match described:
        case Points():
            motion = table(*read_points(folder / described.file, unit))
            start = float(motion(0.0))
        case Sequence():
            steps: list[Move] = []
            now = start
            for step in described.steps:
                steps += plan(step, now, folder, unit).moves
                now = steps[-1].commanded.end
            return _delayed(steps, start, described.delay)
        case Rest():
            motion = rest(start, described.duration)
        case Shaped():
            motion = trapezoid(start, described.end, described.speed, described.acceleration)
            known = described.frequencies
            shaping = Shaping(DESIGNS[described.shape], None if known == MODEL else tuple(map(float, known)))
        case MinimumJerk():
            motion = minimum_jerk(start, described.end, described.duration)
        case Trapezoid():
            motion = trapezoid(start, described.end, described.speed, described.acceleration)
        case SCurve():
            d = described
            motion = s_curve(start, d.end, d.speed, d.acceleration, d.jerk)
        case SpeedTrapezoid():
            motion = speed_trapezoid(start, described.speed, described.ramp, described.hold)
        case SmoothRamps():
            motion = smooth_ramps(start, described.speed, described.ramp, described.hold)
    return _delayed([Move(motion, shaping)], start, described.delay)


def _delayed(moves: list[Move], start: float, delay: float) -> Plan:
    """Moves after a wait."""
    from towercrane.motion import rest
    from towercrane.plans import Move, Plan

    return Plan((Move(rest(start, delay)), *moves) if delay else tuple(moves))


def read_points(path: Path, unit: str = "m") -> tuple[list[float], list[float]]:
    """Times [s] and values [m or rad] of a CSV file with one header line and two columns.

    Raises
    ------
    CaseError
        If the file cannot be read, or a line is not two numbers, or the times do not increase from 0.
    """
    value = "position or length [m]" if unit == "m" else f"angle [{unit}]"
    wanted = f"a CSV file: one header line, then time [s] and {value} per line"
    try:
        lines = path.read_text("utf-8-sig").splitlines()
    except (OSError, ValueError) as error:
        got = "text that is not UTF-8" if isinstance(error, UnicodeDecodeError) else "no readable file"
        raise CaseError([Fault(str(path), "", wanted, got, "the path is relative to the case file")]) from None
    rows = [(number, line) for number, line in enumerate(lines, start=1) if line.strip()]
    faults = []
    if rows and len(numbers_of(rows[0][1])) == 2:
        faults.append(Fault(str(path), f"line {rows[0][0]}", "a header line", shown(rows[0][1])))
    times: list[float] = []
    values: list[float] = []
    for number, line in rows[1:]:
        fault = _row_fault(line, times, "metres" if unit == "m" else "radians")
        if fault:
            faults.append(Fault(str(path), f"line {number}", *fault))
        pair = numbers_of(line)
        if len(pair) == 2:
            times.append(pair[0])
            values.append(pair[1])
    if not faults and len(times) < 2:
        faults.append(Fault(str(path), "", wanted, f"{len(times)} lines of numbers", "two or more are needed"))
    if faults:
        raise CaseError(faults[:SHOWN_FAULTS])
    return times, values


def numbers_of(line: str) -> list[float]:
    """The finite numbers of a line; those that are not drop out."""
    numbers = []
    for cell in line.split(","):
        try:
            number = float(cell)
        except ValueError:
            continue
        if math.isfinite(number):
            numbers.append(number)
    return numbers


def _row_fault(line: str, times: list[float], units: str) -> tuple[str, str, str] | None:
    """Wanted, got and hint for a faulty line."""
    columns = line.split(",")
    if len(columns) != 2:
        hint = "columns are parted by commas" if ";" in line or "\t" in line else ""
        return "two columns: time, value", f"{len(columns)} in {shown(line)}", hint
    numbers = numbers_of(line)
    if len(numbers) != 2:
        return "two finite numbers", shown(line), f"numbers stand without units: seconds and {units}"
    if not times and numbers[0] != 0.0:
        return "a first time of 0", f"{numbers[0]:g}", "times count from the start of the motion"
    if times and numbers[0] <= times[-1]:
        return f"a time after {times[-1]:g}", f"{numbers[0]:g}", ""
    return None

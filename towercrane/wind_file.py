"""The wind of a case: steady, or gusts from a CSV file."""

from __future__ import annotations

from dataclasses import replace
from math import cos, sin
from typing import TYPE_CHECKING, Any

from towercrane.faults import CaseError, Fault, shown
from towercrane.plausibility import at, si_at
from towercrane.profiles import SHOWN_FAULTS, numbers_of

if TYPE_CHECKING:
    from pathlib import Path

    from towercrane.motion import Motion

CHANNELS = ("wind_x", "wind_y", "wind_z")
"""Names of the wind's motions, as in :data:`towercrane.cranes.wind.CHANNELS`."""

COLUMNS = 4
"""Time and three components."""

UNEVEN = 1e-6
"""Departure of a time from the uniform grid, relative to its step, that is more than rounding."""

STRONGEST = 80.0
"""Largest plausible component of the wind [m/s]."""


def wind_motions(tree: dict[str, Any], folder: Path) -> tuple[list[Fault], dict[str, Motion | None]]:
    """Motions of the wind's components [m/s], none for a case in still air, and what is wrong with its file."""
    wind = at(tree, "wind")
    if not isinstance(wind, dict):
        return [], {}
    from towercrane.cranes.wind import gusts, steady

    series = wind.get("series")
    if isinstance(series, str) and series:
        try:
            return [], dict(gusts(*read_gusts(folder / series)))
        except CaseError as error:
            named = "named by wind.series of the case"
            return [replace(f, hint=f"{f.hint}; {named}" if f.hint else named) for f in error.faults], {}
    speed = si_at(tree, "wind.speed", "m/s")
    direction, upward = si_at(tree, "wind.direction", "rad", 0.0), si_at(tree, "wind.upward", "m/s", 0.0)
    if speed is None or direction is None or upward is None:
        return [], {}
    return [], dict(steady([speed * cos(direction), speed * sin(direction), upward]))


def read_gusts(path: Path) -> tuple[float, list[list[float]]]:
    """Time step [s] and velocities [m/s] of a CSV file with one header line and four columns.

    Raises
    ------
    CaseError
        If the file cannot be read, a line is not four numbers, or the times are not evenly spaced from 0.
    """
    wanted = "a CSV file: one header line, then time [s] and wind along x, y and z [m/s] per line"
    try:
        lines = path.read_text("utf-8-sig").splitlines()
    except (OSError, ValueError) as error:
        got = "text that is not UTF-8" if isinstance(error, UnicodeDecodeError) else "no readable file"
        raise CaseError([Fault(str(path), "", wanted, got, "the path is relative to the case file")]) from None
    written = [(number, line) for number, line in enumerate(lines, start=1) if line.strip()]
    faults = []
    if written and len(numbers_of(written[0][1])) == COLUMNS:
        faults.append(Fault(str(path), f"line {written[0][0]}", "a header line", shown(written[0][1])))
    rows: list[list[float]] = []
    for number, line in written[1:]:
        values = numbers_of(line)
        if len(values) != COLUMNS or line.count(",") != COLUMNS - 1:
            what, hint = "four finite numbers: time, x, y, z", "columns are parted by commas; numbers have no units"
            faults.append(Fault(str(path), f"line {number}", what, shown(line), hint))
            continue
        step = rows[1][0] - rows[0][0] if len(rows) > 1 else None
        due = 0.0 if not rows else None if step is None else len(rows) * step
        late = values[0] <= rows[-1][0] if rows else False
        if late or (due is not None and abs(values[0] - due) > UNEVEN * (step or 1.0)):
            what = f"the time {due:g} s, evenly spaced from 0" if due is not None else "a time after the last"
            faults.append(Fault(str(path), f"line {number}", what, f"{values[0]:g}"))
        elif max(abs(value) for value in values[1:]) > STRONGEST:
            what = f"components up to {STRONGEST:g} m/s"
            faults.append(Fault(str(path), f"line {number}", what, shown(line), "km/h meant?"))
        rows.append(values)
    if not faults and len(rows) < 2:
        faults.append(Fault(str(path), "", wanted, f"{len(rows)} lines of numbers", "two or more are needed"))
    if faults:
        raise CaseError(faults[:SHOWN_FAULTS])
    return rows[-1][0] / (len(rows) - 1), [row[1:] for row in rows]

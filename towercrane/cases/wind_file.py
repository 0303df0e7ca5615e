"""The wind of a case: steady, or gusts from a CSV file."""

from __future__ import annotations

from dataclasses import replace
from math import cos, sin
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.schema.csv_table import SHOWN_FAULTS, TIME, Column, read_table
from towercrane.schema.faults import CaseError, Fault
from towercrane.schema.ranges import at, si_at

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from towercrane.motions.motion import Motion
    from towercrane.schema.csv_table import CsvTable

    Floats = NDArray[np.float64]

CHANNELS = ("wind_x", "wind_y", "wind_z")
"""Names of the wind's motions, as in :data:`towercrane.cranes.parts.wind.CHANNELS`."""

AXES = {
    axis: (axis, f"wind_{axis}", f"wind {axis}", f"v{axis}", speed) for axis, speed in zip("xyz", "uvw", strict=True)
}
"""Components, and the names that a header may give them."""

ROUNDING = 1e-12
"""Relative; what numbers differ by that are the same."""

MOST_DECIMALS = 10
"""Decimal places from which on a time is taken as exact."""

STRONGEST = 80.0
"""Largest plausible component of the wind [m/s]."""


def wind_motions(tree: dict[str, Any], folder: Path) -> tuple[list[Fault], dict[str, Motion | None]]:
    """Motions of the wind's components [m/s], none for a case in still air, and what is wrong with its file."""
    wind = at(tree, "wind")
    if not isinstance(wind, dict):
        return [], {}
    from towercrane.cranes.parts.wind import gusts, steady

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


def read_gusts(path: Path) -> tuple[Floats, Floats]:
    """Times [s], shape (p,), and velocities [m/s], shape (p, 3), of a CSV file.

    Raises
    ------
    CaseError
        If it is no such table, see :func:`towercrane.schema.csv_table.read_table`, its times are not evenly spaced
        within the decimals that they are given with, or a wind is too strong to be one.
    """
    table = read_table(path, (TIME, *(Column(axis, "m/s", words) for axis, words in AXES.items())))
    faults = uneven(table)
    largest = np.max(abs(table.values[:, 1:]), axis=1)
    for row in np.flatnonzero(largest > STRONGEST).tolist():
        what, hint = f"components up to {STRONGEST:g} m/s", "x [km/h] meant? The header names the unit"
        faults.append(table.fault(row, what, f"{largest[row]:g} m/s", hint))
    if faults:
        raise CaseError(faults[:SHOWN_FAULTS])
    return table.values[:, 0], table.values[:, 1:]


def uneven(table: CsvTable) -> list[Fault]:
    """The first row whose time is not evenly spaced within their decimals, if there is one."""
    times = table.written[:, 0]
    steps = np.diff(times)
    # A gap or a slip does not change the usual step, and many steps tell it more finely than one.
    usual = float(np.mean(steps[abs(steps - np.median(steps)) <= 0.1 * np.median(steps)]))
    due = np.arange(len(times)) * times[-1] / max(round(times[-1] / usual), 1)
    # Both the time itself and the last one, which sets the step, are rounded; after a gap all are late.
    rows = np.flatnonzero(abs(times - due) > _last_place(times) + ROUNDING * times[-1])[:1].tolist()
    return [table.fault(row, f"the time {due[row]:g} s, evenly spaced from 0", f"{times[row]:g}") for row in rows]


def _last_place(numbers: Floats) -> float:
    """Size of the last decimal place that any of the numbers has."""
    for decimals in range(MOST_DECIMALS):
        if np.all(abs(np.round(numbers, decimals) - numbers) <= ROUNDING * (1.0 + abs(numbers))):
            return float(10.0**-decimals)
    return 0.0

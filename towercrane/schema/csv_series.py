"""Components over time in CSV files, at even steps: wind, ground, floors."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.schema.csv_table import SHOWN_FAULTS, TIME, Column, read_table
from towercrane.schema.faults import CaseError, Fault

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from numpy.typing import NDArray

    from towercrane.schema.csv_table import CsvTable

    Floats = NDArray[np.float64]

ROUNDING = 1e-12
"""Relative; what numbers differ by that are the same."""

MOST_DECIMALS = 10
"""Decimal places from which on a time is taken as exact."""


def read_series(
    path: Path, unit: str, words: Mapping[str, tuple[str, ...]], most: float, hint: str
) -> tuple[Floats, Floats]:
    """Times [s], shape (p,), and components, shape (p, components), of a CSV file.

    Parameters
    ----------
    path : Path
    unit : str
        SI unit of the components.
    words : mapping of str to tuple of str
        Components, and the names that a header may give them.
    most : float
        Largest plausible size of a component.
    hint : str
        Likely cause of a larger one.

    Raises
    ------
    CaseError
        If it is no such table, see :func:`towercrane.schema.csv_table.read_table`, its times are not evenly spaced
        within the decimals that they are given with, or a component is too large to be one.
    """
    table = read_table(path, (TIME, *(Column(axis, unit, known) for axis, known in words.items())))
    faults = _uneven(table)
    largest = np.max(abs(table.values[:, 1:]), axis=1)
    for row in np.flatnonzero(largest > most).tolist():
        faults.append(table.fault(row, f"components up to {most:g} {unit}", f"{largest[row]:g} {unit}", hint))
    if faults:
        raise CaseError(faults[:SHOWN_FAULTS])
    return table.values[:, 0], table.values[:, 1:]


def _uneven(table: CsvTable) -> list[Fault]:
    """The first row whose time is not evenly spaced within their decimals, if there is one."""
    times = table.written[:, 0]
    steps = np.diff(times)
    # A gap or a slip does not change the usual step, and many steps tell it more finely than one.
    alike = abs(steps - np.median(steps)) <= 0.1 * np.median(steps)
    usual = float(np.mean(steps[alike]) if alike.any() else steps[0])
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

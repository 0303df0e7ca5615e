"""Fatigue: what the cycles in the forces and moments of runs come to, each run as often as it occurs."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.runs.summary import assumed
from towercrane.schema.faults import did_you_mean
from towercrane.simulation.outcomes import FINISHED
from towercrane.studies.fatigue.counting import (
    CLASSES,
    COUNTINGS,
    REFERENCE,
    STANDARD,
    class_of,
    cycles_of_a_day,
    equivalent_range,
    spectrum_factor,
    spectrum_shape,
)

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from towercrane.results.recording import Result

    Floats = NDArray[np.float64]

SMALLEST = 1e-3
"""Part of the largest range below which cycles are not counted: they change k_m, which tells nothing then, alone."""

RESULTANTS = ("base_shear", "overturning_moment", "overturning_moment_first_order")
"""Outputs that are never negative, whose cycles are not those of what they are the resultant of."""


@dataclass(frozen=True, eq=False)
class Operation:
    """A run and how often it occurs in a day.

    Parameters
    ----------
    name : str
    result : Result
    count : float
    """

    name: str
    result: Result
    count: float = 1.0


@dataclass(frozen=True)
class Spectra:
    """How cycles are counted and judged.

    Parameters
    ----------
    days : float
        How often the day occurs.
    exponents : tuple of float
        Of the lines in a diagram of ranges over numbers of cycles.
    reference_cycles : float
    counting : {"repeated", "alone"}
    classes : dict of str to float
        Largest spectrum factor of each class, ascending.
    standard : str
        Where classes and reference come from.
    """

    days: float = 1.0
    exponents: tuple[float, ...] = (3.0, 4.0, 5.0)
    reference_cycles: float = REFERENCE
    counting: str = "repeated"
    classes: Mapping[str, float] = field(default_factory=lambda: CLASSES)
    standard: str = STANDARD


@dataclass(frozen=True, eq=False)
class Fatigue:
    """Cycles of all days by output, and what is said of them.

    Parameters
    ----------
    cycles : dict of str to ndarray, shape (cycles, 3)
        Range, mean and number.
    units : dict of str to str
    report : dict
        Ready for JSON.
    """

    cycles: dict[str, Floats]
    units: dict[str, str]
    report: dict[str, Any]


def fatigue(
    operations: Sequence[Operation], outputs: Sequence[str] | None = None, spectra: Spectra | None = None
) -> Fatigue:
    """Count the cycles of runs.

    Parameters
    ----------
    operations : sequence of Operation
        What a day consists of, in this order; see :func:`towercrane.studies.fatigue.counting.cycles_of_a_day`.
    outputs : sequence of str, optional
        Single forces and moments; by default all that every run has and that change.
    spectra : Spectra, optional

    Returns
    -------
    Fatigue

    Raises
    ------
    ValueError
        If there is nothing to count, an output is none of a run's, or a number is out of its range.
    """
    told = spectra or Spectra()
    _check(operations, told)
    shared = _shared(operations)
    for name in outputs or ():
        if name not in shared:
            near = did_you_mean(name, shared)
            raise ValueError(
                f"outputs: wanted some of {', '.join(shared)}, got {name!r}{f'; {near}' if near else ''}"
            )
    chosen = list(outputs) if outputs else [name for name in shared if name not in RESULTANTS]
    counted, units = {}, {}
    for name in chosen:
        histories = [np.asarray(one.result[name].values, dtype=float) for one in operations]
        day = cycles_of_a_day(histories, [one.count for one in operations], told.counting)
        largest = day[:, 0].max(initial=0.0)
        size = max(float(abs(values).max()) for values in histories)
        if not outputs and largest <= 1e-9 * size:
            continue
        counted[name] = day[day[:, 0] >= SMALLEST * largest] * (1.0, 1.0, told.days)
        units[name] = operations[0].result[name].attrs["units"]
    if not counted:
        raise ValueError("outputs: wanted a force or a moment that changes, got runs in which none does")
    return Fatigue(counted, units, _report(operations, told, counted, units))


def _check(operations: Sequence[Operation], told: Spectra) -> None:
    if not operations or not sum(one.count for one in operations) > 0.0:
        raise ValueError("operations: wanted one or more that occur, got none")
    for one in operations:
        _positive(f"count of {one.name}", one.count, least=0.0)
    _positive("days", told.days)
    _positive("reference_cycles", told.reference_cycles)
    if not told.exponents:
        raise ValueError("exponents: wanted one or more, got none")
    for exponent in told.exponents:
        if not 1.0 <= exponent <= 20.0:
            raise ValueError(f"exponents: wanted numbers from 1 to 20, got {exponent:g}")
    if told.counting not in COUNTINGS:
        raise ValueError(f"counting: wanted one of {', '.join(COUNTINGS)}, got {told.counting!r}")
    limits = list(told.classes.values())
    if not limits or any(not own > 0.0 for own in limits) or any(np.diff(limits) <= 0.0):
        raise ValueError("classes: wanted positive limits that ascend, got others")


def _positive(name: str, value: float, least: float | None = None) -> None:
    fits = value >= least if least is not None else value > 0.0
    if not (fits and value < np.inf):
        raise ValueError(f"{name}: wanted a number {'from' if least is not None else 'above'} 0, got {value:g}")


def _shared(operations: Sequence[Operation]) -> list[str]:
    """Single forces and moments that every run has."""
    first = operations[0].result
    found = [
        str(name)
        for name, own in first.data_vars.items()
        if own.dims == ("time",) and own.attrs["units"] in ("N", "N m")
    ]
    shared = [name for name in found if all(name in one.result for one in operations)]
    if not shared:
        raise ValueError("outputs: wanted runs with forces or moments of the same names, got none")
    return shared


def _report(
    operations: Sequence[Operation], told: Spectra, counted: dict[str, Floats], units: dict[str, str]
) -> dict[str, Any]:
    """What is said of the cycles, ready for JSON."""
    notices = [
        f"{one.name} ended early, at {one.result.attrs['end_time']:.6g} s: {one.result.attrs['outcome']}; "
        "its cycles are those to that time"
        for one in operations
        if one.result.attrs["outcome"] != FINISHED
    ]
    notices += [
        f"{name.replace('_', ' ')} is a resultant, never negative: where a load changes its side ranges are too small"
        for name in counted
        if name in RESULTANTS
    ]
    named = {entry for one in operations for entry in assumed(one.result)}
    return {
        "operations": [
            {
                "name": one.name,
                "count": one.count,
                "crane": one.result.attrs["crane"],
                "outcome": one.result.attrs["outcome"],
                "end_time_s": float(one.result.attrs["end_time"]),
                "look_step_s": float(np.max(np.diff(one.result["time"].values), initial=0.0)),
            }
            for one in operations
        ],
        "days": told.days,
        "counting": told.counting,
        "reference_cycles": told.reference_cycles,
        "exponents": list(told.exponents),
        "standard": told.standard,
        "classes": dict(told.classes),
        "smallest_range_counted": SMALLEST,
        "outputs": {
            name: {
                "units": units[name],
                "largest_range": float(cycles[:, 0].max(initial=0.0)),
                "cycles": float(cycles[:, 2].sum()),
                "spectra": [_judged(cycles, exponent, told) for exponent in told.exponents],
            }
            for name, cycles in counted.items()
        },
        "notices": notices,
        "assumed": [{"key": key, "value": value, "why": why} for key, value, why in sorted(named)],
    }


def _judged(cycles: Floats, exponent: float, told: Spectra) -> dict[str, Any]:
    factor = spectrum_factor(cycles, exponent, told.reference_cycles)
    return {
        "exponent": exponent,
        "equivalent_range": equivalent_range(cycles, exponent, told.reference_cycles),
        "k": spectrum_shape(cycles, exponent),
        "s": factor,
        "class": class_of(factor, told.classes),
    }

"""Rainflow counting of histories, of one alone, repeated, or repeated with others in a day's work.

Cycles are arrays of three columns: range, mean, and how often each occurs. Extraction is that of the package
`rainflow` (ASTM E1049-85, 5.4.4), which counts what is not closed at a history's end by halves; repeating it is ours.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

CLASSES = {
    "S0": 0.008, "S1": 0.016, "S2": 0.032, "S3": 0.063, "S4": 0.125,
    "S5": 0.25, "S6": 0.5, "S7": 1.0, "S8": 2.0, "S9": 4.0,
}  # fmt: skip
"""Largest spectrum factor s_m of each class."""

STANDARD = "EN 13001-1:2015"
"""Where the classes come from."""

REFERENCE = 2e6
"""Number of cycles that spectrum factors and equivalent ranges refer to, of the same standard."""


def turning_points(values: Floats) -> Floats:
    """First and last value of a history and those where it turns."""
    values = np.asarray(values, dtype=float)
    moved = values[np.r_[True, np.diff(values) != 0.0]]
    if len(moved) < 3:
        return moved
    way = np.diff(moved)
    return np.asarray(moved[np.r_[True, way[:-1] * way[1:] < 0.0, True]])


def cycles_alone(values: Floats) -> Floats:
    """Cycles of a history that happens once, shape (cycles, 3): those that it does not close count by halves."""
    from rainflow import extract_cycles

    points = turning_points(values)
    if len(points) < 3:
        # A single way there, which the package leaves out.
        return _gathered([(abs(b - a), 0.5 * (a + b), 0.5) for a, b in pairwise(points)])
    return _gathered([(size, mean, count) for size, mean, count, *_ in extract_cycles(points)])


def cycles_repeated(values: Floats) -> Floats:
    """Cycles of each repetition of a history that happens again and again: all of them are whole.

    Begun and ended at its largest value the history closes every cycle (ASTM E1049-85, 5.4.5); these are the closed
    ones of one history and those of its residue followed by itself.
    """
    points = turning_points(values)
    if len(points) < 2:
        return _gathered([])
    top = int(np.argmax(points))
    return cycles_alone(np.concatenate([points[top:], points[: top + 1]]))


COUNTINGS: dict[str, Callable[[Floats], Floats]] = {"repeated": cycles_repeated, "alone": cycles_alone}
"""Ways to count a history."""


def cycles_of_a_day(histories: Sequence[Floats], counts: Sequence[float], counting: str = "repeated") -> Floats:
    """Cycles of histories that occur so often in a day; days repeat.

    Those that occur once or more follow one another in this order, all repetitions of one together, which closes
    cycles from one history to another: n - 1 repetitions of each, and once all of them in a row. A history that does
    not occur every day is repeated by itself. Counted "alone" each is counted by itself as often as it occurs.
    """
    own = [COUNTINGS[counting](values) for values in histories]
    often = np.asarray(counts, dtype=float)
    if counting == "alone":
        return _weighted(own, often)
    daily = [np.asarray(values, dtype=float) for values, count in zip(histories, often, strict=True) if count >= 1.0]
    row = cycles_repeated(np.concatenate(daily)) if daily else _gathered([])
    return _weighted([*own, row], [*(count - 1.0 if count >= 1.0 else count for count in often), 1.0])


def equivalent_range(cycles: Floats, exponent: float, reference: float = REFERENCE) -> float:
    """Range of which so many cycles do the same damage, (sum n S^m / N_ref)^(1/m)."""
    if not len(cycles):
        return 0.0
    largest = float(cycles[:, 0].max())
    # Relative to the largest: powers of newton metres overflow nothing then.
    return float(largest * spectrum_factor(cycles, exponent, reference) ** (1.0 / exponent))


def spectrum_factor(cycles: Floats, exponent: float, reference: float = REFERENCE) -> float:
    """s_m = nu k_m: sum n (S / S_max)^m / N_ref; unlike k_m it does not depend on which small cycles are counted."""
    largest = float(cycles[:, 0].max(initial=0.0))
    return float(cycles[:, 2] @ (cycles[:, 0] / largest) ** exponent) / reference if largest > 0.0 else 0.0


def spectrum_shape(cycles: Floats, exponent: float) -> float:
    """k_m = sum (n / N) (S / S_max)^m, between 0 and 1."""
    number = float(cycles[:, 2].sum())
    return spectrum_factor(cycles, exponent, number) if number > 0.0 else 0.0


def class_of(factor: float, classes: Mapping[str, float]) -> str:
    """The first class whose limit a spectrum factor does not pass."""
    name = next((name for name, most in classes.items() if factor <= most), "")
    return name or f"beyond {list(classes)[-1]}"


def _weighted(parts: Sequence[Floats], counts: Sequence[float] | Floats) -> Floats:
    """Cycles together, those of each part so often."""
    rows = [part * (1.0, 1.0, count) for part, count in zip(parts, counts, strict=True) if count > 0.0]
    return _gathered(np.concatenate(rows) if rows else [])


def _gathered(rows: Sequence[tuple[float, float, float]] | Floats) -> Floats:
    """Each range and mean once, with how often it occurs, the largest range first."""
    found = np.reshape(np.asarray(rows, dtype=float), (-1, 3))
    kinds, place = np.unique(found[:, :2], axis=0, return_inverse=True)
    counts = np.bincount(np.ravel(place), weights=found[:, 2], minlength=len(kinds))
    return np.ascontiguousarray(np.column_stack([kinds, counts])[::-1])

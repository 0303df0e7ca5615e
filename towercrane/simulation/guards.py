"""Guards: values that must not fall below their floors, and how a solver looks for their falls inside its steps."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from modal.compiler.kinds import NumberRow, Row

    Floats = NDArray[np.float64]

NEAR = 0.5
"""A guard is near its floor where it comes closer to it than this part of its range in a step, as the stages see it.

Between two stages, at most 0.3 of a step apart, a parabola falls by 0.09 of its range below what they see, and a
vibration of which the whole step is one period by 0.21.
"""

FEW_LOOKS = 8
"""Points of a step that show whether a guard that may be near its floor is close to it."""

CLOSE = 0.15
"""A guard is close to its floor where it comes closer to it than this part of its range, as so many points see it.

Between two of them a parabola falls by 0.016 of its range, and a vibration of which the whole step is one period by
0.04, of which it is two by 0.15.
"""

LOOKS = 32
"""Points of a step at which the guards are looked at once one of them is close to its floor.

What dips between two of them is at most 0.001 of a parabola's range deep, 0.0025 of a vibration's.
"""

NARROWEST = 1e-12
"""Part of a step within which a fall is found."""

SOON, LATE, ROUGHLY = 1e-3, 0.99, 1e-3
"""A step is taken anew, up to its guard, where that falls between these parts of it, found as exactly as the last."""

MOST_RETAKES = 4
"""Times that a step which ends at a guard is taken anew, up to there; one or two do as a rule."""

MOST_STALLED = 20
"""Switches in a row without time passing at which a run is given up."""


def fallen(guards: Row, floors: Row) -> int:
    """Index of the first guard below its floor, or -1."""
    for g in range(guards.size):
        if guards[g] < floors[g]:
            return g
    return -1


def widen(lowest: NumberRow, highest: NumberRow, guards: NumberRow) -> None:
    """Let the guards' ranges contain what they are now."""
    for g in range(guards.size):
        lowest[g] = min(lowest[g], guards[g])
        highest[g] = max(highest[g], guards[g])


def is_near(lowest: float, highest: float, floor: float, part: float) -> bool:
    """Whether a guard of this range has fallen below its floor, or come closer than that part of its range."""
    return bool(lowest < floor or lowest - floor < part * (highest - lowest))


def any_near(lowest: Row, highest: Row, floors: Row, part: float) -> bool:
    """Whether one of the guards with these ranges in a step is that near to its floor."""
    found = False
    for g in range(floors.size):
        found = found or is_near(lowest[g], highest[g], floors[g], part)
    return found


def first_fall(
    begin: float, end: float, dense: Callable[[Any], Floats], margins: Callable[[float, Floats], Floats]
) -> tuple[float, int] | None:
    """Time at which a guard first falls inside a step, and its index; None if none does.

    Parameters
    ----------
    begin, end : float
        Times between which the step goes [s].
    dense : callable
        State at a time, or states at several as columns.
    margins : callable
        How far the guards that have floors are above them at a time and state.
    """

    def seen(looks: int) -> tuple[Floats, Floats]:
        times = np.linspace(begin, end, looks + 1)[1:]
        return times, np.array([margins(time, state) for time, state in zip(times, dense(times).T, strict=True)])

    _, found = seen(FEW_LOOKS)
    lowest, highest = found.min(axis=0), found.max(axis=0)
    if not any(is_near(low, high, 0.0, CLOSE) for low, high in zip(lowest, highest, strict=True)):
        return None
    times, found = seen(LOOKS)
    below = np.flatnonzero((found < 0.0).any(axis=1))
    if len(below) == 0:
        return None
    high, fallen_there = float(times[below[0]]), found[below[0]] < 0.0
    low = high - (end - begin) / LOOKS
    while high - low > NARROWEST * (end - begin):
        middle = 0.5 * (low + high)
        there = margins(middle, dense(middle)) < 0.0
        if there.any():
            high, fallen_there = middle, there
        else:
            low = middle
    return high, int(np.argmax(fallen_there))

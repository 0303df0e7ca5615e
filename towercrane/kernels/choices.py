"""Choices in equations: for numbers, for arrays of them, and for operands that record.

A branch on a number would not be recorded, and would send all lanes one way.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.kernels.straight.graph import Operand, branch, graph_of

if TYPE_CHECKING:
    from collections.abc import Callable


def below(a: Any, b: Any) -> Any:
    """1 where a number is less than another, else 0."""
    recorded = _recorded("below", a, b)
    return np.less(a, b) * 1.0 if recorded is None else recorded


def choose(where: Any, a: Any, b: Any) -> Any:
    """One value where a condition is not zero, else another."""
    if not isinstance(where, Operand):
        return np.where(where, a, b) if np.ndim(where) else (a if where else b)
    if not isinstance(a, Operand) and not isinstance(b, Operand) and a == b:
        return a
    return _recorded("choose", where, a, b)


def nth(place: Any, count: int) -> Any:
    """Whole part of a place among so many, the first or last if it is outside."""
    if isinstance(place, Operand):
        return place.graph.operand("nth", place.place, count)
    return np.clip(np.trunc(place).astype(int), 0, count - 1)


def either(holds: Any, one: Callable[[Any], Any], other: Callable[[Any], Any], argument: Any) -> tuple[Any, ...]:
    """What one function gives where a condition is not zero, else what the other does: tuples of numbers.

    Only what is chosen is computed; with lanes the second is computed where any lane wants it.
    """
    if isinstance(holds, Operand):
        return branch(holds, one, other, argument)
    if not np.ndim(holds):
        return tuple(one(argument) if holds else other(argument))
    if np.all(holds):
        return tuple(one(argument))
    with np.errstate(all="ignore"):
        return tuple(np.where(holds, a, b) for a, b in zip(one(argument), other(argument), strict=True))


def _recorded(operation: str, *values: Any) -> Any:
    """An operation on values of which one is an operand; None if none is."""
    graph = graph_of(values)
    return None if graph is None else graph.operand(operation, *(graph.place(value) for value in values))

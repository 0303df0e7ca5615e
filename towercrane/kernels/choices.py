"""Choices in equations: for numbers, for operands that record, for arrays of numbers; and of lane vectors.

A branch on a number would not be recorded, and would send all lanes one way.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from modal.compiler.compiled import kernel
from modal.compiler.traced import spoken
from towercrane.kernels.straight.graph import Operand, branch
from towercrane.kernels.vector import DOUBLES, LANES, VECTOR

if TYPE_CHECKING:
    from collections.abc import Callable

_intrinsic: Any = intrinsic


def _said(compiled: Any, python: Callable[..., Any]) -> Any:
    """A compiled function that is another one to Python."""
    compiled.__class__ = type("Said", (type(compiled),), {"__call__": lambda _self, *given: python(*given)})
    return compiled


def _recorded(operation: str, *values: Any) -> Any:
    """An operation on values of which one is an operand; None if none is."""
    graph = next((value.graph for value in values if isinstance(value, Operand)), None)
    return None if graph is None else graph.operand(operation, *(graph.place(value) for value in values))


def _below(a: Any, b: Any) -> Any:
    recorded = _recorded("below", a, b)
    return np.less(a, b) * 1.0 if recorded is None else recorded


def _chosen(where: Any, a: Any, b: Any) -> Any:
    if not isinstance(where, Operand):
        return np.where(where, a, b) if np.ndim(where) else (a if where else b)
    return _recorded("choose", where, a, b)


def _nth(place: Any, count: int) -> Any:
    if isinstance(place, Operand):
        return place.graph.operand("nth", place.place, count)
    return np.clip(np.trunc(place).astype(int), 0, count - 1)


@kernel()
def _compiled_below(a: float, b: float) -> float:
    return 1.0 if a < b else 0.0


below = _said(_compiled_below, _below)
"""1 where a number is less than another, else 0."""


@kernel()
def _compiled_nth(place: float, count: int) -> int:
    return min(max(int(place), 0), count - 1)


nth = _said(_compiled_nth, _nth)
"""Whole part of a place among so many, the first or last if it is outside."""


@_intrinsic
def _compiled_choose(_context: Any, where: Any, a: Any, b: Any) -> Any:
    kind = VECTOR if VECTOR in (where, a, b) else types.float64

    def build(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        given = zip(arguments, signature.args, strict=True)
        condition, one, other = (context.cast(builder, value, own, kind) for value, own in given)
        zero = ir.Constant(DOUBLES, [0.0] * LANES) if kind == VECTOR else ir.Constant(ir.DoubleType(), 0.0)
        return builder.select(builder.fcmp_unordered("!=", condition, zero), one, other)

    return kind(where, a, b), build


choose = spoken(_compiled_choose, _chosen)
"""One value where a condition is not zero, else another; in every lane where one of the three is a lane vector."""


def either(condition: Any, one: Any, other: Any) -> Any:
    """Function that is what one function is where a condition of its argument holds, else what the other is.

    Parameters
    ----------
    condition, one, other : kernels of a number
        The first gives :func:`below`; the others a tuple of numbers each. Only what is chosen is computed; with lanes
        the second is computed where any lane wants it.
    """

    def chosen(argument: Any) -> Any:
        if condition(argument) != 0.0:
            return one(argument)
        return other(argument)

    def said(argument: Any) -> Any:
        holds = condition(argument)
        if isinstance(holds, Operand):
            return branch(holds, one, other, argument)
        with np.errstate(all="ignore"):
            return tuple(np.where(holds, a, b) for a, b in zip(one(argument), other(argument), strict=True))

    chosen.__qualname__ = f"either_{one.__name__}_{other.__name__}"
    return _said(kernel()(chosen), said)

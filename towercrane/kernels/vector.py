"""Lane vectors: a type for compiled code that holds one number of each of several runs.

An operation on a lane vector is one instruction of the processor's vector unit (or a few, where its registers are
shorter) and rounds in every lane as the same operation on a single number does. Equations that are written for
numbers compile for lane vectors as they stand and give every lane the bits that a single run would get.
"""

from __future__ import annotations

import operator
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.typeconv.castgraph import Conversion
from numba.extending import intrinsic, lower_builtin, lower_cast, models, register_model, type_callable

# Numba's own functions carry no types.
_intrinsic: Any = intrinsic

LANES = 8
"""Runs side by side; eight doubles fill a register of AVX-512."""


class LaneVector(types.Type):
    """A double in every lane."""

    def __init__(self) -> None:
        super().__init__(name=f"LaneVector[{LANES}]")

    def can_convert_from(self, _context: Any, other: Any) -> Any:
        """Numbers become the same number in every lane."""
        return Conversion.safe if isinstance(other, types.Float | types.Integer) else None


VECTOR = LaneVector()

DOUBLES = ir.VectorType(ir.DoubleType(), LANES)
TABLE = types.Array(types.float64, 3, "C")


@register_model(LaneVector)
class _LaneVectorModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, DOUBLES)


def spread(builder: Any, value: Any, kind: Any) -> Any:
    """The same value in every lane."""
    first = builder.insert_element(ir.Constant(kind, ir.Undefined), value, ir.Constant(ir.IntType(32), 0))
    zeros = ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)
    return builder.shuffle_vector(first, ir.Constant(kind, ir.Undefined), zeros)


def _doubles(context: Any, builder: Any, value: Any, kind: Any) -> Any:
    """A number or lane vector as a lane vector."""
    if kind == VECTOR:
        return value
    return spread(builder, context.cast(builder, value, kind, types.float64), DOUBLES)


@lower_cast(types.Float, VECTOR)
@lower_cast(types.Integer, VECTOR)
def _from_number(context: Any, builder: Any, kind: Any, _target: Any, value: Any) -> Any:
    return _doubles(context, builder, value, kind)


def _is_number(kind: Any) -> bool:
    return isinstance(kind, types.Float | types.Integer)


def _pairs(function: Any, build: Any) -> None:
    """Give a function of two numbers its meaning for a lane vector and a number, lane vector or both."""

    @type_callable(function)
    def typed(_context: Any) -> Any:
        def typer(a: Any, b: Any) -> Any:
            if VECTOR in (a, b) and all(operand == VECTOR or _is_number(operand) for operand in (a, b)):
                return VECTOR
            return None

        return typer

    def lower(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        values = zip(arguments, signature.args, strict=True)
        return build(builder, *(_doubles(context, builder, value, kind) for value, kind in values))

    for other in (VECTOR, types.Float, types.Integer):
        lower_builtin(function, VECTOR, other)(lower)
        if other is not VECTOR:
            lower_builtin(function, other, VECTOR)(lower)


def _called(name: str) -> Any:
    """Build a call of an LLVM intrinsic on one lane vector."""

    def build(_context: Any, builder: Any, value: Any) -> Any:
        kind = ir.FunctionType(DOUBLES, [DOUBLES])
        function = cgutils.get_or_insert_function(builder.module, kind, f"llvm.{name}.v{LANES}f64")
        return builder.call(function, [value])

    return build


def _single(function: Any, build: Any) -> None:
    """Give a function of one number its meaning for a lane vector."""

    @type_callable(function)
    def typed(_context: Any) -> Any:
        return lambda a: VECTOR if a == VECTOR else None

    @lower_builtin(function, VECTOR)
    def lower(context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        return build(context, builder, arguments[0])


def _chosen(comparison: str) -> Any:
    """Build the choice that Python's min or max makes: the second value where it compares, else the first."""

    def build(builder: Any, a: Any, b: Any) -> Any:
        return builder.select(builder.fcmp_ordered(comparison, b, a), b, a)

    return build


for _function, _name in (
    (operator.add, "fadd"),
    (operator.sub, "fsub"),
    (operator.mul, "fmul"),
    (operator.truediv, "fdiv"),
):
    for _form in (_function, getattr(operator, f"i{_function.__name__}")):
        _pairs(_form, lambda builder, a, b, name=_name: getattr(builder, name)(a, b))


@_intrinsic
def choose(_context: Any, where: Any, a: Any, b: Any) -> Any:
    """In every lane one value where a condition is not zero, else another; numbers count for all lanes."""

    def build(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        given = zip(arguments, signature.args, strict=True)
        condition, one, other = (_doubles(context, builder, value, kind) for value, kind in given)
        zero = ir.Constant(DOUBLES, [0.0] * LANES)
        return builder.select(builder.fcmp_unordered("!=", condition, zero), one, other)

    return VECTOR(where, a, b), build


_pairs(min, _chosen("<"))
_pairs(max, _chosen(">"))
_single(operator.neg, lambda _context, builder, a: builder.fneg(a))
_single(abs, _called("fabs"))
_single(np.sqrt, _called("sqrt"))

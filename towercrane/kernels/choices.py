"""Choices in compiled equations that hold for one number and for lane vectors alike.

A branch sends all lanes one way; these look at every lane by itself, or ask for what all lanes have in common.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from towercrane.kernels.vector import DOUBLES, INDEX, INTEGERS, LANES, VECTOR, spread

_intrinsic: Any = intrinsic


def _constant(kind: Any, number: float) -> Any:
    """A number, or the same in every lane."""
    return ir.Constant(DOUBLES, [number] * LANES) if kind == VECTOR else ir.Constant(ir.DoubleType(), number)


@_intrinsic
def below(_context: Any, a: Any, b: Any) -> Any:
    """1 where a is less than b, else 0; in every lane where one of them is a lane vector.

    A comparison that is a number, and not a truth value, has a type that widens to lanes as its operands do.
    """
    kind = VECTOR if VECTOR in (a, b) else types.float64

    def build(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        given = zip(arguments, signature.args, strict=True)
        one, other = (context.cast(builder, value, own, kind) for value, own in given)
        return builder.uitofp(builder.fcmp_ordered("<", one, other), _constant(kind, 0.0).type)

    return kind(a, b), build


@_intrinsic
def choose(_context: Any, where: Any, a: Any, b: Any) -> Any:
    """A where a condition is not zero, else b; in every lane where one of the three is a lane vector."""
    kind = VECTOR if VECTOR in (where, a, b) else types.float64

    def build(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        given = zip(arguments, signature.args, strict=True)
        condition, one, other = (context.cast(builder, value, own, kind) for value, own in given)
        return builder.select(builder.fcmp_unordered("!=", condition, _constant(kind, 0.0)), one, other)

    return kind(where, a, b), build


@_intrinsic
def everywhere(_context: Any, condition: Any) -> Any:
    """Whether a condition is not zero, in all lanes."""

    def build(_context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        kind = signature.args[0]
        bits = builder.fcmp_unordered("!=", arguments[0], _constant(kind, 0.0))
        if kind == VECTOR:
            all_bits = ir.IntType(LANES)
            return builder.icmp_unsigned("==", builder.bitcast(bits, all_bits), all_bits(2**LANES - 1))
        return bits

    return types.boolean(condition), build


@_intrinsic
def whole(_context: Any, value: Any) -> Any:
    """Whole number that a float holds, or a lane vector in every lane."""

    def build(_context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        number = arguments[0]
        if signature.args[0] == VECTOR:
            number = builder.extract_element(number, ir.Constant(ir.IntType(32), 0))
        return builder.fptosi(number, ir.IntType(64))

    return types.int64(value), build


@_intrinsic
def nth(_context: Any, place: Any, count: Any) -> Any:
    """Whole part of a place among so many, the first or last if it is outside; in every lane of a lane vector."""
    kind = INDEX if place == VECTOR else types.int64

    def build(_context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        found, last = arguments[0], builder.sub(arguments[1], ir.Constant(ir.IntType(64), 1))
        first = ir.Constant(ir.IntType(64), 0)
        if kind == INDEX:
            first, last = spread(builder, first, INTEGERS), spread(builder, last, INTEGERS)
        index = builder.fptosi(found, first.type)
        index = builder.select(builder.icmp_signed("<", index, first), first, index)
        return builder.select(builder.icmp_signed(">", index, last), last, index)

    return kind(place, types.int64), build

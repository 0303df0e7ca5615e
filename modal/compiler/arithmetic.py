"""What operators and functions make of numbers, as instructions of LLVM."""

from __future__ import annotations

import ast
from typing import Any

import numpy as np
from llvmlite import ir

from modal.compiler.lanes import LANES

DOUBLE, WHOLE, BIT = ir.DoubleType(), ir.IntType(64), ir.IntType(1)
VECTOR = ir.VectorType(DOUBLE, LANES)
"""Kinds of numbers; the last has one of each lane."""

INTRINSIC = {
    "sqrt": "sqrt", "abs": "fabs", "ceil": "ceil", "exp": "exp", "log": "log", "sin": "sin", "cos": "cos",
}  # fmt: skip
OUTSIDE = "log1p", "expm1", "cosh", "tanh"
"""Functions of one number: LLVM's own, and those of the system's mathematical library."""

COMPARED = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!="}
COMBINED = {
    ast.Add: "add", ast.Sub: "sub", ast.Mult: "mul", ast.Div: "div", ast.FloorDiv: "div", ast.Mod: "rem",
    ast.BitAnd: "and_", ast.BitOr: "or_", ast.LShift: "shl", ast.RShift: "ashr",
}  # fmt: skip
ALIGNED = 8
"""Bytes: NumPy promises 16, a register of lanes would want 64."""


class Untranslatable(TypeError):
    """A function does what compiled functions cannot; a fault of the program."""


def constant(value: Any) -> Any:
    """A number that is known."""
    for kind, llvm in ((bool, BIT), (int, WHOLE), (float, DOUBLE)):
        if isinstance(value, kind):
            return ir.Constant(llvm, value)
    raise Untranslatable(repr(value))


def widest(values: list[Any]) -> Any:
    """Kind that holds all of some numbers."""
    kinds = [value.type for value in values]
    return next(kind for kind in (VECTOR, DOUBLE, WHOLE, BIT) if kind in kinds)


class Arithmetic:
    """Writes where a builder stands."""

    def __init__(self, builder: Any) -> None:
        self.builder = builder

    def load(self, pointer: Any) -> Any:
        """What is in memory."""
        return self.builder.load(pointer, align=ALIGNED)

    def store(self, value: Any, pointer: Any) -> None:
        """Put a number into memory, as one of the kind that is there."""
        self.builder.store(self.turned(value, pointer.type.pointee), pointer, align=ALIGNED)

    def turned(self, value: Any, kind: Any) -> Any:
        """A number as one of another kind that holds it."""
        if value.type == kind:
            return value
        if kind == DOUBLE and value.type in (WHOLE, BIT):
            convert = self.builder.sitofp if value.type == WHOLE else self.builder.uitofp
            return convert(value, DOUBLE)
        if kind == WHOLE and value.type == BIT:
            return self.builder.zext(value, WHOLE)
        if kind == VECTOR and value.type in (DOUBLE, WHOLE, BIT):
            return self._spread(self.turned(value, DOUBLE))
        raise Untranslatable(f"a {value.type} where there was a {kind}")

    def _spread(self, value: Any) -> Any:
        nothing, single = ir.Constant(VECTOR, ir.Undefined), ir.IntType(32)
        first = self.builder.insert_element(nothing, value, ir.Constant(single, 0))
        return self.builder.shuffle_vector(first, nothing, ir.Constant(ir.VectorType(single, LANES), [0] * LANES))

    def alike(self, values: list[Any]) -> list[Any]:
        """Numbers as those of the widest kind among them."""
        kind = widest(values)
        return [self.turned(value, kind) for value in values]

    def truth(self, value: Any) -> Any:
        """Whether a number is not zero; a bit as it is."""
        return value if value.type == BIT else self.compared(ast.NotEq(), value, constant(0))

    def combined(self, operator: ast.operator, left: Any, right: Any) -> Any:
        """What an operator makes of two numbers."""
        if isinstance(operator, ast.Pow):
            return self._power(left, right)
        left, right = self.alike([left, right])
        name = COMBINED[type(operator)]
        if isinstance(operator, ast.Div) and left.type != VECTOR:
            left, right = self.turned(left, DOUBLE), self.turned(right, DOUBLE)
        if left.type in (DOUBLE, VECTOR):
            return getattr(self.builder, f"f{name}")(left, right)
        # Whole numbers are divided where both are positive.
        return getattr(self.builder, {"div": "sdiv", "rem": "srem"}.get(name, name))(left, right)

    def _power(self, base: Any, exponent: Any) -> Any:
        count = getattr(exponent, "constant", 0) if exponent.type == WHOLE else 0
        if count in (2, 3, 4):
            squared = self.combined(ast.Mult(), base, base)
            other = {2: None, 3: base, 4: squared}[count]
            return self.combined(ast.Mult(), squared, other) if other else squared
        return self.function("pow", self.turned(base, DOUBLE), self.turned(exponent, DOUBLE))

    def negative(self, value: Any) -> Any:
        """A number with the other sign."""
        if isinstance(value, ir.Constant):
            return ir.Constant(value.type, -value.constant)
        return self.builder.neg(value) if value.type == WHOLE else self.builder.fneg(value)

    def compared(self, operator: ast.cmpop, left: Any, right: Any) -> Any:
        """A bit, or one of each lane."""
        left, right = self.alike([left, right])
        sign = COMPARED[type(operator)]
        if left.type in (WHOLE, BIT):
            return self.builder.icmp_signed(sign, left, right)
        compare = self.builder.fcmp_unordered if sign == "!=" else self.builder.fcmp_ordered
        return compare(sign, left, right)

    def extreme(self, values: list[Any], *, least: bool) -> Any:
        """Least or largest of some numbers, of equal ones the first."""
        found, *others = self.alike(values)
        for other in others:
            below = (other, found) if least else (found, other)
            found = self.builder.select(self.compared(ast.Lt(), *below), other, found)
        return found

    def chosen(self, where: Any, a: Any, b: Any) -> Any:
        """In every lane one number where a condition is not zero, else another."""
        where, a, b = (self.turned(value, VECTOR) for value in (where, a, b))
        return self.builder.select(self.compared(ast.NotEq(), where, constant(0)), a, b)

    def is_infinite(self, value: Any) -> Any:
        """Whether a number is so."""
        return self.compared(ast.Eq(), self.function("fabs", value), constant(np.inf))

    def is_finite(self, value: Any) -> Any:
        """Whether a number is so."""
        return self.compared(ast.Lt(), self.function("fabs", value), constant(np.inf))

    def function(self, name: str, *values: Any) -> Any:
        """LLVM's own function of doubles or lane vectors."""
        kind = values[0].type
        return self._call(f"llvm.{name}.{f'v{LANES}f64' if kind == VECTOR else 'f64'}", kind, values)

    def outside(self, name: str, *values: Any) -> Any:
        """A function of the system's mathematical library; of lane vectors lane by lane."""
        if values[0].type != VECTOR:
            return self._call(name, DOUBLE, values)
        found = ir.Constant(VECTOR, ir.Undefined)
        for lane in range(LANES):
            number = ir.Constant(ir.IntType(32), lane)
            own = [self.builder.extract_element(value, number) for value in values]
            found = self.builder.insert_element(found, self._call(name, DOUBLE, own), number)
        return found

    def _call(self, name: str, kind: Any, values: Any) -> Any:
        module = self.builder.module
        called = module.globals.get(name)
        if called is None:
            called = ir.Function(module, ir.FunctionType(kind, [kind] * len(values)), name)
        return self.builder.call(called, values)

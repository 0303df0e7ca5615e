"""Expressions of compiled functions as instructions of LLVM."""

from __future__ import annotations

import ast
import builtins
import inspect
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from llvmlite import ir

if TYPE_CHECKING:
    from collections.abc import Callable

DOUBLE, WHOLE, BIT = ir.DoubleType(), ir.IntType(64), ir.IntType(1)

INTRINSIC = {"sqrt": "sqrt", "abs": "fabs", "ceil": "ceil", "exp": "exp", "log": "log", "sin": "sin", "cos": "cos"}
OUTSIDE = "log1p", "expm1", "cosh", "tanh"
"""Functions of one number: LLVM's own, and those of the system's mathematical library."""

COMPARED = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!="}
COMBINED = {ast.Add: "add", ast.Sub: "sub", ast.Mult: "mul", ast.Div: "div", ast.FloorDiv: "div", ast.Mod: "rem"}


class Untranslatable(TypeError):
    """A function does what compiled functions cannot; a fault of the program."""


@dataclass(frozen=True)
class Array:
    """An array, or a part of one: where it begins and how long its axes are."""

    pointer: Any
    sizes: tuple[Any, ...]


class Expressions(ABC):
    """Writes what the expressions of one function are worth.

    A value is a number of LLVM, an `Array` or a tuple of numbers.
    """

    def __init__(self, library: Any, python: Any, made: Any) -> None:
        self.library, self.python, self.made = library, python, made
        self.builder = ir.IRBuilder(made.append_basic_block())

    @abstractmethod
    def read(self, node: ast.Name) -> Any:
        """Value of a name."""

    def value(self, node: ast.expr) -> Any:
        """Value of an expression."""
        match node:
            case ast.Constant():
                return self.constant(node.value)
            case ast.Name():
                return self.read(node)
            case ast.Tuple():
                return tuple(self.value(own) for own in node.elts)
            case ast.Subscript():
                found = self.part(node)
                entry = isinstance(getattr(found, "type", None), ir.PointerType)
                return self.builder.load(found) if entry else found
            case ast.BinOp():
                return self.combined(node.op, self.value(node.left), self.value(node.right))
            case ast.UnaryOp(op=ast.Not()):
                return self.builder.not_(self.bit(node.operand))
            case ast.UnaryOp(op=ast.USub()):
                return self._negative(self.value(node.operand))
            case ast.BoolOp() | ast.Compare():
                return self.bit(node)
            case ast.IfExp():
                return self._chosen(node)
            case ast.Call(keywords=[]):
                return self._called(node)
            case ast.Attribute(attr="shape"):
                return self.value(node.value).sizes
            case ast.Attribute(attr="size"):
                return self._product(self.value(node.value).sizes)
            case ast.Attribute():
                return self.constant(self.outer(node))
        return self.cannot(node)

    def constant(self, value: Any) -> Any:
        """A number that is known."""
        for kind, llvm in ((bool, BIT), (int, WHOLE), (float, DOUBLE)):
            if isinstance(value, kind):
                return ir.Constant(llvm, value)
        raise Untranslatable(f"{self.python.__qualname__}: {value!r}")

    def outer(self, node: ast.expr) -> Any:
        """What a name stands for outside the function."""
        if isinstance(node, ast.Attribute):
            return getattr(self.outer(node.value), node.attr)
        if not isinstance(node, ast.Name):
            self.cannot(node)
        name = node.id  # type: ignore[attr-defined]
        found = self.python.__globals__.get(name, getattr(builtins, name, None))
        return self.cannot(node) if found is None else found

    def cannot(self, node: ast.AST) -> Any:
        """Refuse what is not known."""
        raise Untranslatable(f"{self.python.__qualname__}: {ast.unparse(node)}")

    def turned(self, value: Any, kind: Any) -> Any:
        """A number as one of another kind that holds it."""
        if value.type == kind:
            return value
        if kind == DOUBLE and value.type in (WHOLE, BIT):
            convert = self.builder.sitofp if value.type == WHOLE else self.builder.uitofp
            return convert(value, DOUBLE)
        if kind == WHOLE and value.type == BIT:
            return self.builder.zext(value, WHOLE)
        raise Untranslatable(f"{self.python.__qualname__}: a {value.type} where there was a {kind}")

    def alike(self, values: list[Any]) -> list[Any]:
        """Numbers as those of the widest kind among them."""
        kind = _widest(values)
        return [self.turned(value, kind) for value in values]

    def part(self, node: ast.Subscript) -> Any:
        """Pointer to an entry, a part of an array, or an entry of a tuple."""
        whole = self.value(node.value)
        indices = list(node.slice.elts) if isinstance(node.slice, ast.Tuple) else [node.slice]
        if isinstance(whole, tuple):
            (index,) = indices
            return whole[self.value(index).constant]
        offset, sizes = self.constant(0), list(whole.sizes)
        kept: list[Any] = []
        for index in indices:
            size = sizes.pop(0)
            if kept or (isinstance(index, ast.Slice) and index.step):
                self.cannot(node)
            if isinstance(index, ast.Slice):
                first = self.value(index.lower) if index.lower else self.constant(0)
                kept = [self.builder.sub(self.value(index.upper) if index.upper else size, first)]
            else:
                first = self.value(index)
            offset = self.builder.add(offset, self._product((first, *sizes)))
        pointer = self.builder.gep(whole.pointer, [offset])
        return Array(pointer, (*kept, *sizes)) if kept or sizes else pointer

    def _product(self, values: tuple[Any, ...]) -> Any:
        found = values[0]
        for value in values[1:]:
            found = self.builder.mul(found, value)
        return found

    def combined(self, operator: ast.operator, left: Any, right: Any) -> Any:
        """What an operator makes of two numbers."""
        if isinstance(operator, ast.Pow):
            return self._power(left, right)
        left, right = self.alike([left, right])
        name = COMBINED[type(operator)]
        if isinstance(operator, ast.Div):
            left, right = self.turned(left, DOUBLE), self.turned(right, DOUBLE)
        if left.type == DOUBLE:
            return getattr(self.builder, f"f{name}")(left, right)
        # Whole numbers are divided where both are positive.
        return getattr(self.builder, {"div": "sdiv", "rem": "srem"}.get(name, name))(left, right)

    def _power(self, base: Any, exponent: Any) -> Any:
        count = getattr(exponent, "constant", 0) if exponent.type == WHOLE else 0
        if count in (2, 3, 4):
            squared = self.combined(ast.Mult(), base, base)
            other = {2: None, 3: base, 4: squared}[count]
            return self.combined(ast.Mult(), squared, other) if other else squared
        given = [self.turned(base, DOUBLE), self.turned(exponent, DOUBLE)]
        return self.builder.call(self.library.intrinsic("pow", 2), given)

    def _negative(self, value: Any) -> Any:
        if isinstance(value, ir.Constant):
            return ir.Constant(value.type, -value.constant)
        return self.builder.fneg(value) if value.type == DOUBLE else self.builder.neg(value)

    def bit(self, node: ast.expr) -> Any:
        """Whether a condition holds; what need not be looked at is not."""
        match node:
            case ast.BoolOp():
                return self._in_turn(node.values, both=isinstance(node.op, ast.And))
            case ast.Compare(ops=[ast.In()], comparators=[ast.Tuple() as among]):
                left = self.value(node.left)
                found = [self._compared(ast.Eq(), left, self.value(own)) for own in among.elts]
                return self._all(found, self.builder.or_)
            case ast.Compare():
                operands = [self.value(own) for own in (node.left, *node.comparators)]
                sides = zip(node.ops, operands, operands[1:], strict=False)
                return self._all([self._compared(*own) for own in sides], self.builder.and_)
        value = self.value(node)
        return value if value.type == BIT else self.cannot(node)

    def _all(self, bits: list[Any], join: Callable[[Any, Any], Any]) -> Any:
        found = bits[0]
        for own in bits[1:]:
            found = join(found, own)
        return found

    def _in_turn(self, tests: list[ast.expr], *, both: bool) -> Any:
        after, found = self.made.append_basic_block(), []
        for test in tests:
            found.append((self.bit(test), self.builder.block))
            if test is not tests[-1]:
                further = self.made.append_basic_block()
                ways = (further, after) if both else (after, further)
                self.builder.cbranch(found[-1][0], *ways)
                self.builder.position_at_end(further)
        self.builder.branch(after)
        self.builder.position_at_end(after)
        return self._joined(found)

    def _joined(self, ways: list[tuple[Any, Any]]) -> Any:
        found = self.builder.phi(ways[0][0].type)
        for value, block in ways:
            found.add_incoming(value, block)
        return found

    def _compared(self, operator: ast.cmpop, left: Any, right: Any) -> Any:
        left, right = self.alike([left, right])
        sign = COMPARED[type(operator)]
        if left.type != DOUBLE:
            return self.builder.icmp_signed(sign, left, right)
        compare = self.builder.fcmp_unordered if sign == "!=" else self.builder.fcmp_ordered
        return compare(sign, left, right)

    def _chosen(self, node: ast.IfExp) -> Any:
        after, ways = self.made.append_basic_block(), []
        blocks = self.made.append_basic_block(), self.made.append_basic_block()
        self.builder.cbranch(self.bit(node.test), *blocks)
        for block, own in zip(blocks, (node.body, node.orelse), strict=True):
            self.builder.position_at_end(block)
            ways.append((self.value(own), self.builder.block))
        kind, joined = _widest([value for value, _ in ways]), []
        for value, block in ways:
            self.builder.position_at_end(block)
            joined.append((self.turned(value, kind), block))
            self.builder.branch(after)
        self.builder.position_at_end(after)
        return self._joined(joined)

    def _called(self, node: ast.Call) -> Any:
        function, values = self.outer(node.func), [self.value(argument) for argument in node.args]
        if function in (min, max):
            return self._extreme(function is min, self.alike(values))
        if function is float:
            return self.turned(values[0], DOUBLE)
        if function is int:
            value = values[0]
            return self.builder.fptosi(value, WHOLE) if value.type == DOUBLE else self.turned(value, WHOLE)
        if function is np.isfinite:
            size = self.builder.call(self.library.intrinsic("fabs"), values)
            return self.builder.fcmp_ordered("<", size, self.constant(np.inf))
        if inspect.isfunction(function):
            return self.library.call(self, function, values)
        name = getattr(function, "__name__", "")
        if name in INTRINSIC:
            called = self.library.intrinsic(INTRINSIC[name])
        else:
            called = self.library.outside(name) if name in OUTSIDE else self.cannot(node)
        return self.builder.call(called, [self.turned(value, DOUBLE) for value in values])

    def _extreme(self, least: bool, values: list[Any]) -> Any:
        found, *others = values
        for other in others:
            below = (other, found) if least else (found, other)
            found = self.builder.select(self._compared(ast.Lt(), *below), other, found)
        return found


def _widest(values: list[Any]) -> Any:
    """Kind that holds all of some numbers."""
    kinds = [value.type for value in values]
    return next(kind for kind in (DOUBLE, WHOLE, BIT) if kind in kinds)

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

from modal.compiler.arithmetic import (
    DOUBLE,
    INTRINSIC,
    OUTSIDE,
    VECTOR,
    WHOLE,
    Arithmetic,
    Untranslatable,
    constant,
    widest,
)
from modal.compiler.lanes import choose, in_lanes

if TYPE_CHECKING:
    from collections.abc import Callable


@dataclass(frozen=True)
class Array:
    """An array, or a part of one: where it begins and how long its axes are."""

    pointer: Any
    sizes: tuple[Any, ...]


class Expressions(Arithmetic, ABC):
    """Writes what the expressions of one function are worth.

    A value is a number of LLVM, an `Array`, a tuple of values, or of a named tuple a dict of them.
    """

    def __init__(self, library: Any, python: Any, made: Any) -> None:
        super().__init__(ir.IRBuilder(made.append_basic_block()))
        self.library, self.python, self.made = library, python, made

    @abstractmethod
    def read(self, name: str) -> Any:
        """Value of a variable; None if there is none of this name."""

    def value(self, node: ast.expr) -> Any:
        """Value of an expression."""
        match node:
            case ast.Constant():
                return constant(node.value)
            case ast.Name():
                found = self.read(node.id)
                return constant(self.outer(node)) if found is None else found
            case ast.Tuple():
                return tuple(self.value(own) for own in node.elts)
            case ast.Subscript():
                found = self.part(node)
                return self.load(found) if _is_pointer(found) else found
            case ast.BinOp():
                return self.combined(node.op, self.value(node.left), self.value(node.right))
            case ast.UnaryOp(op=ast.Not()):
                return self.builder.not_(self.bit(node.operand))
            case ast.UnaryOp(op=ast.USub()):
                return self.negative(self.value(node.operand))
            case ast.BoolOp() | ast.Compare():
                return self.bit(node)
            case ast.IfExp():
                return self._either(node)
            case ast.Call(keywords=[]):
                return self._called(node)
            case ast.Attribute(attr="shape"):
                return self.value(node.value).sizes
            case ast.Attribute(attr="size"):
                return self._product(self.value(node.value).sizes)
            case ast.Attribute(value=ast.Name(id=name)) if isinstance(self.read(name), dict):
                return self.read(name)[node.attr]
            case ast.Attribute():
                return constant(self.outer(node))
        return self.cannot(node)

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
        raise Untranslatable(ast.unparse(node))

    def part(self, node: ast.Subscript) -> Any:
        """Pointer to an entry, a part of an array, or an entry of a tuple."""
        whole = self.value(node.value)
        indices = list(node.slice.elts) if isinstance(node.slice, ast.Tuple) else [node.slice]
        if isinstance(whole, tuple):
            (index,) = indices
            return whole[self.value(index).constant]
        offset, sizes = constant(0), list(whole.sizes)
        kept: list[Any] = []
        for index in indices:
            size = sizes.pop(0)
            if kept or (isinstance(index, ast.Slice) and index.step):
                self.cannot(node)
            if isinstance(index, ast.Slice):
                first = self.value(index.lower) if index.lower else constant(0)
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

    def bit(self, node: ast.expr) -> Any:
        """Whether a condition holds; what need not be looked at is not."""
        match node:
            case ast.BoolOp():
                return self._in_turn(node.values, both=isinstance(node.op, ast.And))
            case ast.Compare(ops=[ast.In()], comparators=[ast.Tuple() as among]):
                left = self.value(node.left)
                found = [self.compared(ast.Eq(), left, self.value(own)) for own in among.elts]
                return self._all(found, self.builder.or_)
            case ast.Compare():
                operands = [self.value(own) for own in (node.left, *node.comparators)]
                sides = zip(node.ops, operands, operands[1:], strict=False)
                return self._all([self.compared(*own) for own in sides], self.builder.and_)
        return self.truth(self.value(node))

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

    def _either(self, node: ast.IfExp) -> Any:
        after, ways = self.made.append_basic_block(), []
        blocks = self.made.append_basic_block(), self.made.append_basic_block()
        self.builder.cbranch(self.bit(node.test), *blocks)
        for block, own in zip(blocks, (node.body, node.orelse), strict=True):
            self.builder.position_at_end(block)
            ways.append((self.value(own), self.builder.block))
        kind, joined = widest([value for value, _ in ways]), []
        for value, block in ways:
            self.builder.position_at_end(block)
            joined.append((self.turned(value, kind), block))
            self.builder.branch(after)
        self.builder.position_at_end(after)
        return self._joined(joined)

    def _called(self, node: ast.Call) -> Any:
        values = [self.value(argument) for argument in node.args]
        pointed = self.read(node.func.id) if isinstance(node.func, ast.Name) else None
        if pointed is not None:
            return self._handed_to(pointed, values)
        function = self.outer(node.func)
        if function in KNOWN:
            return KNOWN[function](self, *values)
        if inspect.isfunction(function):
            return self.library.call(self, function, values)
        name = getattr(function, "__name__", "")
        if name not in INTRINSIC and name not in OUTSIDE:
            self.cannot(node)
        given = [value if value.type == VECTOR else self.turned(value, DOUBLE) for value in values]
        return self.function(INTRINSIC[name], *given) if name in INTRINSIC else self.outside(name, *given)

    def whole(self, value: Any) -> Any:
        """A number without what is behind its point."""
        return self.builder.fptosi(value, WHOLE) if value.type == DOUBLE else self.turned(value, WHOLE)

    def in_lanes(self, array: Array) -> Array:
        """An array seen as one of lane vectors."""
        return Array(self.builder.bitcast(array.pointer, VECTOR.as_pointer()), array.sizes[:-1])

    def _handed_to(self, pointer: Any, values: list[Any]) -> Any:
        """Call of a procedure."""
        given = [value.pointer if isinstance(value, Array) else value for value in values]
        kind = ir.FunctionType(ir.VoidType(), [value.type for value in given])
        return self.builder.call(self.builder.bitcast(pointer, kind.as_pointer()), given)


KNOWN: dict[Any, Callable[..., Any]] = {
    min: lambda own, *values: own.extreme(list(values), least=True),
    max: lambda own, *values: own.extreme(list(values), least=False),
    float: lambda own, value: own.turned(value, DOUBLE),
    int: lambda own, value: own.whole(value),
    bool: lambda own, value: own.truth(value),
    round: lambda own, value: own.whole(own.function("rint", value)),
    np.isfinite: lambda own, value: own.is_finite(value),
    np.isinf: lambda own, value: own.is_infinite(value),
    choose: lambda own, *values: own.chosen(*values),
    in_lanes: lambda own, array: own.in_lanes(array),
}
"""Functions that are written where they are called."""


def _is_pointer(value: Any) -> bool:
    return isinstance(getattr(value, "type", None), ir.PointerType)

"""Statements of compiled functions as instructions of LLVM."""

from __future__ import annotations

import ast
import inspect
import textwrap
from typing import TYPE_CHECKING, Any, get_origin

from llvmlite import ir

from modal.compiler.arithmetic import WHOLE, constant
from modal.compiler.expressions import Array, Expressions

if TYPE_CHECKING:
    from collections.abc import Callable


class Body(Expressions):
    """Writes the instructions of one function.

    Parameters
    ----------
    library
        What holds the functions it calls, see `modal.compiler.translation`.
    python, made : function
        The function, and that of LLVM.
    given : dict
        Values of its arguments.
    gives : type
        Kind of what it gives.
    number : LLVM type
        What a `Number` is.
    """

    def __init__(self, library: Any, python: Any, made: Any, given: dict[str, Any], gives: Any, number: Any) -> None:
        # Variables live in memory of the function's own, which LLVM turns into registers.
        self._memory = ir.IRBuilder(made.append_basic_block())
        super().__init__(library, python, made)
        self._gives, self._number = gives, number
        self._variables: dict[str, Any] = {}
        self._loops: list[tuple[Any, Any]] = []
        first = self.builder.block
        for name, value in given.items():
            self._keep(name, value)
        (tree,) = ast.parse(textwrap.dedent(inspect.getsource(python))).body
        self._all_of(tree.body)  # type: ignore[attr-defined]
        if not self.builder.block.is_terminated:
            # A function that gives something has given it by now.
            (self.builder.ret_void if gives is None else self.builder.unreachable)()
        self._memory.branch(first)

    def read(self, name: str) -> Any:
        """Value of a variable; None if there is none of this name."""
        known = self._variables.get(name)
        if known is None or isinstance(known, dict):
            return known
        if isinstance(known, Array):
            pointer, *sizes = (self.builder.load(room) for room in known.sizes)
            return Array(pointer, tuple(sizes))
        if isinstance(known, tuple):
            return tuple(self.builder.load(room) for room in known)
        return self.builder.load(known)

    def _keep(self, name: str, value: Any) -> None:
        """Give a variable a value; it stays of the kind of its first. What a named tuple holds stays as it is."""
        if isinstance(value, dict):
            self._variables[name] = value
            return
        parts = (value.pointer, *value.sizes) if isinstance(value, Array) else value
        single = not isinstance(parts, tuple)
        known = self._variables.get(name)
        if known is None:
            rooms = tuple(self._memory.alloca(part.type) for part in ((parts,) if single else parts))
            known = Array(None, rooms) if isinstance(value, Array) else (rooms[0] if single else rooms)
            self._variables[name] = known
        rooms = known.sizes if isinstance(known, Array) else ((known,) if single else known)
        for room, part in zip(rooms, (parts,) if single else parts, strict=True):
            self.builder.store(self.turned(part, room.type.pointee), room)

    def _all_of(self, statements: list[ast.stmt]) -> None:
        for statement in statements:
            if not self.builder.block.is_terminated:
                self._statement(statement)

    def _statement(self, node: ast.stmt) -> None:
        match node:
            case ast.Assign():
                value = self.value(node.value)
                for target in node.targets:
                    self._assign(target, value)
            case ast.AnnAssign(annotation=ast.Name(id="Number"), value=ast.expr() as begun):
                self._assign(node.target, self.turned(self.value(begun), self._number))
            case ast.AugAssign():
                before = self.value(node.target)
                self._assign(node.target, self.combined(node.op, before, self.value(node.value)))
            case ast.If():
                self._if(node)
            case ast.For(iter=ast.Call() as steps, target=ast.Name(id=name), orelse=[]):
                self._for(name, steps, node.body)
            case ast.While(orelse=[]):
                self._loop(lambda: self.bit(node.test), lambda: None, node.body)
            case ast.Return():
                self._return(node.value)
            case ast.Break() | ast.Continue():
                self.builder.branch(self._loops[-1][isinstance(node, ast.Continue)])
            case ast.Expr(value=ast.Constant()):
                # A docstring.
                pass
            case ast.Expr():
                self.value(node.value)
            case _:
                self.cannot(node)

    def _assign(self, target: ast.expr, value: Any) -> None:
        match target:
            case ast.Tuple():
                for own, part in zip(target.elts, value, strict=True):
                    self._assign(own, part)
            case ast.Subscript():
                place = self.part(target)
                self.store(value, place)
            case ast.Name():
                self._keep(target.id, value)
            case _:
                self.cannot(target)

    def _if(self, node: ast.If) -> None:
        then, after = self.made.append_basic_block(), self.made.append_basic_block()
        otherwise = self.made.append_basic_block()
        self.builder.cbranch(self.bit(node.test), then, otherwise)
        for block, statements in ((then, node.body), (otherwise, node.orelse)):
            self.builder.position_at_end(block)
            self._all_of(statements)
            if not self.builder.block.is_terminated:
                self.builder.branch(after)
        self.builder.position_at_end(after)

    def _loop(self, test: Callable[[], Any], step: Callable[[], Any], body: list[ast.stmt]) -> None:
        head, inside, more, after = (self.made.append_basic_block() for _ in range(4))
        self.builder.branch(head)
        self.builder.position_at_end(head)
        self.builder.cbranch(test(), inside, after)
        self.builder.position_at_end(inside)
        self._loops.append((after, more))
        self._all_of(body)
        self._loops.pop()
        if not self.builder.block.is_terminated:
            self.builder.branch(more)
        self.builder.position_at_end(more)
        step()
        self.builder.branch(head)
        self.builder.position_at_end(after)

    def _for(self, name: str, call: ast.Call, body: list[ast.stmt]) -> None:
        if self.outer(call.func) is not range:
            self.cannot(call)
        bounds = [self.value(argument) for argument in call.args]
        zero, one = constant(0), constant(1)
        start, stop, step = ((zero, *bounds, one), (*bounds, one), bounds)[len(bounds) - 1]
        down = step.constant < 0
        counter = self._memory.alloca(WHOLE)
        self.builder.store(start, counter)

        def test() -> Any:
            now = self.builder.load(counter)
            self._keep(name, now)
            return self.builder.icmp_signed(">" if down else "<", now, stop)

        def further() -> None:
            self.builder.store(self.builder.add(self.builder.load(counter), step), counter)

        self._loop(test, further, body)

    def _return(self, node: ast.expr | None) -> None:
        if node is None:
            self.builder.ret_void()
            return
        value, kind = self.value(node), self.made.function_type.return_type
        if get_origin(self._gives) is not tuple:
            self.builder.ret(self.turned(value, kind))
            return
        found = ir.Constant(kind, ir.Undefined)
        for index, (part, own) in enumerate(zip(value, kind.elements, strict=True)):
            found = self.builder.insert_value(found, self.turned(part, own), index)
        self.builder.ret(found)

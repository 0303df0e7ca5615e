"""From a program to machine code: straight instructions in the order in which the outputs want them."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Any

from llvmlite import ir
from numba import types
from numba.core import cgutils

from towercrane.kernels.straight.solution import Solution

if TYPE_CHECKING:
    from towercrane.kernels.straight.program import Program

DOUBLE, INTEGER, BIT = ir.DoubleType(), ir.IntType(64), ir.IntType(1)

# Numba's own functions carry no types.
_insert: Any = cgutils.get_or_insert_function


class Emitter:
    """Writes the instructions of a program where a builder stands.

    Parameters
    ----------
    program : Program
    context, builder
        Numba's.
    arrays : dict of str to LLVM value
        Pointer to the first double of each array; "t" is the time itself.
    shapes : dict of str to tuple of int
        Of the arrays that are given.
    lanes : int
        Runs side by side, whose doubles lie next to each other in every array but a table; 0 for a single run.
    """

    def __init__(
        self, program: Program, context: Any, builder: Any, arrays: dict[str, Any], shapes: dict[str, Any], lanes: int
    ) -> None:
        self.program, self.context, self.builder = program, context, builder
        self.arrays, self.shapes, self.lanes = arrays, shapes, lanes
        self.kind = ir.VectorType(DOUBLE, lanes) if lanes else DOUBLE
        self.whole = ir.VectorType(INTEGER, lanes) if lanes else INTEGER
        self.values: dict[int, Any] = {}

    def write(self) -> None:
        """Compute and store all outputs."""
        for (name, index), place in self.program.outputs.items():
            self.builder.store(self._number(self.value(place)), self._pointer(name, index), align=8)

    def value(self, place: int) -> Any:
        """LLVM value of a node, computed depth first: what is needed last is computed last."""
        waiting = [place]
        while waiting:
            top = waiting[-1]
            if top in self.values:
                waiting.pop()
                continue
            missing = [needed for needed in self._before(top) if needed not in self.values]
            if missing:
                waiting.extend(reversed(missing))
            else:
                self.values[top] = self._build(top)
                waiting.pop()
        return self.values[place]

    def _before(self, place: int) -> tuple[int, ...]:
        """Nodes that must stand before a node."""
        if place in self.program.slots:
            return ()
        if self.program.graph.nodes[place].operation == "branch":
            # What only one way needs is left to it.
            return self.program.operands(place)[:1]
        return self.program.operands(place)

    def _build(self, place: int) -> Any:
        operation, operands = self.program.graph.nodes[place]
        builder = self.builder
        if place in self.program.slots:
            return self._load("numbers", self.program.slots[place])
        if operation == "number":
            return self._constant(operands[0])
        if operation == "given":
            name, index = operands
            return self.arrays[name] if name == "t" else self._load(name, _flat(index, self.shapes[name]))
        if operation == "item":
            return self._item(*operands)
        if operation == "branch":
            return self._branch(*operands)
        if operation == "solve":
            root = partial(self._intrinsic, "sqrt")
            solution = Solution(builder, operands[0], self._constant(1.0), root)
            return solution.write([self._number(self.values[entry]) for entry in operands[1:]])
        if operation == "part":
            return self.values[operands[0]][operands[1]]
        if operation == "nth":
            return self._nth(*operands)
        if operation == "choose":
            condition, one, other = (self.values[operand] for operand in operands)
            return builder.select(self._bit(condition), self._number(one), self._number(other))
        given = [self._number(self.values[operand]) for operand in operands]
        if operation == "below":
            return builder.fcmp_ordered("<", *given)
        if operation in ("add", "sub", "mul", "div", "neg"):
            return getattr(builder, f"f{operation}")(*given)
        if operation == "sign":
            return self._sign(*given)
        if operation in ("tanh", "atan2"):
            return self._each(getattr(math, operation), *given)
        return self._intrinsic({"abs": "fabs"}.get(operation, operation), *given)

    def _constant(self, number: float) -> Any:
        return ir.Constant(self.kind, [number] * self.lanes if self.lanes else number)

    def _number(self, value: Any) -> Any:
        """A whole number or a comparison as a double; doubles as they are."""
        if value.type == self.kind:
            return value
        convert = self.builder.sitofp if value.type == self.whole else self.builder.uitofp
        return convert(value, self.kind)

    def _bit(self, value: Any) -> Any:
        """Whether a number is not zero; a comparison as it is."""
        if value.type != self.kind:
            return value
        return self.builder.fcmp_unordered("!=", value, self._constant(0.0))

    def _pointer(self, name: str, index: int) -> Any:
        offset = ir.Constant(INTEGER, index * max(self.lanes, 1))
        pointer = self.builder.gep(self.arrays[name], [offset])
        return self.builder.bitcast(pointer, self.kind.as_pointer()) if self.lanes else pointer

    def _load(self, name: str, index: int) -> Any:
        # Numpy promises 16 bytes, a register of eight doubles would want 64.
        return self.builder.load(self._pointer(name, index), align=8)

    def _item(self, name: str, first: int, *others: int) -> Any:
        """Entry of a table whose first index is known when the code runs; each lane has its own."""
        _, rows, columns = self.shapes[name]
        at, stride = others[0] * columns + others[1], ir.Constant(INTEGER, rows * columns)
        builder, cell = self.builder, self.values[first]

        def load(own: Any) -> Any:
            offset = builder.add(builder.mul(own, stride), ir.Constant(INTEGER, at))
            return builder.load(builder.gep(self.arrays[name], [offset]), align=8)

        if not self.lanes:
            return load(cell)
        found = ir.Constant(self.kind, ir.Undefined)
        for lane in range(self.lanes):
            number = ir.Constant(ir.IntType(32), lane)
            found = builder.insert_element(found, load(builder.extract_element(cell, number)), number)
        return found

    def _nth(self, place: int, count: int) -> Any:
        def every(number: int) -> Any:
            return ir.Constant(self.whole, [number] * self.lanes if self.lanes else number)

        builder, index = self.builder, self.builder.fptosi(self.values[place], self.whole)
        index = builder.select(builder.icmp_signed("<", index, every(0)), every(0), index)
        return builder.select(builder.icmp_signed(">", index, every(count - 1)), every(count - 1), index)

    def _branch(self, condition: int, one: tuple[int, ...], other: tuple[int, ...]) -> list[Any]:
        """Both ways on from a condition; with lanes the second way is taken only where some lane wants it."""
        builder, bits = self.builder, self._bit(self.values[condition])
        if self.lanes:
            first = self._way(one)
            every = ir.IntType(self.lanes)
            all_agree = builder.icmp_unsigned("==", builder.bitcast(bits, every), every(2**self.lanes - 1))
            before = builder.block
            with builder.if_then(builder.not_(all_agree), likely=False):
                second = self._way(other)
                chosen = [builder.select(bits, a, b) for a, b in zip(first, second, strict=True)]
                after = builder.block
            return [self._joined((a, before), (b, after)) for a, b in zip(first, chosen, strict=True)]
        with builder.if_else(bits, likely=True) as (then, otherwise):
            with then:
                first = self._way(one)
                before = builder.block
            with otherwise:
                second = self._way(other)
                after = builder.block
        return [self._joined((a, before), (b, after)) for a, b in zip(first, second, strict=True)]

    def _way(self, places: tuple[int, ...]) -> list[Any]:
        """Values that are known only where the builder stands."""
        outside, self.values = self.values, dict(self.values)
        found = [self._number(self.value(place)) for place in places]
        self.values = outside
        return found

    def _joined(self, *ways: tuple[Any, Any]) -> Any:
        joined = self.builder.phi(self.kind)
        for value, block in ways:
            joined.add_incoming(value, block)
        return joined

    def _sign(self, value: Any) -> Any:
        builder, zero, one = self.builder, self._constant(0.0), self._constant(1.0)
        positive = builder.select(builder.fcmp_ordered(">", value, zero), one, value)
        return builder.select(builder.fcmp_ordered("<", value, zero), self._constant(-1.0), positive)

    def _intrinsic(self, name: str, value: Any) -> Any:
        suffix = f"v{self.lanes}f64" if self.lanes else "f64"
        kind = ir.FunctionType(self.kind, [self.kind])
        return self.builder.call(_insert(self.builder.module, kind, f"llvm.{name}.{suffix}"), [value])

    def _each(self, function: Any, *values: Any) -> Any:
        """A function of numbers, lane by lane."""
        called = self.context.get_function(function, types.float64(*[types.float64] * len(values)))
        if not self.lanes:
            return called(self.builder, values)
        found = ir.Constant(self.kind, ir.Undefined)
        for lane in range(self.lanes):
            number = ir.Constant(ir.IntType(32), lane)
            own = called(self.builder, [self.builder.extract_element(value, number) for value in values])
            found = self.builder.insert_element(found, own, number)
        return found


def _flat(index: tuple[int, ...], shape: tuple[int, ...]) -> int:
    """Place of an entry in an array's memory."""
    found = 0
    for own, length in zip(index, shape, strict=True):
        found = found * length + own
    return found

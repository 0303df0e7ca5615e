"""From a program to machine code: straight instructions in the order in which the outputs want them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from llvmlite import ir

from modal.compiler.arithmetic import VECTOR, WHOLE, Arithmetic
from modal.compiler.expressions import Array
from modal.compiler.lanes import LANES
from towercrane.kernels.straight.solution import solve_in_place

if TYPE_CHECKING:
    from modal.compiler.translation import Library
    from towercrane.kernels.straight.program import Program

WHOLES = ir.VectorType(WHOLE, LANES)


class Emitter(Arithmetic):
    """Writes the instructions of a program where a builder stands.

    Parameters
    ----------
    program : Program
    library : Library
        What holds the functions that are called.
    builder
        Of LLVM's instructions.
    arrays : dict of str to LLVM value
        Pointer to the first number, a double or a lane vector, of each array; "t" is the time itself. A table holds
        doubles.
    shapes : dict of str to tuple of int
        Of the arrays that are given.
    """

    def __init__(
        self, program: Program, library: Library, builder: Any, arrays: dict[str, Any], shapes: dict[str, Any]
    ) -> None:
        super().__init__(builder)
        self.program, self.library, self.arrays, self.shapes = program, library, arrays, shapes
        self.kind = arrays["t"].type
        self.lanes = self.kind == VECTOR
        self.whole = WHOLES if self.lanes else WHOLE
        self.values: dict[int, Any] = {}

    def write(self) -> None:
        """Compute and store all outputs."""
        for (name, index), place in self.program.outputs.items():
            self.store(self._number(self.value(place)), self._pointer(name, index))

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
            return self.load(self._pointer("numbers", self.program.slots[place]))
        if operation == "number":
            return self._constant(operands[0])
        if operation == "given":
            name, index = operands
            return (
                self.arrays[name] if name == "t" else self.load(self._pointer(name, _flat(index, self.shapes[name])))
            )
        if operation == "item":
            return self._item(*operands)
        if operation == "branch":
            return self._branch(*operands)
        if operation == "solve":
            return self._solved(operands[0], [self._number(self.values[entry]) for entry in operands[1:]])
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
            return self.outside(operation, *given)
        return self.function({"abs": "fabs"}.get(operation, operation), *given)

    def _constant(self, number: float) -> Any:
        return ir.Constant(self.kind, [number] * LANES if self.lanes else number)

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
        return self.builder.gep(self.arrays[name], [ir.Constant(WHOLE, index)])

    def _item(self, name: str, first: int, *others: int) -> Any:
        """Entry of a table whose first index is known when the code runs; each lane has its own."""
        _, rows, columns = self.shapes[name]
        at, stride = others[0] * columns + others[1], ir.Constant(WHOLE, rows * columns)
        builder, cell = self.builder, self.values[first]

        def load(own: Any) -> Any:
            offset = builder.add(builder.mul(own, stride), ir.Constant(WHOLE, at))
            return self.load(builder.gep(self.arrays[name], [offset]))

        if not self.lanes:
            return load(cell)
        found = ir.Constant(self.kind, ir.Undefined)
        for lane in range(LANES):
            number = ir.Constant(ir.IntType(32), lane)
            found = builder.insert_element(found, load(builder.extract_element(cell, number)), number)
        return found

    def _solved(self, count: int, entries: list[Any]) -> list[Any]:
        """Solution of a system from right sides and the rows of the lower triangle."""
        builder, size, given = self.builder, ir.Constant(WHOLE, count), iter(entries)
        with builder.goto_entry_block():
            matrix, right = (builder.alloca(self.kind, ir.Constant(WHOLE, own)) for own in (count * count, count))
        rights = [builder.gep(right, [ir.Constant(WHOLE, i)]) for i in range(count)]
        triangle = [
            builder.gep(matrix, [ir.Constant(WHOLE, i * count + j)]) for i in range(count) for j in range(i + 1)
        ]
        for pointer in (*rights, *triangle):
            self.store(next(given), pointer)
        self.library.call(self, solve_in_place, [Array(matrix, (size, size)), Array(right, (size,))])
        return [self.load(pointer) for pointer in rights]

    def _nth(self, place: int, count: int) -> Any:
        def every(number: int) -> Any:
            return ir.Constant(self.whole, [number] * LANES if self.lanes else number)

        builder, index = self.builder, self.builder.fptosi(self.values[place], self.whole)
        index = builder.select(builder.icmp_signed("<", index, every(0)), every(0), index)
        return builder.select(builder.icmp_signed(">", index, every(count - 1)), every(count - 1), index)

    def _branch(self, condition: int, one: tuple[int, ...], other: tuple[int, ...]) -> list[Any]:
        """Both ways on from a condition; with lanes the second way is taken only where some lane wants it."""
        builder, bits = self.builder, self._bit(self.values[condition])
        if self.lanes:
            first = self._way(one)
            every = ir.IntType(LANES)
            all_agree = builder.icmp_unsigned("==", builder.bitcast(bits, every), every(2**LANES - 1))
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


def _flat(index: tuple[int, ...], shape: tuple[int, ...]) -> int:
    """Place of an entry in an array's memory."""
    found = 0
    for own, length in zip(index, shape, strict=True):
        found = found * length + own
    return found

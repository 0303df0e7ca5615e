"""What a recording computes: outputs of a graph, and what of it depends on constants alone."""

from __future__ import annotations

import hashlib
import math
import pickle
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.kernels.algebra import solved

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from towercrane.kernels.straight.graph import Graph

    Values = Mapping[str, Any]

CONSTANT = "constant"
"""Name of the numbers that do not change during a run; those that a switch changes are called ``numbers``."""


@dataclass(frozen=True, eq=False)
class Program:
    """Graph with what is wanted of it.

    Parameters
    ----------
    graph : Graph
    outputs : dict of (str, int) to int
        Places in the graph of what is written, by array and index in it.
    count : int
        Entries of ``numbers``, which what follows from constants alone stands behind.
    """

    graph: Graph
    outputs: dict[tuple[str, int], int]
    count: int

    def operands(self, place: int) -> tuple[int, ...]:
        """Nodes that a node needs, whichever way a branch takes."""
        operation, operands = self.graph.nodes[place]
        if operation in ("number", "given"):
            return ()
        if operation == "item":
            return (operands[1],)
        if operation == "branch":
            return (operands[0], *operands[1], *operands[2])
        if operation == "solve":
            return operands[1:]
        return operands[:1] if operation in ("part", "nth") else operands

    @cached_property
    def needed(self) -> list[int]:
        """Nodes that the outputs need, each after those that it needs itself."""
        found: set[int] = set()
        waiting = list(self.outputs.values())
        while waiting:
            place = waiting.pop()
            if place not in found:
                found.add(place)
                waiting.extend(self.operands(place))
        return sorted(found)

    @cached_property
    def settled(self) -> frozenset[int]:
        """Nodes that depend on constants alone."""
        found: set[int] = set()
        for place in self.needed:
            operation, operands = self.graph.nodes[place]
            if operation == "given":
                settles = operands[0] == CONSTANT
            else:
                settles = operation not in ("branch", "part", "item", "solve") and found.issuperset(
                    self.operands(place)
                )
            if settles:
                found.add(place)
        return frozenset(found)

    @cached_property
    def slots(self) -> dict[int, int]:
        """Where in ``numbers`` the code finds a node that depends on constants alone, if others need it."""
        asked = set(self.outputs.values())
        for place in self.needed:
            if place not in self.settled:
                asked.update(self.operands(place))
        wanted = (place for place in sorted(asked & self.settled) if self.graph.nodes[place].operation != "number")
        return {place: self.count + slot for slot, place in enumerate(wanted)}

    def constants(self, numbers: Any) -> Any:
        """What stands behind the numbers; shape (slots, ...) where the last axes of the numbers count many runs."""
        settled = (place for place in self.needed if place in self.settled)
        values = evaluate(self.graph, settled, {CONSTANT: numbers})
        return np.array([values[place] for place in self.slots], dtype=float).reshape(-1, *numbers.shape[1:])

    def values(self, given: Values) -> dict[tuple[str, int], Any]:
        """All outputs, with what is worked out from constants among the given numbers."""
        slots = {place: given["numbers"][slot] for place, slot in self.slots.items()}
        running = (
            place
            for place in self.needed
            if place not in self.settled or self.graph.nodes[place].operation == "number"
        )
        values = evaluate(self.graph, running, given, slots)
        return {output: values[place] for output, place in self.outputs.items()}

    def digest(self, shapes: Mapping[str, Any], sources: bytes) -> str:
        """Text that is equal for the same programs, with arrays of these shapes, written by the same sources."""
        content = (
            [self.graph.nodes[place] for place in self.needed],
            self.needed,
            self.outputs,
            shapes,
            self.count,
            sources,
        )
        return hashlib.sha256(pickle.dumps(content)).hexdigest()[:24]


def evaluate(
    graph: Graph, places: Iterable[int], given: Values, known: Mapping[int, Any] | None = None
) -> dict[int, Any]:
    """Values of nodes, with what is given as arrays by name: numbers, or arrays of many instants or runs.

    Values of some nodes may be known already.
    """
    values: dict[int, Any] = dict(known or {})
    with np.errstate(all="ignore"):
        for place in places:
            operation, operands = graph.nodes[place]
            if operation == "number":
                values[place] = np.float64(operands[0])
            elif operation == "given":
                values[place] = given[operands[0]][operands[1]]
            elif operation == "item":
                values[place] = given[operands[0]][(values[operands[1]], *operands[2:])]
            elif operation == "branch":
                condition, *ways = operands
                pairs = zip(*ways, strict=True)
                values[place] = [_where(values[condition], values[a], values[b]) for a, b in pairs]
            elif operation == "solve":
                values[place] = solved(*system_of(operands[0], [values[entry] for entry in operands[1:]]))
            elif operation == "part":
                values[place] = values[operands[0]][operands[1]]
            elif operation == "nth":
                values[place] = np.clip(np.trunc(values[operands[0]]).astype(int), 0, operands[1] - 1)
            else:
                values[place] = DONE[operation](*(values[operand] for operand in operands))
    return values


def system_of(count: int, entries: Sequence[Any]) -> tuple[list[Sequence[Any]], Sequence[Any]]:
    """Rows of the lower triangle of a symmetric system, and its right sides, from :meth:`Graph.solve`'s entries."""
    ends = [count + i * (i + 1) // 2 for i in range(count + 1)]
    return [entries[first:last] for first, last in pairwise(ends)], entries[:count]


def _where(condition: Any, a: Any, b: Any) -> Any:
    found: Any = np.where(condition, a, b)
    return found[()]


def _of_each(function: Callable[..., float]) -> Callable[..., Any]:
    """A function of the C library, as machine code has it, of numbers and arrays; NumPy's differ in the last bit."""

    def done(*values: Any) -> Any:
        given = np.broadcast_arrays(*(np.asarray(value, dtype=float) for value in values))
        rows = zip(*(array.ravel().tolist() for array in given), strict=True)
        found = [function(*row) if all(map(math.isfinite, row)) else np.nan for row in rows]
        return np.array(found).reshape(given[0].shape)[()]

    return done


DONE: dict[str, Any] = {
    "add": np.add,
    "sub": np.subtract,
    "mul": np.multiply,
    "div": np.divide,
    "atan2": _of_each(math.atan2),
    "neg": np.negative,
    "sqrt": np.sqrt,
    "sin": _of_each(math.sin),
    "cos": _of_each(math.cos),
    "tanh": _of_each(math.tanh),
    "sign": np.sign,
    "abs": np.abs,
    "below": np.less,
    "choose": _where,
}
"""What operations do to numbers and to arrays of them."""

"""What a recording computes: outputs of a graph, and what of it depends on constants alone."""

from __future__ import annotations

import hashlib
import pickle
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from towercrane.kernels.straight.graph import Graph

    Values = Mapping[str, Any]

CONSTANT = frozenset(("constant", "vectors", "matrices", "tables"))
"""Arrays whose entries do not change during a run, but for the items of a table. A switch changes some of
``numbers``: the others are called constant."""


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
                settles = operands[0] in CONSTANT
            else:
                settles = operation not in ("branch", "part", "item") and found.issuperset(self.operands(place))
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

    def constants(self, given: Values) -> Any:
        """What stands behind the numbers; shape (slots, ...) with arrays whose last axes count many runs.

        Parameters
        ----------
        given : mapping of str to ndarray
            The arrays of constants by name.
        """
        values = evaluate(self.graph, (place for place in self.needed if place in self.settled), given)
        return np.array([values[place] for place in self.slots], dtype=float)

    def digest(self, shapes: Mapping[str, Any]) -> str:
        """Text that is equal for programs, with arrays of these shapes, that are the same."""
        content = [self.graph.nodes[place] for place in self.needed], self.needed, self.outputs, shapes, self.count
        return hashlib.sha256(pickle.dumps(content)).hexdigest()[:24]


def evaluate(graph: Graph, places: Iterable[int], given: Values) -> dict[int, Any]:
    """Values of nodes, with what is given as arrays by name: numbers, or arrays of many instants or runs."""
    values: dict[int, Any] = {}
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
            elif operation == "part":
                values[place] = values[operands[0]][operands[1]]
            elif operation == "nth":
                values[place] = np.clip(np.trunc(values[operands[0]]).astype(int), 0, operands[1] - 1)
            else:
                values[place] = DONE[operation](*(values[operand] for operand in operands))
    return values


def _where(condition: Any, a: Any, b: Any) -> Any:
    found: Any = np.where(condition, a, b)
    return found[()]


DONE: dict[str, Any] = {
    "add": np.add,
    "sub": np.subtract,
    "mul": np.multiply,
    "div": np.divide,
    "neg": np.negative,
    "sqrt": np.sqrt,
    "sin": np.sin,
    "cos": np.cos,
    "tanh": np.tanh,
    "sign": np.sign,
    "abs": np.abs,
    "below": np.less,
    "choose": _where,
}
"""What operations do to numbers and to arrays of them."""

"""What is done to numbers, written down: operands that record, and the graph of what they recorded.

Equations are called once, as Python, with operands in place of numbers. Each distinct expression is one node of the
graph; zeros and ones that are known leave no trace, and a branch that Python can take leaves only what it chose.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

COMMUTATIVE = frozenset(("add", "mul"))
"""Operations whose operands may be exchanged without a change of a bit."""

PAIRS: dict[Any, str] = {
    np.add: "add",
    np.subtract: "sub",
    np.multiply: "mul",
    np.divide: "div",
    np.arctan2: "atan2",
}
"""Functions of two numbers."""

SINGLES: dict[Any, str] = {
    np.sqrt: "sqrt",
    np.sin: "sin",
    np.cos: "cos",
    np.tanh: "tanh",
    np.sign: "sign",
    np.absolute: "abs",
    np.negative: "neg",
}
"""Functions of one number."""


class Node(NamedTuple):
    """One operation.

    Parameters
    ----------
    operation : str
        "number" with its value, "given" with the name of an array and the place in it, "item" with the name of a
        table, a node of the first index and the other indices, "branch" with a condition and two tuples of nodes,
        "solve" with a number of unknowns and nodes, "part" with one of these two and which of its results, or an
        operation on nodes.
    operands : tuple
    """

    operation: str
    operands: tuple[Any, ...]


@dataclass(eq=False)
class Graph:
    """Nodes in the order in which they were recorded; an operation's operands stand before it."""

    nodes: list[Node] = field(default_factory=list)
    known: dict[Node, int] = field(default_factory=dict)

    def add(self, operation: str, *operands: Any) -> int:
        """Place of an operation, which is noted once however often it is asked for."""
        node = Node(operation, operands)
        place = self.known.get(node)
        if place is None:
            place = self.known[node] = len(self.nodes)
            self.nodes.append(node)
        return place

    def operand(self, operation: str, *operands: Any) -> Operand:
        """An operand that stands for an operation."""
        return Operand(self, self.add(operation, *operands))

    def place(self, value: Any) -> int:
        """Place of an operand, or of a number that is known."""
        if isinstance(value, Operand):
            return value.place
        # Minus zero and zero are one key of a dictionary, and one number to every equation here.
        return self.add("number", float(value))

    def solve(self, entries: Sequence[Any], count: int) -> list[Operand]:
        """Solution of a symmetric system: right sides, then the rows of its lower triangle, are entries."""
        solved = self.add("solve", count, *(self.place(entry) for entry in entries))
        return [self.operand("part", solved, k) for k in range(count)]

    def given(self, name: str, *shape: int) -> np.ndarray[Any, Any]:
        """Array of operands that are given when the code runs."""
        array = np.empty(shape, dtype=object)
        for index in np.ndindex(*shape):
            array[index] = self.operand("given", name, index)
        return array


def graph_of(values: Iterable[Any]) -> Graph | None:
    """Graph of the operands among values; None if there are none."""
    return next((value.graph for value in values if isinstance(value, Operand)), None)


class Operand:
    """A number that is known only when the code runs."""

    __slots__ = ("graph", "place")

    def __init__(self, graph: Graph, place: int) -> None:
        self.graph, self.place = graph, place

    def __bool__(self) -> bool:
        raise TypeError("wanted a named choice, got a branch on a number that is not known yet")

    def __array_ufunc__(self, function: Any, method: str, *values: Any, **_: Any) -> Any:
        if method != "__call__":
            return NotImplemented
        if function in SINGLES:
            return self.graph.operand(SINGLES[function], self.place)
        return _pair(self.graph, PAIRS[function], *values) if function in PAIRS else NotImplemented

    def __add__(self, other: Any) -> Any:
        return _pair(self.graph, "add", self, other)

    def __radd__(self, other: Any) -> Any:
        return _pair(self.graph, "add", other, self)

    def __sub__(self, other: Any) -> Any:
        return _pair(self.graph, "sub", self, other)

    def __rsub__(self, other: Any) -> Any:
        return _pair(self.graph, "sub", other, self)

    def __mul__(self, other: Any) -> Any:
        return _pair(self.graph, "mul", self, other)

    def __rmul__(self, other: Any) -> Any:
        return _pair(self.graph, "mul", other, self)

    def __truediv__(self, other: Any) -> Any:
        return _pair(self.graph, "div", self, other)

    def __rtruediv__(self, other: Any) -> Any:
        return _pair(self.graph, "div", other, self)

    def __neg__(self) -> Operand:
        return self.graph.operand("neg", self.place)

    def __abs__(self) -> Operand:
        return self.graph.operand("abs", self.place)


def _pair(graph: Graph, operation: str, a: Any, b: Any) -> Any:
    """Result of an operation on two values of which one at least is an operand."""
    if operation == "atan2":
        # Which way zero points depends on the other.
        return graph.operand(operation, graph.place(a), graph.place(b))
    if not isinstance(a, Operand):
        if operation in COMMUTATIVE:
            return _pair(graph, operation, b, a)
        if a == 0.0:
            return -b if operation == "sub" else 0.0
    elif not isinstance(b, Operand):
        if b == 0.0 and operation != "div":
            return 0.0 if operation == "mul" else a
        if b == 1.0 and operation in ("mul", "div"):
            return a
        if b == -1.0 and operation == "mul":
            return -a
    places = graph.place(a), graph.place(b)
    return graph.operand(operation, *(sorted(places) if operation in COMMUTATIVE else places))


def branch(
    condition: Operand, one: Callable[..., Any], other: Callable[..., Any], *arguments: Any
) -> tuple[Any, ...]:
    """Record both ways on from a condition: what is only needed for one is computed only there."""
    graph = condition.graph
    ways = (tuple(graph.place(value) for value in way(*arguments)) for way in (one, other))
    chosen = graph.add("branch", condition.place, *ways)
    return tuple(graph.operand("part", chosen, k) for k in range(len(graph.nodes[chosen].operands[1])))


class Table:
    """Table of numbers whose first index may be an operand.

    Parameters
    ----------
    graph : Graph
    name : str
    shape : tuple of int
    entries : ndarray of object, optional
        What it gives at places that are known.
    """

    def __init__(self, graph: Graph, name: str, shape: tuple[int, ...], entries: Any = None) -> None:
        self.graph, self.name, self.shape, self.entries = graph, name, shape, entries

    def __getitem__(self, index: tuple[Any, ...]) -> Any:
        first, *others = index
        if isinstance(first, Operand):
            return self.graph.operand("item", self.name, first.place, *others)
        return self.entries[index]

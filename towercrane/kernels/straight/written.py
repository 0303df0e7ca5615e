"""Equations of one scene, recorded and compiled: what stays the same is worked out once, zeros leave no trace."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.kernels.straight.graph import Graph, Table
from towercrane.kernels.straight.leaves import changing, known_of, table_of, with_numbers
from towercrane.kernels.straight.program import Program

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from towercrane.kernels.straight.code import StraightCode

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Written:
    """Equations written out.

    Parameters
    ----------
    program : Program
    shapes : dict of str to tuple of int
        Shapes of the arrays that the equations are given.
    counts : tuple of int
        Numbers of slopes and of guards.
    """

    program: Program
    shapes: dict[str, tuple[int, ...]]
    counts: tuple[int, int]
    compiled: dict[bool, StraightCode] = field(default_factory=dict)
    asked: list[int] = field(default_factory=lambda: [0])

    def rhs(self, *, lanes: bool = False) -> StraightCode:
        """Compiled right-hand side, of a single run or of eight side by side."""
        if lanes not in self.compiled:
            from towercrane.kernels.straight.code import StraightCode

            self.compiled[lanes] = StraightCode(self.program, self.shapes, lanes=lanes)
        return self.compiled[lanes]

    def values(self, numbers: Floats, table: Floats) -> Callable[[Floats, Floats], Floats]:
        """Slopes when a phase begins, as a function of states in columns and inputs; shape (slopes, p).

        Where they are asked for often, they are compiled.
        """
        numbers = self.numbers(numbers)

        def slopes(states: Floats, inputs: Floats) -> Floats:
            self.asked[0] += states.shape[1]
            found = np.empty((states.shape[1], self.counts[0]))
            if self.asked[0] > COMPILED_AFTER:
                rhs, guards = self.rhs(), np.empty(self.counts[1])
                for state, slope in zip(np.ascontiguousarray(states.T), found, strict=True):
                    rhs(0.0, state, slope, inputs, numbers, table, guards)
                return found.T
            given = {"t": {(): 0.0}, "y": states, "inputs": inputs, "numbers": numbers, "tables": table}
            outputs = self.program.values(given)
            for index in range(self.counts[0]):
                found[:, index] = outputs["dy", index]
            return found.T

        return slopes

    def numbers(self, numbers: Floats) -> Floats:
        """Numbers of a system, and behind them what follows from constants alone; of many, in columns."""
        return np.concatenate([numbers, self.program.constants(numbers)])


_WRITTEN: dict[Any, Written] = {}
"""What has been written last, by all that it depends on."""

COMPILED_AFTER = 3_000
"""States whose slopes are worked out by NumPy, operation by operation, before equations are compiled for it."""

MOST_KEPT = 64
"""Equations kept in memory beside those that a system holds."""


def written(
    equations: Callable[..., Any], constants: Any, numbers: Sequence[Floats], states: int, inputs: tuple[int, int]
) -> Written:
    """Equations written out for constants that are alike in all but their numbers.

    Parameters
    ----------
    equations : callable
        ``equations(constants, t, y, inputs)`` gives two sequences of numbers: what stands for slopes, and guards.
    constants : dataclass
        Of one system, see :mod:`towercrane.kernels.straight.leaves`.
    numbers : sequence of ndarray
        Of all: what is zero in each of them leaves no trace.
    states : int
        Entries of y.
    inputs : tuple of int
        Shape of the inputs' polynomials.
    """
    zeros = np.all([own == 0.0 for own in numbers], axis=0)
    key = equations, known_of(constants), states, inputs, zeros.tobytes()
    found = _WRITTEN.get(key)
    if found is None:
        found = _record(equations, constants, zeros, states, inputs)
        if len(_WRITTEN) >= MOST_KEPT:
            del _WRITTEN[next(iter(_WRITTEN))]
        _WRITTEN[key] = found
    return found


def _record(
    equations: Callable[..., Any], constants: Any, zeros: NDArray[np.bool_], states: int, inputs: tuple[int, int]
) -> Written:
    graph = Graph()
    numbers = graph.given("constant", len(zeros))
    numbers[zeros] = 0.0
    for place in changing(constants):
        numbers[place] = graph.operand("given", "numbers", (place,))
    table = table_of(constants)
    given = with_numbers(constants, numbers, Table(graph, "tables", table.shape))
    slopes, guards = equations(
        given, graph.operand("given", "t", ()), graph.given("y", states), graph.given("inputs", *inputs)
    )
    outputs = {
        (name, index): graph.place(value)
        for name, values in (("dy", slopes), ("guards", guards))
        for index, value in enumerate(values)
    }
    shapes = {"y": (states,), "inputs": inputs, "numbers": zeros.shape, "tables": table.shape}
    return Written(Program(graph, outputs, len(numbers)), shapes, (len(slopes), len(guards)))

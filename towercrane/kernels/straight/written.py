"""Equations of one scene, recorded and compiled: what stays the same is worked out once, zeros leave no trace."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.kernels.straight.graph import Graph, Table
from towercrane.kernels.straight.program import Program

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Data = Mapping[str, Floats]


@dataclass(frozen=True)
class Known:
    """What is known of a system's data when its equations are written out, beside which of it is zero.

    Parameters
    ----------
    numbers : tuple of int
        Entries of ``numbers`` that equations count or choose with.
    tables : tuple of tuples of int
        Entries of ``tables`` of the same kind.
    changing : tuple of int
        Entries of ``numbers`` that a switch changes during a run.
    """

    numbers: tuple[int, ...] = ()
    tables: tuple[tuple[int, ...], ...] = ()
    changing: tuple[int, ...] = ()


@dataclass(frozen=True, eq=False)
class Written:
    """Equations written out.

    Parameters
    ----------
    program : Program
    shapes : dict of str to tuple of int
        Shapes of the arrays that the equations are given.
    """

    program: Program
    shapes: dict[str, tuple[int, ...]]
    compiled: dict[int, Any] = field(default_factory=dict)

    def rhs(self, signature: Any, lanes: int = 0) -> Any:
        """Compiled right-hand side, of a single run or of so many side by side."""
        if lanes not in self.compiled:
            from towercrane.kernels.straight.code import straight_code

            self.compiled[lanes] = straight_code(self.program, self.shapes, signature, lanes)
        return self.compiled[lanes]

    def numbers(self, data: Data) -> Floats:
        """Numbers of a system, and behind them what follows from constants alone."""
        return np.concatenate([data["numbers"], self.program.constants({**data, "constant": data["numbers"]})])

    def numbers_of_many(self, systems: Sequence[Data]) -> Floats:
        """:meth:`numbers` of systems, each in a column."""
        return self.numbers({name: np.stack([system[name] for system in systems], axis=-1) for name in systems[0]})


_WRITTEN: dict[Any, Written] = {}
"""What has been written last, by all that it depends on."""

MOST_KEPT = 64
"""Equations kept in memory beside those that a system holds."""


def written(
    equations: Callable[..., None],
    sizes: tuple[int, int],
    known: Known,
    systems: Sequence[Data],
    inputs: tuple[int, int],
    work: tuple[int, int],
) -> Written:
    """Equations of systems with the same zeros, or of one, written out.

    Parameters
    ----------
    equations : callable
        As :func:`towercrane.simulation.system.rhs_signature` has them, in Python.
    sizes : tuple of int
        Number of states and of guards.
    known : Known
    systems : sequence of mappings of str to ndarray
        numbers, vectors, matrices and tables of each.
    inputs, work : tuple of int
        Shapes of the inputs' polynomials and of scratch.
    """
    first = systems[0]
    # Systems share what they do not differ in.
    distinct = {name: {id(system[name]): system[name] for system in systems}.values() for name in first}
    zeros = {name: np.all([array == 0.0 for array in arrays], axis=0) for name, arrays in distinct.items()}
    tables = first["tables"][_index(known)]
    patterns = (*((array.shape, array.tobytes()) for array in zeros.values()),)
    numbers = first["numbers"][list(known.numbers)]
    key = equations, sizes, known, inputs, work, patterns, numbers.tobytes(), tables.tobytes()
    found = _WRITTEN.get(key)
    if found is None:
        found = _record(equations, sizes, known, first, zeros, inputs, work)
        if len(_WRITTEN) >= MOST_KEPT:
            del _WRITTEN[next(iter(_WRITTEN))]
        _WRITTEN[key] = found
    return found


def _index(known: Known) -> tuple[NDArray[np.int64], ...]:
    """The known entries of the tables as an index."""
    return tuple(np.array(known.tables, dtype=int).reshape(-1, 3).T)


def _record(
    equations: Callable[..., None], sizes: tuple[int, int], known: Known, data: Data, zeros: Mapping[str, Any],
    inputs: tuple[int, int], work: tuple[int, int],
) -> Written:  # fmt: skip
    graph = Graph()
    numbers = graph.given("constant", *data["numbers"].shape)
    numbers[zeros["numbers"]] = 0.0
    for place in known.changing:
        numbers[place] = graph.operand("given", "numbers", (place,))
    for place in known.numbers:
        numbers[place] = float(data["numbers"][place])
    vectors, matrices = (graph.given(name, *data[name].shape) for name in ("vectors", "matrices"))
    vectors[zeros["vectors"]], matrices[zeros["matrices"]] = 0.0, 0.0
    tables = Table(graph, "tables", data["tables"].shape)
    if known.tables:
        tables.entries = graph.given("tables", *tables.shape)
        tables.entries[zeros["tables"]] = 0.0
        tables.entries[_index(known)] = data["tables"][_index(known)]
    slopes, guards, scratch = (np.zeros(shape, dtype=object) for shape in (*sizes, work))
    equations(
        graph.operand("given", "t", ()), graph.given("y", sizes[0]), slopes, graph.given("inputs", *inputs), numbers,
        vectors, matrices, tables, scratch, guards,
    )  # fmt: skip
    outputs = {
        (name, index): graph.place(value)
        for name, values in (("dy", slopes), ("guards", guards))
        for index, value in enumerate(values)
    }
    shapes = {"y": (sizes[0],), "inputs": inputs} | {name: array.shape for name, array in data.items()}
    return Written(Program(graph, outputs, len(numbers)), shapes)

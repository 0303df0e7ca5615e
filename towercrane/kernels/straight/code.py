"""Machine code of a program: compiled by numba's own compiler, called as any right-hand side is, kept on disk."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from llvmlite import ir
from numba import njit, types
from numba.core import cgutils
from numba.extending import intrinsic
from numba.np.arrayobj import make_array

from modal.compiler.folder import cache_folder
from modal.compiler.kernel_cache import keep
from towercrane.kernels.straight.emitter import Emitter

if TYPE_CHECKING:
    from towercrane.kernels.straight.program import Program

# Numba's own functions carry no types.
_intrinsic: Any = intrinsic
_njit: Any = njit

DOUBLES = ir.DoubleType().as_pointer()

ARGUMENTS = ("t", "y", "dy", "inputs", "numbers", "vectors", "matrices", "tables", "work", "guards")
"""Arguments of a right-hand side, see :func:`towercrane.simulation.system.rhs_signature`."""

LANE_ARGUMENTS = ("t", "y", "dy", "inputs", "numbers", "tables", "guards")
"""Those of one for lane vectors, see :func:`towercrane.kernels.arrays.lane_rhs_signature`."""


def straight_code(program: Program, shapes: dict[str, tuple[int, ...]], signature: Any, lanes: int) -> Any:
    """Compiled right-hand side of a program.

    Parameters
    ----------
    program : Program
    shapes : dict of str to tuple of int
        Shapes of the arrays that are given.
    signature : numba signature
        For numbers, or for lane vectors.
    lanes : int
        Runs side by side; 0 for a single run.
    """

    @_intrinsic
    def emitted(_context: Any, arguments: Any) -> Any:
        def build(context: Any, builder: Any, _signature: Any, values: Any) -> Any:
            kinds_and_values = zip(arguments, cgutils.unpack_tuple(builder, values[0]), strict=True)
            given = dict(zip(names, kinds_and_values, strict=True))
            arrays = {"t": given.pop("t")[1]}
            for name, (kind, value) in given.items():
                data = make_array(kind)(context, builder, value).data
                arrays[name] = builder.bitcast(data, DOUBLES)
            Emitter(program, context, builder, arrays, shapes, lanes).write()
            return context.get_dummy_value()

        return types.none(arguments), build

    def rhs(
        t: Any, y: Any, dy: Any, inputs: Any, numbers: Any, vectors: Any, matrices: Any, tables: Any, work: Any,
        guards: Any,
    ) -> None:  # fmt: skip
        emitted((t, y, dy, inputs, numbers, vectors, matrices, tables, work, guards))

    def lane_rhs(t: Any, y: Any, dy: Any, inputs: Any, numbers: Any, tables: Any, guards: Any) -> None:
        emitted((t, y, dy, inputs, numbers, tables, guards))

    function, names = (lane_rhs, LANE_ARGUMENTS) if lanes else (rhs, ARGUMENTS)
    digest = program.digest(shapes)
    # Numba names machine code by the function's name and a counter of this process: code from the cache and code that
    # is compiled here would be taken for each other.
    function.__name__ = function.__qualname__ = f"{function.__name__}_{digest}"
    made = _njit(error_model="numpy", _nrt=False)(function)
    keep(made, function, cache_folder(), digest)
    made.compile(signature)
    made.disable_compile()
    return made

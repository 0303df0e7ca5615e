"""Machine code of a program: compiled by numba's own compiler, called as any right-hand side is, kept on disk."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from llvmlite import ir
from numba import njit, types
from numba.core import cgutils
from numba.extending import intrinsic
from numba.np.arrayobj import make_array

from modal.compiler.folder import cache_folder
from modal.compiler.kernel_cache import keep
from towercrane.kernels.arrays import lane_rhs_signature, rhs_signature
from towercrane.kernels.straight.emitter import Emitter

if TYPE_CHECKING:
    from towercrane.kernels.straight.program import Program

# Numba's own functions carry no types.
_intrinsic: Any = intrinsic
_njit: Any = njit

DOUBLES = ir.DoubleType().as_pointer()

ARGUMENTS = ("t", "y", "dy", "inputs", "numbers", "tables", "guards")
"""Arguments of a right-hand side, see :func:`towercrane.kernels.arrays.rhs_signature`."""


@cache
def _sources() -> bytes:
    """What writes machine code, as text: other sources write other code for the same program."""
    return b"".join(source.read_bytes() for source in sorted(Path(__file__).parent.glob("*.py")))


def straight_code(program: Program, shapes: dict[str, tuple[int, ...]], lanes: int) -> Any:
    """Compiled right-hand side of a program.

    Parameters
    ----------
    program : Program
    shapes : dict of str to tuple of int
        Shapes of the arrays that are given.
    lanes : int
        Runs side by side; 0 for a single run.
    """

    @_intrinsic
    def emitted(_context: Any, arguments: Any) -> Any:
        def build(context: Any, builder: Any, _signature: Any, values: Any) -> Any:
            kinds_and_values = zip(arguments, cgutils.unpack_tuple(builder, values[0]), strict=True)
            given = dict(zip(ARGUMENTS, kinds_and_values, strict=True))
            arrays = {"t": given.pop("t")[1]}
            for name, (kind, value) in given.items():
                data = make_array(kind)(context, builder, value).data
                arrays[name] = builder.bitcast(data, DOUBLES)
            Emitter(program, context, builder, arrays, shapes, lanes).write()
            return context.get_dummy_value()

        return types.none(arguments), build

    def rhs(t: Any, y: Any, dy: Any, inputs: Any, numbers: Any, tables: Any, guards: Any) -> None:
        emitted((t, y, dy, inputs, numbers, tables, guards))

    digest = program.digest(shapes, _sources())
    # Numba names machine code by the function's name and a counter of this process: code from the cache and code that
    # is compiled here would be taken for each other.
    rhs.__name__ = rhs.__qualname__ = f"{'lane_rhs' if lanes else 'rhs'}_{digest}"
    made = _njit(error_model="numpy", _nrt=False)(rhs)
    keep(made, rhs, cache_folder(), digest)
    made.compile(lane_rhs_signature() if lanes else rhs_signature())
    made.disable_compile()
    return made

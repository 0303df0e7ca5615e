"""Machine code of a program: compiled by LLVM, called as any right-hand side is, kept on disk."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any

from llvmlite import ir

from modal.compiler.arithmetic import DOUBLE, VECTOR
from modal.compiler.folder import sources
from modal.compiler.machine_code import loaded
from modal.compiler.native import array_door
from modal.compiler.translation import Library
from towercrane.kernels.straight.emitter import Emitter

if TYPE_CHECKING:
    from collections.abc import Callable

    from towercrane.kernels.straight.program import Program

ARRAYS = {"y": 1, "dy": 1, "inputs": 2, "numbers": 1, "tables": 3, "guards": 1}
"""Arrays of a right-hand side and their axes: inputs holds the polynomials of a phase, one row for each channel;
numbers and tables are the model's constants, the numbers followed by what is worked out from them; dy and guards are
written."""

WRITER = "modal/compiler", "towercrane/kernels/straight"
"""Sources of what writes machine code: others write other code for the same program."""


class StraightCode:
    """Compiled right-hand side ``rhs(t, y, dy, inputs, numbers, tables, guards)``, t since the phase began [s].

    A procedure for compiled functions; that of a single run can be called from Python too.

    Parameters
    ----------
    program : Program
    shapes : dict of str to tuple of int
        Shapes of the arrays that are given.
    lanes : bool
        Whether every number is that of eight runs side by side; the tables are the same for all.
    """

    def __init__(self, program: Program, shapes: dict[str, tuple[int, ...]], *, lanes: bool) -> None:
        name = "lane_rhs" if lanes else "rhs"

        def module() -> Any:
            return _module(name, program, shapes, VECTOR if lanes else DOUBLE)

        # An engine goes with the last who holds it.
        self._engine = loaded(name, program.digest(shapes, sources(*WRITER)).encode(), module)
        self.address = self._engine.get_function_address(name)
        kind = ctypes.CFUNCTYPE(None, ctypes.c_double, *[ctypes.c_void_p] * len(ARRAYS))
        self._entry: Callable[..., None] = kind(self.address)
        self._doors = [array_door(f"rhs: {name}", "float64", axes, 0) for name, axes in ARRAYS.items()]

    def __call__(self, t: float, *arrays: Any) -> None:
        """Write dy and guards of a single run."""
        self._entry(t, *[door(array)[0] for door, array in zip(self._doors, arrays, strict=True)])


def _module(name: str, program: Program, shapes: dict[str, tuple[int, ...]], number: Any) -> Any:
    """LLVM module of a right-hand side."""
    library = Library(name, [])
    taken = [number, *[(DOUBLE if own == "tables" else number).as_pointer() for own in ARRAYS]]
    made = ir.Function(library.module, ir.FunctionType(ir.VoidType(), taken), name)
    builder = ir.IRBuilder(made.append_basic_block())
    Emitter(program, library, builder, dict(zip(("t", *ARRAYS), made.args, strict=True)), shapes).write()
    builder.ret_void()
    return library.module

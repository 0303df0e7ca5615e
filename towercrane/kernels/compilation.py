"""The first compilation of the kernels, spread over two processes."""

from __future__ import annotations

import sys
import warnings
from contextlib import suppress
from importlib import import_module
from typing import TYPE_CHECKING, Any

from modal.compiler.folder import is_compiled

if TYPE_CHECKING:
    from multiprocessing.process import BaseProcess

FLEXIBLE = "towercrane.cranes.tower.kernels.rhs", "modal.beams.roots"
AT_REST = "towercrane.cranes.tower.kernels.structure", "modal.beams.roots"
STRUCTURE, SHAPES = "modal.structures.structure_kernel", "modal.structures.shape_kernel"
STEPPER = "towercrane.simulation.stepper"

KERNELS = {
    "radial": FLEXIBLE,
    "space": FLEXIBLE,
    "jib": ("towercrane.cranes.jib.kernel",),
    **dict.fromkeys(("multi-mass", "enhanced", "basic"), ("towercrane.cranes.slewing.kernel",)),
    "lanes": ("towercrane.cranes.tower.kernels.lane_rhs", "towercrane.simulation.lanes.advance"),
    "modes": AT_REST,
    "structure": (STRUCTURE,),
    "chain": (STRUCTURE, SHAPES),
    "runs": (STEPPER,),
}
"""Modules whose import compiles: the equations of a kind of crane, those for many runs side by side, a
flexible crane at rest, exact structures, towers that are chains of segments, and the integrator."""


def missing_kernels(*uses: str) -> tuple[str, ...]:
    """Modules of kernels for these uses that are not compiled yet."""
    modules = dict.fromkeys(module for use in uses for module in KERNELS[use])
    return tuple(module for module in modules if not is_compiled(module))


def compile_kernels(*modules: str) -> None:
    """Import modules of kernels, some here, the others in a process beside: all leave code in the cache."""
    # Those of exact structures call the same functions, which are compiled once in a process.
    here = [module for module in modules if module in (STRUCTURE, SHAPES)] or list(modules[:1])
    beside = [module for module in modules if module not in here]
    other = _started(beside) if beside else None
    try:
        for module in here:
            import_module(module)
    finally:
        if other:
            other.join()


def _started(modules: list[str]) -> BaseProcess:
    """A process that imports these modules."""
    import multiprocessing

    import numba

    # A third of numba loads with the first function that it compiles. A fork then need not load it once more;
    # elsewhere than on Linux libraries do not bear one.
    numba.njit("float64(float64)")(lambda x: x)
    context: Any = multiprocessing.get_context("fork" if sys.platform == "linux" else "spawn")
    process: BaseProcess = context.Process(target=_import, args=modules)
    process.start()
    return process


def _import(*modules: str) -> None:
    # If it fails, it does no harm: what it should have compiled is compiled where it is used, and said there.
    warnings.simplefilter("ignore")
    with suppress(Exception, KeyboardInterrupt):
        for module in modules:
            import_module(module)

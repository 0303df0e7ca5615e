"""The first compilation of the kernels, spread over two processes."""

from __future__ import annotations

import sys
from contextlib import suppress
from importlib import import_module
from typing import TYPE_CHECKING, Any

from modal.compiled import is_compiled

if TYPE_CHECKING:
    from multiprocessing.process import BaseProcess

FLEXIBLE = "towercrane.cranes.flexible_rhs", "modal.roots"
STRUCTURE = "modal.structure_kernel"
STEPPER = "towercrane.stepper"

KERNELS = {
    "radial": FLEXIBLE,
    "space": FLEXIBLE,
    "jib": ("towercrane.cranes.jib_crane_kernel",),
    **dict.fromkeys(("multi-mass", "enhanced", "basic"), ("towercrane.cranes.lumped_kernel",)),
    "lanes": ("towercrane.cranes.radial_lane_rhs", "towercrane.cranes.radial_lanes"),
    "structure": (STRUCTURE,),
    "chain": (STRUCTURE, "modal.shape_kernel"),
    "runs": (STEPPER,),
}
"""Modules whose import compiles: the equations of a kind of crane, those for many runs side by side, exact
structures, towers that are chains of segments, and the integrator."""


def missing_kernels(*uses: str) -> tuple[str, ...]:
    """Modules of kernels for these uses that are not compiled yet, the one that takes longest first."""
    modules = dict.fromkeys(module for use in uses for module in KERNELS[use])
    missing = [module for module in modules if not is_compiled(module)]
    return tuple(sorted(missing, key=lambda module: module != STRUCTURE))


def compile_kernels(here: str, *beside: str) -> None:
    """Import modules of kernels, the first here, the others in a process beside: all leave code in the cache."""
    other = _started(beside) if beside else None
    try:
        import_module(here)
    finally:
        if other:
            other.join()


def _started(modules: tuple[str, ...]) -> BaseProcess:
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
    # If it fails, it does no harm: what it should have compiled is compiled where it is used.
    with suppress(Exception, KeyboardInterrupt):
        for module in modules:
            import_module(module)

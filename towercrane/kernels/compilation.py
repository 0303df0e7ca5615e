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


def missing_kernels(*modules: str) -> tuple[str, ...]:
    """Those of some modules of kernels that are not compiled yet."""
    return tuple(module for module in dict.fromkeys(modules) if not is_compiled(module))


def compile_kernels(*modules: str) -> None:
    """Import modules of kernels, the first here, others in a process beside: all leave code in the cache."""
    here, *beside = modules
    other = _started(beside) if beside else None
    try:
        import_module(here)
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

"""The one decorator for compiled kernels: numba with a cache that cannot go stale."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from modal.compiler.folder import cache_folder

if TYPE_CHECKING:
    from collections.abc import Callable


class NoCompiler(RuntimeError):
    """Numba is told not to compile."""


def kernel(
    signature: Any = None,
    *,
    python_entry: bool | tuple[Any, ...] = False,
    inline: bool = False,
    allocates: bool = False,
    parallel_calls: bool = False,
) -> Callable[[Callable[..., Any]], Any]:
    """Compile a function with numba: with a signature at once, cached; without one into the kernels that call it.

    Parameters
    ----------
    signature : numba signature, optional
        A function with a signature can be called from Python, and be passed to kernels as a function pointer. One
        without stays as it is for Python.
    python_entry : bool or tuple of numba types
        Python calls a function without a signature: compile it for that at its first call, or for arguments of these
        types at once.
    inline : bool
        Copy the function into each kernel that calls it: tuples that a call returns go through memory.
    allocates : bool
        The function makes arrays, or gets them from one that does. All others work on arrays that Python owns for
        as long as the call lasts, and count no references to them: with it a right-hand side takes a third to two
        thirds longer. numba refuses to compile a function that allocates and does not say so.
    parallel_calls : bool
        Let several threads be inside at the same time: the interpreter's lock is given away on the way in.
    """
    import numba
    from numba.core import config as numba_config

    from modal.compiler.kernel_cache import keep

    # Both are typed more narrowly than they are used here, or not at all.
    config: Any = numba_config
    compile_: Any = numba.njit
    if config.DISABLE_JIT:
        raise NoCompiler("NUMBA_DISABLE_JIT: wanted unset or 0, got 1: the equations are written for the compiler")
    # An entry for Python takes longer to compile than many a function behind it.
    inner = signature is None and not python_entry

    def decorate(function: Callable[..., Any]) -> Any:
        made = compile_(
            error_model="numpy",
            inline="always" if inline else "never",
            _nrt=allocates,
            nogil=parallel_calls,
            no_cpython_wrapper=inner,
            no_cfunc_wrapper=inner,
        )(function)
        if inner:
            # Not kept: numba would take the machine code of a function without an entry for that of one with it.
            made.__class__ = _inner(type(made))
            return made
        keep(made, function, cache_folder())
        if signature is not None:
            made.compile(signature)
            made.disable_compile()
        if isinstance(python_entry, tuple):
            made.compile(python_entry)
        return made

    return decorate


def _inner(dispatcher: type) -> type:
    """Class of compiled functions without an entry for Python, which calls what they were instead of crashing."""

    def call(self: Any, *arguments: Any) -> Any:
        return self.py_func(*arguments)

    return type("Inner", (dispatcher,), {"__call__": call})

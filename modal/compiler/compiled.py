"""The one decorator for compiled kernels: numba with a cache that cannot go stale.

Numba keys its cache on the file that holds a function, not on the files of the functions it calls, so a
change in one module would leave old machine code in use in another. Here the cache folder is named after
a digest of all sources of the rooms with kernels instead: any change there starts a fresh one.
"""

from __future__ import annotations

import hashlib
import os
import tempfile
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

ROOMS = "modal", "towercrane/kernels", "towercrane/simulation", "towercrane/cranes"
"""Folders with kernels, or with what they read, in them or below."""


class CacheWarning(UserWarning):
    """Machine code could not be kept, or had to be made anew."""


class NoCompiler(RuntimeError):
    """Numba is told not to compile."""


@cache
def cache_folder() -> Path:
    """Folder of the machine code that belongs to exactly these sources, of all folders with kernels."""
    if chosen := os.environ.get("NUMBA_CACHE_DIR"):
        return Path(chosen)
    import platformdirs

    top = Path(__file__).resolve().parents[2]
    digest = hashlib.sha256()
    for room in ROOMS:
        for source in sorted((top / room).rglob("*.py")):
            digest.update(source.read_bytes())
    return Path(platformdirs.user_cache_dir("towercrane", appauthor=False)) / digest.hexdigest()[:16]


@cache
def obstacle(folder: Path) -> str:
    """Why a folder, which is made if need be, cannot keep files; empty if it can."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        os.listdir(folder)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError as error:
        return (error.strerror or str(error)).lower()
    return ""


def is_compiled(module: str) -> bool:
    """Whether machine code of the named module's kernels is in the cache already."""
    *_, room, name = module.split(".")
    return any(cache_folder().glob(f"{room}_*/{name}.*.nbi"))


def kernel(
    signature: Any = None,
    *,
    door: bool | tuple[Any, ...] = False,
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
    door : bool or tuple of numba types
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
    # A door for Python takes longer to compile than many a function behind it.
    inner = signature is None and not (door or inline)

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
            # Not kept: numba would take the machine code of a function without a door for that of one with a door.
            made.__class__ = _inner(type(made))
            return made
        before, config.CACHE_DIR = config.CACHE_DIR, str(cache_folder())
        try:
            keep(made, function, cache_folder())
        finally:
            config.CACHE_DIR = before
        if signature is not None:
            made.compile(signature)
            made.disable_compile()
        if isinstance(door, tuple):
            made.compile(door)
        return made

    return decorate


def _inner(dispatcher: type) -> type:
    """Class of compiled functions without a door: Python, which would crash without it, calls what they were."""

    def call(self: Any, *arguments: Any) -> Any:
        return self.py_func(*arguments)

    return type("Inner", (dispatcher,), {"__call__": call})

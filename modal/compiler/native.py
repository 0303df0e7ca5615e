"""Compiled functions without numba: translated together, module by module, and kept on disk.

Numba takes a third of a minute for the kernels of exact structures, most of it to find out what each value is. Here
their annotations say it, and LLVM optimises what calls each other once.
"""

from __future__ import annotations

import ctypes
import hashlib
import os
import tempfile
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args

import numpy as np

from modal.compiler.files import say, sealed, verified
from modal.compiler.folder import cache_folder, obstacle

if TYPE_CHECKING:
    from collections.abc import Callable

    from llvmlite.binding import TargetMachine

NUMBERS: dict[Any, Any] = {float: ctypes.c_double, int: ctypes.c_int64, bool: ctypes.c_bool, None: None}

_engines: list[Any] = []
"""What holds the code in use."""


def native(name: str, *functions: Callable[..., Any]) -> tuple[Native, ...]:
    """Functions compiled together, see `modal.compiler.translation`, when one is first called from Python.

    They take numbers and arrays, and give a number or nothing.

    Parameters
    ----------
    name : str
        What their machine code is called on disk.
    functions : callable
        Those that Python calls; what they call in their turn is compiled with them.
    """
    together: list[Native] = []
    together += [Native(python, name, together) for python in functions]
    return tuple(together)


class Native:
    """A function that is called as compiled."""

    def __init__(self, python: Callable[..., Any], name: str, together: list[Native]) -> None:
        self.python, self.name, self.together = python, name, together
        self.entry: Any = None
        self.given: list[Callable[[Any], tuple[Any, ...]]] = []

    def __call__(self, *arguments: Any) -> Any:
        """Call it; numbers are turned into its own kinds, arrays must be of them."""
        if self.entry is None:
            _load(self.name, self.together)
        values: list[Any] = []
        for convert, argument in zip(self.given, arguments, strict=True):
            values += convert(argument)
        return self.entry(*values)

    def connect(self, address: int, kinds: dict[str, Any]) -> None:
        """Let Python in at an address."""
        # Put in place at the end: another thread may be doing the same.
        types: list[Any] = []
        given: list[Callable[[Any], tuple[Any, ...]]] = []
        gives = kinds.pop("return")
        for name, kind in kinds.items():
            if get_args(kind):
                _, entry, axes = get_args(kind)
                types += [ctypes.c_void_p] + [ctypes.c_int64] * axes
                given.append(_array(f"{self.python.__name__}: {name}", entry, axes))
            else:
                types.append(NUMBERS[kind])
                given.append(partial(_number, kind))
        self.given = given
        self.entry = ctypes.CFUNCTYPE(NUMBERS[gives], *types)(address)


def _number(kind: type, value: Any) -> tuple[Any]:
    return (kind(value),)


def _array(name: str, entry: str, axes: int) -> Callable[[Any], tuple[int, ...]]:
    wanted = np.dtype({"double": "float64", "whole": "int64"}[entry])

    def given(array: Any) -> tuple[int, ...]:
        flags = array.flags
        if array.dtype != wanted or array.ndim != axes or not flags.c_contiguous:
            raise TypeError(f"{name}: wanted {wanted} in order, {axes} axes, got {array.dtype} {array.shape}")
        # An array takes six times as long to say where it is.
        quick = array.size and flags.writeable
        place = ctypes.addressof(ctypes.c_char.from_buffer(array)) if quick else array.ctypes.data
        return place, *array.shape

    return given


def _load(name: str, together: list[Native]) -> None:
    """Machine code of functions into this process."""
    import llvmlite.binding as llvm

    from modal.compiler.translation import kinds_of

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    machine = llvm.Target.from_default_triple().create_target_machine(
        cpu=llvm.get_host_cpu_name(),
        features=llvm.get_host_cpu_features().flatten(),
        opt=2,
        reloc="default",
        codemodel="jitdefault",
        jit=True,
    )
    code = _kept(name, together, machine)
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), machine)
    engine.add_object_file(llvm.ObjectFileRef.from_data(code))
    engine.finalize_object()
    _engines.append(engine)
    for door in together:
        door.connect(engine.get_function_address(door.python.__name__), kinds_of(door.python))


def _kept(name: str, together: list[Native], machine: TargetMachine) -> bytes:
    """Machine code of functions from the cache, or made and kept there."""
    folder = cache_folder()
    path = folder / "native" / f"{name}.{_digest(machine)}.o"
    reason = obstacle(folder)
    if reason:
        say(f"kernels are compiled each time, for {folder} cannot keep them: {reason}")
        return _compiled(name, together, machine)
    try:
        return verified(str(path))
    except FileNotFoundError:
        pass
    except (OSError, ValueError) as error:
        say(f"damaged machine code in {path.parent} is compiled anew ({error})")
    code = _compiled(name, together, machine)
    try:
        _write(path, sealed(code))
    except OSError as error:
        say(f"machine code cannot be kept in {path.parent}: {(error.strerror or str(error)).lower()}")
    return code


def _write(path: Path, content: bytes) -> None:
    """A file that is whole for whoever sees it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, fresh = tempfile.mkstemp(dir=path.parent)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        os.replace(fresh, path)
    except OSError:
        with suppress(OSError):
            os.unlink(fresh)
        raise


def _digest(machine: TargetMachine) -> str:
    """What machine code hangs on: all sources of this package, the compiler and the processor."""
    import llvmlite.binding as llvm

    digest = hashlib.sha256()
    for source in sorted(Path(__file__).resolve().parents[1].rglob("*.py")):
        digest.update(source.read_bytes())
    host = machine.triple, llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten(), llvm.llvm_version_info
    digest.update(repr(host).encode())
    return digest.hexdigest()[:16]


def _compiled(name: str, together: list[Native], machine: TargetMachine) -> bytes:
    """Object code of functions and of all that they call."""
    import llvmlite.binding as llvm

    from modal.compiler.translation import Library

    library = Library(name, [door.python for door in together])
    library.module.triple = machine.triple
    code = llvm.parse_assembly(str(library.module))
    options = llvm.create_pipeline_tuning_options(2)
    builder = llvm.create_pass_builder(machine, options)
    builder.getModulePassManager().run(code, builder)
    found: bytes = machine.emit_object(code)
    return found

"""Machine code of LLVM modules: made for this processor, kept on disk, put into this process."""

from __future__ import annotations

import hashlib
import os
import tempfile
import threading
from contextlib import suppress
from functools import cache
from typing import TYPE_CHECKING, Any

from modal.compiler.files import say, sealed, verified
from modal.compiler.folder import cache_folder, obstacle

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

OPTIMISED = 2
"""How much LLVM does to a module."""

_one_at_a_time = threading.RLock()


def loaded(name: str, stamp: bytes, module: Callable[[], Any]) -> Any:
    """Engine that holds the machine code of a module, for as long as it is there itself.

    Parameters
    ----------
    name : str
        What its file is called.
    stamp : bytes
        What the module hangs on, besides the compiler and the processor: equal for equal code.
    module : callable
        Gives the module, where its code is not on disk.
    """
    import llvmlite.binding as llvm

    with _one_at_a_time:
        machine, host = _machine()
        digest = hashlib.sha256(stamp + host).hexdigest()[:16]
        code = _kept(f"{name}.{digest}.o", lambda: _compiled(module(), machine))
        # An engine owns what it is made with.
        engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), _target_machine())
        engine.add_object_file(llvm.ObjectFileRef.from_data(code))
        engine.finalize_object()
    return engine


@cache
def _machine() -> tuple[Any, bytes]:
    """What compiles for this processor, and its name with that of the compiler."""
    import llvmlite.binding as llvm

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    machine = _target_machine()
    features = llvm.get_host_cpu_features().flatten()
    return machine, repr((machine.triple, llvm.get_host_cpu_name(), features, llvm.llvm_version_info)).encode()


def _target_machine() -> Any:
    import llvmlite.binding as llvm

    return llvm.Target.from_default_triple().create_target_machine(
        cpu=llvm.get_host_cpu_name(),
        features=llvm.get_host_cpu_features().flatten(),
        opt=OPTIMISED,
        reloc="default",
        codemodel="jitdefault",
        jit=True,
    )


def _compiled(module: Any, machine: Any) -> bytes:
    """Object code of a module."""
    import llvmlite.binding as llvm

    module.triple = machine.triple
    code = llvm.parse_assembly(str(module))
    builder = llvm.create_pass_builder(machine, llvm.create_pipeline_tuning_options(OPTIMISED))
    builder.getModulePassManager().run(code, builder)
    found: bytes = machine.emit_object(code)
    return found


def _kept(file: str, make: Callable[[], bytes]) -> bytes:
    """Machine code from the cache, or made and kept there."""
    folder = cache_folder()
    path = folder / "native" / file
    if reason := obstacle(folder):
        say(f"kernels are compiled each time, for {folder} cannot keep them: {reason}")
        return make()
    try:
        return verified(str(path))
    except FileNotFoundError:
        pass
    except (OSError, ValueError) as error:
        say(f"damaged machine code in {path.parent} is compiled anew ({error})")
    code = make()
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

"""What commands compile before they begin: every module that they need, in a cache that no change leaves stale."""

import importlib.util
import subprocess
import sys
from pathlib import Path

from numba import types

import modal
from modal.compiler import compiled, folder
from towercrane.commands.shared.terminal import USES
from towercrane.kernels.compilation import compile_kernels

TOP = Path(modal.__file__).parents[1]
PACKAGES = [TOP / "modal", TOP / "towercrane"]


def test_kernels_are_in_the_rooms_whose_sources_name_the_cache():
    makers = [
        source.relative_to(TOP).as_posix()
        for package in PACKAGES
        for source in package.rglob("*.py")
        if "compiled import kernel" in source.read_text()
    ]
    assert all(maker.startswith(folder.ROOMS) for maker in makers)
    assert all((TOP / room).is_dir() for room in folder.ROOMS)


def test_a_change_of_a_source_names_another_cache(tmp_path, monkeypatch):
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    for name in ("modal/compiler", "towercrane/kernels"):
        (tmp_path / name).mkdir(parents=True)
    kernel, layout = tmp_path / "modal/roots.py", tmp_path / "towercrane/kernels/layout.py"
    monkeypatch.setattr(folder, "__file__", str(tmp_path / "modal/compiler/folder.py"))
    found = []
    for changed in (kernel, layout, kernel):
        changed.write_text(f"x = {len(found)}\n")
        found.append(folder.cache_folder.__wrapped__())
    assert len(set(found)) == 3
    assert folder.cache_folder.__wrapped__() == found[-1]


def test_all_modules_of_kernels_are_there():
    assert all(importlib.util.find_spec(module) for modules in USES.values() for module in modules)


def test_what_is_compiled_here_or_beside_is_missing_no_more(tmp_path, monkeypatch):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    # This process has compiled its own kernels elsewhere: a fresh one finds them missing, and makes them.
    code = (
        "from towercrane.commands.shared.terminal import USES\n"
        "from towercrane.kernels.compilation import compile_kernels as c, missing_kernels as m\n"
        "modules = USES['lanes']; before = m(*modules); c(*before); print(len(before), len(m(*modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["2", "0"]


def _doubled(x):
    return x + x


def test_what_kernels_call_is_python_to_python_until_it_has_a_door():
    inner, outer = compiled.kernel()(_doubled), compiled.kernel(python_entry=True)(_doubled)
    assert inner("a") == "aa"
    assert not inner.signatures
    assert outer(1.5) == inner(1.5) == 3.0
    assert outer.signatures
    caller = compiled.kernel(types.float64(types.float64))(lambda x: inner(x) + 1.0)
    assert caller(1.5) == 4.0
    assert inner.signatures
    # What a kernel has compiled for itself is no door.
    assert inner(1.5) == 3.0


def test_nothing_beside_starts_no_process(monkeypatch):
    monkeypatch.setattr("multiprocessing.get_context", None)
    compile_kernels("towercrane.kernels.polynomial")

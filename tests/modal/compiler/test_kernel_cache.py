"""Machine code on disk: damaged files are compiled anew, folders that cannot keep any are done without."""

import os
import subprocess
import sys
import warnings
from pathlib import Path

import pytest
from numba import types

from modal.compiler import compiled, files, kernel_cache
from modal.compiler.folder import CacheWarning, obstacle


def doubled(x):
    return x + x


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setattr(compiled, "cache_folder", lambda: tmp_path / "cache")
    monkeypatch.setattr(files, "_said", [])
    return tmp_path / "cache"


def compile_it():
    made = compiled.kernel(types.float64(types.float64))(doubled)
    assert made(1.5) == 3.0
    return sum(made.stats.cache_hits.values())


def emptied(content):
    return b""


def cut_in_half(content):
    return content[: len(content) // 2]


def one_bit_flipped(content):
    middle = len(content) * 3 // 4
    return content[:middle] + bytes([content[middle] ^ 1]) + content[middle + 1 :]


def test_whole_files_are_loaded_without_a_word(folder):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert compile_it() == 0
        assert {path.suffix for path in folder.rglob("*.nb?")} == {".nbi", ".nbc"}
        assert compile_it() == 1


@pytest.mark.parametrize("suffix", [".nbi", ".nbc"])
@pytest.mark.parametrize("damage", [emptied, cut_in_half, one_bit_flipped])
def test_damaged_file_is_compiled_anew_once_and_said(folder, suffix, damage):
    compile_it()
    (path,) = folder.rglob(f"*{suffix}")
    path.write_bytes(damage(path.read_bytes()))
    with pytest.warns(CacheWarning, match="damaged machine code in .* is compiled anew") as said:
        assert compile_it() == 0
    assert len(said) == 1
    assert compile_it() == 1


def test_folder_that_cannot_be_made_is_done_without_and_the_source_s_own_stays_clean(folder):
    folder.write_text("a file", encoding="utf-8")
    beside = Path(__file__).parent / "__pycache__"
    before = set(beside.glob("*.nb?"))
    obstacle.cache_clear()
    with pytest.warns(CacheWarning, match="compiled each time, for .* cannot keep them: file exists"):
        assert compile_it() == 0
    assert compile_it() == 0
    assert set(beside.glob("*.nb?")) == before


def test_full_disk_is_said_and_the_kernel_works(folder, monkeypatch):
    def full(*arguments):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(kernel_cache.KernelFile, "save", full)
    with pytest.warns(CacheWarning, match="cannot be kept in .*: no space left on device"):
        assert compile_it() == 0


def test_switched_off_compiler_is_named():
    code = (
        "from modal.compiler.compiled import kernel, NoCompiler\n"
        "try:\n    kernel()\nexcept NoCompiler as e:\n    print(e)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, env={**os.environ, "NUMBA_DISABLE_JIT": "1"}
    )
    assert done.stdout.startswith("NUMBA_DISABLE_JIT: wanted unset or 0, got 1")

"""The folder that keeps machine code: its name, its rooms, and whether it can keep any.

Numba keys its cache on the file that holds a function, not on the files of the functions it calls, so a
change in one module would leave old machine code in use in another. Here the cache folder is named after
a digest of all sources of the rooms with kernels instead: any change there starts a fresh one.
"""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import tempfile
import time
from contextlib import suppress
from functools import cache
from pathlib import Path

ROOMS = "modal", "towercrane/kernels", "towercrane/simulation"
"""Folders with kernels, or with what they read, in them or below."""

DIGITS = 16
"""Digits of the digest that names a folder."""

KEPT = 30.0
"""Days for which a folder of other sources is kept that nobody uses."""


class CacheWarning(UserWarning):
    """Machine code could not be kept, or had to be made anew."""


@cache
def cache_folder() -> Path:
    """Folder of the machine code that belongs to exactly these sources, of all folders with kernels."""
    if chosen := os.environ.get("NUMBA_CACHE_DIR"):
        return Path(chosen)
    top = Path(__file__).resolve().parents[2]
    digest = hashlib.sha256()
    for room in ROOMS:
        for source in sorted((top / room).rglob("*.py")):
            digest.update(source.read_bytes())
    return _user_cache() / digest.hexdigest()[:DIGITS]


def _user_cache() -> Path:
    import platformdirs

    return Path(platformdirs.user_cache_dir("towercrane", appauthor=False))


@cache
def obstacle(folder: Path) -> str:
    """Why a folder, which is made if need be, cannot keep files; empty if it can."""
    try:
        fresh = not folder.exists()
        folder.mkdir(parents=True, exist_ok=True)
        os.listdir(folder)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError as error:
        return (error.strerror or str(error)).lower()
    with suppress(OSError):
        # Reading leaves no trace of its own.
        os.utime(folder)
    if fresh and folder.parent == _user_cache():
        prune(folder)
    return ""


def prune(folder: Path) -> None:
    """Remove the folders beside this one that hold other sources' machine code and that nobody has used for long."""
    oldest = time.time() - KEPT * 24.0 * 3600.0
    with suppress(OSError):
        for other in folder.parent.iterdir():
            is_code = re.fullmatch(f"[0-9a-f]{{{DIGITS}}}", other.name) and other.is_dir()
            if is_code and other != folder and other.stat().st_mtime < oldest:
                shutil.rmtree(other, ignore_errors=True)


def is_compiled(module: str) -> bool:
    """Whether machine code of the named module's kernels is in the cache already."""
    *_, room, name = module.split(".")
    return any(cache_folder().glob(f"{room}_*/{name}.*.nbi"))

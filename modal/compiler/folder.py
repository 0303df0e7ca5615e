"""The folder that keeps machine code: its name, its rooms, and whether it can keep any.

It is named after a digest of all sources of the rooms with kernels: any change there starts a fresh one.
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

TOP = Path(__file__).resolve().parents[2]
"""Folder of the packages."""

ROOMS = "modal", "towercrane/kernels", "towercrane/simulation"
"""Folders with kernels, or with what they read, in them or below."""

DIGITS = 16
"""Digits of the digest that names a folder."""

CHOSEN = "TOWERCRANE_CACHE_DIR"
"""Variable of the environment that names another folder."""

KEPT = 30.0
"""Days for which a folder of other sources is kept that nobody uses."""


class CacheWarning(UserWarning):
    """Machine code could not be kept, or had to be made anew."""


@cache
def cache_folder() -> Path:
    """Folder of the machine code that belongs to exactly these sources, of all folders with kernels."""
    if chosen := os.environ.get(CHOSEN):
        return Path(chosen)
    return _user_cache() / sources(*ROOMS).hex()[:DIGITS]


@cache
def sources(*rooms: str) -> bytes:
    """Digest of all sources in some folders of the program and below."""
    digest = hashlib.sha256()
    for room in rooms:
        for source in sorted((TOP / room).rglob("*.py")):
            digest.update(source.read_bytes())
    return digest.digest()


def room_of(file: str) -> str:
    """Which of the rooms a source is in; of another its folder."""
    path = Path(file).resolve()
    inside = (room for room in ROOMS if path.is_relative_to(TOP / room))
    return next(inside, str(path.parent))


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

"""The folder of a run: what may stand in it, and how it gets there whole."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping
    from pathlib import Path

RUN_FILES = (
    "result.nc", "summary.json", "result.csv", "overview.png", "motion.png", "swing.png", "phase.png", "tower.png",
    "jib.png", "spectrum.png", "modes.png", "sway.png", "moments.png", "torque.png", "angles.png", "path.png",
    "plan.png", "torques.png",
)  # fmt: skip
"""Everything that a run may write."""


def obstacle(folder: Path) -> str:
    """Why results cannot be written to a folder, which need not exist yet; empty if they can."""
    existing = folder
    while not existing.exists():
        existing = existing.parent
    if not existing.is_dir():
        return f"wanted a folder, {existing} is a file"
    return "" if os.access(existing, os.W_OK) else f"no right to write in {existing}"


def write(folder: Path, files: Mapping[str, Any]) -> None:
    """Put data sets (.nc, .csv), figures (.png) and text in place, each file whole.

    Raises
    ------
    OSError
        If one cannot be written; those before it are whole, and an old file in its place stays.
    """
    from towercrane import results
    from towercrane.plots import style

    for name, content in files.items():
        path = folder / name
        match path.suffix:
            case ".nc":
                results.save(content, path)
            case ".csv" if not isinstance(content, str):
                results.save_csv(content, path)
            case ".png":
                style.save(content, path)
            case _:
                results.write_text(content, path)


def remove_stale(folder: Path, written: Collection[str]) -> list[str]:
    """Take away files that an earlier run left and this one did not replace: they would show another result."""
    stale = [name for name in RUN_FILES if name not in written and (folder / name).is_file()]
    for name in stale:
        (folder / name).unlink()
    return stale

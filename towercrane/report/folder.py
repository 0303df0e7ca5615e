"""The folder of a command's files: what may stand in it, how they get there whole, and which of them are its own."""

from __future__ import annotations

import hashlib
import json
import os
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping
    from pathlib import Path

RUN_FILES = (
    "result.nc", "summary.json", "result.csv", "overview.png", "motion.png", "swing.png", "phase.png", "tower.png",
    "jib.png", "spectrum.png", "modes.png", "sway.png", "moments.png", "torque.png", "angles.png", "path.png",
    "plan.png", "torques.png", "base.png", "wind.png", "ground.png", "collars.png",
)  # fmt: skip
"""Everything that a run may write."""

SUMMARY = "summary.json"
"""File of a run that records what else it wrote."""


def obstacle(folder: Path, names: Collection[str] = ()) -> str:
    """Why files of these names cannot be written to a folder, which need not exist yet; empty if they can."""
    existing = folder
    while not os.path.lexists(existing):
        existing = existing.parent
    if not existing.exists():
        return f"wanted a folder, {existing} is a link that leads nowhere"
    if not existing.is_dir():
        return f"wanted a folder, {existing} is a file"
    if not os.access(existing, os.W_OK | os.X_OK):
        return f"no right to write in {existing}"
    taken = next((folder / name for name in names if (folder / name).is_dir()), None)
    return f"wanted a file, {taken} is a folder" if taken else ""


def write(folder: Path, files: Mapping[str, Any]) -> None:
    """Put data sets (.nc, .csv), figures (.png) and text in place, all of them or none.

    Raises
    ------
    OSError
        If one cannot be written; the old files stay.
    """
    with ExitStack() as stack:
        for name, content in files.items():
            _stage(stack, folder / name, content)


def write_run(folder: Path, files: Mapping[str, Any], summary: dict[str, Any]) -> tuple[str, list[str]]:
    """Put a run's files and its summary in place, all or none; take away what an earlier run left and recorded.

    A file that an earlier run wrote and this one does not replace would show another result. One that has changed
    since is somebody's own.

    Returns
    -------
    text : str
        The summary as it was written, with the digests of the other files in ``files``.
    removed : list of str
        Names of the files taken away.
    """
    earlier = {name: digest for name, digest in _recorded(folder).items() if name not in files}
    with ExitStack() as stack:
        staged = {name: _stage(stack, folder / name, content) for name, content in files.items()}
        digests = {name: _digest(path) for name, path in staged.items()}
        text = json.dumps({**summary, "files": digests}, indent=2, allow_nan=False)
        _stage(stack, folder / SUMMARY, text + "\n")
    removed = [name for name, digest in earlier.items() if _digest(folder / name) == digest]
    for name in removed:
        (folder / name).unlink()
    return text, removed


def _stage(stack: ExitStack, path: Path, content: Any) -> Path:
    """Write a temporary file that takes its place as the stack ends well."""
    from towercrane.results import files as results

    temporary = stack.enter_context(results.replacing(path))
    match path.suffix:
        case ".nc":
            results.put(content, temporary)
        case ".csv" if not isinstance(content, str):
            results.put_csv(content, temporary)
        case ".png":
            from towercrane.report.plots import style

            style.put(content, temporary)
        case _:
            temporary.write_text(content, encoding="utf-8")
    return temporary


def _recorded(folder: Path) -> dict[str, str]:
    """Digests of the files that an earlier run says it wrote."""
    try:
        files = json.loads((folder / SUMMARY).read_text("utf-8"))["files"]
        return {name: files[name] for name in RUN_FILES if name in files}
    except (OSError, ValueError, LookupError, TypeError, RecursionError):
        return {}


def _digest(path: Path) -> str:
    """Digest of a file's content; empty where there is none."""
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError:
        return ""

"""TOML files as they are read: their size, depth and syntax, and what of a bad one may be shown."""

from __future__ import annotations

import re
import tomllib
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from towercrane.schema.faults import CaseError, Fault, shown

if TYPE_CHECKING:
    from collections.abc import Set
    from pathlib import Path

DEEPEST = 20
"""Tables and lists within each other; a case has a handful."""

LARGEST = 4 * 2**20
"""Bytes of a case or a crane file; those that ship with the program have a few thousand."""


def read_toml(path: Path, known: Set[str] = frozenset()) -> dict[str, Any]:
    """Parse a TOML file.

    Parameters
    ----------
    path : Path
    known : set of str
        Every dotted key of a case: of a text that cannot be parsed a line is shown if it has no other tables.

    Raises
    ------
    CaseError
        If the file cannot be opened, is not UTF-8 or not TOML.
    """
    wanted = "a TOML file"
    try:
        with path.open("rb") as file:
            data = file.read(LARGEST + 1)
        if len(data) > LARGEST:
            raise CaseError([Fault(str(path), "", f"{wanted} of at most {LARGEST} bytes", "a larger one")])
        content = data.decode("utf-8-sig")
    except OSError as error:
        raise CaseError([Fault(str(path), "", wanted, (error.strerror or "no file").lower())]) from None
    except UnicodeDecodeError as error:
        got = f"a byte that is not UTF-8 at position {error.start}"
        raise CaseError([Fault(str(path), "", wanted, got, "save the file with the encoding UTF-8")]) from None
    try:
        return {name: _copied(item) for name, item in _parsed(content).items()}
    except (ValueError, RecursionError) as error:
        raise CaseError([_syntax_fault(path, content, error, known)]) from None


@lru_cache(8)
def _parsed(content: str) -> dict[str, Any]:
    """What a text says; many runs of a case read the same two files."""
    return tomllib.loads(content)


def _copied(node: Any) -> Any:
    """Tables and lists that may be changed."""
    if isinstance(node, dict):
        return {name: _copied(item) for name, item in node.items()}
    return [_copied(item) for item in node] if isinstance(node, list) else node


def is_deep(tree: Any) -> bool:
    """Whether tables and lists lie so deep within each other that a walk through them would not end well."""
    level = [tree] if isinstance(tree, dict | list) else []
    for _ in range(DEEPEST):
        level = [item for node in level for item in (node.values() if isinstance(node, dict) else node)]
        level = [item for item in level if isinstance(item, dict | list)]
    return bool(level)


def is_file(path: Path) -> bool:
    """Whether a file is there; a name that no file can have is none."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def _syntax_fault(path: Path, content: str, error: Exception, known: Set[str]) -> Fault:
    message = str(error)
    at = re.search(r"\s*\(at line (\d+), column (\d+)\)", message)
    if not at:
        where = "end of file" if "end of document" in message else ""
        return Fault(str(path), where, "TOML", message.split(" (at")[0] or "unreadable text")
    line = content.splitlines()[int(at[1]) - 1 : int(at[1])]
    written = line[0].strip() if line else ""
    hint = ""
    if re.search(r"=\s*[-+.\d]+\s*[A-Za-z°%]", written) or re.search(r"=\s*[A-Za-z]", written):
        hint = 'text and quantities with a unit stand in quotes: mass = "800 kg"'
    elif "Cannot overwrite" in message or "Cannot declare" in message:
        hint = "the same key or table stands in the file twice"
    said = message[: at.start()]
    if _is_ours(content, known):
        said = f"{said}: {shown(written)}"
    else:
        # Any file that the program can read may have been named: neither its lines nor its keys are shown.
        said = re.sub(r"\s+(\(.*\)|'[^='\]\\]+')", "", said)
    return Fault(str(path), f"line {at[1]}, column {at[2]}", "TOML", said, hint)


def _is_ours(content: str, known: Set[str]) -> bool:
    """Whether all tables of a text that cannot be parsed are those of a case or a crane."""
    tables = {name for key in known for name in (key, key.removeprefix("crane."))}
    headings = re.findall(r"^\s*\[+\s*([^\[\]]*?)\s*\]+", content, re.MULTILINE)
    return bool(headings) and tables.issuperset(headings)

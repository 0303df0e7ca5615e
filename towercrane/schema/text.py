"""Text of a case: its file, the crane file it names and the overrides, merged before anything is checked."""

from __future__ import annotations

import os
import tomllib
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from towercrane.schema.faults import CaseError, Fault, did_you_mean, shown
from towercrane.schema.toml_files import DEEPEST, is_deep, is_file, read_toml

if TYPE_CHECKING:
    from collections.abc import Sequence, Set
    from pathlib import Path


@dataclass
class CaseText:
    """A case as written, with its crane in place and overrides applied.

    Parameters
    ----------
    path : Path
        Case file.
    tree : dict
        Merged TOML.
    crane_path : Path or None
        File that the crane came from; None for an inline crane.
    origins : dict
        Override that set a key or created a table, by dotted key.
    faults : list of Fault
        What went wrong on the way.
    """

    path: Path
    tree: dict[str, Any]
    crane_path: Path | None = None
    origins: dict[str, str] = field(default_factory=dict)
    faults: list[Fault] = field(default_factory=list)

    def located(self, fault: Fault) -> Fault:
        """The fault with the file it is in, and its key as seen from there."""
        if fault.file:
            return fault
        parts = fault.key.split(".")
        for count in range(len(parts), 0, -1):
            origin = self.origins.get(".".join(parts[:count]))
            if origin:
                return replace(fault, file=f"--set {origin}")
        if self.crane_path and fault.key.startswith("crane."):
            key, named = fault.key.removeprefix("crane."), fault.wanted.replace("[crane.", "[")
            return replace(fault, file=str(self.crane_path), key=key, wanted=named)
        return replace(fault, file=str(self.path))


def read_case(path: Path, overrides: Sequence[str], known: Set[str]) -> CaseText:
    """Read a case file, the crane file it names and the overrides.

    Parameters
    ----------
    path : Path
    overrides : sequence of str
        ``key=value`` each.
    known : set of str
        Every dotted key that some kind of case knows. A file without any is no case, and nothing of it is shown.

    Raises
    ------
    CaseError
        If the case file cannot be read at all; lesser faults are collected in the result.
    """
    text = CaseText(path, read_toml(path, known))
    if not text.tree:
        sections = "crane, [payload], [rope], [motion.trolley], [run]"
        raise CaseError([Fault(str(path), "", f"a case: {sections}", "an empty file")])
    if "crane" not in text.tree and {"tower", "jib"} & set(text.tree):
        hint = 'a case names its crane: crane = "crane.toml"'
        raise CaseError([Fault(str(path), "", "a case: crane, [payload], [rope], ...", "a crane file", hint)])
    if known.isdisjoint(text.tree):
        # This is some other file, of which nothing is shown.
        wanted = "a case: crane, [payload], [rope], [motion.trolley], [run]"
        raise CaseError([Fault(str(path), "", wanted, "a file without any of its keys")])
    settings = [s for s in (_setting(text, o) for o in overrides) if s]
    if any(is_deep(value) for _, value, _ in settings) or is_deep(text.tree):
        wanted, hint = f"tables and lists up to {DEEPEST} within each other", "no key of a case lies so deep"
        raise CaseError([Fault(str(path), "", wanted, "deeper ones", hint)])
    for key, value, origin in settings:
        if not key.startswith("crane."):
            _put(text, key, value, origin)
    _read_crane(text, known)
    for key, value, origin in settings:
        if key.startswith("crane."):
            _put(text, key, value, origin)
    return text


def in_utf8(override: str) -> str:
    """An override whose bytes were no text where the terminal's encoding is another.

    Raises
    ------
    CaseError
        If it is not UTF-8 either.
    """
    try:
        override.encode()
    except UnicodeEncodeError:
        with suppress(UnicodeError):
            return os.fsencode(override).decode()
        raise CaseError([Fault(f"--set {override}", "", "text in UTF-8", shown(override))]) from None
    return override


def _setting(text: CaseText, override: str) -> tuple[str, Any, str] | None:
    """Key, value and wording of an override."""
    key, sign, written = override.partition("=")
    key, written = key.strip(), written.strip()
    if not (sign and key and all(key.split(".")) and key.count(".") < DEEPEST):
        hint = 'for example payload.mass="1200 kg"'
        text.faults.append(Fault(f"--set {override}", "", "key=value", shown(override), hint))
        return None
    try:
        value = tomllib.loads(f"value = {written}")
    except (ValueError, RecursionError):
        value = {}
    return key, value["value"] if set(value) == {"value"} else written, f"{key}={written}"


def _put(text: CaseText, key: str, value: Any, origin: str) -> None:
    """Set a dotted key, creating tables on the way."""
    *parents, last = key.split(".")
    place: Any = text.tree
    for depth, name in enumerate(parents, start=1):
        path, following = ".".join(parents[:depth]), key.split(".")[depth]
        if isinstance(place, list):
            if (index := _index(name, place)) is None:
                text.faults.append(_off_the_list(origin, path, place, name))
                return
            place = place[index]
        elif isinstance(place, dict):
            if name not in place and following.isdecimal():
                hint = f"nothing there has the index {following} to be changed"
                text.faults.append(Fault(f"--set {origin}", path, f"a list, such as [[{path}]]", "none", hint))
                return
            if name not in place:
                place[name] = {}
                text.origins[path] = origin
            place = place[name]
        if not isinstance(place, dict | list):
            if path != "crane":  # a crane file that could not be read has its own fault
                text.faults.append(Fault(f"--set {origin}", path, "a table", shown(place)))
            return
    if isinstance(place, dict):
        place[last] = value
        text.origins[key] = origin
    elif (index := _index(last, place)) is not None:
        place[index] = value
        text.origins[key] = origin
    else:
        text.faults.append(_off_the_list(origin, key, place, last))


def _off_the_list(origin: str, key: str, place: list[Any], name: str) -> Fault:
    return Fault(f"--set {origin}", key, f"an index below {len(place)}", shown(name), "the first has index 0")


def _index(name: str, items: list[Any]) -> int | None:
    """Place in a list that a part of a key names; None if there is none."""
    # Python refuses to read numbers of more than 4300 digits.
    index = int(name) if name.isdecimal() and len(name) < 10 else len(items)
    return index if index < len(items) else None


def _read_crane(text: CaseText, known: Set[str]) -> None:
    """Put the crane file's content in place of its name."""
    name = text.tree.get("crane")
    if name is None or isinstance(name, dict):
        return
    if not isinstance(name, str):
        text.faults.append(Fault("", "crane", 'a file name, such as "crane.toml", or a table', shown(name)))
        return
    path = text.path.parent / name
    if not is_file(path):
        files = sorted(p.name for p in text.path.parent.glob("*.toml") if p != text.path)
        hint = did_you_mean(name, files, "the path is relative to the case file")
        got = f"{shown(name)}: {'no regular file' if os.path.lexists(path) else 'no such file'}"
        text.faults.append(Fault("", "crane", "the name of a crane file", got, hint))
        return
    try:
        crane = read_toml(path, known)
    except CaseError as error:
        text.faults += error.faults
        return
    if not crane:
        wanted = "a crane: name, [tower], [jib], [counter_jib], [trolley]"
        text.faults.append(Fault(str(path), "", wanted, "an empty file"))
        return
    if known.isdisjoint(f"crane.{key}" for key in crane):
        # This is some other file, of which nothing is shown.
        wanted = "a crane: name, [tower], [jib], [counter_jib], [trolley]"
        text.faults.append(Fault(str(path), "", wanted, "a file without any table of a crane"))
        return
    if "crane" in crane:
        wanted, hint = "a crane file: name, [tower], [jib], ...", "the case itself goes to the command line"
        text.faults.append(Fault(str(path), "", wanted, "a case file, which names a crane itself", hint))
        return
    text.tree["crane"], text.crane_path = crane, path


def leaves(node: Any, key: str = "") -> list[tuple[str, Any]]:
    """Dotted key and value of everything that is neither table nor list."""
    if not isinstance(node, dict | list):
        return [(key, node)]
    items = node.items() if isinstance(node, dict) else enumerate(node)
    return [leaf for name, item in items for leaf in leaves(item, f"{key}.{name}" if key else str(name))]

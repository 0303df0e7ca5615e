"""Cases that ship with the program, and the file that a case's name means."""

from __future__ import annotations

import os
from pathlib import Path

from towercrane.schema.faults import CaseError, Fault, closest
from towercrane.schema.toml_files import is_file, read_toml


def case_folder() -> Path:
    """Folder of the shipped cases: inside the installed package, or beside it in a source checkout."""
    package = Path(__file__).parents[1]
    installed = package / "_cases"
    return installed if installed.is_dir() else package.parent / "cases"


def list_cases() -> list[tuple[str, str]]:
    """Name and title of every shipped case."""
    cases = []
    for path in case_folder().rglob("*.toml"):
        content = read_toml(path)
        if "crane" in content:
            cases.append((case_name(path), str(content.get("title", ""))))
    return sorted(cases)


def find_case(path: Path) -> Path:
    """The case file that a path or a shipped case's name means."""
    shipped = case_folder() / path
    for candidate in (path, shipped, Path(f"{shipped}.toml")):
        if is_file(candidate):
            return candidate
    wanted = "a case file or the name of a shipped case"
    if os.path.isdir(path):
        inside = ", ".join(sorted(p.name for p in path.glob("*.toml")))
        raise CaseError([Fault(str(path), "", wanted, "a folder", f"it holds {inside}" if inside else "")])
    if os.path.lexists(path):
        raise CaseError([Fault(str(path), "", wanted, "no regular file")])
    names = [name for name, _ in list_cases()]
    by_end = {name.rpartition("/")[2]: name for name in names}
    asked = path.as_posix().removesuffix(".toml")
    near = closest(asked, names) or by_end.get(closest(path.stem, by_end) or "")
    hint = f'closest shipped case: "{near}"' if near else f"shipped cases: {', '.join(names)}"
    raise CaseError([Fault(str(path), "", wanted, "no such file", hint)])


def case_name(path: Path) -> str:
    """Name of a case: its path in the folder of the shipped ones, or its file's name; without the ending."""
    folder = case_folder().resolve()
    full = path.resolve()
    name = (full.relative_to(folder) if full.is_relative_to(folder) else Path(full.name)).with_suffix("").as_posix()
    # A file's name may be bytes that are no text; what is written about it is text.
    return name.encode("utf-8", "backslashreplace").decode()

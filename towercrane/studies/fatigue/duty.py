"""Duty files: what a working day consists of, and how its cycles are judged."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from towercrane.schema.faults import CaseError, Fault, did_you_mean, shown
from towercrane.schema.toml_files import read_toml
from towercrane.studies.fatigue.counting import COUNTINGS
from towercrane.studies.fatigue.study import Spectra

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

KEYS = (
    "title", "operations", "days", "outputs", "exponents", "reference_cycles", "counting", "standard", "classes",
)  # fmt: skip
OPERATION = ("run", "case", "set", "count")

WORDS: dict[Any, str] = {
    str: "a text in quotes",
    dict: "a table",
    list: "a list in brackets",
}


@dataclass(frozen=True)
class Task:
    """One operation: a finished run, or a case with changes.

    Parameters
    ----------
    count : float
        How often it occurs in a day.
    run : Path or None
        A result file, or the folder of one.
    case : str
        File or name of a case; empty for a run.
    changes : tuple of str
        ``key=value`` each.
    """

    count: float = 1.0
    run: Path | None = None
    case: str = ""
    changes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Duty:
    """A day's work.

    Parameters
    ----------
    title : str
    tasks : tuple of Task
    outputs : tuple of str
        Those that are counted; empty: all forces and moments that change.
    spectra : Spectra
    """

    title: str
    tasks: tuple[Task, ...]
    outputs: tuple[str, ...] = ()
    spectra: Spectra = field(default_factory=Spectra)


def is_duty(path: Path) -> bool:
    """Whether a file is there that states operations."""
    if path.suffix != ".toml" or not path.is_file():
        return False
    try:
        return "operations" in read_toml(path)
    except CaseError:
        # Who reads it as a case says what is wrong.
        return False


def read_duty(path: Path) -> Duty:
    """Read a duty file; runs and cases are beside it, cases also shipped ones.

    Raises
    ------
    CaseError
        With every fault of the file.
    """
    tree, faults = read_toml(path), []

    def fault(key: str, wanted: str, got: object, hint: str = "") -> None:
        faults.append(Fault(str(path), key, wanted, got if isinstance(got, str) else shown(got), hint))

    def known(table: dict[str, Any], keys: tuple[str, ...], prefix: str = "") -> None:
        for key in table:
            if key not in keys:
                got = f'the unknown key "{key}"'
                fault(prefix + key, f"one of the keys {', '.join(keys)}", got, did_you_mean(key, keys))

    def typed(table: dict[str, Any], key: str, kind: type, default: Any, prefix: str = "") -> Any:
        value = table.get(key, default)
        if isinstance(value, kind):
            return value
        fault(prefix + key, WORDS[kind], shown(value))
        return default

    def number(value: object, key: str, fits: Callable[[float], bool], wanted: str) -> float:
        if isinstance(value, int | float) and not isinstance(value, bool) and fits(value) and value < float("inf"):
            return float(value)
        fault(key, wanted, shown(value))
        return 1.0

    known(tree, KEYS)
    operations = typed(tree, "operations", list, [])
    if not operations:
        fault("operations", "tables [[operations]], one or more", "none")
    tasks = []
    for place, own in enumerate(operations):
        prefix = f"operations.{place}."
        if not isinstance(own, dict):
            fault(prefix[:-1], "a table [[operations]]", own)
            continue
        known(own, OPERATION, prefix)
        if ("run" in own) == ("case" in own):
            got = "both" if "run" in own else "neither"
            fault(prefix[:-1], 'either run = "results/..." or case = "..."', got)
        count = number(own.get("count", 1.0), f"{prefix}count", lambda value: value >= 0.0, "a number from 0")
        run, case = (typed(own, key, str, "", prefix) for key in ("run", "case"))
        changes = typed(own, "set", list, [], prefix)
        if run and changes:
            fault(f"{prefix}set", "changes of a case", "changes of a finished run")
        tasks.append(Task(count, path.parent / run if run else None, _beside(path, case), tuple(map(str, changes))))
    told = Spectra()
    exponents = typed(tree, "exponents", list, list(told.exponents))
    classes = typed(tree, "classes", dict, dict(told.classes))
    counting = typed(tree, "counting", str, told.counting)
    if counting not in COUNTINGS:
        fault("counting", f"one of {', '.join(COUNTINGS)}", counting, did_you_mean(counting, COUNTINGS))
    positive, limits = "a number above 0", []
    for name, most in classes.items():
        limits.append(number(most, f"classes.{name}", lambda value: value > 0.0, positive))
    if any(first >= second for first, second in pairwise(limits)):
        fault("classes", "limits that ascend", "others")
    spectra = replace(
        told,
        days=number(tree.get("days", 1.0), "days", lambda value: value > 0.0, positive),
        exponents=tuple(
            number(own, "exponents", lambda value: 1.0 <= value <= 20.0, "numbers from 1 to 20") for own in exponents
        ),
        reference_cycles=number(
            tree.get("reference_cycles", told.reference_cycles),
            "reference_cycles",
            lambda value: value > 0.0,
            positive,
        ),
        counting=counting,
        classes=dict(zip(classes, limits, strict=True)),
        standard=typed(tree, "standard", str, told.standard if "classes" not in tree else "as the duty file states"),
    )
    title = typed(tree, "title", str, path.stem)
    outputs = tuple(map(str, typed(tree, "outputs", list, [])))
    if faults:
        raise CaseError(faults)
    return Duty(title, tuple(tasks), outputs, spectra)


def _beside(path: Path, case: str) -> str:
    """A case's file beside a duty file, or what was written: the name of a shipped case."""
    beside = path.parent / case
    return str(beside) if case and beside.is_file() else case

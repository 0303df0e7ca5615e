"""What commands on a case do alike: load and check, refuse, compile, write, print, name the next useful command."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import typer

from towercrane.commands.shared.terminal import (
    ENDED_EARLY,
    NOT_AS_EXPECTED,
    fail,
    folder_for_results,
    load,
    options_of,
    say,
    suggest,
    tell,
    write,
)
from towercrane.simulation.outcomes import FINISHED

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Mapping, Sequence

    from towercrane.cases.case import Case
    from towercrane.simulation.system import NoEquilibrium


@dataclass
class Task:
    """A case that a command works on.

    Parameters
    ----------
    name : str
        Case as it was typed.
    changes : list of str
        As they were typed after ``--set``.
    case : Case
    as_json : bool
        Whether JSON is wanted instead of tables.
    folder : Path or None
        Where files go; None where nothing is written.
    """

    name: str
    changes: list[str]
    case: Case
    as_json: bool = False
    folder: Path | None = None

    def serves(self, use: str) -> bool:
        """Whether the case's kind can be used for it, see :class:`towercrane.cranes.kind.Kind`."""
        return self.case.kind in kinds_for(use) and not self.refusal(use)

    def refusal(self, use: str) -> str:
        """Why a case of a kind that can be used so cannot; nothing where it can."""
        from towercrane.cranes.registry import KINDS

        return KINDS[self.case.kind].refusal(use, self.case.checked)

    def need(self, use: str, lacking: str) -> None:
        """Refuse a case of a kind that cannot be used so; ``lacking`` is what cranes without beams do not have."""
        kind = self.case.kind
        self.allow(use)
        if self.serves(use):
            return
        self.refuse(f"a crane of kind {kind!r} has no {lacking}; try: towercrane linearise {self.name}")

    def allow(self, use: str) -> None:
        """Refuse a case that cannot be used so though others of its kind can."""
        if why := self.refusal(use):
            self.refuse(f"{why}; try: towercrane linearise {self.name}")

    def refuse(self, why: str) -> NoReturn:
        """End with what is wrong with the case."""
        fail(f"{self.name}: {why}")

    def say_notices(self) -> None:
        """Tell what the case's tables do that nobody would expect."""
        from towercrane.cases.table_notices import table_notices

        for notice in table_notices(self.case):
            say(f"note: {notice}")

    def into(self, out: Path | None, purpose: str = "", names: Collection[str] = ()) -> None:
        """Put files of these names into a folder, that of the case and the purpose where none is wanted."""
        ending = f"-{purpose}" if purpose else ""
        self.folder = out if out is not None else Path("results") / f"{self.case.name}{ending}"
        folder_for_results(self.folder, names)

    def spare(self, earlier: str) -> None:
        """Put a part of a result beside the folder where that holds a file of an earlier, whole one."""
        if self.folder is not None and (self.folder / earlier).exists():
            self.folder = self.folder.with_name(f"{self.folder.name}-interrupted")

    def command(self, command: str, *more: str) -> tuple[str, ...]:
        """A command on the same case with the same changes."""
        return (command, self.name, *options_of(self.changes), *more)

    def finish(
        self,
        report: dict[str, Any],
        tables: Callable[[dict[str, Any]], None],
        following: Sequence[str],
        files: Mapping[str, Any] | None = None,
        written: str = "",
    ) -> None:
        """Write files, print the report, name the next command; ``written`` is said instead of the files' names."""
        finish(report, tables, following, files, folder=self.folder, as_json=self.as_json, written=written)


def begin(
    name: str,
    changes: list[str] | None,
    *,
    as_json: bool = False,
    notices: bool = False,
    read: Callable[[str, list[str]], Case] = load,
) -> Task:
    """Load and check a case; say its notices where no report does."""
    changes = changes or []
    task = Task(name, changes, read(name, changes), as_json)
    if notices:
        task.say_notices()
    return task


def finish(
    report: dict[str, Any],
    tables: Callable[[dict[str, Any]], None],
    following: Sequence[str],
    files: Mapping[str, Any] | None = None,
    *,
    folder: Path | None,
    as_json: bool,
    written: str = "",
) -> None:
    """Write files, print the report as JSON or as tables, name the next useful command."""
    if folder is not None and files:
        write(folder, files)
    if as_json:
        tell(as_text(report))
        return
    tables(report)
    if folder is not None and files:
        tell(f"written to {folder}: {written or ', '.join(files)}")
    suggest(*following)


def as_text(report: Any) -> str:
    """A report as JSON, which has no infinity: what is not finite becomes text."""
    return json.dumps(_finite(report), indent=2, allow_nan=False)


def kinds_for(use: str) -> tuple[str, ...]:
    """Kinds of case that can be used so."""
    from towercrane.cranes.registry import serving

    return serving(use)


def either(use: str) -> str:
    """Kinds of case that can be used so, in words."""
    return " or ".join(map(repr, kinds_for(use)))


def no_equilibrium(failure: NoEquilibrium) -> NoReturn:
    """End where the crane cannot stand."""
    say(f"{failure.outcome}: {failure}")
    raise typer.Exit(ENDED_EARLY) from None


def end_of_run(expected: dict[str, Any] | None, outcome: str, end: float) -> None:
    """End with what a run has missed of what its case expects, or with its outcome unless it has finished."""
    if expected and not expected["met"]:
        say("\n".join(expected["misses"]))
        raise typer.Exit(NOT_AS_EXPECTED)
    if outcome != FINISHED:
        say(f"the run ended at {end:.6g} s: {outcome}")
        raise typer.Exit(ENDED_EARLY)


def _finite(node: Any) -> Any:
    """The report with what is not finite as text."""
    if isinstance(node, dict):
        return {key: _finite(item) for key, item in node.items()}
    if isinstance(node, list | tuple):
        return [_finite(item) for item in node]
    return str(node) if isinstance(node, float) and not abs(node) < float("inf") else node

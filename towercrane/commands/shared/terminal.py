"""What the commands share at the terminal: options, exit codes, messages, the folder of results."""

from __future__ import annotations

import signal
import sys
import threading
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn, TypeVar

import typer

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterator, Mapping

    import xarray as xr

    from towercrane.cases.case import Case

Found = TypeVar("Found")

NOT_AS_EXPECTED, BAD_INPUT, ENDED_EARLY, INTERRUPTED = 1, 2, 3, 130
"""Exit codes besides 0: not what a case or a benchmark expects; bad input; the run ended before its time with a named
outcome; Ctrl-C."""

CaseName = Annotated[str, typer.Argument(metavar="CASE", help="A case file, or the name of a shipped case.")]
Changes = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help='Change a key, e.g. --set payload.mass="1200 kg".'),
]


def path_of(text: str) -> Path:
    """A path as it was typed; an empty name, which an unset variable leaves, is not the current folder."""
    if not text:
        raise typer.BadParameter("wanted a name, got an empty one")
    return Path(text)


def out_option(what: str, metavar: str = "DIR") -> Any:
    """Where a command puts its files."""
    return typer.Option("--out", metavar=metavar, help=what, parser=path_of)


Out = Annotated[Path | None, out_option("Folder for the results.")]
Pictures = Annotated[bool, typer.Option(help="Draw the pictures.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON instead of tables.")]


def load(name: str, changes: list[str] | None) -> Case:
    """Read and check a case."""
    from towercrane.cases.case import load_case

    return load_case(name, changes or [])


def load_run(path: str) -> xr.Dataset:
    """Read and check the result file of a run."""
    from towercrane.results import files as results
    from towercrane.results.result_file import check_run

    try:
        result = results.load(path)
    except FileNotFoundError:
        fail(f"{path}: wanted a case or a result.nc, got no file")
    except (OSError, ValueError, RuntimeError, KeyError) as error:
        fail(f"{path}: wanted a result.nc of `towercrane run`, got a file that cannot be read: {error}")
    try:
        check_run(result)
    except ValueError as error:
        fail(f"{path}: {error}")
    return result


@contextmanager
def held_interrupts() -> Iterator[Callable[[], None]]:
    """Keep Ctrl-C until the caller asks: libraries turn one that meets them in their own code into other errors.

    Yields
    ------
    callable
        Raises KeyboardInterrupt if there was one; asked once more at the end.
    """
    caught: list[int] = []

    def ask() -> None:
        if caught:
            raise KeyboardInterrupt

    if threading.current_thread() is not threading.main_thread():
        yield ask
        return
    before = signal.signal(signal.SIGINT, lambda number, frame: caught.append(number))
    try:
        yield ask
    finally:
        signal.signal(signal.SIGINT, before)
    ask()


def with_progress(case: Case, simulate: Callable[..., Found]) -> Found:
    """Run with a progress bar if somebody is looking; Ctrl-C ends the run and keeps what is finished."""
    if not sys.stderr.isatty():
        return simulate(case)
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (TextColumn("{task.description}", markup=False), BarColumn(), TextColumn("{task.completed:.0f} s"))
    with Progress(*columns, TimeRemainingColumn(), console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(_readable(case.name), total=case.run.duration)
        return simulate(case, progress=lambda time: bar.update(task, completed=time))


def with_bar(title: str, run: Callable[..., Found], total: float = 1.0) -> Found:
    """Call with ``progress`` that moves a bar if somebody is looking, else without."""
    if not sys.stderr.isatty():
        return run()
    from rich.console import Console
    from rich.markup import escape
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(escape(_readable(title)), total=total)
        return run(progress=lambda done: bar.update(task, completed=done))


def folder_for_results(folder: Path, names: Collection[str] = ()) -> None:
    """Refuse a folder where files of these names cannot be written before the work, not after it."""
    from towercrane.report.folder import obstacle

    if reason := obstacle(folder, names):
        fail(f"--out {folder}: {reason}")


def write(folder: Path, files: Mapping[str, Any]) -> None:
    """Put files into a folder, all of them or none."""
    from towercrane.report import folder as results

    with _writing(folder):
        results.write(folder, files)


def write_run(folder: Path, files: Mapping[str, Any], summary: dict[str, Any]) -> tuple[str, list[str]]:
    """Put a run's files into a folder; its summary as written, and what was taken away of an earlier run."""
    from towercrane.report import folder as results

    with _writing(folder):
        return results.write_run(folder, files, summary)


@contextmanager
def _writing(folder: Path) -> Iterator[None]:
    """Say why a folder cannot be written."""
    folder_for_results(folder)
    try:
        yield
    except OSError as error:
        fail(f"{folder}: cannot be written, what was there stays: {error.strerror or error}")


def options_of(changes: list[str] | None) -> list[str]:
    """The changes as options again."""
    return [part for change in changes or [] for part in ("--set", change)]


def tell(text: str) -> None:
    """Print a result; what a terminal would obey is spelled out."""
    typer.echo(_readable(text))


def say(text: str) -> None:
    """Tell the person, not the pipe."""
    typer.echo(_readable(text), err=True)


def _readable(text: str) -> str:
    from towercrane.schema.faults import printable_lines

    return printable_lines(text)


def show_warning(message: Warning | str) -> None:
    """Say what went otherwise than it should, without the line of the program that found it."""
    say(f"note: {message}")


def suggest(*arguments: str) -> None:
    """Print the next useful command, quoted so that it works as it stands."""
    import shlex

    tell(f"next: {shlex.join(['towercrane', *arguments])}")


def quantity(option: str, text: str, unit: str) -> float:
    """A quantity at an option with its unit, or a plain number in SI."""
    from towercrane.schema.units import UnitError, to_si

    value: str | float = text
    with suppress(ValueError):
        value = float(text)
    try:
        return to_si(value, unit)
    except UnitError as error:
        fail(f"{option}: {error}")


def fail(message: str) -> NoReturn:
    """Say what is wrong with the input and end with its exit code."""
    say(message)
    sys.exit(BAD_INPUT)

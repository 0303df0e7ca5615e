"""The command `sweep`: a case over a grid of values."""

from __future__ import annotations

import time
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any

import typer

from towercrane.commands.shared.skeleton import begin
from towercrane.commands.shared.terminal import (
    INTERRUPTED,
    NOT_AS_EXPECTED,
    AsJson,
    CaseName,
    Changes,
    Out,
    Pictures,
    fail,
    options_of,
    say,
    with_bar,
)
from towercrane.simulation import outcomes

if TYPE_CHECKING:
    import xarray as xr

    from towercrane.cases.case import Case

MOST_RUNS = 1_000_000
"""Runs beyond which a grid is more likely a slip."""


def sweep(
    case: CaseName,
    vary: Annotated[
        list[str],
        typer.Option(
            "--vary",
            metavar="KEY=FROM:TO:COUNT",
            help="Values of a key, e.g. --vary payload.mass=100kg:2000kg:20 or "
            "--vary model.jib_vertical_modes=1,2,3; with several keys all combinations.",
        ),
    ],
    out: Out = None,
    output: Annotated[
        list[str] | None,
        typer.Option("--output", metavar="NAME", help="Only this output, e.g. base_moment_y; may be repeated."),
    ] = None,
    threads: Annotated[int | None, typer.Option("--threads", min=1, help="Threads; all cores by default.")] = None,
    changes: Changes = None,
    as_json: AsJson = False,
    pictures: Pictures = True,
) -> None:
    """Run a case over a grid of values.

    Writes sweep.nc, sweep.csv and a picture.
    """
    written = _written(vary)
    first = [f"{key}={text.partition(':')[0].partition(',')[0].strip()}" for key, text in written.items()]

    def read(name: str, changes: list[str]) -> Case:
        from towercrane.runs.variants import varied_case

        return varied_case(name, changes, first)

    task = begin(case, changes, as_json=as_json, notices=True, read=read)
    task.into(out, "sweep")
    values = _values(task.case, written, first)
    from towercrane.report.tables.studies import sweep_tables
    from towercrane.runs.sweep import grid
    from towercrane.runs.sweep_report import report, runs_csv, worst

    began = time.perf_counter()
    data = _with_progress(task.case, grid(values), output, threads)
    if not set(data["outcome"].values) - {outcomes.INTERRUPTED}:
        say("interrupted before the first run had ended: nothing is written")
        raise typer.Exit(INTERRUPTED)
    summary = report(data, time.perf_counter() - began)
    files: dict[str, Any] = {"sweep.nc": data, "sweep.csv": runs_csv(data)}
    if pictures:
        from towercrane.report.plots.studies import sweep as pictured

        files |= pictured.extremes(data)
    if outcomes.INTERRUPTED in summary["outcomes"]:
        task.spare("sweep.nc")
    task.finish(summary, sweep_tables, task.command("run", *options_of(worst(data))), files)
    if outcomes.INTERRUPTED in summary["outcomes"]:
        raise typer.Exit(INTERRUPTED)
    if faults := summary["faults"]:
        say(f"bad input in {len(faults)} of {summary['runs']} runs, the first: {faults[0]['fault']}")
        raise typer.Exit(NOT_AS_EXPECTED)


def _written(vary: list[str]) -> dict[str, str]:
    """What is written of every key that is varied."""
    found: dict[str, str] = {}
    for option in vary:
        key, sign, written = option.partition("=")
        key = key.strip()
        if not (key and sign and written.strip()):
            fail(f"--vary {option}: wanted KEY=FROM:TO:COUNT or KEY=VALUE,VALUE,..., such as rope.length=5m:20m:16")
        if key in found:
            fail(f"--vary {option}: the key stands in two options")
        found[key] = written
    return found


def _values(case: Case, vary: dict[str, str], first: list[str]) -> dict[str, list[Any]]:
    """The values of every key that is varied."""
    from dataclasses import replace
    from math import prod

    from towercrane.cases.case import load_case
    from towercrane.cases.kinds import knows, unit_of
    from towercrane.schema.faults import CaseError
    from towercrane.schema.units import UnitError, to_si

    values: dict[str, list[Any]] = {}
    for key, written in vary.items():
        option, unit = f"{key}={written}", unit_of(case.kind, key)
        parts = [part.strip() for part in written.split(":")]
        if not knows(case.kind, key):
            try:
                # The case itself tells best what is wrong with a key.
                load_case(case.path, [*case.changes, *first])
            except CaseError as refused:
                faults = [replace(fault, file=fault.file.replace("--set", "--vary", 1)) for fault in refused.faults]
                raise CaseError(faults) from None
        try:
            if len(parts) == 1:
                given = [part.strip() for part in written.split(",")]
                values[key] = [_number(part) if unit is None else to_si(_number(part), unit) for part in given]
            else:
                values[key] = _steps(option, parts, None if unit is None else (to_si, unit))
        except UnitError as error:
            fail(f"--vary {option}: {error}")
    if (runs := prod(len(given) for given in values.values())) > MOST_RUNS:
        fail(f"--vary: wanted at most {MOST_RUNS} runs, got {runs}")
    return values


def _steps(option: str, parts: list[str], quantity: Any) -> list[Any]:
    """Equal steps from one value to another."""
    import numpy as np

    if len(parts) != 3 or not parts[2].isdecimal() or int(parts[2]) < 2:
        fail(f"--vary {option}: wanted FROM:TO:COUNT with a count of two or more, got {':'.join(parts)}")
    ends, count = [_number(part) for part in parts[:2]], int(parts[2])
    if count > MOST_RUNS:
        fail(f"--vary {option}: wanted at most {MOST_RUNS} values, got {count}")
    if quantity is not None:
        read, unit = quantity
        return list(np.linspace(read(ends[0], unit), read(ends[1], unit), count).tolist())
    if not all(isinstance(end, int) for end in ends):
        fail(f"--vary {option}: wanted whole numbers, or single values such as {option.partition('=')[0]}=a,b")
    steps = np.linspace(ends[0], ends[1], count)
    if not np.all(steps == np.round(steps)):
        fail(f"--vary {option}: wanted steps that are whole numbers, got {(ends[1] - ends[0]) / (count - 1):g}")
    return [int(step) for step in steps]


def _number(text: str) -> Any:
    """A number if the text is one, else the text."""
    for number in (int, float):
        try:
            return number(text)
        except ValueError:
            continue
    return text


def _with_progress(
    case: Case, values: dict[str, list[Any]], outputs: list[str] | None, threads: int | None
) -> xr.Dataset:
    """Run with a progress bar if somebody is looking."""
    from towercrane.runs.sweep import UnknownOutput
    from towercrane.runs.sweep import sweep as run_all

    count = len(next(iter(values.values())))
    wanted = partial(run_all, case, values, outputs=outputs, threads=threads)
    try:
        return with_bar(f"{count} runs", wanted, count)
    except UnknownOutput as error:
        fail(f"--output: {error}")

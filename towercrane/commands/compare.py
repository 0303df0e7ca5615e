"""The command `compare`: a case in models from rigid to rich."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from towercrane.commands.terminal import (
    AsJson,
    CaseName,
    Changes,
    Out,
    Pictures,
    announce_compilation,
    fail,
    folder_for_results,
    load,
    options_of,
    say_notices,
    suggest,
    tell,
    with_bar,
    write,
)

if TYPE_CHECKING:
    from towercrane.cases.case import Case


def compare(
    case: CaseName,
    target: Annotated[
        float | None,
        typer.Option(
            "--target", metavar="ERROR", help="Accepted relative error of the load's place; else the case's."
        ),
    ] = None,
    out: Out = None,
    changes: Changes = None,
    as_json: AsJson = False,
    pictures: Pictures = True,
) -> None:
    """Run a case in models from rigid to rich; which modes it needs for an error, and why."""
    loaded = load(case, changes)
    say_notices(loaded)
    folder = out if out is not None else Path("results") / f"{loaded.name}-compare"
    folder_for_results(folder)
    if target is not None and not 0.0 < target < 1.0:
        fail(f"--target {target:g}: wanted a fraction between 0 and 1")
    if loaded.kind not in ("radial", "space"):
        fail(f"{case}: wanted a case of kind 'radial' or 'space', whose modes count, got {loaded.kind!r}")
    from towercrane.cases.models import uses_of

    announce_compilation(*uses_of(loaded), "runs")
    from towercrane.studies.comparison import TARGET

    accepted = target or _asked(loaded) or TARGET
    report, results = _compared(loaded, accepted)
    files: dict[str, Any] = {"compare.json": json.dumps(report, indent=2, allow_nan=False) + "\n"}
    if pictures:
        from towercrane.report.plots.studies.comparison import paths

        files["paths.png"] = paths(report, results)
    write(folder, files)
    if as_json:
        tell(json.dumps(report, indent=2, allow_nan=False))
        return
    from towercrane.report.tables.space import comparison_tables

    comparison_tables(report)
    tell(f"written to {folder}: {', '.join(files)}")
    counts: dict[str, int] = next(
        (row["modes"] for row in report["rows"] if row["name"] == report["recommended"]), {}
    )
    suggest(
        "run", case, *options_of(changes), *options_of([f"model.{key}={count}" for key, count in counts.items()])
    )  # fmt: skip


def _asked(case: Case) -> float | None:
    """Relative error that the case asks for, the least of its outputs'."""
    from towercrane.accuracy.promise import targets_of

    return min((one.value for one in targets_of(case).values() if one.relative), default=None)


def _compared(case: Case, target: float) -> tuple[dict[str, Any], dict[str, Any]]:
    """The comparison, with a progress bar if somebody is looking."""
    from towercrane.studies.comparison import compare as compared

    try:
        return with_bar(f"models of {case.name}", partial(compared, case, target))
    except ValueError as error:
        fail(f"{case.path}: {error}")

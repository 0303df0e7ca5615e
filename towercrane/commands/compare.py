"""The command `compare`: a case in models from rigid to rich."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Annotated, Any

import typer

from towercrane.commands.shared.skeleton import Task, as_text, begin, either
from towercrane.commands.shared.terminal import AsJson, CaseName, Changes, Out, Pictures, fail, options_of, with_bar

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
    """Run a case in models from rigid to rich.

    Which modes it needs for an error, and why.
    """
    task = begin(case, changes, as_json=as_json, notices=True)
    task.into(out, "compare")
    if target is not None and not 0.0 < target < 1.0:
        fail(f"--target {target:g}: wanted a fraction between 0 and 1")
    task.allow("compare")
    if not task.serves("compare"):
        task.refuse(f"wanted a case of kind {either('compare')}, whose modes count, got {task.case.kind!r}")
    from towercrane.report.tables.space import comparison_tables
    from towercrane.studies.comparison import TARGET

    report, results = _compared(task.case, target or _asked(task.case) or TARGET)
    files: dict[str, Any] = {"compare.json": as_text(report) + "\n"}
    if pictures:
        from towercrane.report.plots.studies.comparison import paths

        files["paths.png"] = paths(report, results)
    task.finish(report, comparison_tables, _recommended(task, report), files)


def _asked(case: Case) -> float | None:
    """Relative error that the case asks for, the least of its outputs'."""
    from towercrane.cases.models import targets_of

    return min((one.value for one in targets_of(case).values() if one.relative), default=None)


def _compared(case: Case, target: float) -> tuple[dict[str, Any], dict[str, Any]]:
    """The comparison, with a progress bar if somebody is looking."""
    from towercrane.studies.comparison import compare as compared

    try:
        return with_bar(f"models of {case.name}", partial(compared, case, target))
    except ValueError as error:
        fail(f"{case.path}: {error}")


def _recommended(task: Task, report: dict[str, Any]) -> tuple[str, ...]:
    """A run with the modes that the error needs."""
    counts: dict[str, int] = next(
        (row["modes"] for row in report["rows"] if row["name"] == report["recommended"]), {}
    )
    return task.command("run", *options_of([f"model.{key}={count}" for key, count in counts.items()]))

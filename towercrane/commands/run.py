"""The command `run`: simulate a case, verified if wanted."""

from __future__ import annotations

import json
from typing import Annotated, Any

import typer

from towercrane.commands.shared.pictures import run_pictures
from towercrane.commands.shared.skeleton import Task, begin, either, end_of_run
from towercrane.commands.shared.terminal import (
    INTERRUPTED,
    NOT_AS_EXPECTED,
    AsJson,
    CaseName,
    Changes,
    Out,
    Pictures,
    fail,
    held_interrupts,
    say,
    suggest,
    tell,
    with_progress,
    write_run,
)
from towercrane.simulation import outcomes


def run(
    case: CaseName,
    out: Out = None,
    changes: Changes = None,
    as_json: AsJson = False,
    pictures: Pictures = True,
    csv: Annotated[bool, typer.Option("--csv", help="Write result.csv as well.")] = False,
    verify: Annotated[
        bool, typer.Option("--verify", help="Run a richer model with a tighter tolerance as well and compare.")
    ] = False,
) -> None:
    """Simulate a case; write result.nc, summary.json and pictures."""
    task = begin(case, changes, as_json=as_json)
    if verify:
        task.allow("verify")
    if verify and not task.serves("verify"):
        fail(f"--verify: wanted a case of kind {either('verify')}, got {task.case.kind!r}")
    from towercrane.report.folder import RUN_FILES

    task.into(out, names=RUN_FILES)
    from towercrane.runs.run import record_case
    from towercrane.runs.summary import summarise

    result = with_progress(task.case, record_case)
    interrupted, verified = result.attrs["outcome"] == outcomes.INTERRUPTED, {}
    if verify and result.attrs["outcome"] == outcomes.FINISHED:
        from towercrane.accuracy.promise import settle, verification

        try:
            verified["verification"] = verification(task.case, result)
            settle(result, verified["verification"])
        except KeyboardInterrupt:
            say("the run is kept, its verification is not")
            interrupted = True
    summary = summarise(task.case, result) | verified
    # Pictures mark them, and whoever reads the file finds them.
    result.attrs["loads"] = json.dumps(summary["loads"])
    result.attrs["release"] = json.dumps(summary.get("release"))
    files: dict[str, Any] = {"result.nc": result, **({"result.csv": result} if csv else {})}
    assert task.folder is not None
    if interrupted:
        task.spare("summary.json")
    try:
        if pictures and not interrupted:
            with held_interrupts():
                files |= run_pictures(task.case, result)
    except KeyboardInterrupt:
        interrupted = True
    finally:
        # Whatever becomes of the pictures, the run is kept.
        text, stale = write_run(task.folder, files, summary)
    names = ", ".join([*files, "summary.json"])
    if as_json:
        tell(text)
    else:
        _print(summary, [f"written to {task.folder}: {names}", *_removed(stale)])
        suggest(*_following(task))
    if interrupted:
        say(f"kept in {task.folder}: {names}")
        raise typer.Exit(INTERRUPTED)
    end_of_run(summary["expected"], summary["outcome"], summary["end_time_s"])
    if "accuracy" in summary:
        from towercrane.accuracy.promise import AS_ASKED

        if summary["accuracy"]["outcome"] not in AS_ASKED:
            say(f"error asked for: {summary['accuracy']['outcome']}")
            raise typer.Exit(NOT_AS_EXPECTED)


def _print(summary: dict[str, Any], lines: list[str]) -> None:
    from towercrane.report.tables.runs import run_tables, verification_tables

    run_tables(summary)
    if "verification" in summary:
        verification_tables(summary["verification"])
    for line in lines:
        tell(line)


def _removed(stale: list[str]) -> list[str]:
    return [f"removed, of an earlier run: {', '.join(stale)}"] if stale else []


def _following(task: Task) -> tuple[str, ...]:
    """What to look at next: what a change did to the frequencies, or more modes."""
    from towercrane.cases.assumptions import left_out

    if left_out(task.case) and not task.changes:
        richer = f"results/{task.case.name}-5-jib-modes"
        return task.command("run", "--set", "model.jib_vertical_modes=5", "--out", richer)
    return task.command("modes" if task.serves("modes") else "linearise")

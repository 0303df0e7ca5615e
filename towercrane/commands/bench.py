"""The command `bench`: speed against error on this machine."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from towercrane.commands.shared.skeleton import as_text, finish
from towercrane.commands.shared.terminal import (
    NOT_AS_EXPECTED,
    AsJson,
    fail,
    folder_for_results,
    out_option,
    say,
)


def bench(
    quick: Annotated[bool, typer.Option("--quick", help="Fewer repeats and rivals; about a minute.")] = False,
    subject: Annotated[str, typer.Option("--subject", metavar="NAME", help="Measure one subject only.")] = "",
    hard: Annotated[bool, typer.Option("--hard", help="Run the hard cases against their targets.")] = False,
    stability: Annotated[
        bool, typer.Option("--stability", help="Energy drift, error growth and failures of every method.")
    ] = False,
    out: Annotated[Path | None, out_option("Folder for bench.json and the pictures.")] = None,
    as_json: AsJson = False,
) -> None:
    """Measure speed against error on this machine.

    Other solvers and structures stand beside.
    """
    chosen = [
        name for name, wanted in (("--subject", subject), ("--hard", hard), ("--stability", stability)) if wanted
    ]
    if len(chosen) > 1:
        fail(f"bench: wanted one of --subject, --hard and --stability, got {' and '.join(chosen)}")
    if out is not None:
        folder_for_results(out)
    report = _measured(quick, subject, hard, stability)
    files: dict[str, Any] = {}
    if out is not None:
        from towercrane.report.plots.bench.work import pictures

        files = {**pictures(report), "bench.json": as_text(report) + "\n"}
    from towercrane.report.tables.studies import bench_tables

    following = ("run", "qtz5613/condition-3", "--set", "solver.rtol=1e-6")
    finish(report, bench_tables, following, files, folder=out, as_json=as_json)
    if not report.get("met", True):
        say("not all as expected, see the rows marked NO or !")
        raise typer.Exit(NOT_AS_EXPECTED)


def _measured(quick: bool, subject: str, hard: bool, stability: bool) -> dict[str, Any]:
    """What the benchmark was asked for."""
    if hard:
        from towercrane.bench.runs.hard import hard_cases

        found = hard_cases(say)
        return {"subjects": [found], "met": found["met"]}
    if stability:
        from towercrane.bench.runs import stability as long_run

        return long_run.stability(quick=quick, say=say)
    from towercrane.bench import SUBJECTS, measure

    if subject and subject not in SUBJECTS:
        fail(f"--subject: wanted one of {', '.join(SUBJECTS)}, got {subject!r}")
    return measure(quick=quick, subject=subject, say=say)

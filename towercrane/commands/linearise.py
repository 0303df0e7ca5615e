"""The command `linearise`: the linear model of a case."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from towercrane.commands.shared.skeleton import begin, no_equilibrium
from towercrane.commands.shared.terminal import (
    AsJson,
    CaseName,
    Changes,
    fail,
    folder_for_results,
    options_of,
    out_option,
    tell,
)


def linearise(
    case: CaseName,
    at: Annotated[
        float,
        typer.Option("--at", metavar="SECONDS", min=0.0, help="When: trolley and rope stand where they are then."),
    ] = 0.0,
    out: Annotated[Path | None, out_option("Write A, B, C, D to a .mat or .npz file.", "FILE")] = None,
    changes: Changes = None,
    as_json: AsJson = False,
) -> None:
    """Linear state-space model of a case and its eigenvalues.

    A file is for MATLAB or Python.
    """
    from towercrane.linear.statespace import FILE_TYPES

    task = begin(case, changes, as_json=as_json, notices=True)
    if not at < float("inf"):
        fail(f"--at {at}: wanted a finite number of seconds")
    if out is not None:
        if out.suffix.lower() not in FILE_TYPES or out.is_dir():
            fail(f"--out {out}: wanted a file that ends in {' or '.join(FILE_TYPES)}")
        folder_for_results(out.parent)
    from towercrane.cases.assumptions import as_notes, rests_on
    from towercrane.cases.models import motions_of
    from towercrane.report.tables.modes import linear_tables
    from towercrane.simulation.system import NoEquilibrium
    from towercrane.studies.linear_report import linear_model, linear_report

    try:
        linear = linear_model(task.case, at)
    except NoEquilibrium as failure:
        no_equilibrium(failure)
    if out is not None:
        linear.save(out, as_notes(rests_on(task.case)))

    def show(report: dict[str, Any]) -> None:
        linear_tables(report, tuple(motions_of(task.case)))
        if out is not None:
            tell(f"written to {out}")

    moment = ("--at", f"{at:g}") if at else ()
    into_file = ("linearise", case, *moment, *options_of(changes), "--out", f"results/{task.case.name}.mat")
    task.finish(linear_report(task.case, at, linear), show, into_file if out is None else task.command("run"))

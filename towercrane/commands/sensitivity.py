"""The command `sensitivity`: which parameters and members of a slewing crane matter."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Annotated, Any

import typer

from towercrane.commands.shared.skeleton import as_text, begin
from towercrane.commands.shared.terminal import AsJson, CaseName, Changes, Out, Pictures, fail, with_bar

if TYPE_CHECKING:
    from towercrane.cases.case import Case


def sensitivity(
    case: CaseName,
    vary: Annotated[
        list[str] | None,
        typer.Option("--vary", metavar="PATTERN", help='Parameters, e.g. --vary "stiffness_*"; all by default.'),
    ] = None,
    step: Annotated[float, typer.Option("--step", help="Percent of nominal between two values.")] = 20.0,
    tolerance: Annotated[
        float, typer.Option("--tolerance", help="Change of every output below which a member is made rigid.")
    ] = 0.02,
    out: Out = None,
    changes: Changes = None,
    as_json: AsJson = False,
    pictures: Pictures = True,
) -> None:
    """Which parameters and freedoms of a slewing crane matter.

    And the reduced crane that follows, beside the full one.
    """
    task = begin(case, changes, as_json=as_json)
    task.into(out, "sensitivity")
    if not 1.0 <= step <= 100.0:
        fail(f"--step {step:g}: wanted percents from 1 to 100")
    if not 0.0 < tolerance < 1.0:
        fail(f"--tolerance {tolerance:g}: wanted a fraction between 0 and 1")
    from towercrane.cranes.slewing.build import parameters_of as written
    from towercrane.cranes.slewing.tables import SlewingCase
    from towercrane.studies.sensitivity import parameters_of, report

    parameters = written(task.case.tables(SlewingCase).crane)
    names = parameters_of(parameters, vary or ["*"])
    if not names:
        known = ", ".join(parameters_of(parameters))
        fail(f"--vary {' '.join(vary or [])}: wanted patterns that match some of {known}")
    from towercrane.cases.assumptions import as_attribute, rests_on
    from towercrane.report.tables.studies import sensitivity_tables

    study = _study(task.case, names, step, tolerance)
    study.data.attrs["assumed"] = as_attribute(rests_on(task.case))
    summary = report(study, task.case)
    files: dict[str, Any] = {"sensitivity.nc": study.data, "sensitivity.json": as_text(summary) + "\n"}
    if pictures:
        from towercrane.report.plots.studies import sensitivity as pictured

        files["ranking.png"] = pictured.ranking(study)
        files |= {f"surface-{name}.png": pictured.surface(study.data, name) for name in names}
    task.finish(summary, sensitivity_tables, task.command("run"), files, f"{len(files)} files")


def _study(case: Case, names: list[str], step: float, tolerance: float) -> Any:
    """Run a sensitivity study."""
    from towercrane.cases.models import motions_of
    from towercrane.cranes.slewing.build import builder_of, parameters_of
    from towercrane.cranes.slewing.tables import SlewingCase
    from towercrane.studies.sensitivity import study

    tables = case.tables(SlewingCase)
    percent = sorted({step * i for i in range(int(200.0 / step) + 1)} | {50.0, 100.0, 150.0})
    run = partial(
        study, parameters_of(tables.crane), builder_of(tables), motions_of(case), case.run.duration,
        vary=names, percent=percent, tolerance=tolerance,
    )  # fmt: skip
    return with_bar(f"{len(names)} parameters, {len(percent)} values each", run)

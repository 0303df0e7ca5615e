"""The command `shape`: motions that leave the load at rest."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Annotated, Any

import typer

from towercrane.commands.shared.skeleton import as_text, begin, kinds_for, no_equilibrium
from towercrane.commands.shared.terminal import AsJson, CaseName, Changes, Out, Pictures, fail, with_bar

if TYPE_CHECKING:
    from towercrane.cases.case import Case


def shape(
    case: CaseName,
    within: Annotated[
        float, typer.Option("--within", metavar="METRES", help="Distance from its rest at which the load is at rest.")
    ] = 0.1,
    step: Annotated[
        float, typer.Option("--step", metavar="SECONDS", help="Time between two rows of a drive's table.")
    ] = 0.05,
    out: Out = None,
    changes: Changes = None,
    as_json: AsJson = False,
    pictures: Pictures = True,
) -> None:
    """Motions that leave the load at rest, and tables of them.

    How still, how surely and how fast each is.
    """
    task = begin(case, changes, as_json=as_json, notices=True)
    task.into(out, "shape")
    loaded = task.case
    if not 0.0 < within < float("inf"):
        fail(f"--within {within:g}: wanted a positive distance")
    if not 1e-3 <= step <= 10.0:
        fail(f"--step {step:g}: wanted seconds from 0.001 to 10")
    from towercrane.studies.candidates import driven

    task.allow("shape")
    if not task.serves("shape"):
        kinds = " or ".join(kinds_for("shape"))
        task.refuse(f"wanted a crane of kind {kinds}, whose modes are known; got {loaded.kind}")
    if not driven(loaded.plans):
        task.refuse("wanted a trolley, a luffing or a slewing drive that moves, got none")
    if at_speed := [name for name, plan in loaded.plans.items() if plan.at_speed]:
        task.refuse(f"wanted drives that begin and end at rest, got {', '.join(at_speed)} at speed")
    from towercrane.cases.assumptions import as_attribute, as_entries, as_notes, rests_on
    from towercrane.cases.models import model_of
    from towercrane.report.drive_table import drive_table
    from towercrane.report.tables.studies import shape_tables
    from towercrane.simulation.system import NoEquilibrium
    from towercrane.studies.rest_study import report, study

    model: Any = model_of(loaded)
    try:
        run = partial(study, model, loaded.plans, allowed=within)
        done = with_bar(f"motions of {loaded.name}", run)
    except NoEquilibrium as failure:
        no_equilibrium(failure)
    notes, known = as_notes(rests_on(loaded)), {"case": loaded.name, "crane": loaded.crane.name}
    summary = {**known, **report(done), "assumed": as_entries(rests_on(loaded))}
    chosen = done.recommended.candidate
    files: dict[str, Any] = {"shape.json": as_text(summary) + "\n"}
    for channel in driven(loaded.plans):
        unit = "m" if channel == "trolley" else "rad"
        about = {**known, "drive": channel, "motion": chosen.title, "assumed": as_attribute(rests_on(loaded))}
        files[f"drive-{channel}.csv"] = drive_table(chosen.motions[channel], step, unit, about)
    if pictures:
        from towercrane.report.plots.studies import shaping as pictured

        files["residuals.png"] = pictured.residuals(done, loaded.crane.name, notes)
        files["profiles.png"] = pictured.profiles(done, loaded.crane.name, notes)
    following = task.command("run", *_reshaped(loaded, chosen.name, driven(loaded.plans)))
    task.finish(summary, shape_tables, following, files)


def _reshaped(case: Case, name: str, channels: list[str]) -> list[str]:
    """Options that give every planned drive of a case another shape; none where its motion has other keys."""
    from towercrane.motions.shaping import DESIGNS

    shapes = [getattr(getattr(case.checked.motion, channel), "shape", "") for channel in channels]
    if name not in DESIGNS or not {*shapes} <= {"trapezoid", *DESIGNS}:
        return []
    return [part for channel in channels for part in ("--set", f"motion.{channel}.shape={name}")]

"""The command `lift`: how hard a load pulls as it leaves the ground."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any

import typer

from towercrane.commands.shared.skeleton import as_text, begin
from towercrane.commands.shared.terminal import (
    ENDED_EARLY,
    AsJson,
    CaseName,
    Changes,
    Out,
    Pictures,
    fail,
    options_of,
    quantity,
    say,
    with_bar,
)
from towercrane.simulation import outcomes

if TYPE_CHECKING:
    from towercrane.studies.lift.hand import Classes

SpeedsOrPlaces = str | None


def lift(
    case: CaseName,
    speeds: Annotated[
        SpeedsOrPlaces,
        typer.Option("--speeds", metavar="V,V", help="Hoisting speeds [m/s], or with units; four up to the case's."),
    ] = None,
    positions: Annotated[
        SpeedsOrPlaces,
        typer.Option("--positions", metavar="X,X", help="Places of the trolley [m]; 0.2, 0.5, 0.9 of the jib."),
    ] = None,
    window: Annotated[
        float, typer.Option("--window", metavar="SECONDS", help="Time after lift-off that is looked at.")
    ] = 10.0,
    slack: Annotated[
        float | None, typer.Option("--slack", metavar="METRES", help="Of the rope at the start; else the case's.")
    ] = None,
    acceleration: Annotated[
        float | None, typer.Option("--acceleration", metavar="M/S2", help="Of the hoist; else the case's.")
    ] = None,
    creep: Annotated[
        float | None,
        typer.Option("--creep", metavar="M/S", help="Speed until the load hangs, 0 for none; else the case's."),
    ] = None,
    classes: Annotated[
        list[str] | None,
        typer.Option(
            "--class", metavar="NAME=PHI2MIN,BETA2", help="A hoisting class; replaces all. May be repeated."
        ),
    ] = None,
    standard: Annotated[
        str | None, typer.Option("--standard", metavar="TEXT", help="Where classes that are given come from.")
    ] = None,
    out: Out = None,
    changes: Changes = None,
    as_json: AsJson = False,
    pictures: Pictures = True,
) -> None:
    """Dynamic factors of a load that is lifted off the ground.

    Of rope, base and jib root over hoisting speed and trolley position, beside hand formulas and hoisting classes.
    """
    task = begin(case, changes, as_json=as_json, notices=True)
    task.into(out, "lift", ("lift.json", "lift.png"))
    if not task.serves("lift"):
        task.refuse(
            task.refusal("lift") or f"a crane of kind {task.case.kind!r} has no trolley on a jib to lift from"
        )
    from towercrane.report.tables.lift import lift_tables
    from towercrane.studies.lift.hoisting import hoisting_of
    from towercrane.studies.lift.study import lift as study

    own = {"slack": slack, "acceleration": acceleration, "creep": creep}
    told = {name: value for name, value in own.items() if value is not None}
    fast, places = _numbers("--speeds", speeds, "m/s"), _numbers("--positions", positions, "m")
    judged = _classes(classes, standard)
    wanted = partial(
        study, task.case, fast, places,
        window=window, hoisting=replace(hoisting_of(task.case)[0], **told), classes=judged,
    )  # fmt: skip
    try:
        report = with_bar(f"lift-off of {task.case.name}", wanted, len(fast or range(4)) * len(places or range(3)))
    except ValueError as error:
        task.refuse(str(error))
    files: dict[str, Any] = {"lift.json": as_text(report) + "\n"}
    if pictures:
        from towercrane.report.plots.studies.lift import factors

        files["lift.png"] = factors(report)
    task.finish(report, lift_tables, task.command("run", *_worst(task.case, report)), files)
    if any(row["outcome"] != outcomes.FINISHED for row in report["runs"]):
        say("some of the runs ended early")
        raise typer.Exit(ENDED_EARLY)


def _numbers(option: str, text: str | None, unit: str) -> list[float] | None:
    """Numbers with commas between them, in SI."""
    if text is None:
        return None
    return [quantity(f"{option} {text}", part.strip(), unit) for part in text.split(",")]


def _classes(given: list[str] | None, standard: str | None) -> Classes:
    """Hoisting classes, those of the options where there are any."""
    from towercrane.studies.lift.hand import Class, Classes

    if not given:
        if standard is not None:
            fail(f"--standard {standard}: wanted classes of that standard beside it, --class NAME=PHI2MIN,BETA2")
        return Classes()
    found = {}
    for option in given:
        name, _, values = option.partition("=")
        try:
            least, slope = (float(own) for own in values.split(","))
            found[name.strip()] = Class(least, slope)
        except ValueError:
            fail(f"--class {option}: wanted NAME=PHI2MIN,BETA2, such as HC2=1.10,0.34")
    try:
        return Classes(found, standard or "given by options")
    except ValueError as error:
        fail(f"--class: {error}")


def _worst(case: Any, report: dict[str, Any]) -> list[str]:
    """Options of a run at the place where the rope pulls hardest."""
    known = [row for row in report["runs"] if row["dynamic_factor"]]
    if not known:
        return []
    worst = max(known, key=lambda row: row["dynamic_factor"]["rope"]["value"])
    shape = getattr(getattr(case.checked.motion, "trolley", None), "shape", "")
    return options_of([f"motion.trolley.start={worst['trolley_position_m']:g}"]) if shape == "rest" else []

"""The command `modes`: natural frequencies of a tower crane, in the jib's plane or in space."""

from __future__ import annotations

from math import degrees
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from towercrane.commands.shared.pictures import mode_picture
from towercrane.commands.shared.skeleton import Task, begin
from towercrane.commands.shared.terminal import ENDED_EARLY, AsJson, CaseName, Changes, out_option

if TYPE_CHECKING:
    from towercrane.cases.case import Case


def modes(
    case: CaseName,
    changes: Changes = None,
    out: Annotated[Path | None, out_option("Folder for pictures of the modes.")] = None,
    actual: Annotated[
        bool, typer.Option("--actual", help="Solve for the effect of shear, weight, ... beside its prediction.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Natural frequencies of tower, jib and crane.

    Each is checked a second way, beside what matters for it.
    """
    task = begin(case, changes, as_json=as_json)
    task.need("modes", "beams")
    if out is not None:
        task.into(out)
    from towercrane.cranes.tower.file.case_tables import TowerCase
    from towercrane.cranes.tower.file.plane import stays_in_plane

    tables = task.case.tables(TowerCase)
    clamped = tables.crane.tower_head is None and tables.crane.jib.luffing is None
    if stays_in_plane(tables) and clamped:
        _in_plane(task, actual)
    else:
        _in_space(task)


def _in_plane(task: Task, actual: bool) -> None:
    from modal.structures.members import FewModes
    from towercrane.cases.models import model_of
    from towercrane.report.tables.modes import modes_tables
    from towercrane.studies.natural import natural_frequencies

    model: Any = model_of(task.case)
    try:
        report = natural_frequencies(task.case, model=model, actual=actual)
    except FewModes as error:
        task.refuse(f"crane.tower.lattice: wanted horizontals that leave the modes asked for; {error}")
    files = {"modes.png": mode_picture(task.case, model)} if task.folder is not None else {}
    task.finish(report, modes_tables, task.command("run"), files)
    if any("outcome" in row for row in report["crane"]):
        raise typer.Exit(ENDED_EARLY)


def _in_space(task: Task) -> None:
    from towercrane.report.tables.space import space_modes_tables
    from towercrane.studies.space_modes import space_frequencies

    report = space_frequencies(task.case)
    files = _pictures(task.case) if task.folder is not None else {}
    task.finish(report, space_modes_tables, task.command("run"), files)
    if "outcome" in report or any("outcome" in row for rows in report["sweeps"].values() for row in rows):
        raise typer.Exit(ENDED_EARLY)


def _pictures(case: Case) -> dict[str, Any]:
    """Modes where the drives stand at the start, none for a tower that buckles, and frequencies over the drives."""
    from towercrane.cases.assumptions import as_notes
    from towercrane.cranes.tower.file.case_tables import TowerCase
    from towercrane.report.plots.studies import space_modes as pictured
    from towercrane.simulation.system import NoEquilibrium
    from towercrane.studies.space_modes import drawn_sweeps, modes_at, modes_rest_on, place_at, space_model

    tables = case.tables(TowerCase)
    model, place = space_model(tables), place_at(case)
    notes = as_notes(modes_rest_on(case))
    title = f"{case.crane.name}, load {case.payload.mass:g} kg: "
    pivots = tables.crane.jib.luffing is not None
    position = f"jib at {degrees(place.position):g} deg" if pivots else f"trolley {place.position:g} m"
    where = f"{position}, rope {place.rope_length:g} m"
    swept = pictured.frequencies(drawn_sweeps(case), f"{title}natural frequencies about {where}", notes)
    files: dict[str, Any] = {"frequencies.png": swept}
    try:
        modes = modes_at(model, place, tables.modes.crane_count)
    except NoEquilibrium:
        return files
    counter_jib = tables.crane.counter_jib.reach
    return {"modes.png": pictured.shapes(model, modes, place, counter_jib, f"{title}modes, {where}", notes), **files}

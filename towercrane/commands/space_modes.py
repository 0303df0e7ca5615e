"""The command `modes` for a crane in space."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import typer

from towercrane.commands.terminal import (
    ENDED_EARLY,
    announce_compilation,
    folder_for_results,
    options_of,
    suggest,
    tell,
    write,
)

if TYPE_CHECKING:
    from pathlib import Path

    from towercrane.cases.case import Case


def space_modes(case: Case, name: str, changes: list[str] | None, out: Path | None, as_json: bool) -> None:
    """Print natural frequencies and kinds of a case in space; draw modes and frequencies where a folder is given.

    Parameters
    ----------
    case : Case
    name : str
        As it was typed, for the next command.
    changes : list of str or None
    out : Path or None
    as_json : bool
    """
    if out is not None:
        folder_for_results(out)
    from towercrane.cases.models import tower_uses

    announce_compilation("modes", *tower_uses(case))
    from towercrane.studies.space_modes import space_frequencies

    report = space_frequencies(case)
    files = _pictures(case) if out is not None else {}
    if out is not None:
        write(out, files)
    if as_json:
        tell(json.dumps(report, indent=2))
    else:
        from towercrane.report.tables.space import space_modes_tables

        space_modes_tables(report)
        if out is not None:
            tell(f"written to {out}: {', '.join(files)}")
        suggest("run", name, *options_of(changes))
    if "outcome" in report or any("outcome" in row for rows in report["sweeps"].values() for row in rows):
        raise typer.Exit(ENDED_EARLY)


def _pictures(case: Case) -> dict[str, Any]:
    """Modes where the drives stand at the start, none for a tower that buckles, and frequencies over the drives."""
    from towercrane.cases.assumptions import as_notes
    from towercrane.cranes.tower.file.build import space_model
    from towercrane.cranes.tower.file.case_tables import SpaceCase
    from towercrane.report.plots.studies import space_modes as pictured
    from towercrane.simulation.system import NoEquilibrium
    from towercrane.studies.space_modes import drawn_sweeps, modes_at, modes_rest_on, place_at

    tables = case.tables(SpaceCase)
    model, place = space_model(tables), place_at(case)
    notes = as_notes(modes_rest_on(case))
    title = f"{case.crane.name}, load {case.payload.mass:g} kg: "
    where = f"trolley {place.trolley_position:g} m, rope {place.rope_length:g} m"
    swept = pictured.frequencies(drawn_sweeps(case), f"{title}natural frequencies about {where}", notes)
    files: dict[str, Any] = {"frequencies.png": swept}
    try:
        modes = modes_at(model, place, tables.modes.count)
    except NoEquilibrium:
        return files
    counter_jib = tables.crane.counter_jib.length
    return {"modes.png": pictured.shapes(model, modes, place, counter_jib, f"{title}modes, {where}", notes), **files}

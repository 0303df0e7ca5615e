"""The command `map`: natural frequencies over trolley position and payload, and the tower's buckling load."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any

import typer

from towercrane.commands.shared.skeleton import Task, as_text, begin
from towercrane.commands.shared.terminal import (
    ENDED_EARLY,
    AsJson,
    CaseName,
    Changes,
    Out,
    Pictures,
    fail,
    quantity,
    say,
    with_bar,
)
from towercrane.simulation.outcomes import FINISHED, TOWER_BUCKLED

if TYPE_CHECKING:
    from collections.abc import Callable

    import xarray as xr

    from modal import CraneFrame
    from towercrane.cases.case import Case
    from towercrane.cranes.tower.file.case_tables import MapRequest

MOST_MODES = 20
"""Branches beyond which a map takes minutes and cannot be read."""


def frequency_map(
    case: CaseName,
    positions: Annotated[
        int | None,
        typer.Option(
            "--positions", metavar="N", help="Places of the trolley, or angles of the jib; else the case's."
        ),
    ] = None,
    payload: Annotated[
        list[str] | None,
        typer.Option(
            "--payload",
            metavar="MASSES",
            help='Loads, e.g. --payload "400 kg, 2 t"; else the case\'s.',
        ),
    ] = None,
    modes: Annotated[int, typer.Option("--modes", metavar="N", help="Branches from the lowest on.")] = 6,
    shapes: Annotated[
        str | None,
        typer.Option("--shapes", metavar="X", help='Draw the modes with the trolley there, e.g. --shapes "23 m".'),
    ] = None,
    out: Out = None,
    changes: Changes = None,
    as_json: AsJson = False,
    pictures: Pictures = True,
) -> None:
    """Natural frequencies over trolley position and payload.

    Of the crane in the plane, with the tower's buckling load; of a jib that pivots over its angle.
    """
    task = begin(case, changes, as_json=as_json)
    task.need("map", "beams")
    task.into(out, "map")
    loaded = task.case
    from towercrane.cranes.tower.file.case_tables import MOST_POSITIONS, TowerCase
    from towercrane.cranes.tower.file.requests import ends_of_map, map_of, places_of

    if positions is not None and not 1 <= positions <= MOST_POSITIONS:
        fail(f"--positions {positions}: wanted 1 to {MOST_POSITIONS}")
    if not 1 <= modes <= MOST_MODES:
        fail(f"--modes {modes}: wanted 1 to {MOST_MODES}")
    tables = loaded.tables(TowerCase)
    asked = map_of(tables)
    masses = _masses(asked, payload)
    low, reach = ends_of_map(tables)
    clamped = tables.crane.tower_head is None and tables.crane.jib.luffing is None
    if shapes is not None and not clamped:
        fail(f"--shapes: wanted a crane whose jib is clamped; try: towercrane modes {case} --out DIR")
    where = None if shapes is None else _position(shapes, reach)
    import numpy as np

    from towercrane.cranes.tower.file.build import crane_frame
    from towercrane.cranes.tower.file.effects import softened
    from towercrane.report.tables.modes import map_tables
    from towercrane.studies.map_report import csv_text, map_report, provenance

    frame = crane_frame(tables, weight=softened(tables)) if clamped else None
    places = np.unique(getattr(asked, places_of(tables)))
    if positions is not None:
        # A single place is the jib's end, where the load bends it most; of a jib that pivots its lowest angle.
        places = np.linspace(low, reach, positions) if positions > 1 else np.array([reach if low == 0.0 else low])
    data = _mapped(loaded, _solver(task, frame, modes), places, masses)
    data.attrs |= provenance(loaded)
    report = map_report(data)
    files: dict[str, Any] = {
        "map.nc": data,
        "map.csv": csv_text(data),
        "map.json": as_text(report) + "\n",
    }
    if pictures:
        from towercrane.report.plots.studies import frequency_map as pictured

        files["map.png"] = pictured.frequencies(data)
    if where is not None and frame is not None:
        files |= _mode_picture(loaded, frame, where, modes)
    drawn = where is not None or not clamped
    following = task.command("run") if drawn else task.command("map", "--shapes", f"{0.5 * reach:g} m")
    task.finish(report, map_tables, following, files)
    if report["outcome"] != FINISHED:
        for row in report["payloads"]:
            if row["outcome"] != FINISHED:
                factor = f" at {row['buckling_factor']:.4g} times the weights"
                ends = factor if row["outcome"] == TOWER_BUCKLED else ""
                say(f"load {row['payload_kg']:g} kg: {row['outcome']}{ends}")
        raise typer.Exit(ENDED_EARLY)


def _masses(asked: MapRequest, written: list[str] | None) -> list[float]:
    """Payloads [kg], ascending, each once."""
    masses = set() if written else set(asked.payload_masses)
    for text in (part.strip() for option in written or () for part in option.split(",")):
        mass = quantity(f"--payload {text}", text, "kg")
        if not 0.0 < mass <= 1e6:
            fail(f"--payload {text}: wanted a mass above 0 and up to 1000 t; without a load the hook's own")
        masses.add(mass)
    return sorted(masses)


def _position(written: str, reach: float) -> float:
    """Place of the trolley [m]."""
    position = quantity(f"--shapes {written}", written, "m")
    if not 0.0 <= position <= reach:
        fail(f"--shapes {written}: wanted a place on the jib, 0 to {reach:g} m")
    return position


def _solver(task: Task, frame: CraneFrame | None, modes: int) -> Callable[..., xr.Dataset]:
    """What makes the map: of an exact frame, or of models where there is none."""
    if frame is not None:
        from towercrane.studies.frequency_map import frequency_map as computed

        return partial(computed, frame, modes=modes)
    from towercrane.cranes.tower.file.case_tables import TowerCase
    from towercrane.studies.frequency_map import SPARE
    from towercrane.studies.ritz.model_map import model_map
    from towercrane.studies.ritz.plane_crane import RICHER, rich_crane

    tables = task.case.tables(TowerCase)
    crane, richer = rich_crane(tables), rich_crane(tables, RICHER)
    if modes > crane.most - SPARE:
        fail(f"--modes {modes}: wanted 1 to {crane.most - SPARE}, as many as the model of such a crane can tell")
    return partial(model_map, crane, richer, modes=modes)


def _mapped(case: Case, computed: Callable[..., xr.Dataset], places: Any, masses: list[float]) -> xr.Dataset:
    """The map, with a progress bar if somebody is looking."""
    from modal.structures.members import FewModes

    title = f"{case.name}: {len(masses)} payloads, {len(places)} positions"
    try:
        return with_bar(title, partial(computed, places, masses))
    except FewModes as error:
        fail(f"{case.path}: crane.tower.lattice: wanted horizontals that leave the modes asked for; {error}")


def _mode_picture(case: Case, frame: CraneFrame, position: float, count: int) -> dict[str, Any]:
    """Picture of the modes with the case's own payload; none if the tower buckles under it."""
    from modal import Unstable
    from towercrane.cases.assumptions import as_notes, rests_on
    from towercrane.report.plots.studies.frequency_map import shapes
    from towercrane.studies.plane_modes import PlaneCrane

    try:
        found = PlaneCrane(replace(frame, payload_mass=case.payload.mass)).modes(position, count)
    except Unstable:
        return {}
    title = (
        f"{case.crane.name}: trolley at {position:g} m, load {case.payload.mass:g} kg on {case.rope.length:g} m; "
        "crane to scale, displacements not"
    )
    return {"shapes.png": shapes(found, title, as_notes(rests_on(case, exact_crane=True)))}

"""Command that sets a tower's lattice, as the truss that it is, beside the beams that stand for it."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from towercrane.commands.terminal import (
    AsJson,
    CaseName,
    Changes,
    announce_compilation,
    fail,
    load,
    options_of,
    suggest,
    tell,
)

if TYPE_CHECKING:
    from towercrane.cases.case import Case


def lattice(case: CaseName, changes: Changes = None, as_json: AsJson = False) -> None:
    """The tower's lattice as beams beside its truss: deflections, frequencies, errors and times."""
    loaded = load(case, changes)
    if loaded.kind == "space":
        fail(f"{case}: wanted a case of kind 'radial', got 'space'; try: towercrane modes {case}")
    if loaded.kind != "radial":
        fail(f"{case}: a crane of kind {loaded.kind!r} has no lattice; try: towercrane linearise {case}")
    from towercrane.cranes.tower.file.members import has_lattice

    if not has_lattice(loaded.crane):
        fail(f"{case}: crane.tower.lattice: wanted the members of the tower, or of each of its segments, got none")
    announce_compilation("structure")
    try:
        report = lattice_report(loaded)
    except ValueError as error:
        fail(f"{case}: crane.tower.lattice: {error}")
    if as_json:
        tell(json.dumps(report, indent=2))
        return
    from towercrane.report.tables.modes import lattice_tables

    lattice_tables(report)
    suggest("modes", case, *options_of(changes), "--actual")


def lattice_report(case: Case) -> dict[str, Any]:
    """Truss and beams of a case's lattice, ready for JSON.

    Returns
    -------
    dict
        ``models``: a list with name, answers, errors relative to the truss, seconds; ``height_m`` of the truss, which
        has whole panels and neither the tower's bodies nor its foundation; ``assumed``.

    Raises
    ------
    ValueError
        If the truss is a mechanism, or legs do not stand on those below.
    """
    from modal.lattices.lattice_comparison import compare_truss
    from towercrane.cases.assumptions import as_entries
    from towercrane.cranes.tower.file.build import radial_crane
    from towercrane.cranes.tower.file.case_tables import RadialCase
    from towercrane.cranes.tower.file.members import tower_truss

    tables = case.tables(RadialCase)
    truss, crane = tower_truss(tables.crane), radial_crane(tables)
    assert truss is not None
    models = compare_truss(truss, crane.end_body)
    return {
        "name": crane.name,
        "height_m": float(truss.nodes[-1, 2]),
        "models": [asdict(model) for model in models],
        "assumed": as_entries(
            a for a in case.assumed if a.key.startswith(("crane.tower.", "crane.counter_jib.", "crane.jib."))
        ),
    }

"""A tower's lattice as the truss that it is, beside the beams that stand for it."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from modal.lattices.lattice_comparison import compare_truss
from towercrane.cases.assumptions import as_entries
from towercrane.cranes.tower.file.build import crane_of
from towercrane.cranes.tower.file.case_tables import TowerCase
from towercrane.cranes.tower.file.members import tower_truss
from towercrane.cranes.tower.file.requests import left_out_in_plane

if TYPE_CHECKING:
    from towercrane.cases.case import Case


def lattice_report(case: Case) -> dict[str, Any]:
    """Truss and beams of a case's lattice, ready for JSON.

    Returns
    -------
    dict
        ``models``: a list with name, answers, errors relative to the truss, seconds; ``height_m`` of the truss, which
        has whole panels and neither the tower's bodies nor its foundation; ``left_out``, ``assumed``.

    Raises
    ------
    ValueError
        If the truss is a mechanism, or legs do not stand on those below.
    """
    tables = case.tables(TowerCase)
    truss, crane = tower_truss(tables.crane), crane_of(tables)
    assert truss is not None
    models = compare_truss(truss, crane.end_body)
    return {
        "name": crane.name,
        "height_m": float(truss.nodes[-1, 2]),
        "models": [asdict(model) for model in models],
        "left_out": left_out_in_plane(tables),
        "assumed": as_entries(
            a for a in case.assumed if a.key.startswith(("crane.tower.", "crane.counter_jib.", "crane.jib."))
        ),
    }

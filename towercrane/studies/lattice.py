"""Lattices of a crane as the trusses that they are, beside the beams that stand for them."""

from __future__ import annotations

from dataclasses import asdict
from math import isnan, pi
from typing import TYPE_CHECKING, Any

from modal.lattices.lattice_comparison import compare_truss
from modal.lattices.space_comparison import compare_in_space
from towercrane.cases.assumptions import as_entries
from towercrane.cranes.tower.file.build import crane_of
from towercrane.cranes.tower.file.case_tables import TowerCase
from towercrane.cranes.tower.file.lattices.in_space import lattices_of
from towercrane.cranes.tower.file.members import tower_truss

if TYPE_CHECKING:
    from collections.abc import Iterable

    from modal.lattices.space_comparison import SpaceModel
    from towercrane.cases.case import Case

TUBE = 10.0
"""Diameter over wall of the round tubes that members with rigid joints are taken to be."""


def lattice_report(case: Case) -> dict[str, Any]:
    """Trusses and beams of a case's lattices, ready for JSON.

    Returns
    -------
    dict
        ``models`` of the tower in one plane, bare and with the slewing part on top: a list with name, answers, errors
        relative to the truss, seconds; empty where the tower has no lattice. ``lattices``, each with name, length,
        whether both planes are alike, and models: in space, pinned, with rigid joints and as a beam, of a jib also as
        the beams of each plane that results rest on. Models have deflections of the tip per force [m/N] and its twist
        per torque [rad/(N m)], frequencies by kind [Hz], seconds; None is what a model does not say. ``tube``, the
        diameter over wall of members with rigid joints; ``height_m`` of the tower's truss, which has whole panels and
        neither the tower's bodies nor its foundation; ``assumed``.

    Raises
    ------
    ValueError
        If there is no lattice, a truss is a mechanism, or parts do not fit each other; it names the key.
    """
    tables = case.tables(TowerCase)
    crane = crane_of(tables)
    try:
        truss = tower_truss(tables.crane)
    except ValueError as error:
        raise ValueError(f"crane.tower.lattice: {error}") from error
    models = compare_truss(truss, crane.end_body) if truss is not None else ()
    rigidity, found = TUBE / (8.0 * pi), []
    for lattice in lattices_of(tables.crane):
        try:
            in_space = compare_in_space(lattice.frame, lattice.beam, rigidity, lattice.planes)
        except ValueError as error:
            raise ValueError(f"{lattice.key}: {error}") from error
        found.append(
            {
                "name": lattice.name,
                "length_m": lattice.length,
                "planes_alike": lattice.planes is None,
                "models": [_in_space(model) for model in in_space],
            }
        )
    if not found:
        raise ValueError(
            "crane.tower.lattice: wanted all members of the tower, or of a jib (each segment's lattice), got none"
        )
    return {
        "name": crane.name,
        "height_m": None if truss is None else float(truss.nodes[-1, 2]),
        "models": [asdict(model) for model in models],
        "lattices": found,
        "tube": TUBE,
        "assumed": as_entries(
            a for a in case.assumed if a.key.startswith(("crane.tower.", "crane.counter_jib.", "crane.jib."))
        ),
    }


def _in_space(model: SpaceModel) -> dict[str, Any]:
    """A model in space, ready for JSON."""

    def said(values: Iterable[float]) -> list[float | None]:
        return [None if isnan(value) else value for value in values]

    return {
        "name": model.name,
        "deflections": dict(zip(("vertical", "lateral", "twist"), said(model.answers.deflections), strict=True)),
        "frequencies_hz": {kind: said(values) for kind, values in model.answers.frequencies_hz.items()},
        "seconds": model.seconds,
    }

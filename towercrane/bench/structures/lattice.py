"""Benchmark of a lattice tower: its truss as the reference, beside three beams, exact and by finite elements."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, get_args

import numpy as np

from modal import Chain, ColumnTruss, StructureElements, chain_structure
from modal.lattices.lattice import BeamModel
from modal.lattices.lattice_comparison import LatticeAnswers, beam_answers, truss_answers
from towercrane.bench.clock import interleaved, short
from towercrane.bench.structures.structure import EXACT, NO_MPMATH, transfer_matrices
from towercrane.cases.case import load_case
from towercrane.cranes.tower.file.build import crane_of
from towercrane.cranes.tower.file.case_tables import TowerCase
from towercrane.cranes.tower.file.members import lattice_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from modal import EndBody, Segment

    Floats = NDArray[np.float64]

CASE = "qtz5613/condition-3"

COUNT = 2
"""Frequencies of the bare tower, and as many with the slewing part."""

ELEMENTS = (2, 4, 8, 16, 32, 64)
"""Numbers of elements."""

TRUSS = "truss"


def lattice(repeats: int) -> dict[str, Any]:
    """Frequencies and static flexibility of the QTZ5613's tower, by its truss and by the beams that stand for it.

    Returns
    -------
    dict
        A subject as in :func:`towercrane.bench.measure`; each record has ``model``, ``method``, ``elements`` and
        ``errors`` against the truss (``bare``, ``loaded``, ``flexibility``), ``own_error`` against the same beam's
        exact frequencies (None without mpmath), ``cpu_seconds``.
    """
    case = load_case(CASE)
    tables = case.tables(TowerCase)
    column, crane = lattice_of(tables.crane), crane_of(tables)
    assert column is not None, "the benchmark's crane has a lattice"
    panels, mass, body = (
        round(crane.tower.length / column.panel_height),
        crane.tower.mass / crane.tower.length,
        crane.end_body,
    )
    height = panels * column.panel_height
    segments = {name: column.segment(height, mass, name) for name in get_args(BeamModel)}
    contestants: dict[str, Callable[[], LatticeAnswers]] = {
        TRUSS: partial(truss_answers, ColumnTruss(column, height, mass), body, COUNT)
    }
    about: dict[str, tuple[str, str, int | None]] = {TRUSS: (TRUSS, TRUSS, None)}
    for name, segment in segments.items():
        contestants[f"{name}, {EXACT}"] = partial(beam_answers, (segment,), body, COUNT)
        about[f"{name}, {EXACT}"] = name, EXACT, None
        for number in ELEMENTS:
            contestants[f"{name}, {number}"] = partial(element_answers, segment, body, number)
            about[f"{name}, {number}"] = name, "finite elements", number
    found, timings = interleaved(contestants, repeats)
    exact = {name: _exact(segment, body, found[f"{name}, {EXACT}"]) for name, segment in segments.items()}
    records: list[dict[str, Any]] = []
    for key, (model, method, elements) in about.items():
        reference = exact.get(model)
        own = None if reference is None else float(np.max(abs(_frequencies(found[key]) / reference - 1.0)))
        records.append(
            {
                "model": model, "method": method, "elements": elements,
                "errors": _errors(found[key].relative_to(found[TRUSS])), "own_error": own,
                "cpu_seconds": timings[key].cpu, "shown": timings[key].spread,
            }
        )  # fmt: skip
    missing = [NO_MPMATH.replace("errors", "the beam's own errors")] if any(e is None for e in exact.values()) else []
    return {
        "name": "lattice",
        "title": f"Lattice tower of {panels} panels: worst error against its truss, and of each beam's own",
        "columns": [
            "model", "method", "f1, f2 bare", "f1, f2 loaded", "flexibility", "of the beam's own", "CPU [ms]"
        ],
        "left": 2,
        "rows": [_row(record) for record in records],
        "records": records,
        "notes": [
            "reference: the pin-jointed space truss, whose nodes carry the mass; loaded: with the slewing part on "
            "top; flexibility: deflection of the top under a force and under a moment",
            "of the beam's own: its four frequencies against transfer matrices in 50-digit arithmetic; elements are "
            "Hermite, for the shear-flexible beam Timoshenko of fourth degree; both are exact statically",
            "every time is for all four frequencies and both deflections, building included",
            *missing,
        ],
    }  # fmt: skip


def element_answers(segment: Segment, body: EndBody, elements: int) -> LatticeAnswers:
    """What finite elements say of a clamped beam."""
    bare = StructureElements(chain_structure(Chain((segment,), {})), elements)
    loaded = StructureElements(chain_structure(Chain((segment,), {1: body})), elements)
    force, moment = (float(bare.displacements(load)[0]) for load in ((1.0, 0.0), (0.0, 1.0)))
    hertz = [tuple((s.angular_frequencies(COUNT) / (2.0 * np.pi)).tolist()) for s in (bare, loaded)]
    return LatticeAnswers(force, moment, hertz[0], hertz[1])


def _exact(segment: Segment, body: EndBody, near: LatticeAnswers) -> Floats | None:
    """Frequencies in 50-digit arithmetic [Hz], bare and loaded; None without mpmath."""
    parts = []
    for bodies, found in (({}, near.frequencies_hz), ({1: body}, near.body_frequencies_hz)):
        angular, _ = transfer_matrices(Chain((segment,), bodies), 2.0 * np.pi * np.array(found))
        if angular is None:
            return None
        parts.append(angular / (2.0 * np.pi))
    return np.concatenate(parts)


def _frequencies(answers: LatticeAnswers) -> Floats:
    return np.array([*answers.frequencies_hz, *answers.body_frequencies_hz])


def _errors(difference: LatticeAnswers) -> dict[str, float]:
    """Largest error of each kind."""
    return {
        "bare": max(map(abs, difference.frequencies_hz)),
        "loaded": max(map(abs, difference.body_frequencies_hz)),
        "flexibility": max(abs(difference.force_deflection), abs(difference.moment_deflection)),
    }


def _row(record: dict[str, Any]) -> list[str]:
    errors = ["-" if record["model"] == TRUSS else short(error) for error in record["errors"].values()]
    method = record["method"] if record["elements"] is None else f"{record['elements']} elements"
    return [record["model"], "" if method == TRUSS else method, *errors, short(record["own_error"]), record["shown"]]

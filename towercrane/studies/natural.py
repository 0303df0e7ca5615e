"""Natural frequencies of a case: tower, jib and the coupled crane, each beside a second way to get them."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np

from modal.clock import timed
from towercrane.cases.assumptions import as_entries, left_out, rests_on
from towercrane.cases.models import motions_of
from towercrane.cranes.tower.crane_model import PLANE_MODES
from towercrane.cranes.tower.equations.small_motions import plane_modes
from towercrane.cranes.tower.file.build import asked_modes, crane_frame, tower_model
from towercrane.cranes.tower.file.case_tables import TowerCase
from towercrane.cranes.tower.file.effects import effects_in, effects_report
from towercrane.cranes.tower.file.members import lattice_of
from towercrane.cranes.tower.file.requests import modes_of, of_play
from towercrane.simulation.outcomes import TOWER_BUCKLED
from towercrane.simulation.system import NoEquilibrium

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from modal import Beam, Chain, CraneFrame, EndBody, LacedColumn
    from towercrane.cases.case import Case
    from towercrane.cranes.tower.model import FlexibleModel
    from towercrane.cranes.tower.modes.parameters import TowerCrane

FRAME_MODES = 5
"""Frequencies of the coupled crane that are shown, commonly the pendulum's and four of the structure."""


FIRST_ROOT = 1.8751040687119611
"""Of a clamped uniform beam."""


def natural_frequencies(case: Case, *, model: FlexibleModel | None = None, actual: bool = False) -> dict[str, Any]:
    """Roots and frequencies of a case, ready for JSON.

    Parameters
    ----------
    case : Case
    model : FlexibleModel, optional
        The case's own, where it has been built.
    actual : bool
        Put beside every prediction what a solution gives.

    Returns
    -------
    dict
        ``tower`` with what the results include, see ``effects`` (frequencies_hz, method, seconds; of a uniform tower
        without effects roots; outcome and message where it buckles), ``jib`` (frequencies_hz, uniform: roots),
        ``finite_elements`` of the tower (frequencies_hz, relative_difference, elements, seconds), ``effects`` of
        shear, weight, rotary inertia and foundation, see `towercrane.cranes.tower.file.effects.effects_report`,
        ``crane`` (a list with trolley_position_m, frequencies_hz, swing_mode, exact_hz and relative_difference to the
        exact mode of the same shape, None where there is none, predicted_difference, missing_from_the_model with
        frequency_hz and member, exact_unlike_the_model_hz, see `towercrane.studies.mode_pairs.ModePairs`; outcome and
        message where the tower buckles), ``uniform_jib`` where ``actual`` is asked for and the jib is none, see
        `uniform_jib_cost`, ``buckling_factor`` on all weights, ``lattice`` where the case has one,
        ``assumed``.
    """
    from modal import Beam, Chain, Modes

    tables = case.tables(TowerCase)
    model = model or tower_model(tables, planar=True)
    asked = modes_of(tables, motions_of(case, model)["trolley"])
    crane, count, elements = model.crane.written, asked.count, asked.elements
    assert crane is not None, "it is made of the case's"
    jib, effects = crane.jib_modes(count), effects_in(tables)
    if isinstance(crane.tower, Beam) and not effects.kept:
        tower, check = _uniform_tower(crane.tower, crane.end_body, count, elements)
    else:
        tower, check = _chain_tower(effects.results_tower, count, elements)
    report: dict[str, Any] = {
        "case": case.name,
        "name": crane.name,
        "tower": tower,
        "jib": {"frequencies_hz": jib.frequencies_hz.tolist()},
        "finite_elements": check,
        "effects": effects_report(effects, actual=actual),
        "crane_model": {kind: asked_modes(tables)[kind] for kind in PLANE_MODES},
        "left_out": [*left_out(case), *of_play(tables)],
        "rope_length_m": case.rope.length,
        "payload_mass_kg": case.payload.mass,
    }
    if isinstance(jib, Modes):
        report["jib"]["roots"] = jib.roots.tolist()
    report["crane"] = [_coupled(tables, model, crane, position) for position in asked.trolley_positions]
    if actual and isinstance(crane.jib, Chain):
        frame = crane_frame(tables, weight=model.weight_softening)
        report["uniform_jib"] = uniform_jib_cost(frame, asked.trolley_positions, FRAME_MODES)
    report["buckling_factor"] = _buckling_factor(tables, asked.trolley_positions[0])
    if tables.crane.tower.published_roots and "roots" in tower:
        report["tower"]["published_roots"] = list(tables.crane.tower.published_roots)
    if (lattice := lattice_of(tables.crane)) is not None:
        report["lattice"] = _lattice(lattice, crane.tower.length)
    entering = rests_on(case, exact_crane=True)
    lattice_too = (a for a in case.assumed if a in entering or a.key.startswith("crane.tower.lattice."))
    report["assumed"] = as_entries(lattice_too)
    return report


def _uniform_tower(tower: Beam, body: EndBody, count: int, elements: int) -> tuple[dict[str, Any], dict[str, Any]]:
    """Roots of a uniform tower from their closed form and its frequencies from finite elements, with their times."""
    from modal import characteristic_roots, finite_element_frequencies

    ratios = body.mass / tower.mass, body.rotary_inertia / (tower.mass * tower.length**2)
    roots, seconds = timed(lambda: characteristic_roots(*ratios, count))
    exact = (roots / tower.length) ** 2 * np.sqrt(tower.bending_stiffness / tower.mass_per_length)
    found = {"frequencies_hz": (exact / (2 * np.pi)).tolist(), "roots": roots.tolist()}
    checked = _checked(lambda: finite_element_frequencies(tower, count, body, elements=elements), exact, elements)
    return found | {"method": "closed form", "seconds": seconds}, checked


def _chain_tower(tower: Chain, count: int, elements: int) -> tuple[dict[str, Any], dict[str, Any]]:
    """Frequencies of a tower with all that it carries, exact and from finite elements, with their times."""
    from modal import chain_frequencies, chain_structure, finite_element_structure_frequencies
    from modal.structures.members import Unstable

    found: dict[str, Any] = {"method": "dynamic stiffness"}
    try:
        exact, seconds = timed(lambda: chain_frequencies(tower, count))
    except Unstable as failure:
        nothing: dict[str, Any] = {"frequencies_hz": [], "seconds": 0.0}
        check = nothing | {"relative_difference": [], "elements": elements}
        return found | nothing | {"outcome": TOWER_BUCKLED, "message": str(failure)}, check
    structure = chain_structure(tower)
    checked = _checked(
        lambda: finite_element_structure_frequencies(structure, count, elements=elements), exact, elements
    )
    return found | {"frequencies_hz": (exact / (2 * np.pi)).tolist(), "seconds": seconds}, checked


def _checked(solve: Callable[[], Any], exact: Any, elements: int) -> dict[str, Any]:
    frequencies, seconds = timed(solve)
    return {
        "frequencies_hz": (frequencies / (2 * np.pi)).tolist(),
        "relative_difference": (frequencies / exact - 1.0).tolist(),
        "elements": elements,
        "seconds": seconds,
    }


def _coupled(tables: TowerCase, model: FlexibleModel, crane: TowerCrane, position: float) -> dict[str, Any]:
    """Frequencies of the coupled crane with the trolley at a position [m], beside the exact ones of the frame."""
    from towercrane.cranes.tower.truncation import truncation_error
    from towercrane.studies.mode_pairs import paired_modes
    from towercrane.studies.plane_modes import PlaneCrane

    row: dict[str, Any] = {"trolley_position_m": position, "frequencies_hz": []}
    try:
        found, swing = plane_modes(model, position, tables.rope.length)
    except NoEquilibrium as failure:
        return row | {"outcome": failure.outcome, "message": str(failure)}
    found = found[:FRAME_MODES]
    row |= {"frequencies_hz": (found / (2 * np.pi)).tolist(), "swing_mode": swing + 1}
    if model.counts["tower_x"] and model.counts["jib_vertical"]:
        exact = PlaneCrane(crane_frame(tables, weight=model.weight_softening))
        pairs = paired_modes(model, exact, position, len(found))
        row["exact_hz"] = pairs.exact_hz
        row["relative_difference"] = [
            None if other is None else own / other - 1.0
            for own, other in zip(pairs.frequencies_hz, pairs.exact_hz, strict=True)
        ]
        row["predicted_difference"] = truncation_error(model, crane, position, tables.rope.length)[
            : len(found)
        ].tolist()
        row["missing_from_the_model"] = [{"frequency_hz": f, "member": member} for f, member in pairs.missing]
        row["exact_unlike_the_model_hz"] = pairs.unlike
    return row


def _buckling_factor(tables: TowerCase, position: float) -> float | None:
    """Factor on all weights, trolley and load included, at which the tower buckles; None: it never does."""
    from modal import crane_structure

    factor = crane_structure(crane_frame(tables, weight=True), position).buckling_factor()
    return factor if np.isfinite(factor) else None


def _lattice(column: LacedColumn, height: float) -> dict[str, dict[str, Any]]:
    """Section properties of the lattice, each with what it may be used for."""
    properties = {
        "chord_second_moment_of_area": column.chord_second_moment_of_area,
        "stiffening_factor": column.stiffening_factor,
        "bending_stiffness": column.bending_stiffness,
        "shear_stiffness": column.shear_stiffness,
        "mass_flexibility": column.mass_flexibility,
        "equivalent_slenderness": column.equivalent_slenderness(height),
        "equivalent_second_moment_of_area": column.equivalent_second_moment_of_area(height),
    }
    return {name: dataclasses.asdict(found) for name, found in properties.items()}


def uniform_jib_cost(frame: CraneFrame, positions: Sequence[float], count: int) -> list[dict[str, Any]]:
    """Relative changes of a crane's exact frequencies by a uniform jib as heavy as its own, with the same first one.

    Parameters
    ----------
    frame : CraneFrame
        With a jib of several segments, or with bodies or shear.
    positions : sequence of float
        Of the trolley [m].
    count : int
        Frequencies.

    Returns
    -------
    list of dict
        trolley_position_m and relative_difference, a number for each frequency, for every position.
    """
    from modal import Chain, Segment, crane_structure
    from modal.structures.chain_modes import chain_modes

    assert frame.jib is not None, "jibs that bend alone are asked for"
    own = frame.jib
    mass = own.inertia[0] / own.length
    first = float(chain_modes(own, 1).angular_frequencies[0])
    bending = mass * (first * (own.length / FIRST_ROOT) ** 2) ** 2
    uniform = dataclasses.replace(frame, jib=Chain((Segment(own.length, mass, bending),)))
    found = []
    for position in positions:
        exact, other = (
            crane_structure(one, position).angular_frequencies(count) for one in (frame, uniform)
        )  # fmt: skip
        found.append({"trolley_position_m": position, "relative_difference": (other / exact - 1.0).tolist()})
    return found

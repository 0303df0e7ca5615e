"""Natural frequencies of a case: tower, jib and the coupled crane, each beside its finite elements; linear model."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np

from modal.clock import timed
from towercrane.models import model_of, radial_model
from towercrane.system import NoEquilibrium

if TYPE_CHECKING:
    from modal import LacedColumn, Structure
    from towercrane.case import Case
    from towercrane.cranes.tower_crane import TowerCrane
    from towercrane.statespace import StateSpace

FRAME_MODES = 5
"""Frequencies of the coupled crane that are shown, commonly the pendulum's and four of the structure."""

FRAME_ELEMENTS = 40
"""Finite elements along the tower and along the jib of the coupled crane."""


def natural_frequencies(case: Case) -> dict[str, Any]:
    """Roots and frequencies of a case, ready for JSON.

    Returns
    -------
    dict
        ``tower`` (roots, frequencies_hz, seconds), ``jib`` (roots, frequencies_hz), ``finite_elements``
        (frequencies_hz, relative_difference, elements, seconds), ``crane`` (a list with trolley_position_m,
        frequencies_hz, swing_mode, finite_elements_hz, relative_difference; outcome and message where the tower
        buckles), ``lattice`` where the case describes one,
        ``assumed``.
    """
    from modal import cantilever_modes, characteristic_roots, finite_element_frequencies

    crane = case.radial_crane()
    count, elements = case.modes.count, case.modes.elements
    modes = cantilever_modes(crane.tower, count, crane.end_body)
    tower, body = crane.tower, crane.end_body
    ratios = body.mass / tower.mass, body.rotary_inertia / (tower.mass * tower.length**2)
    _, seconds = timed(lambda: characteristic_roots(*ratios, count))
    jib = cantilever_modes(crane.jib, count)
    checked, check_seconds = timed(
        lambda: finite_element_frequencies(crane.tower, count, crane.end_body, elements=elements)
    )
    report: dict[str, Any] = {
        "case": case.name,
        "name": crane.name,
        "tower": {
            "roots": modes.roots.tolist(),
            "frequencies_hz": modes.frequencies_hz.tolist(),
            "seconds": seconds,
        },
        "jib": {"roots": jib.roots.tolist(), "frequencies_hz": jib.frequencies_hz.tolist()},
        "finite_elements": {
            "frequencies_hz": (checked / (2 * np.pi)).tolist(),
            "relative_difference": (checked / modes.angular_frequencies - 1.0).tolist(),
            "elements": elements,
            "seconds": check_seconds,
        },
        "crane_model": {"tower_modes": case.model.tower_modes, "jib_modes": case.model.jib_modes},
        "rope_length_m": case.rope.length,
        "payload_mass_kg": case.payload.mass,
    }
    report["crane"] = [_coupled(case, position) for position in case.modes.trolley_positions]
    if case.crane.tower.published_roots:
        report["tower"]["published_roots"] = list(case.crane.tower.published_roots)
    if (lattice := case.lattice()) is not None:
        report["lattice"] = _lattice(lattice, crane.tower.length)
    report["assumed"] = [{"key": a.key, "value": str(a.value), "why": a.why} for a in case.assumed]
    return report


def _coupled(case: Case, position: float) -> dict[str, Any]:
    """Frequencies of the coupled crane with the trolley at a position [m]."""
    from modal import finite_element_structure_frequencies

    crane, model = case.radial_crane(), radial_model(case)
    row: dict[str, Any] = {"trolley_position_m": position, "frequencies_hz": []}
    try:
        found, swing = model.natural_modes(position, case.rope.length)
    except NoEquilibrium as failure:
        return row | {"outcome": failure.outcome, "message": str(failure)}
    found = found[:FRAME_MODES]
    row |= {"frequencies_hz": (found / (2 * np.pi)).tolist(), "swing_mode": swing + 1}
    if model.tower_modes and model.jib_modes and not model.weight_softening:
        frame = finite_element_structure_frequencies(
            plane_frame(crane, position, case.payload.mass, case.rope.length), len(found), elements=FRAME_ELEMENTS
        )
        row["finite_elements_hz"] = (frame / (2 * np.pi)).tolist()
        row["relative_difference"] = (found / frame - 1.0).tolist()
    return row


def plane_frame(crane: TowerCrane, trolley_position: float, payload_mass: float, rope_length: float) -> Structure:
    """Tower and flexible jib with the trolley at a position [m], the rest of the slewing part rigid on the tower."""
    from modal import Chain, CraneFrame, EndBody, Segment, crane_structure

    tower, jib = (
        Chain((Segment(beam.length, beam.mass_per_length, beam.bending_stiffness),), bodies)
        for beam, bodies in (
            (crane.tower, {1: EndBody(crane.counter_mass, crane.counter_inertia)}),
            (crane.jib, {}),
        )
    )
    frame = CraneFrame(
        tower,
        jib,
        trolley_mass=crane.trolley_mass,
        payload_mass=payload_mass,
        rope_length=rope_length,
        gravity=crane.gravity,
    )
    return crane_structure(frame, trolley_position)


def _lattice(column: LacedColumn, height: float) -> dict[str, dict[str, Any]]:
    """Section properties of the lattice, each with what it may be used for."""
    properties = {
        "chord_second_moment_of_area": column.chord_second_moment_of_area,
        "stiffening_factor": column.stiffening_factor,
        "bending_stiffness": column.bending_stiffness,
        "shear_stiffness": column.shear_stiffness,
        "equivalent_slenderness": column.equivalent_slenderness(height),
        "equivalent_second_moment_of_area": column.equivalent_second_moment_of_area(height),
    }
    return {name: dataclasses.asdict(found) for name, found in properties.items()}


def linear_model(case: Case, at: float) -> StateSpace:
    """Linear model of a case about its equilibrium with the drives at rest where they are ``at`` a time [s].

    Raises
    ------
    NoEquilibrium
        If the crane has none.
    """
    from towercrane.linearise import linearise

    return linearise(model_of(case), case.motions, time=at)


def linear_report(case: Case, at: float, linear: StateSpace) -> dict[str, Any]:
    """Linear model of a case, ready for JSON.

    Returns
    -------
    dict
        ``eigenvalues`` (real, imaginary, frequency_hz, damping_ratio, dominant_state; the ratio of a zero is None),
        ``states``, ``inputs`` and ``outputs`` (name, units, value at the operating point), ``A``, ``B``, ``C``,
        ``D``, ``differentiation_error``, ``at_s``, ``assumed``.
    """
    point = linear.point
    report: dict[str, Any] = {"case": case.name, "name": case.crane.name, "at_s": at}
    report["eigenvalues"] = [
        {
            "real": value.real,
            "imaginary": value.imag,
            "frequency_hz": frequency,
            "damping_ratio": ratio if np.isfinite(ratio) else None,
            "dominant_state": state,
        }
        for value, frequency, ratio, state in linear.eigenvalues()
    ]
    kinds = {
        "states": (linear.states, point.states),
        "inputs": (linear.inputs, point.inputs),
        "outputs": (linear.outputs, point.outputs),
    }
    for kind, (signals, values) in kinds.items():
        pairs = zip(signals, values.tolist(), strict=True)
        report[kind] = [{"name": signal.name, "units": signal.units, "value": value} for signal, value in pairs]
    for name in "ABCD":
        report[name] = getattr(linear, name.lower()).tolist()
    report["differentiation_error"] = linear.error
    # The lattice's members enter the tower's check only.
    rests_on = [a for a in case.assumed if not a.key.startswith("crane.tower.lattice.")]
    report["assumed"] = [{"key": a.key, "value": str(a.value), "why": a.why} for a in rests_on]
    return report

"""Natural frequencies of a case: tower, jib and the coupled crane, each beside its finite elements; linear model."""

from __future__ import annotations

import dataclasses
import time
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.models import model_of, radial_model
from towercrane.system import NoEquilibrium

if TYPE_CHECKING:
    from collections.abc import Callable

    from modal import Beam, EndBody, LacedColumn
    from towercrane.case import Case
    from towercrane.statespace import StateSpace

FRAME_MODES = 5
"""Frequencies of the coupled crane that are shown, commonly the pendulum's and four of the structure."""


def natural_frequencies(case: Case) -> dict[str, Any]:
    """Roots and frequencies of a case, ready for JSON.

    Returns
    -------
    dict
        ``tower`` (frequencies_hz; of a uniform tower roots, seconds), ``jib`` (roots, frequencies_hz),
        ``finite_elements`` of a uniform tower (frequencies_hz, relative_difference, elements, seconds), ``crane`` (a
        list with trolley_position_m, frequencies_hz, swing_mode, of a uniform tower finite_elements_hz and
        relative_difference; outcome and message where the tower buckles), ``lattice`` where the case describes one,
        ``assumed``.
    """
    from modal import Beam

    crane, count = case.radial_crane(), case.modes.count
    jib = crane.jib_modes(count)
    report: dict[str, Any] = {
        "case": case.name,
        "name": crane.name,
        "tower": {"frequencies_hz": crane.tower_modes(count).frequencies_hz.tolist()},
        "jib": {"roots": jib.roots.tolist(), "frequencies_hz": jib.frequencies_hz.tolist()},
        "crane_model": {"tower_modes": case.model.tower_modes, "jib_modes": case.model.jib_modes},
        "rope_length_m": case.rope.length,
        "payload_mass_kg": case.payload.mass,
    }
    if isinstance(crane.tower, Beam):
        closed_form, report["finite_elements"] = _uniform_tower(
            crane.tower, crane.end_body, count, case.modes.elements
        )
        report["tower"] |= closed_form
    report["crane"] = [_coupled(case, position) for position in case.modes.trolley_positions]
    if case.crane.tower.published_roots:
        report["tower"]["published_roots"] = list(case.crane.tower.published_roots)
    if (lattice := case.lattice()) is not None:
        report["lattice"] = _lattice(lattice, crane.tower.length)
    report["assumed"] = [{"key": a.key, "value": str(a.value), "why": a.why} for a in case.assumed]
    return report


def _uniform_tower(tower: Beam, body: EndBody, count: int, elements: int) -> tuple[dict[str, Any], dict[str, Any]]:
    """Roots of a uniform tower from their closed form and its frequencies from finite elements, with their times."""
    from modal import characteristic_roots, finite_element_frequencies

    ratios = body.mass / tower.mass, body.rotary_inertia / (tower.mass * tower.length**2)
    roots, seconds = _timed(lambda: characteristic_roots(*ratios, count))
    checked, check_seconds = _timed(lambda: finite_element_frequencies(tower, count, body, elements=elements))
    exact = (roots / tower.length) ** 2 * np.sqrt(tower.bending_stiffness / tower.mass_per_length)
    return {"roots": roots.tolist(), "seconds": seconds}, {
        "frequencies_hz": (checked / (2 * np.pi)).tolist(),
        "relative_difference": (checked / exact - 1.0).tolist(),
        "elements": elements,
        "seconds": check_seconds,
    }


def _coupled(case: Case, position: float) -> dict[str, Any]:
    """Frequencies of the coupled crane with the trolley at a position [m]."""
    from modal import Beam, frame_frequencies

    crane, model = case.radial_crane(), radial_model(case)
    row: dict[str, Any] = {"trolley_position_m": position, "frequencies_hz": []}
    try:
        found, swing = model.natural_modes(position, case.rope.length)
    except NoEquilibrium as failure:
        return row | {"outcome": failure.outcome, "message": str(failure)}
    found = found[:FRAME_MODES]
    row |= {"frequencies_hz": (found / (2 * np.pi)).tolist(), "swing_mode": swing + 1}
    if isinstance(crane.tower, Beam) and model.tower_modes and model.jib_modes and not model.weight_softening:
        frame = frame_frequencies(
            crane.tower,
            crane.jib,
            head_mass=crane.counter_mass,
            head_inertia=crane.counter_inertia,
            trolley_position=position,
            trolley_mass=crane.trolley_mass,
            payload_mass=case.payload.mass,
            rope_length=case.rope.length,
            gravity=crane.gravity,
            count=len(found),
        )
        row["finite_elements_hz"] = (frame / (2 * np.pi)).tolist()
        row["relative_difference"] = (found / frame - 1.0).tolist()
    return row


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


def _timed(function: Callable[[], Any], repeats: int = 5) -> tuple[Any, float]:
    """Result and median time of a few calls [s]; the first, which loads code, is not counted."""
    result = function()
    seconds = []
    for _ in range(repeats):
        began = time.perf_counter()
        function()
        seconds.append(time.perf_counter() - began)
    return result, float(np.median(seconds))


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
    report["assumed"] = [{"key": a.key, "value": str(a.value), "why": a.why} for a in case.rests_on]
    return report

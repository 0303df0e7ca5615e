"""Natural modes of a case in space: frequencies and kinds over trolley position, rope length and slewing angle."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cases.assumptions import as_entries
from towercrane.cases.models import space_model
from towercrane.cranes.tower.small_motions import natural_modes
from towercrane.simulation.system import NoEquilibrium

if TYPE_CHECKING:
    from towercrane.cases.case import Assumption, Case
    from towercrane.cranes.tower.model import FlexibleModel
    from towercrane.cranes.tower.small_motions import NaturalMode

RICHER = 2
"""More modes of every kind in the model that shows what the case's leaves out."""

POINTS = 25
"""Places of a sweep that a picture draws."""


@dataclass(frozen=True)
class Place:
    """Where the drives stand.

    Parameters
    ----------
    trolley_position, rope_length : float
        [m]
    slewing_angle : float
        Of the head, or of its drive's shaft [rad].
    """

    trolley_position: float
    rope_length: float
    slewing_angle: float = 0.0


SWEPT = {"trolley_position": "m", "rope_length": "m", "slewing_angle": "rad"}
"""What is varied, each by itself, and its unit."""


def place_at(case: Case, time: float = 0.0) -> Place:
    """Where the drives of a case in space stand at a time [s]."""
    turning = "shaft" if "shaft" in case.motions else "slewing"
    return Place(*(float(case.motions[channel](time)) for channel in ("trolley", "rope", turning)))


def modes_at(model: FlexibleModel, place: Place, count: int) -> list[NaturalMode]:
    """The lowest natural modes with the drives standing somewhere.

    Raises
    ------
    NoEquilibrium
        If the tower buckles.
    """
    return natural_modes(model, place.trolley_position, place.rope_length, place.slewing_angle)[:count]


def asked_places(case: Case) -> dict[str, tuple[float, ...]]:
    """Values of each drive at which the case wants its modes; without any, those at both ends of its way."""
    asked, motions = case.space.modes, case.motions
    turning = motions["shaft" if "shaft" in motions else "slewing"]
    ways = zip(
        SWEPT,
        (asked.trolley_positions, asked.rope_lengths, asked.slewing_angles),
        (motions["trolley"], motions["rope"], turning),
        strict=True,
    )
    return {name: wanted or tuple(dict.fromkeys(motion.range())) for name, wanted, motion in ways}


def space_frequencies(case: Case) -> dict[str, Any]:
    """Natural frequencies of a case in space, ready for JSON.

    Returns
    -------
    dict
        ``at`` (where the drives stand at the start), ``pendulum_hz`` of the rope by itself there, ``modes`` (a list
        with frequency_hz, kind, energy_shares, and relative_difference from a model with more modes), ``sweeps``: for
        each of `SWEPT` a list with value, frequencies_hz and kinds, the other two as in ``at``; outcome and message
        where the tower buckles; ``assumed``.
    """
    model, count, start = space_model(case), case.space.modes.count, place_at(case)
    counts = case.space.model
    richer = {
        name: getattr(counts, name) + RICHER
        for name in ("tower_modes", "torsion_modes", "jib_lateral_modes", "jib_vertical_modes")
        if getattr(counts, name)
    }
    report: dict[str, Any] = {
        "case": case.name,
        "name": case.crane.name,
        "payload_mass_kg": case.payload.mass,
        "modes_of_the_model": model.counts,
        "at": {f"{name}_{unit}": getattr(start, name) for name, unit in SWEPT.items()},
        "pendulum_hz": float(np.sqrt(model.crane.gravity / start.rope_length) / (2.0 * np.pi)),
        "modes": [],
    }
    try:
        found, better = (modes_at(m, start, count) for m in (model, space_model(case, **richer)))
    except NoEquilibrium as failure:
        report |= {"outcome": failure.outcome, "message": str(failure)}
    else:
        report["modes"] = [
            {
                "frequency_hz": mode.frequency_hz,
                "kind": mode.kind,
                "energy_shares": mode.shares,
                "relative_difference": mode.frequency_hz / more.frequency_hz - 1.0,
            }
            for mode, more in zip(found, better, strict=False)
        ]
    report["sweeps"] = {
        name: [_row(model, replace(start, **{name: value}), value, count) for value in values]
        for name, values in asked_places(case).items()
    }
    report["assumed"] = as_entries(modes_rest_on(case))
    return report


def modes_rest_on(case: Case) -> list[Assumption]:
    """Assumptions that natural frequencies rest on: those of the crane at rest in still air."""
    apart = ("motion.", "run.", "wind.", "payload.drag", "crane.wind_areas.", "crane.friction.")
    return [a for a in case.rests_on if not a.key.startswith(apart)]


def drawn_sweeps(case: Case) -> dict[str, list[dict[str, Any]]]:
    """The sweeps of :func:`space_frequencies` at evenly spaced values between their ends, for pictures."""
    model, count, start = space_model(case), case.space.modes.count, place_at(case)
    sweeps = {}
    for name, values in asked_places(case).items():
        low, high = min(values), max(values)
        places = np.linspace(low, high, POINTS if high > low else 1)
        sweeps[name] = [_row(model, replace(start, **{name: float(value)}), float(value), count) for value in places]
    return sweeps


def _row(model: FlexibleModel, place: Place, value: float, count: int) -> dict[str, Any]:
    try:
        found = modes_at(model, place, count)
    except NoEquilibrium as failure:
        nothing: dict[str, Any] = {"value": value, "frequencies_hz": [], "kinds": []}
        return nothing | {"outcome": failure.outcome, "message": str(failure)}
    return {
        "value": value,
        "frequencies_hz": [mode.frequency_hz for mode in found],
        "kinds": [mode.kind for mode in found],
    }

"""Natural modes of a case in space: frequencies and kinds over trolley position, rope length and slewing angle."""

from __future__ import annotations

from dataclasses import astuple, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cases.assumptions import as_entries, rests_on
from towercrane.cases.models import motions_of
from towercrane.cranes.tower.crane_model import MODE_KINDS, described
from towercrane.cranes.tower.equations.small_motions import leans_on, natural_modes
from towercrane.cranes.tower.file.build import asked_modes, crane_of, tower_model
from towercrane.cranes.tower.file.case_tables import TowerCase
from towercrane.cranes.tower.file.requests import of_free_head, of_play
from towercrane.simulation.system import NoEquilibrium
from towercrane.studies.branches import CLEAR
from towercrane.studies.mode_pairs import BELONGING

if TYPE_CHECKING:
    from towercrane.cases.case import Assumption, Case
    from towercrane.cranes.tower.equations.small_motions import NaturalMode
    from towercrane.cranes.tower.model import FlexibleModel

RICHER = 2
"""Modes of every kind that the model which shows what the case's leaves out has more."""

POINTS = 25
"""Places of a sweep that a picture draws."""


@dataclass(frozen=True)
class Place:
    """Where the drives stand.

    Parameters
    ----------
    position : float
        Of the trolley [m], or the angle of a jib that pivots [rad], as its winch has it.
    rope_length : float
        [m]
    slewing_angle : float
        Of the head, or of its drive's shaft [rad].
    """

    position: float
    rope_length: float
    slewing_angle: float = 0.0


def swept(tables: TowerCase) -> dict[str, str]:
    """What is varied, each by itself, and its unit; in the order of a `Place`."""
    position = {"trolley_position": "m"} if tables.crane.jib.luffing is None else {"luffing_angle": "rad"}
    return {**position, "rope_length": "m", "slewing_angle": "rad"}


def space_model(tables: TowerCase) -> FlexibleModel:
    """The case's crane with a load that may swing to all sides, in the modes for which the crane has data."""
    known = described(crane_of(tables))
    absent = {kind: 0 for kind in MODE_KINDS if kind not in known}
    return tower_model(tables, planar=False, heading=0.0, **absent)


def place_at(case: Case, time: float = 0.0) -> Place:
    """Where the drives of a case in space stand at a time [s]."""
    motions = motions_of(case)
    turning = "shaft" if "shaft" in motions else "slewing"
    position = "luffing" if "luffing" in motions else "trolley"
    return Place(*(float(motions[channel](time)) for channel in (position, "rope", turning)))


def modes_at(model: FlexibleModel, place: Place, count: int) -> list[NaturalMode]:
    """The lowest natural modes with the drives standing somewhere.

    Raises
    ------
    NoEquilibrium
        If the tower buckles.
    """
    return natural_modes(model, place.position, place.rope_length, place.slewing_angle)[:count]


def asked_places(case: Case) -> dict[str, tuple[float, ...]]:
    """Values of each drive at which the case wants its modes; without any, those at both ends of its way."""
    tables, motions = case.tables(TowerCase), motions_of(case)
    asked, turning = tables.modes, motions["shaft" if "shaft" in motions else "slewing"]
    position = motions["luffing" if "luffing" in motions else "trolley"]
    ways = zip(
        swept(tables),
        (asked.trolley_positions or asked.luffing_angles, asked.rope_lengths, asked.slewing_angles),
        (position, motions["rope"], turning),
        strict=True,
    )
    return {name: wanted or tuple(dict.fromkeys(motion.range())) for name, wanted, motion in ways}


def space_frequencies(case: Case) -> dict[str, Any]:
    """Natural frequencies of a case in space, ready for JSON.

    Returns
    -------
    dict
        ``at`` (where the drives stand at the start), ``pendulum_hz`` of the rope by itself there, ``modes`` (a list
        with frequency_hz, kind, energy_shares, and relative_difference from the mode of the same shape of a model
        with more modes of every kind that the crane has, None where there is none), ``missing_from_the_model`` (a
        list with frequency_hz and kind: modes of the richer model up to the highest of these that the case's cannot
        have), ``sweeps``: for each of `swept` a list with value, frequencies_hz and kinds, the other two as in
        ``at``; outcome and message
        where the tower buckles; ``left_out`` (what they know of collars with play), ``assumed``.
    """
    tables = case.tables(TowerCase)
    model, count, start = space_model(tables), tables.modes.crane_count, place_at(case)
    at = astuple(start)
    report: dict[str, Any] = {
        "case": case.name,
        "name": case.crane.name,
        "payload_mass_kg": case.payload.mass,
        "modes_of_the_model": model.counts,
        "at": {f"{name}_{unit}": value for (name, unit), value in zip(swept(tables).items(), at, strict=True)},
        "pendulum_hz": float(np.sqrt(model.crane.gravity / start.rope_length) / (2.0 * np.pi)),
        "modes": [],
        "missing_from_the_model": [],
        "left_out": [],
    }
    try:
        modes = natural_modes(model, *vars(start).values())
        report["left_out"] = [
            *of_play(tables, leans_on(model, *vars(start).values())), *of_free_head(tables, model)
        ]  # fmt: skip
        report |= beside_a_richer(model, modes, richer_model(tables), start, count)
    except NoEquilibrium as failure:
        report |= {"outcome": failure.outcome, "message": str(failure)}
    report["sweeps"] = {
        name: [_row(model, at, i, value, count) for value in values]
        for i, (name, values) in enumerate(asked_places(case).items())
    }
    report["assumed"] = as_entries(modes_rest_on(case))
    return report


def richer_model(tables: TowerCase) -> FlexibleModel:
    """The case's crane with more modes of every kind that it has, those that the case leaves out too."""
    kinds = described(crane_of(tables))
    asked = asked_modes(tables)
    more = {kind: asked[kind] + RICHER for kind in kinds}
    return tower_model(tables, planar=False, heading=0.0, **more)


def beside_a_richer(
    model: FlexibleModel, modes: list[NaturalMode], richer: FlexibleModel, place: Place, count: int
) -> dict[str, Any]:
    """The lowest modes of a model beside those of the same shape of a richer one.

    Shapes are compared by the modal assurance criterion with the richer model's stiffness as its weight, see
    :func:`towercrane.studies.mode_pairs.paired_modes`: in its modes, which have unit elastic energy, a shape's
    entries squared are the shares of its energy.

    Raises
    ------
    NoEquilibrium
        If the richer model's tower buckles.
    """
    theirs = natural_modes(richer, *vars(place).values())
    own = np.zeros((len(theirs), len(modes)))
    for kind, part in model.parts.items():
        first = richer.parts[kind].start
        own[first : first + model.counts[kind]] = np.transpose([mode.shape[part] for mode in modes])
    # Rope and slings have the same coordinates in both.
    hung = modes[0].shape[model.coordinates :].size
    own[-hung:] = np.transpose([mode.shape[-hung:] for mode in modes])
    entries = np.linalg.solve(np.transpose([mode.shape for mode in theirs]), own)
    criteria = (entries**2 / (entries**2).sum(axis=0)).T
    held = (np.linalg.qr(entries)[0] ** 2).sum(axis=1)
    rows = []
    for mode, criterion in zip(modes[:count], criteria, strict=False):
        b = int(np.argmax(criterion))
        other = theirs[b].frequency_hz if criterion[b] >= CLEAR else None
        rows.append({
            "frequency_hz": mode.frequency_hz,
            "kind": mode.kind,
            "energy_shares": mode.shares,
            "relative_difference": None if other is None else mode.frequency_hz / other - 1.0,
        })  # fmt: skip
    highest = modes[:count][-1].frequency_hz
    missing = [
        {"frequency_hz": mode.frequency_hz, "kind": mode.kind}
        for mode, share in zip(theirs, held, strict=True)
        if share < BELONGING and mode.frequency_hz <= highest
    ]
    return {"modes": rows, "missing_from_the_model": missing}


def modes_rest_on(case: Case) -> list[Assumption]:
    """Assumptions that natural frequencies, and what the modes left out would change, rest on: in still air."""
    apart = ("motion.", "run.", "wind.", "earthquake.", "payload.drag", "crane.wind_areas.", "crane.friction.")
    return [a for a in rests_on(case, all_modes=True) if not a.key.startswith(apart)]


def drawn_sweeps(case: Case) -> dict[str, list[dict[str, Any]]]:
    """The sweeps of :func:`space_frequencies` at evenly spaced values between their ends, for pictures."""
    tables = case.tables(TowerCase)
    model, count, at = space_model(tables), tables.modes.crane_count, astuple(place_at(case))
    sweeps = {}
    for i, (name, values) in enumerate(asked_places(case).items()):
        low, high = min(values), max(values)
        places = np.linspace(low, high, POINTS if high > low else 1)
        sweeps[name] = [_row(model, at, i, float(value), count) for value in places]
    return sweeps


def _row(model: FlexibleModel, at: tuple[float, ...], changed: int, value: float, count: int) -> dict[str, Any]:
    """Modes with one of the drives, by its place among them, at a value of its own."""
    position, rope, heading = (value if i == changed else own for i, own in enumerate(at))
    place = Place(position, rope, heading)
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

"""What of a tower crane's file a case does not use: one file serves scenes in the plane and in space."""

from __future__ import annotations

from typing import TYPE_CHECKING

from modal import Foundation
from towercrane.cranes.tower.file.build import asked_modes
from towercrane.cranes.tower.file.lattices.torsion import KEYS
from towercrane.cranes.tower.file.members import beam_choice, foundation_of
from towercrane.cranes.tower.file.plane import stays_in_plane

if TYPE_CHECKING:
    from collections.abc import Iterator

    from towercrane.cranes.tower.file.case_tables import TowerCase

SIDEWAYS = "second_moment_of_area", "shear_stiffness", "rotary_inertia_per_length"
"""What a jib's bending to its sides has of its own."""


def idle(tables: TowerCase, *, exact_crane: bool = False, all_modes: bool = False) -> Iterator[str]:
    """Beginnings of keys of a crane that do not enter its equations of motion.

    Parameters
    ----------
    tables : TowerCase
    exact_crane : bool
        For the exact frequencies of the whole crane in the plane, whose counter-jib bends where its file says so.
    all_modes : bool
        For models with modes of every kind that the crane has, whatever the case takes.
    """
    crane, model = tables.crane, tables.model
    planar = exact_crane or stays_in_plane(tables)
    rigid = planar or not (model.torsion_modes or all_modes)
    if not crane.tower.segments:
        if beam_choice(crane.tower, crane.tower) != "stated":
            yield "crane.tower.second_moment_of_area"
        elif rigid or all(getattr(crane.tower, key) is not None for key in KEYS):
            yield "crane.tower.lattice."
    if foundation_of(crane) == Foundation():
        yield "crane.foundation.block."
    if rigid:
        yield from (f"crane.tower.{key}" for key in KEYS)
        yield from (f"crane.tower.collars.{k}.torsional_stiffness" for k in range(len(crane.tower.collars)))
    yield from _idle_of_jibs(tables, planar, bending=exact_crane or all_modes)
    if planar:
        yield "crane.roll_inertia"
    if planar or tables.motion.shaft is None:
        yield from ("crane.drive.", "crane.friction.")
    if exact_crane or tables.wind is None:
        yield "crane.wind_areas."


def _idle_of_jibs(tables: TowerCase, planar: bool, *, bending: bool) -> Iterator[str]:
    """The same of jib and counter-jib, which bend as the case has it, or wherever their file says how."""
    counts = asked_modes(tables)
    for name, jib in (("jib", tables.crane.jib), ("counter_jib", tables.crane.counter_jib)):
        upright, sideways = (bending or bool(counts[f"{name}_{way}_modes"]) for way in ("vertical", "lateral"))
        # On ties a jib bends up and down whatever modes it has.
        upright, sideways = upright or bool(jib.ties), sideways and not planar
        pieces = [f"crane.{name}.segments.{number}." for number, _ in enumerate(jib.segments)]
        if jib.lattice is not None and jib.laced is None:
            yield f"crane.{name}.lattice."
        for piece in (f"crane.{name}.", *pieces):
            if not sideways:
                # A jib that is rigid to its sides turns with the inertia of its sections all the same.
                yield from (f"{piece}lateral_{key}" for key in (SIDEWAYS if planar else SIDEWAYS[:2]))
            if name == "counter_jib" and not upright:
                yield from (f"{piece}{key}" for key in ("second_moment_of_area", "shear_stiffness"))
                if not sideways:
                    yield f"{piece}youngs_modulus"

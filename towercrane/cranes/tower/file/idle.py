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
    counter_jib = 0 if exact_crane else asked_modes(tables)["counter_jib_vertical_modes"]
    if not (exact_crane or all_modes or counter_jib):
        yield from ("crane.counter_jib.youngs_modulus", "crane.counter_jib.second_moment_of_area")
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
    if planar or not (model.jib_lateral_modes or all_modes):
        pieces = [f"segments.{number}." for number, _ in enumerate(crane.jib.segments)] or [""]
        yield from (f"crane.jib.{piece}lateral_{name}" for piece in pieces for name in SIDEWAYS)
    if planar:
        yield "crane.roll_inertia"
    if planar or tables.motion.shaft is None:
        yield from ("crane.drive.", "crane.friction.")
    if exact_crane or tables.wind is None:
        yield "crane.wind_areas."

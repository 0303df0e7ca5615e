"""What of a tower crane's file a case does not use: one file serves runs in the plane and in space."""

from __future__ import annotations

from typing import TYPE_CHECKING

from towercrane.cranes.tower.file.members import beam_choice

if TYPE_CHECKING:
    from collections.abc import Iterator

    from towercrane.cranes.tower.file.case_tables import RadialCase, SpaceCase
    from towercrane.cranes.tower.file.tables import Crane


def idle_in_plane(tables: RadialCase, *, exact_crane: bool = False, all_modes: bool = False) -> Iterator[str]:
    """Beginnings of keys of a crane that do not enter its equations of motion in the plane.

    Parameters
    ----------
    tables : RadialCase
    exact_crane : bool
        For the exact frequencies of the whole crane in the plane, whose counter-jib bends where its file says so.
    all_modes : bool
        For models with modes of every kind; in the plane that changes nothing.
    """
    yield from _idle(tables.crane, exact_crane=exact_crane)
    yield from ("crane.tower.torsional_", "crane.jib.lateral_second_moment_of_area")
    yield from ("crane.drive.", "crane.friction.", "crane.wind_areas.", "crane.roll_inertia")


def idle_in_space(tables: SpaceCase, *, exact_crane: bool = False, all_modes: bool = False) -> Iterator[str]:
    """Beginnings of keys of a crane that do not enter its equations of motion in space.

    Parameters
    ----------
    tables : SpaceCase
    exact_crane : bool
        As in `idle_in_plane`.
    all_modes : bool
        For models with modes of every kind that the crane has, whatever the case takes.
    """
    yield from _idle(tables.crane, exact_crane=exact_crane)
    if not (tables.model.torsion_modes or all_modes):
        yield "crane.tower.torsional_"
    if not (tables.model.jib_lateral_modes or all_modes):
        yield "crane.jib.lateral_second_moment_of_area"
    if tables.motion.shaft is None:
        yield from ("crane.drive.", "crane.friction.")
    if tables.wind is None:
        yield "crane.wind_areas."


def _idle(crane: Crane, *, exact_crane: bool) -> Iterator[str]:
    """What neither uses."""
    if not exact_crane:
        yield from ("crane.counter_jib.youngs_modulus", "crane.counter_jib.second_moment_of_area")
    if not crane.tower.segments:
        stated = beam_choice(crane.tower, crane.tower) == "stated"
        yield "crane.tower.lattice." if stated else "crane.tower.second_moment_of_area"

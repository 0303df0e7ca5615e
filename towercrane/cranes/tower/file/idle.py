"""What of a tower crane's file a case does not use: one file serves runs in the plane and in space."""

from __future__ import annotations

from typing import TYPE_CHECKING

from towercrane.cranes.tower.file.build import beam_choice
from towercrane.schema.text import leaves

if TYPE_CHECKING:
    from collections.abc import Iterator

    from towercrane.cases.case import Case


def idle_in_file(case: Case) -> tuple[str, ...]:
    """Tables and keys that are written but do not enter the equations of motion."""
    unused = tuple(idle_keys(case))
    keys = [key for key, _ in leaves({"crane": case.as_written["crane"]}) if key.startswith(unused)]
    found = (next(name for name in unused if key.startswith(name)).rstrip(".") for key in keys)
    return tuple(dict.fromkeys(found))


def idle_keys(case: Case, *, exact_crane: bool = False, all_modes: bool = False) -> Iterator[str]:
    """Beginnings of keys of a tower crane that do not enter its equations of motion; none for other cranes.

    The options are those of :func:`towercrane.cases.assumptions.rests_on`.
    """
    if case.kind not in ("radial", "space"):
        return
    if not exact_crane:
        yield from ("crane.counter_jib.youngs_modulus", "crane.counter_jib.second_moment_of_area")
    tower = case.crane.tower
    if not tower.segments:
        stated = beam_choice(tower, tower) == "stated"
        yield "crane.tower.lattice." if stated else "crane.tower.second_moment_of_area"
    space = case.space if case.kind == "space" else None
    if space is None or not (space.model.torsion_modes or all_modes):
        yield "crane.tower.torsional_"
    if space is None or not (space.model.jib_lateral_modes or all_modes):
        yield "crane.jib.lateral_second_moment_of_area"
    if space is None or space.motion.shaft is None:
        yield from ("crane.drive.", "crane.friction.")
    if space is None or space.wind is None:
        yield "crane.wind_areas."
    if space is None:
        yield "crane.roll_inertia"

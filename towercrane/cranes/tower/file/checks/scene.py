"""What of a tower crane's scene belongs together, checked on the tables as written."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from towercrane.cranes.parts.turbulence.checks import MISSING, check_wind
from towercrane.cranes.tower.file.case_tables import Model
from towercrane.cranes.tower.file.checks.jib import laced
from towercrane.cranes.tower.file.checks.tower import tables_in
from towercrane.cranes.tower.file.plane import heading_written
from towercrane.cranes.tower.targets import ALL, absent, lacking
from towercrane.schema.faults import Fault, shown
from towercrane.schema.ranges import at, si
from towercrane.schema.units import wanted

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

NEEDED = {
    "torsion_modes": (("tower.torsional_stiffness", "N m^2"), ("tower.torsional_inertia_per_length", "kg m^2/m")),
}
"""What of the crane modes of a kind need, and its unit."""

PRESSED = {
    "crane.wind_areas.tower": "m",
    "crane.wind_areas.jib": "m",
    "crane.wind_areas.counter_jib": "m",
    "crane.wind_areas.counterweight": "m^2",
    "payload.drag_area": "m^2",
    "payload.drag": "N s^2/m^2",
}
"""What the wind may press on, and its unit."""


def check_scene(tree: dict[str, Any]) -> Iterator[Fault]:
    """Faults of a scene as a whole. Keys that are wrong by themselves are for others to report."""
    heading = heading_written(tree)
    yield from _check_outputs(tree, () if heading is None else absent(heading))
    if heading is None:
        yield from _check_members(tree)
        yield from _check_bending(tree, "lateral")
    if heading is None or any(at(tree, key) is not None for key in ("crane.jib.luffing", "crane.tower_head")):
        yield from _check_force(tree)
    if at(tree, "model.counter_jib_vertical_modes"):
        yield from _check_bending(tree, "vertical")
    yield from _check_drive(tree)
    yield from check_wind(tree, PRESSED)
    yield from _check_floors(tree)


def _check_outputs(tree: dict[str, Any], still: Collection[str]) -> Iterator[Fault]:
    """Errors that are asked for of outputs which the crane does not have, or which stay still in its scene."""
    ties = (tables_in(at(tree, f"crane.{member}.ties")) for member in ("jib", "counter_jib"))
    none = lacking(at(tree, "crane.jib.luffing") is not None, *map(len, ties))
    outputs, target = at(tree, "accuracy.outputs"), at(tree, "accuracy.target")
    asked = [("outputs", name) for name in outputs] if isinstance(outputs, list) else []
    asked += [("target", name) for name in target] if isinstance(target, dict) else []
    for key, name in asked:
        if isinstance(name, str) and name in ALL and (name in none or name in still):
            what = f"one of {', '.join(output for output in ALL if output not in {*none, *still})}"
            hint = "nothing turns the head, blows or shakes across the jib: the scene stays in the jib's plane"
            hint = "runs of such a crane have no such output" if name in none else hint
            yield Fault("", f"accuracy.{key}", what, shown(name), hint)


def _check_force(tree: dict[str, Any]) -> Iterator[Fault]:
    """A force that no output is named for where a target without names is one of the motions."""
    target = at(tree, "accuracy.target")
    if isinstance(target, str) and not at(tree, "accuracy.outputs") and si(target, "N") is not None:
        hint = "accuracy.outputs names the forces that the target is for"
        yield Fault("", "accuracy.target", "an error of motions where no outputs are named", shown(target), hint)


def _check_members(tree: dict[str, Any]) -> Iterator[Fault]:
    """Modes of members that the crane file does not describe."""
    for modes, keys in NEEDED.items():
        if modes == "torsion_modes" and _laced_throughout(tree):
            continue
        count = at(tree, f"model.{modes}")
        count = Model.model_fields[modes].default if count is None else count
        if not (isinstance(count, int) and count > 0) or not isinstance(at(tree, "crane.tower"), dict):
            continue
        for key, unit in keys:
            if at(tree, f"crane.{key}") is None and isinstance(at(tree, f"crane.{key.partition('.')[0]}"), dict):
                more = "; a lattice of the whole tower gives it as well" if modes == "torsion_modes" else ""
                yield _undescribed(f"crane.{key}", unit, modes, count, more)


def _check_bending(tree: dict[str, Any], plane: str) -> Iterator[Fault]:
    """Modes of jibs whose file does not say how they bend to their sides, or of a counter-jib up and down."""
    name = "lateral_second_moment_of_area" if plane == "lateral" else "second_moment_of_area"
    for member in ("jib", "counter_jib"):
        jib, key = at(tree, f"crane.{member}"), f"{member}_{plane}_modes"
        count = at(tree, f"model.{key}")
        count = Model.model_fields[key].default if count is None else count
        if not isinstance(jib, dict) or not (isinstance(count, int) and count > 0):
            continue
        pieces = [(f"crane.{member}.segments.{k}", own) for k, own in enumerate(tables_in(jib.get("segments")))]
        for place, piece in pieces or [(f"crane.{member}", jib)]:
            if name not in piece and not laced(piece, jib):
                yield _undescribed(f"{place}.{name}", "m^4", key, count)


def _undescribed(key: str, unit: str, modes: str, count: int, more: str = "") -> Fault:
    what = f"{wanted(unit)}, for model.{modes} = {count}"
    return Fault("", key, what, MISSING, f"model.{modes} = 0 leaves it rigid{more}")


def _laced_throughout(tree: dict[str, Any]) -> bool:
    """Whether the tower, or each of its segments, has its members given."""
    tower = at(tree, "crane.tower")
    segments = at(tree, "crane.tower.segments")
    pieces = segments if isinstance(segments, list) and segments else [tower]
    return all(isinstance(piece, dict) and isinstance(piece.get("lattice"), dict) for piece in pieces)


def _check_drive(tree: dict[str, Any]) -> Iterator[Fault]:
    """A head that turns twice, and a shaft without its drive."""
    if at(tree, "motion.shaft") is None:
        return
    if at(tree, "motion.slewing") is not None:
        what = "one of [motion.slewing] (the head turns as stated) and [motion.shaft] (its drive's shaft does)"
        yield Fault("", "motion.slewing", what, "both", "leave one out")
    crane = at(tree, "crane")
    if isinstance(crane, dict) and "drive" not in crane:
        hint = "without a drive the head turns as [motion.slewing] says"
        what = "a table [crane.drive] with soft_stiffness, stiff_stiffness, corner: [motion.shaft] needs it"
        yield Fault("", "crane.drive", what, "nothing: the table is missing", hint)


def _check_floors(tree: dict[str, Any]) -> Iterator[Fault]:
    """Floors that are not one for each collar."""
    floors, collars = at(tree, "earthquake.floors"), at(tree, "crane.tower.collars") or []
    if isinstance(floors, list) and floors and isinstance(collars, list) and len(floors) != len(collars):
        what = f"a file for each of {len(collars)} collars of the tower, the lowest first, or none"
        yield Fault("", "earthquake.floors", what, f"{len(floors)}", "without files collars move with the ground")

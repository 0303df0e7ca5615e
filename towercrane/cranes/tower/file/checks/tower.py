"""What of a crane file's tower belongs together, checked on the tables as written."""

from __future__ import annotations

from math import sqrt
from typing import TYPE_CHECKING, Any

from towercrane.cranes.tower.file.tower_tables import Tower, TowerSegment
from towercrane.schema.faults import Fault, closest, shown
from towercrane.schema.ranges import at, si_at
from towercrane.schema.units import wanted

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

TOWER = "crane.tower"

UNIFORM = (
    "mass_per_length", "second_moment_of_area", "lattice", "shear_stiffness", "rotary_inertia_per_length",
    "published_roots",
)  # fmt: skip
"""Keys that describe a uniform tower."""

ROUNDING = 1e-6
"""Relative; heights that are written with a few digits may miss the sum of the segments by rounding."""

MISSING = "nothing: the key is missing"


def check_tower(tree: dict[str, Any]) -> Iterator[Fault]:
    """Faults of a tower crane's tower and of what it bears as wholes.

    Keys that are wrong by themselves are for others to report.
    """
    tower = at(tree, TOWER)
    if isinstance(tower, dict):
        segments = tables_in(tower.get("segments"))
        both = [name for name in UNIFORM if name in tower]
        if segments and both:
            hint = "the segments have keys of their own; youngs_modulus and beam may stay with the tower"
            got = f"{', '.join(both)} beside {len(segments)} segment{'s' if len(segments) > 1 else ''}"
            yield Fault("", f"{TOWER}.segments", "segments, or the keys of a uniform tower, not both", got, hint)
        elif segments:
            yield from _check_segments(tree, tower, segments)
        elif not tower.get("segments") and "segments" not in meant(tower, Tower.model_fields):
            yield from _check_uniform(tower)
        for key, section in ((TOWER, tower), *_numbered("segments", segments)):
            yield from _check_lattice(f"{key}.lattice", section.get("lattice"))
        for name in ("bodies", "collars"):
            yield from _check_heights(name, tables_in(tower.get(name)), tower_height(tree))
        yield from _check_apart(tables_in(tower.get("collars")))
        yield from _check_gaps(tables_in(tower.get("collars")))
    yield from _check_coupling(tree)


def tower_height(tree: dict[str, Any]) -> float | None:
    """Height of a crane's tower, stated or the sum of its segments [m]; None where it is not known."""
    height = si_at(tree, f"{TOWER}.height", "m")
    return sum_of_segments(tree, TOWER) if height is None else height if height > 0.0 else None


def sum_of_segments(tree: dict[str, Any], member: str) -> float | None:
    """Sum of the lengths of a member's segments [m]; None where one is not known."""
    segments = tables_in(at(tree, f"{member}.segments"))
    lengths = [si_at(segment, "length", "m") for segment in segments]
    known = [length for length in lengths if length is not None and length > 0.0]
    return sum(known) if known and len(known) == len(lengths) else None


def _check_uniform(tower: dict[str, Any]) -> Iterator[Fault]:
    """What a uniform tower lacks, and a beam that its keys do not give."""
    needed = {"height": "m", "mass_per_length": "kg/m", "youngs_modulus": "Pa"}
    yield from missing(TOWER, tower, needed, Tower.model_fields)
    chosen = tower.get("beam") or ("stated" if "second_moment_of_area" in tower else "shear-flexible")
    key = f"{TOWER}.second_moment_of_area"
    if "lattice" not in tower and "second_moment_of_area" not in tower:
        if not meant(tower, Tower.model_fields) & {"lattice", "second_moment_of_area"}:
            yield Fault("", key, f"{wanted('m^4')}, or a table [tower.lattice]", MISSING)
    elif chosen == "stated" and "second_moment_of_area" not in tower:
        hint = "without the key beam the lattice gives the beam"
        yield Fault("", key, f'{wanted("m^4")}: beam = "stated" needs it', MISSING, hint)
    elif chosen in ("shear-flexible", "euler", "code-equivalent"):
        if "lattice" not in tower:
            what = '"stated", or a table [tower.lattice] that gives another beam'
            yield Fault("", f"{TOWER}.beam", what, shown(chosen))
        elif "shear_stiffness" in tower:
            yield _second_shear(f"{TOWER}.shear_stiffness", tower["shear_stiffness"])


def _check_segments(tree: dict[str, Any], tower: dict[str, Any], segments: list[dict[str, Any]]) -> Iterator[Fault]:
    """Segments that lack a modulus or a beam or have two, and heights that do not fit."""
    chosen, laced = tower.get("beam"), ["lattice" in segment for segment in segments]
    if chosen == "code-equivalent":
        hint = "the equivalent second moment of area is that of one uniform column"
        yield Fault("", f"{TOWER}.beam", '"shear-flexible" or "euler" for segments', shown(chosen), hint)
    elif (chosen == "stated" and any(laced)) or (chosen in ("shear-flexible", "euler") and not any(laced)):
        what = "a beam that the segments give: " + ('"shear-flexible" or "euler"' if any(laced) else '"stated"')
        hint = f"{'some have' if any(laced) else 'none has'} a lattice"
        yield Fault("", f"{TOWER}.beam", what, shown(chosen), hint)
    for key, segment in _numbered("segments", segments):
        if "youngs_modulus" not in tower:
            yield from missing(key, segment, {"youngs_modulus": "Pa"}, TowerSegment.model_fields)
        yield from _check_section(key, segment)
    height, total = si_at(tree, f"{TOWER}.height", "m"), sum_of_segments(tree, TOWER)
    if height and total and abs(height - total) > ROUNDING * total:
        got = f"{shown(tower['height'])}"
        hint = "a segment is missing or counted twice? height may be left out"
        yield Fault("", f"{TOWER}.height", f"the sum of the segments, {total:g} m", got, hint)


def _check_section(key: str, segment: dict[str, Any]) -> Iterator[Fault]:
    """A segment whose beam is described twice or not at all, and a lattice that tapers like a solid."""
    stated, laced = "second_moment_of_area" in segment, "lattice" in segment
    name = f"{key}.second_moment_of_area"
    if stated and laced:
        what = "one of second_moment_of_area and lattice in a segment"
        yield Fault("", name, what, f"{shown(segment['second_moment_of_area'])} beside a lattice", "leave one out")
    elif not stated and not laced:
        if not meant(segment, TowerSegment.model_fields) & {"lattice", "second_moment_of_area"}:
            yield Fault("", name, f"{wanted('m^4')}, or a lattice of the segment", MISSING)
    elif laced:
        if "shear_stiffness" in segment:
            yield _second_shear(f"{key}.shear_stiffness", segment["shear_stiffness"])
        if segment.get("taper") in ("wedge", "cone"):
            hint = "the legs of a lattice draw together, their area stays"
            yield Fault("", f"{key}.taper", '"legs" for a segment with a lattice', shown(segment["taper"]), hint)


def _second_shear(key: str, value: object) -> Fault:
    what = "no shear stiffness beside a beam that comes from the lattice"
    return Fault("", key, what, shown(value), "leave it out, or state second_moment_of_area with it")


def _check_lattice(key: str, lattice: object) -> Iterator[Fault]:
    """A lacing that lacks its members."""
    if not (isinstance(lattice, dict) and lattice.get("lacing") == "N"):
        return
    if not si_at(lattice, "horizontal_area", "m^2", 0.0):
        what = 'an area above 0, such as "8 cm^2": the lacing "N" needs horizontals'
        given = lattice.get("horizontal_area")
        yield Fault("", f"{key}.horizontal_area", what, MISSING if given is None else shown(given))


HINTS = {
    "bodies": "a body above it has a positive offset",
    "collars": "a collar holds the tower, not what turns on it",
}
"""Why something may stand above the tower."""


def _check_heights(name: str, tables: list[dict[str, Any]], total: float | None) -> Iterator[Fault]:
    """Bodies or collars above the tower."""
    for key, table in _numbered(name, tables):
        height = si_at(table, "height", "m")
        if total and height is not None and height > total * (1.0 + ROUNDING):
            what = f"a height from 0 to {total:g} m (the height of the tower)"
            yield Fault("", f"{key}.height", what, shown(table["height"]), HINTS[name])


def _check_apart(collars: list[dict[str, Any]]) -> Iterator[Fault]:
    """Collars at one height."""
    heights: list[float] = []
    for key, collar in _numbered("collars", collars):
        height = si_at(collar, "height", "m")
        if height is None:
            continue
        if any(abs(height - other) <= ROUNDING * height for other in heights):
            hint = "one collar has the stiffness of both"
            yield Fault("", f"{key}.height", "heights that differ", f"{shown(collar['height'])} twice", hint)
        heights.append(height)


def _check_gaps(collars: list[dict[str, Any]]) -> Iterator[Fault]:
    """Collars with play that hold more than the tower's place."""
    for key, collar in _numbered("collars", collars):
        for name in ("rotation_stiffness", "torsional_stiffness"):
            if si_at(collar, "gap", "m", 0.0) and (value := collar.get(name)) is not None:
                hint = "within its play the tower turns and twists freely; state a collar without gap for that"
                yield Fault("", f"{key}.{name}", "nothing for a collar with a gap", shown(value), hint)


def _check_coupling(tree: dict[str, Any]) -> Iterator[Fault]:
    """A coupling of springs that are not there, or that is stronger than they."""
    key = "crane.foundation"
    coupling = si_at(tree, f"{key}.coupling_stiffness", "N")
    names = {"translation_stiffness": "N/m", "rotation_stiffness": "N m/rad"}
    if not coupling:
        return
    missing = [name for name in names if at(tree, f"{key}.{name}") is None]
    if missing:
        what = f"{' and '.join(missing)} beside it: it couples the two springs"
        yield Fault("", f"{key}.coupling_stiffness", what, MISSING, "without it the foot is rigid that way")
        return
    springs = [si_at(tree, f"{key}.{name}", unit) for name, unit in names.items()]
    if all(spring is not None and spring > 0.0 for spring in springs):
        limit = sqrt((springs[0] or 0.0) * (springs[1] or 0.0))
        if abs(coupling) >= limit:
            got = shown(at(tree, f"{key}.coupling_stiffness"))
            hint = "at the root of both stiffnesses' product a motion of the foot meets no resistance"
            yield Fault("", f"{key}.coupling_stiffness", f"less than {limit:.4g} N in either sense", got, hint)


def missing(key: str, table: dict[str, Any], needed: dict[str, str], known: Iterable[str]) -> Iterator[Fault]:
    """Keys that are not there, unless a misspelt one is."""
    for name, unit in needed.items():
        if name not in table and name not in meant(table, known):
            yield Fault("", f"{key}.{name}", wanted(unit), MISSING)


def meant(table: dict[str, Any], known: Iterable[str]) -> set[str | None]:
    """Known keys that unknown ones are closest to."""
    names = list(known)
    return {closest(name, names) for name in table if name not in names}


def tables_in(value: object) -> list[dict[str, Any]]:
    """The tables of a list; what is no list of tables is for others to report."""
    return value if isinstance(value, list) and all(isinstance(item, dict) for item in value) else []


def _numbered(name: str, tables: list[dict[str, Any]]) -> Iterator[tuple[str, dict[str, Any]]]:
    return ((f"{TOWER}.{name}.{index}", table) for index, table in enumerate(tables))

"""What of a crane file's jib and counter-jib belongs together, checked on the tables as written."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from towercrane.cranes.tower.file.checks.tower import MISSING, ROUNDING, meant, missing, sum_of_segments, tables_in
from towercrane.cranes.tower.file.jib_tables import CounterJib, Jib, JibLattice, JibSection, JibSegment
from towercrane.schema.faults import Fault, shown
from towercrane.schema.ranges import at, si_at
from towercrane.schema.units import wanted

if TYPE_CHECKING:
    from collections.abc import Iterator

JIB, COUNTER_JIB = "crane.jib", "crane.counter_jib"

STIFF = "second_moment_of_area", "lattice"
"""Keys that say how stiff a section is."""


def check_jibs(tree: dict[str, Any]) -> Iterator[Fault]:
    """Faults of a tower crane's jib and counter-jib as wholes.

    Keys that are wrong by themselves are for others to report.
    """
    for key in (JIB, COUNTER_JIB):
        jib = at(tree, key)
        if not isinstance(jib, dict):
            continue
        segments = tables_in(jib.get("segments"))
        both = [name for name in JibSection.model_fields if name in jib and name != "youngs_modulus"]
        if segments and both:
            hint = "the segments have keys of their own; youngs_modulus may stay with the jib"
            got = f"{', '.join(both)} beside {len(segments)} segment{'s' if len(segments) > 1 else ''}"
            yield Fault("", f"{key}.segments", "segments, or the keys of a uniform jib, not both", got, hint)
        elif "segments" in meant(jib, CounterJib.model_fields):
            continue
        elif segments:
            for number, segment in enumerate(segments):
                yield from _check_section(f"{key}.segments.{number}", segment, jib)
            yield from _check_sum(tree, key, jib)
        elif key == JIB:
            yield from missing(key, jib, {"length": "m"}, Jib.model_fields)
            yield from _check_section(key, jib, jib)
        else:
            yield from _check_counter_jib(key, jib)
        yield from _check_bodies(tree, key, jib)


def jib_length(tree: dict[str, Any], key: str = JIB) -> float | None:
    """Length of a jib, the sum of its segments or stated [m]; None where it is not known."""
    length = si_at(tree, f"{key}.length", "m")
    return sum_of_segments(tree, key) if tables_in(at(tree, f"{key}.segments")) else length


def _check_section(key: str, section: dict[str, Any], jib: dict[str, Any]) -> Iterator[Fault]:
    """A section without mass, modulus or stiffness, or with two of one kind."""
    known = JibSegment.model_fields if section is not jib else Jib.model_fields
    if "youngs_modulus" not in jib:
        yield from missing(key, section, {"youngs_modulus": "Pa"}, known)
    if "mass" in section and "mass_per_length" in section:
        what = "one of mass and mass_per_length"
        yield Fault("", f"{key}.mass", what, f"{shown(section['mass'])} beside a mass per length", "leave one out")
    elif "mass" not in section and not laced(section, jib) and "lattice" not in meant(section, known):
        yield from missing(key, section, {"mass_per_length": "kg/m"}, known)
    yield from _check_beam(key, section, jib)
    if not {*STIFF} & {*section} and not meant(section, known) & {*STIFF}:
        yield Fault("", f"{key}.second_moment_of_area", f"{wanted('m^4')}, or a lattice", MISSING)


def _check_beam(key: str, section: dict[str, Any], jib: dict[str, Any]) -> Iterator[Fault]:
    """A beam that is stated beside the lattice that gives it, and lacing that lacks its posts."""
    if laced(section, jib):
        both = [other for other in JibSection.model_fields if other in section and other.endswith(BESIDE)]
        if both:
            hint = "the members give the beam: leave it out, or the lattice"
            if section is jib:
                hint = "the members give the beam: leave it out, or state second_moment_of_area with it"
            yield Fault("", f"{key}.{both[0]}", "no stated beam beside a lattice", shown(section[both[0]]), hint)
    yield from _check_lattice(f"{key}.lattice", section.get("lattice"))


def laced(section: dict[str, Any], jib: dict[str, Any]) -> bool:
    """Whether a section as written has its beam from a lattice: in a uniform jib what is stated holds."""
    return "lattice" in section and not (section is jib and "second_moment_of_area" in section)


BESIDE = "second_moment_of_area", "shear_stiffness", "rotary_inertia_per_length"
"""Endings of keys that state what a lattice gives."""


def _check_lattice(key: str, lattice: object) -> Iterator[Fault]:
    """Walls whose lacing lacks its posts or has no place for them, and a wall that is not there."""
    if not isinstance(lattice, dict):
        return
    triangle = lattice.get("shape", "triangle") == "triangle"
    for wall in ("side", "base", "opposite"):
        if lattice.get(f"{wall}_lacing") == "N" and not si_at(lattice, f"{wall}_post_area", "m^2", 0.0):
            what = 'an area above 0, such as "6 cm^2": the lacing "N" needs posts'
            given = lattice.get(f"{wall}_post_area")
            yield Fault("", f"{key}.{wall}_post_area", what, MISSING if given is None else shown(given))
    if triangle and lattice.get("side_lacing", "zigzag") == "zigzag" and si_at(lattice, "side_post_area", "m^2"):
        what = "no posts in zigzag sides of a triangle, whose nodes face no other"
        yield Fault("", f"{key}.side_post_area", what, shown(lattice["side_post_area"]), "leave it out")
    for name in JibLattice.model_fields:
        if triangle and name.startswith("opposite_") and name != "opposite_chord_area" and name in lattice:
            what = 'shape = "rectangle" with it: a triangle has one opposite chord and no wall between two'
            yield Fault("", f"{key}.{name}", what, shown(lattice[name]))
            return


def _check_sum(tree: dict[str, Any], key: str, jib: dict[str, Any]) -> Iterator[Fault]:
    """A stated length that the segments do not add up to."""
    length, total = si_at(tree, f"{key}.length", "m"), sum_of_segments(tree, key)
    if length and total and abs(length - total) > ROUNDING * total:
        hint = "a segment is missing or counted twice? length may be left out"
        yield Fault("", f"{key}.length", f"the sum of the segments, {total:g} m", shown(jib["length"]), hint)


def _check_counter_jib(key: str, jib: dict[str, Any]) -> Iterator[Fault]:
    """A uniform counter-jib that lacks something, or is half flexible."""
    needed = {"length": "m", "mass_per_length": "kg/m"}
    if laced(jib, jib):
        del needed["mass_per_length"]
    yield from missing(key, jib, needed, CounterJib.model_fields)
    yield from _check_beam(key, jib, jib)
    bends = [name for name in ("youngs_modulus", *STIFF) if name in jib]
    if not bends and not jib.get("bodies"):
        return
    hint = "a counter-jib without both is rigid" if bends else "a counter-jib with bodies bends under them"
    if "youngs_modulus" not in jib:
        what = f"{wanted('Pa')}, for a counter-jib that bends"
        yield Fault("", f"{key}.youngs_modulus", what, MISSING, hint)
    if not {*STIFF} & {*jib}:
        what = f"{wanted('m^4')}, for a counter-jib that bends"
        yield Fault("", f"{key}.second_moment_of_area", what, MISSING, hint)
    for name, unit in needed.items():
        if si_at(jib, name, unit) == 0.0:
            hint = "without length or mass it is rigid: leave youngs_modulus and second_moment_of_area out"
            yield Fault("", f"{key}.{name}", f"{wanted(unit)}, above 0 for a counter-jib that bends", "0", hint)


def _check_bodies(tree: dict[str, Any], key: str, jib: dict[str, Any]) -> Iterator[Fault]:
    """Bodies beyond the end."""
    total = jib_length(tree, key)
    for number, body in enumerate(tables_in(jib.get("bodies"))):
        place = si_at(body, "position", "m")
        if total and place is not None and place > total * (1.0 + ROUNDING):
            what = f"a position from 0 to {total:g} m (the length of the {'jib' if key == JIB else 'counter-jib'})"
            hint = "counted from the tower's axis outward"
            yield Fault("", f"{key}.bodies.{number}.position", what, shown(body["position"]), hint)

"""What of tie bars belongs together, and what cannot be asked of a crane that has them; as written."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from towercrane.cranes.tower.file.checks.jib import COUNTER_JIB, JIB, jib_length
from towercrane.cranes.tower.file.checks.tower import MISSING, ROUNDING, tables_in
from towercrane.cranes.tower.modes.tied.bars import MOST_TIES
from towercrane.schema.faults import Fault, shown
from towercrane.schema.ranges import at, si_at
from towercrane.schema.units import wanted

if TYPE_CHECKING:
    from collections.abc import Iterator

    from towercrane.cranes.tower.file.case_tables import TowerCase

HEAD = "crane.tower_head"

WITHOUT = {
    "crane.jib.luffing": "a jib either pivots on its rope or hangs on tie bars",
}
"""What a crane with tie bars cannot have, and why."""

REFUSED = {
    "members": "modes of its members alone are not drawn",
}
"""What a crane with tie bars cannot be used for, and why."""


def refused(tables: TowerCase) -> dict[str, str]:
    """Uses that a checked case cannot serve, and why."""
    if tables.crane.tower_head is None:
        return {}
    return {use: f"the jibs hang on tie bars: {why}" for use, why in REFUSED.items()}


def check_ties(tree: dict[str, Any]) -> Iterator[Fault]:
    """Faults of a cat-head and its ties, or of keys that only such cranes have."""
    head, sides = at(tree, HEAD), {key: at(tree, f"{key}.ties") for key in (JIB, COUNTER_JIB)}
    if head is None:
        for key, ties in sides.items():
            if ties:
                what = "a table [tower_head] that the ties go from: height, mass_per_length, ..."
                yield Fault("", HEAD, what, f"ties in [{key.removeprefix('crane.')}] without it")
                return
        for key in sides:
            yield from _check_axial(tree, key, tied=False)
        return
    for key in sides:
        yield from _check_side(tree, key)
    for key, why in WITHOUT.items():
        if (value := at(tree, key)) is not None:
            got = f"the table [{key}]" if isinstance(value, dict) else shown(value)
            yield Fault("", key, "nothing for a crane with tie bars", got, why)
    if at(tree, "start.state") == "zero-no-self-weight":
        hint = "without weight the ties would be slack"
        yield Fault(
            "", "start.state", '"equilibrium" or "zero" for a crane with tie bars', '"zero-no-self-weight"', hint
        )


def _check_side(tree: dict[str, Any], key: str) -> Iterator[Fault]:
    """A jib or counter-jib and its ties."""
    written, name = at(tree, f"{key}.ties"), key.removeprefix("crane.")
    if not written:
        hint = "a cat-head holds jib and counter-jib; without ties to both leave [tower_head] out"
        yield Fault(
            "", f"{key}.ties", f"one tie or more, [[{name}.ties]] with position, axial_stiffness, ...", MISSING, hint
        )
        return
    ties, length = tables_in(written), jib_length(tree, key)
    if len(ties) > MOST_TIES:
        yield Fault("", f"{key}.ties", f"at most {MOST_TIES} ties", f"{len(ties)}")
    top = si_at(tree, f"{HEAD}.height", "m")
    places: list[float] = []
    for number, tie in enumerate(ties):
        place, height = si_at(tie, "position", "m"), si_at(tie, "height", "m", 0.0)
        own = f"{key}.ties.{number}"
        if place is not None and length and place > length * (1.0 + ROUNDING):
            what = f"a position from 0 to {length:g} m (the length of the {name.replace('_', '-')})"
            yield Fault("", f"{own}.position", what, shown(tie["position"]), "counted from the tower's axis outward")
        if place is not None and any(abs(place - other) < 0.1 for other in places):
            yield Fault("", f"{own}.position", "ties at least 0.1 m apart", shown(tie["position"]), "one tie twice?")
        if place is not None:
            places.append(place)
        if top is not None and height is not None and height >= top:
            what = f"a height below the cat-head's top, {top:g} m over the jibs' axis"
            yield Fault(
                "",
                f"{own}.height",
                what,
                shown(tie.get("height", "0 m")),
                "height of the tie's lower end over the axis",
            )
    yield from _check_axial(tree, key, tied=True)
    jib = at(tree, key)
    stiff = {"segments", "youngs_modulus", "second_moment_of_area", "lattice"}
    if key == COUNTER_JIB and isinstance(jib, dict) and not stiff & {*jib}:
        what = f"{wanted('m^4')}, for a counter-jib on a tie"
        yield Fault("", f"{key}.second_moment_of_area", what, MISSING, "a tie bends it")


def _check_axial(tree: dict[str, Any], key: str, *, tied: bool) -> Iterator[Fault]:
    """Axial stiffness of a jib's sections: all of them with ties, none without."""
    jib = at(tree, key)
    if not isinstance(jib, dict):
        return
    pieces = [(f"{key}.segments.{k}", own) for k, own in enumerate(tables_in(jib.get("segments")))] or [(key, jib)]
    for place, piece in pieces:
        if tied and "axial_stiffness" not in piece:
            hint = "E A of its chords: the ties compress it"
            yield Fault("", f"{place}.axial_stiffness", f"{wanted('N')}, for a jib on ties", MISSING, hint)
        elif not tied and "axial_stiffness" in piece:
            hint = "it matters where ties compress the jib"
            got = shown(piece["axial_stiffness"])
            yield Fault("", f"{place}.axial_stiffness", "nothing for a jib without ties", got, hint)

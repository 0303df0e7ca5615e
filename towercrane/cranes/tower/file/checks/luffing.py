"""What of a jib that pivots belongs together, how far it goes, and what cannot be asked of it; as written."""

from __future__ import annotations

from itertools import chain
from math import degrees, pi
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.tower.file.checks.tower import MISSING, tower_height
from towercrane.cranes.tower.modes.luffing_jib import LuffingJib
from towercrane.schema.faults import Fault, shown
from towercrane.schema.ranges import at, si, si_at
from towercrane.schema.text import leaves

if TYPE_CHECKING:
    from collections.abc import Iterator

    from towercrane.cranes.tower.file.case_tables import TowerCase

JIB = "crane.jib.luffing"

ANGLES = 30
"""Angles between lowest and highest at which the luffing rope must lift the jib."""

OF_SECTIONS = (
    "shear_stiffness", "lateral_shear_stiffness", "rotary_inertia_per_length", "lateral_rotary_inertia_per_length",
)  # fmt: skip
"""Keys of a jib's sections."""

WITHOUT = {
    "crane.trolley": "the load hangs from the jib's head; what is there has the key crane.jib.luffing.tip_mass",
    "motion.trolley": "a jib that pivots carries none; [motion.luffing] moves the load in and out",
    **dict.fromkeys(
        [f"crane.jib.{key}" for key in ("segments", "bodies", "lattice", *OF_SECTIONS)],
        "a jib that pivots is uniform, without shear strain and rotary inertia",
    ),
    **dict.fromkeys(
        [f"crane.counter_jib.{key}" for key in ("segments", "bodies", "lattice", "second_moment_of_area")],
        "a counter-jib behind a jib that pivots is rigid; [[head.bodies]] are what else turns",
    ),
    **dict.fromkeys(
        ("model.counter_jib_vertical_modes", "model.counter_jib_lateral_modes"),
        "a counter-jib behind a jib that pivots is rigid",
    ),
    "earthquake": "earthquakes are for cranes with a trolley",
    "modes.trolley_positions": "give modes.luffing_angles",
    "map.trolley_positions": "give map.luffing_angles",
}
"""What a crane whose jib pivots cannot have, and why or what instead."""


REFUSED = {
    "members": "modes of its members alone are not drawn",
    "lift": "a load is lifted off over places of a trolley",
}
"""What a crane whose jib pivots cannot be used for, and why."""


def refused(tables: TowerCase) -> dict[str, str]:
    """Uses that a checked case cannot serve, and why."""
    if tables.crane.jib.luffing is None:
        return {}
    return {use: f"the jib pivots: {why}" for use, why in REFUSED.items()}


def pivots(tree: dict[str, Any]) -> bool:
    """Whether the jib of a case as written pivots."""
    return isinstance(at(tree, JIB), dict)


def check_luffing(tree: dict[str, Any]) -> Iterator[Fault]:
    """Faults of a jib that pivots, or of keys that only such a jib has."""
    if at(tree, JIB) is None:
        for key in ("crane.head", "motion.luffing", "modes.luffing_angles", "map.luffing_angles"):
            if at(tree, key) is not None:
                hint = "a jib pivots where its file has a table [jib.luffing]"
                yield Fault("", key, "nothing for a jib that does not pivot", shown(at(tree, key)), hint)
        return
    if not pivots(tree):
        return
    for key, why in WITHOUT.items():
        if (value := at(tree, key)) not in (None, 0):
            got = f"the table [{key}]" if isinstance(value, dict) else shown(value)
            yield Fault("", key, "nothing for a jib that pivots", got, why)
    low, high = _ends(tree)
    if low is not None and high is not None:
        if not low < high:
            hint = "lowest and highest mixed up?"
            wanted = f"an angle above lowest_angle, {degrees(low):g} deg"
            yield Fault("", f"{JIB}.highest_angle", wanted, shown(at(tree, f"{JIB}.highest_angle")), hint)
        else:
            yield from _check_lever(tree, low, high)
            yield from _check_modes(tree, low, high)
    yield from _check_motion(tree, low, high)


def _ends(tree: dict[str, Any]) -> tuple[float | None, float | None]:
    """Lowest and highest angle of a jib as written [rad]."""
    return si_at(tree, f"{JIB}.lowest_angle", "rad"), si_at(tree, f"{JIB}.highest_angle", "rad")


def limits(tree: dict[str, Any]) -> tuple[float | None, float | None]:
    """Lowest and highest angle of a jib that pivots [rad], as far as they can be read.

    A motion that does not say where it begins is judged by that alone.
    """
    if at(tree, "motion.luffing.start") is None:
        return None, None
    return _ends(tree)


def _check_lever(tree: dict[str, Any], low: float, high: float) -> Iterator[Fault]:
    """A luffing rope that would push the jib down."""
    jib, length, written = _written(tree), si_at(tree, "crane.jib.length", "m"), at(tree, f"{JIB}.frame_head")
    if jib is None or not length or length <= 0.0:
        return
    for angle in np.linspace(low, high, ANGLES):
        if jib.lever(length, float(angle)) <= 0.0:
            wanted = f"a place from which the rope lifts the jib from {degrees(low):g} to {degrees(high):g} deg"
            hint = f"at {degrees(angle):.3g} deg it would not: forward and up from the tower's top; sign?"
            yield Fault("", f"{JIB}.frame_head", wanted, shown(written), hint)
            return


def _check_modes(tree: dict[str, Any], low: float, high: float) -> Iterator[Fault]:
    """Modes that are asked for at angles at which the jib does not stand."""
    asked = (leaves(at(tree, key) or [], key) for key in ("modes.luffing_angles", "map.luffing_angles"))
    for key, written in chain.from_iterable(asked):
        angle = si(written, "rad")
        # More than a quarter of a turn is told as not plausible.
        if angle is not None and angle <= 0.5 * pi and not low <= angle <= high:
            yield Fault("", key, f"angles from {degrees(low):g} to {degrees(high):g} deg", shown(written))


def _check_motion(tree: dict[str, Any], low: float | None, high: float | None) -> Iterator[Fault]:
    """A luffing motion that is missing, does not say where it begins, or leaves the jib's angles."""
    motion = at(tree, "motion.luffing")
    if motion is None:
        wanted = "a table [motion.luffing] with shape, start: the angle of the jib"
        yield Fault("", "motion.luffing", wanted, "nothing: the table is missing")
    elif not isinstance(motion, dict):
        return
    elif motion.get("shape") == "table":
        hint = "the hoist rope's length at the start is that at the angle which start states"
        yield Fault("", "motion.luffing.shape", "a motion whose start is stated", '"table"', hint)
    elif "start" not in motion:
        known = f", from {degrees(low):g} to {degrees(high):g} deg" if low is not None and high is not None else ""
        yield Fault("", "motion.luffing.start", f"the jib's angle at the start{known}", MISSING)


def angles_of(tree: dict[str, Any]) -> Iterator[float]:
    """Angles of the jib that a luffing motion names [rad]."""
    for key, written in leaves(at(tree, "motion.luffing") or {}, "motion.luffing"):
        value = si(written, "rad") if key.rpartition(".")[2] in ("start", "end") else None
        if value is not None:
            yield value


def head_height(tree: dict[str, Any]) -> float | None:
    """Height of the straight jib's head over the ground at the highest angle that the case names [m]."""
    height, length, jib = tower_height(tree), si_at(tree, "crane.jib.length", "m"), _written(tree)
    highest = max(angles_of(tree), default=None)
    if height is None or length is None or jib is None or highest is None:
        return None
    reached = height + jib.head(length, min(highest, 0.5 * pi))[1]
    return reached if reached > 0.0 else None


def _written(tree: dict[str, Any]) -> LuffingJib | None:
    """The jib of a case as written; None where its places cannot be read."""
    foot, frame_head, winch = (_place(tree, name) for name in ("pivot", "frame_head", "hoist_winch"))
    attachment = si_at(tree, f"{JIB}.rope_attachment", "m", 0.0)
    if foot is None or frame_head is None or winch is None or attachment is None:
        return None
    return LuffingJib(foot, frame_head, winch, attachment, 1.0, 1, 0.0, 0.0)


def _place(tree: dict[str, Any], name: str) -> tuple[float, float] | None:
    """A place of the jib's as written [m]."""
    written = at(tree, f"{JIB}.{name}")
    values = [si(value, "m") for value in written] if isinstance(written, list) else []
    known = [value for value in values if value is not None]
    return (known[0], known[1]) if len(values) == len(known) == 2 else None

"""Motions of a case, and the limits that crane and ground set for them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from math import degrees
from typing import TYPE_CHECKING, Any

from pydantic import ValidationError

from towercrane.cases.earthquake_file import channels_of, earthquake_motions
from towercrane.cases.plausibility import FARTHEST_TURN, FASTEST
from towercrane.cases.profiles import plan
from towercrane.cases.wind_file import CHANNELS, wind_motions
from towercrane.cranes.parts.hoisting.letting_go import CHANNEL, letting_go
from towercrane.cranes.registry import KINDS
from towercrane.motions.plans import Move, Plan
from towercrane.schema.faults import CaseError, Fault, shown
from towercrane.schema.motions import HoistMotion, JointMotion, TrolleyMotion, reader
from towercrane.schema.ranges import at, si, si_at
from towercrane.schema.text import leaves

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from pydantic import TypeAdapter

    from towercrane.cranes.kind import Drives, Track
    from towercrane.cranes.registry import AnyCase


ROUNDING = 1e-9
"""Relative; a motion that ends at the jib's end may overshoot it by rounding."""

RESTS = ("slew", "slewing")
"""Joints that rest at zero where the case does not name them."""


@dataclass(frozen=True)
class Way:
    """Limits of a motion along a line or of a turn.

    Parameters
    ----------
    key : str
        Key of the motion.
    high : float or None
        Largest value [m], of a turn in either sense [rad]; None where it is not known.
    low : float or None
        Smallest value of a turn that has one [rad].
    open_low : bool
        Whether zero itself is too low.
    wanted, hint : str
        For the message.
    turns : bool
        Whether the motion is a turn, in radians.
    fastest : float
        Largest plausible speed [m/s or rad/s].
    """

    key: str
    high: float | None = None
    open_low: bool = False
    wanted: str = ""
    hint: str = ""
    turns: bool = False
    fastest: float = FASTEST
    low: float | None = None

    @property
    def unit(self) -> str:
        """SI unit of the motion."""
        return "rad" if self.turns else "m"

    def keeps(self, value: float) -> bool:
        """Whether a value lies within the limits."""
        high = float("inf") if self.high is None else self.high * (1 + ROUNDING)
        if self.low is not None:
            return self.low - ROUNDING <= value <= high
        if self.turns:
            return abs(value) <= high
        return (value > 0.0 if self.open_low else value >= -ROUNDING) and value <= high

    def fault(self, key: str, got: str) -> Fault:
        """Fault at ``key``."""
        return Fault("", key, self.wanted, got, self.hint)


def check_motions(
    tree: dict[str, Any], folder: Path, kind: str, checked: AnyCase | None
) -> tuple[list[Fault], dict[str, Plan]]:
    """Plans by channel, without those that cannot be built, and where they leave their track or the air.

    Parts of the case that are faulty themselves limit nothing, so that all faults show at once. ``checked`` are its
    tables, where nothing else is wrong.
    """
    faults: list[Fault] = []
    plans: dict[str, Plan | None] = {}
    drives = KINDS[kind].drives_of(tree)
    for track in drives.tracks:
        more, plans[track.name] = _track(tree, track, folder)
        faults += more
    if drives.wind:
        more, wind = wind_motions(tree, folder, kind, checked)
        faults = [*faults, *more]
        plans |= {name: Plan((Move(motion),)) for name, motion in wind.items()}
    if drives.earthquake:
        more, shaking = earthquake_motions(tree, folder)
        faults = [*faults, *more]
        plans |= {name: Plan((Move(motion),)) for name, motion in shaking.items()}
    for joint in _joints(tree, drives):
        low, most, hint = None, FARTHEST_TURN[joint], "the header names the units: slew [deg]"
        wanted = f"angles up to {most:g} rad"
        lowest, highest = drives.limits[joint](tree) if joint in drives.limits else (None, None)
        if lowest is not None and highest is not None and lowest < highest:
            low, most, hint = lowest, highest, "beyond its lowest or its highest angle"
            wanted = f"angles from {degrees(low):g} to {degrees(most):g} deg, at which the jib can stand"
        way = Way(f"motion.{joint}", most, False, wanted, hint, turns=True, fastest=drives.fastest_turn, low=low)
        plans[joint], more = _motion(tree, way, reader(JointMotion), folder, 0.0 if joint in RESTS else None)
        faults += more
    if (released := getattr(checked, "release", None)) is not None:
        plans[CHANNEL] = Plan((Move(letting_go(released.time, released.duration)),))
    more, plans["rope"] = _rope(tree, folder, drives)
    faults += [*more, *_turns_at_first(tree, plans, tuple(name for names in drives.joints for name in names))]
    found = {name: plan for name, plan in plans.items() if plan is not None}
    if KINDS[kind].natural is None:
        faults += [_without_model(name, kind) for name, plan in found.items() if plan.needs_model]
    return faults, found


def _without_model(channel: str, kind: str) -> Fault:
    """Fault of a motion that asks for frequencies which this kind of crane does not give."""
    key = f"motion.{'hoist' if channel == 'rope' else channel}.frequencies"
    hint = "towercrane linearise shows the frequencies of any crane"
    return Fault("", key, f'a list of frequencies for a crane of kind "{kind}", such as ["0.12 Hz"]', '"model"', hint)


def channels(tree: dict[str, Any], kind: str) -> tuple[str, ...]:
    """Names of the motions that drive the crane of a case of this kind."""
    drives = KINDS[kind].drives_of(tree)
    wind = CHANNELS if drives.wind and "wind" in tree else ()
    shaking = channels_of(tree) if drives.earthquake else ()
    return (*(track.name for track in drives.tracks), *_joints(tree, drives), *shaking, *wind, "rope")


def _joints(tree: dict[str, Any], drives: Drives) -> tuple[str, ...]:
    """What turns in a case."""
    written = ([name for name in names if at(tree, f"motion.{name}") is not None] for names in drives.joints)
    return tuple(next(iter(found), names[-1]) for found, names in zip(written, drives.joints, strict=True))


def _track(tree: dict[str, Any], track: Track, folder: Path) -> tuple[list[Fault], Plan | None]:
    name, length_of, along = track
    length = length_of(tree)
    known = f"from 0 to {length:g} m (the length of the {along})" if length else "from 0 on"
    way = Way(f"motion.{name}", length, False, f"positions on the {along}, {known}", f"the {name} leaves the {along}")
    faults = _out_of_way(tree, way, ("start", "end"))
    motion, more = _motion(tree, way, reader(TrolleyMotion), folder, None)
    for listed in (f"modes.{name}_positions", f"map.{name}_positions"):
        for key, value in leaves(at(tree, listed) or [], listed):
            position = si(value, "m")
            if position is not None and not way.keeps(position):
                faults.append(way.fault(key, shown(value)))
    faults += more if not any(f.key.startswith("motion.") for f in faults) else []
    return faults, motion


def _rope(tree: dict[str, Any], folder: Path, drives: Drives) -> tuple[list[Fault], Plan | None]:
    high, what = drives.height(tree), drives.height_is
    known = f"above 0 and up to {high:g} m ({what})" if high else "above 0"
    hint = "the load would be in the ground or the rope wound up"
    in_air = Way("motion.hoist", high, True, f"rope lengths {known}", hint)
    start = si_at(tree, "rope.length", "m")
    if start is not None and start > 0.0 and not in_air.keeps(start):
        return [in_air.fault("rope.length", shown(at(tree, "rope.length")))], None
    faults = _out_of_way(tree, in_air, ("end",))
    for key, value in leaves(at(tree, "modes.rope_lengths") or [], "modes.rope_lengths"):
        length = si(value, "m")
        if length is not None and length > 0.0 and not in_air.keeps(length):
            faults.append(in_air.fault(key, shown(value)))
    rope, more = _motion(tree, in_air, reader(HoistMotion), folder, start)
    return faults or more, rope


def _out_of_way(tree: dict[str, Any], way: Way, names: tuple[str, ...]) -> list[Fault]:
    """Single values of a motion outside its limits."""
    faults = []
    for key, value in leaves(at(tree, way.key), way.key):
        position = si(value, way.unit) if key.rpartition(".")[2] in names else None
        if position is not None and not way.keeps(position):
            faults.append(way.fault(key, shown(value)))
    return faults


def _motion(
    tree: dict[str, Any], way: Way, adapter: TypeAdapter[Any], folder: Path, start: float | None
) -> tuple[Plan | None, list[Fault]]:
    """The motion at ``way.key`` and what is wrong with it as a whole; without one a known start is kept."""
    written = at(tree, way.key)
    if written is None and start is not None and (start > 0.0 or way.turns):
        written = {"shape": "rest"}
    if isinstance(written, dict) and written.get("shape") == "free":
        # It begins at rest; where it goes nobody prescribes.
        written = {"shape": "rest", **({"start": written["start"]} if "start" in written else {})}
    try:
        described = adapter.validate_python(written)
    except ValidationError:
        return None, []
    hoists = not hasattr(described, "start") and way.open_low
    if hoists and start is None:
        return None, []
    begin = start if hoists and start is not None else getattr(described, "start", 0.0)
    try:
        found = plan(described, begin, folder, way.unit)
    except CaseError as error:
        named = f"named by {way.key}.file of the case"
        return None, [replace(f, hint=f"{f.hint}; {named}" if f.hint else named) for f in error.faults]
    except (ArithmeticError, ValueError) as error:
        return None, [Fault("", way.key, "a motion that can be computed", str(error))]
    if jumps := [jump for jump in _jumps(found) if abs(jump[1] - jump[0]) > ROUNDING * max(1.0, abs(jump[0]))]:
        before, after = jumps[0]
        wanted = f"moves that begin at the speed at which the one before ends, here {before:g} {way.unit}/s"
        hint = "start_speed and end_speed say it; a delay is at rest"
        return None, [Fault("", way.key, wanted, f"one that begins at {after:g} {way.unit}/s", hint)]
    motion = found.commanded
    key = f"{way.key}.file" if described.shape == "table" else way.key
    if hoists and abs(float(motion(0.0)) - begin) > 1e-6:
        got = f"a first length of {float(motion(0.0)):g} m"
        return None, [Fault("", key, f"a table that begins with rope.length, {begin:g} m", got)]
    reached, limit = max(abs(rate) for rate in motion.range(1)), way.fastest
    # Other motions state their speed, which has a range of its own.
    units = "angles in radians" if way.turns else "metres"
    hints = {
        "table": f"seconds and {units}? The header names the units: time [s]",
        "minimum-jerk": "a longer duration?",
    }
    if described.shape in hints and reached > limit:
        table, hint = described.shape == "table", hints[described.shape]
        got = f"a {'table' if table else 'motion'} that reaches {reached:.3g} {way.unit}/s"
        return None, [Fault("", key, f"speeds up to {limit:g} {way.unit}/s", got, hint)]
    low, high = motion.range(until=si_at(tree, "run.duration", "s") or 0.0)
    # Other turns state their angles, which have ranges of their own.
    judged = described.shape == "table" or not way.turns or way.low is not None
    if judged and not (way.keeps(low) and way.keeps(high)):
        ends = f"{low:g} to {high:g} {way.unit}" if way.low is None else f"{degrees(low):g} to {degrees(high):g} deg"
        return None, [way.fault(key, f"a motion from {ends}")]
    return found, []


def _jumps(told: Plan) -> list[tuple[float, float]]:
    """Rates at which each move ends and the next one begins."""
    moves = [move.commanded for move in told.moves]
    return [(one.end_rate, float(other(0.0, 1))) for one, other in pairwise(moves)]


def _turns_at_first(tree: dict[str, Any], plans: Mapping[str, Plan | None], joints: tuple[str, ...]) -> list[Fault]:
    """Faults of a crane that turns as a run begins, in a wind or with its load on the ground: that is no rest."""
    turns = [name for name in joints if (told := plans.get(name)) is not None and float(told.commanded(0.0, 1))]
    blows = any(told is not None and told.commanded.mean for name, told in plans.items() if name.startswith("wind"))
    start = at(tree, "start")
    written = start if isinstance(start, dict) else {}
    if not turns or written.get("from"):
        return []
    if written.get("slack") is not None:
        hint = f"motion.{turns[0]} begins at speed"
        return [Fault("", "start.slack", "no such key where the head turns at first", shown(written["slack"]), hint)]
    if not blows or str(written.get("state", "")).startswith("zero"):
        return []
    hint = f"in a wind nothing turns steadily; motion.{turns[0]} begins at speed"
    return [Fault("", "start.state", '"zero", or a start from another run', shown(written.get("state")), hint)]

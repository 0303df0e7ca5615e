"""What a case's numbers may be: one table of wide ranges, and the limits that values set for each other."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, Any

from pydantic import TypeAdapter, ValidationError

from towercrane.casefile import leaves
from towercrane.faults import CaseError, Fault, did_you_mean, shown
from towercrane.profiles import profile
from towercrane.schema import HoistMotion, TrolleyMotion
from towercrane.units import UnitError, split, to_si

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator
    from pathlib import Path

    from towercrane.motion import Motion

MOST_SAMPLES = 5_000_000
FASTEST = 10.0
"""Largest plausible speed of trolley and hook [m/s]."""

ROUNDING = 1e-9
"""Relative; a motion that ends at the jib's end may overshoot it by rounding."""


@dataclass(frozen=True, slots=True)
class Range:
    """Range outside which a value is more likely a slip than a crane.

    Parameters
    ----------
    key : str
        Dotted key; ``*`` stands for any part.
    unit : str
        SI unit of the bounds.
    low, high : float
        Bounds; zero, where the key allows it, is never implausible.
    likely : tuple of str
        Units that the number may have been meant in.
    signed : bool
        Whether a negative value is judged by its size; elsewhere it is impossible, not implausible.
    """

    key: str
    unit: str
    low: float
    high: float
    likely: tuple[str, ...] = ()
    signed: bool = False

    def fault(self, key: str, value: object) -> Fault | None:
        """Fault if ``value`` lies outside the range; a value that cannot be read is for others to report."""
        try:
            size = to_si(value, self.unit) * (-1.0 if self.signed and split(value)[0] < 0.0 else 1.0)
            number = abs(split(value)[0])
        except UnitError:
            return None
        if size <= 0.0 or self.low <= size <= self.high:
            return None
        allow = f'if it is right, put allow_implausible = ["{key}"] at the top of the case file'
        meant = (u for u in self.likely if self.low <= to_si(f"{number!r} {u}", self.unit) <= self.high)
        unit = next(meant, None)
        hint = f"{unit} meant? {allow}" if unit else allow
        wanted = f"a value from {self.low:g} to {self.high:g} {self.unit}".removesuffix(" 1")
        return Fault("", key, wanted, f"{shown(value)}, which is not plausible", hint)


LENGTHS = ("mm", "cm", "km", "ft")
AREAS = ("cm^2", "mm^2")

RANGES = (
    Range("crane.gravity", "m/s^2", 1, 30, ("cm/s^2", "mm/s^2")),
    Range("crane.tower.height", "m", 2, 1000, LENGTHS),
    Range("crane.jib.length", "m", 1, 200, LENGTHS),
    Range("crane.counter_jib.length", "m", 0.5, 100, LENGTHS),
    Range("crane.*.mass_per_length", "kg/m", 1, 20e3, ("t/m", "kg/mm", "g/m")),
    Range("crane.*.youngs_modulus", "Pa", 1e9, 1e12, ("GPa", "MPa", "N/mm^2", "kPa")),
    Range("crane.*.second_moment_of_area", "m^4", 1e-8, 10, ("cm^4", "mm^4")),
    Range("crane.tower.lattice.*_area", "m^2", 1e-5, 0.5, AREAS),
    Range("crane.tower.lattice.leg_spacing", "m", 0.05, 20, LENGTHS),
    Range("crane.tower.lattice.panel_height", "m", 0.05, 20, LENGTHS),
    Range("crane.counter_jib.counterweight", "kg", 50, 1e6, ("t", "g")),
    Range("crane.trolley.mass", "kg", 5, 50e3, ("t", "g")),
    Range("payload.mass", "kg", 1, 1e6, ("t", "g")),
    Range("payload.rope_damping", "N m s/rad", 1e-6, 1e8, ("kN m s/rad",)),
    Range("payload.drag_area", "m^2", 1e-4, 1e3, AREAS),
    Range("rope.length", "m", 0.1, 1000, LENGTHS),
    Range("motion.*.speed", "m/s", 1e-3, FASTEST, ("m/min", "mm/s", "km/h")),
    Range("motion.*.acceleration", "m/s^2", 1e-4, 20, ("cm/s^2", "mm/s^2")),
    Range("motion.*.jerk", "m/s^3", 1e-5, 1e3, ("cm/s^3", "mm/s^3")),
    Range("motion.*.delay", "s", 1e-3, 1e5, ("ms", "min")),
    Range("motion.*.duration", "s", 1e-3, 1e5, ("ms", "min")),
    Range("model.*_damping_ratio", "1", 1e-6, 0.3, ("%",)),
    Range("start.swing_angle", "rad", 1e-9, 1.6, ("deg", "mrad"), signed=True),
    Range("run.duration", "s", 0.01, 1e6, ("ms", "min", "h")),
    Range("run.output_step", "s", 1e-6, 1e4, ("ms",)),
    Range("solver.atol", "1", 1e-20, 1),
)


def implausible(tree: dict[str, Any], allowed: Collection[str]) -> Iterator[Fault]:
    """Values outside their range, except where the case allows them."""
    ruled = {}
    for key, value in leaves(tree):
        for rule in RANGES:
            if fnmatchcase(key, rule.key):
                ruled[key] = rule.fault(key, value)
    for key in allowed:
        if key not in ruled:
            wanted, hint = "keys of this case whose range is checked", did_you_mean(key, ruled)
            yield Fault("", "allow_implausible", wanted, shown(key), hint)
    yield from (fault for key, fault in ruled.items() if fault and key not in allowed)


def check_output(tree: dict[str, Any]) -> Iterator[Fault]:
    """Output steps that do not fit the span."""
    duration, step = _number(tree, "run.duration", "s"), _number(tree, "run.output_step", "s", 0.05)
    if not (duration and step and duration > 0.0 and step > 0.0):
        return
    if step > duration:
        hint = "no output would fall into the run"
        yield Fault("", "run.output_step", f"at most run.duration, {duration:g} s", f"{step:g} s", hint)
    elif duration / step > MOST_SAMPLES:
        got = f"{step:g} s, which makes {duration / step:.3g}"
        yield Fault("", "run.output_step", f"at most {MOST_SAMPLES} output samples", got, "ms or s mixed up?")


def check_elements(tree: dict[str, Any]) -> Iterator[Fault]:
    """Fewer unknowns than wanted modes."""
    count, elements = _number(tree, "modes.count", "1", 4), _number(tree, "modes.elements", "1", 32)
    if count and elements and count >= 2 * elements:
        wanted = f"more than {count / 2:g} elements for {count:g} modes"
        yield Fault("", "modes.elements", wanted, f"{elements:g}", "each element adds two unknowns")


def check_lattice(tree: dict[str, Any]) -> Iterator[Fault]:
    """A lacing that lacks its members."""
    lattice = _at(tree, "crane.tower.lattice")
    key = "crane.tower.lattice.horizontal_area"
    if isinstance(lattice, dict) and lattice.get("lacing") == "N" and not _number(tree, key, "m^2", 0.0):
        wanted = 'an area above 0, such as "8 cm^2": the lacing "N" needs horizontals'
        yield Fault("", key, wanted, shown(lattice.get("horizontal_area", "nothing")))


@dataclass(frozen=True)
class Way:
    """Limits of a motion.

    Parameters
    ----------
    key : str
        Key of the motion.
    high : float or None
        Largest value [m]; None where it is not known.
    open_low : bool
        Whether zero itself is too low.
    wanted, hint : str
        For the message.
    """

    key: str
    high: float | None
    open_low: bool
    wanted: str
    hint: str

    def keeps(self, value: float) -> bool:
        """Whether a value lies within the limits."""
        high = float("inf") if self.high is None else self.high * (1 + ROUNDING)
        return (value > 0.0 if self.open_low else value >= -ROUNDING) and value <= high

    def fault(self, key: str, got: str) -> Fault:
        """Fault at ``key``."""
        return Fault("", key, self.wanted, got, self.hint)


def check_motions(tree: dict[str, Any], folder: Path) -> tuple[list[Fault], Motion | None, Motion | None]:
    """Trolley and rope motion, None where they cannot be built, and where they leave the jib or the air.

    Parts of the case that are faulty themselves limit nothing, so that all faults show at once.
    """
    jib, tower = _number(tree, "crane.jib.length", "m"), _number(tree, "crane.tower.height", "m")
    known = f"from 0 to {jib:g} m (the length of the jib)" if jib else "from 0 on"
    on_jib = Way("motion.trolley", jib, False, f"positions on the jib, {known}", "the trolley leaves the jib")
    faults = _out_of_way(tree, on_jib, ("start", "end"))
    trolley, more = _motion(tree, on_jib, TypeAdapter(TrolleyMotion), folder, None)
    for key, value in leaves(_at(tree, "modes.trolley_positions") or [], "modes.trolley_positions"):
        position = _si(value, "m")
        if position is not None and not on_jib.keeps(position):
            faults.append(on_jib.fault(key, shown(value)))
    faults += more if not any(f.key.startswith("motion.") for f in faults) else []

    known = f"above 0 and up to {tower:g} m (the height of the tower)" if tower else "above 0"
    hint = "the load would be in the ground or the rope wound up"
    in_air = Way("motion.hoist", tower, True, f"rope lengths {known}", hint)
    start = _number(tree, "rope.length", "m")
    if start is not None and start > 0.0 and not in_air.keeps(start):
        return [*faults, in_air.fault("rope.length", shown(_at(tree, "rope.length")))], trolley, None
    hoisting = _out_of_way(tree, in_air, ("end",))
    rope, more = _motion(tree, in_air, TypeAdapter(HoistMotion), folder, start)
    return [*faults, *(hoisting or more)], trolley, rope


def _out_of_way(tree: dict[str, Any], way: Way, names: tuple[str, ...]) -> list[Fault]:
    """Single values of a motion outside its limits."""
    faults = []
    for key, value in leaves(_at(tree, way.key), way.key):
        position = _si(value, "m") if key.rpartition(".")[2] in names else None
        if position is not None and not way.keeps(position):
            faults.append(way.fault(key, shown(value)))
    return faults


def _motion(
    tree: dict[str, Any], way: Way, adapter: TypeAdapter[Any], folder: Path, start: float | None
) -> tuple[Motion | None, list[Fault]]:
    """The motion at ``way.key`` and what is wrong with it as a whole; a rope without hoist rests."""
    written = _at(tree, way.key)
    if written is None and start is not None and start > 0.0:
        written = {"shape": "rest"}
    try:
        described = adapter.validate_python(written)
    except ValidationError:
        return None, []
    hoists = not hasattr(described, "start") and way.open_low
    if hoists and start is None:
        return None, []
    begin = start if hoists and start is not None else getattr(described, "start", 0.0)
    try:
        motion = profile(described, begin, folder)
    except CaseError as error:
        named = f"named by {way.key}.file of the case"
        return None, [replace(f, hint=f"{f.hint}; {named}" if f.hint else named) for f in error.faults]
    except (ArithmeticError, ValueError) as error:
        return None, [Fault("", way.key, "a motion that can be computed", str(error))]
    key = f"{way.key}.file" if described.shape == "table" else way.key
    if hoists and abs(float(motion(0.0)) - begin) > 1e-6:
        got = f"a first length of {float(motion(0.0)):g} m"
        return None, [Fault("", key, f"a table that begins with rope.length, {begin:g} m", got)]
    fastest = max(abs(rate) for rate in motion.range(1))
    if described.shape == "table" and fastest > FASTEST:
        got, hint = (
            f"a table that reaches {fastest:.3g} m/s",
            "times in seconds? the curve through the points is smooth",
        )
        return None, [Fault("", key, f"speeds up to {FASTEST:g} m/s", got, hint)]
    low, high = motion.range()
    if not (way.keeps(low) and way.keeps(high)):
        return None, [way.fault(key, f"a motion from {low:g} to {high:g} m")]
    return motion, []


def _at(tree: Any, key: str) -> Any:
    """Value at a dotted key, None if there is none."""
    for name in key.split("."):
        tree = tree.get(name) if isinstance(tree, dict) else None
    return tree


def _si(value: object, unit: str) -> float | None:
    try:
        return to_si(value, unit)
    except UnitError:
        return None


def _number(tree: dict[str, Any], key: str, unit: str, default: float | None = None) -> float | None:
    """SI value at a dotted key; None if it cannot be read."""
    value = _at(tree, key)
    return default if value is None else _si(value, unit)

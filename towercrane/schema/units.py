"""Quantities with units, turned into SI floats at the door.

The registry knows the units of crane data sheets and no others: it loads thirty times faster than pint's
full list, and a slip such as ``kn`` is an unknown unit, not a knot. An angle has a dimension here, so
``"5 %"`` cannot pass for an angle nor ``"5 deg"`` for a ratio.
"""

from __future__ import annotations

import math
import re
from functools import cache, lru_cache
from typing import TYPE_CHECKING

from towercrane.schema.faults import did_you_mean, shown

if TYPE_CHECKING:
    import pint

DEFINITIONS = """
micro- = 1e-6 = µ- = μ- = u-
milli- = 1e-3 = m-
centi- = 1e-2 = c-
deci- = 1e-1 = d-
kilo- = 1e3 = k-
mega- = 1e6 = M-
giga- = 1e9 = G-
meter = [length] = m = metre
gram = [mass] = g
second = [time] = s = sec
kelvin = [temperature] = K
ampere = [current] = A
radian = [angle] = rad
degree = 0.017453292519943295 * radian = deg = °
revolution = 6.283185307179586 * radian = rev
percent = 0.01 = % = pct
minute = 60 * second = min
hour = 3600 * second = h
hertz = 1 / second = Hz
tonne = 1000 * kilogram = t
inch = 0.0254 * meter = in
foot = 0.3048 * meter = ft
pound = 0.45359237 * kilogram = lb
newton = kilogram * meter / second ** 2 = N
kilogram_force = 9.80665 * newton = kgf
pound_force = 4.4482216152605 * newton = lbf
pascal = newton / meter ** 2 = Pa
bar = 1e5 * pascal = bar
psi = 6894.757293168361 * pascal = psi
joule = newton * meter = J
watt = joule / second = W
revolution_per_minute = 0.10471975511965977 * radian / second = rpm
"""

COMMON = (
    *("mm", "cm", "m", "km", "in", "ft", "g", "kg", "t", "lb", "ms", "s", "min", "h", "N", "kN", "MN"),
    *("Pa", "kPa", "MPa", "GPa", "N/mm^2", "bar", "rad", "mrad", "deg", "rev", "rpm", "Hz", "J", "W", "%"),
)
"""Units offered when one is unknown."""

QUANTITIES = {
    "m": ("a length", "18 m"),
    "m^2": ("an area", "8 cm^2"),
    "m^4": ("a second moment of area", "0.014 m^4"),
    "kg": ("a mass", "800 kg"),
    "kg/m": ("a mass per length", "350 kg/m"),
    "kg/m^3": ("a density", "7850 kg/m^3"),
    "s": ("a time", "120 s"),
    "m/s": ("a speed", "0.8 m/s"),
    "m/s^2": ("an acceleration", "0.1 m/s^2"),
    "m/s^3": ("a jerk", "0.05 m/s^3"),
    "Pa": ("a stress or modulus", "206 GPa"),
    "rad": ("an angle", "5 deg"),
    "rad/s": ("a rotary speed", "7 rpm"),
    "rad/s^2": ("a rotary acceleration", "0.1 rad/s^2"),
    "rad/s^3": ("a rotary jerk", "0.05 rad/s^3"),
    "kg m": ("a mass moment", "90 kg m"),
    "kg m^2": ("a moment of inertia", "6 kg m^2"),
    "kg m^2/m": ("a rotary inertia per length", "250 kg m"),
    "N": ("a force", "120 MN"),
    "Hz": ("a frequency", "0.12 Hz"),
    "N m": ("a torque", "22 N m"),
    "N m^2": ("a torsional stiffness", "170 MN m^2"),
    "N/m": ("a stiffness", "60 kN/m"),
    "N m/rad": ("a rotary stiffness", "40 kN m/rad"),
    "N s/m": ("a damping", "60 N s/m"),
    "N m s/rad": ("a rotary damping", "10 N m s/rad"),
    "N s^2/m^2": ("a drag force per squared speed", "0.08 kg/m"),
    "1": ("a plain number", "0.02"),
}
"""What a quantity in this SI unit is called, and how one is written."""

ALSO = {"N m s/rad": ("N m s",), "N m/rad": ("N m",)}
"""Units accepted as equal to the wanted one."""

USUAL = {
    ("mm", "m"): 1e-3,
    ("cm^2", "m^2"): 1e-4,
    ("t", "kg"): 1e3,
    ("ms", "s"): 1e-3,
    ("min", "s"): 60.0,
    ("h", "s"): 3600.0,
    ("GPa", "Pa"): 1e9,
    ("deg", "rad"): 0.017453292519943295,
    ("kN/m", "N/m"): 1e3,
    ("MN/m", "N/m"): 1e6,
    ("kN m/rad", "N m/rad"): 1e3,
    ("MN m/rad", "N m/rad"): 1e6,
    ("kN m s/rad", "N m s/rad"): 1e3,
    ("kN m", "N m"): 1e3,
    ("MN m^2", "N m^2"): 1e6,
    ("t m^2", "kg m^2"): 1e3,
    ("kg m", "kg m^2/m"): 1.0,
    ("rpm", "rad/s"): 0.10471975511965977,
    ("kg/m", "N s^2/m^2"): 1.0,
    ("g", "m/s^2"): 9.80665,
}
"""Sizes of the commonest units in SI: a case that has no others is read without loading pint, in half the time. Where
an acceleration is wanted a g is no gram."""

FLOAT = r"[+-]?(?:\d+(?:_\d+)*\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|[+-]?(?:nan|inf)\b"
NUMBER = re.compile(rf"\s*({FLOAT})\s*(.*?)\s*", re.ASCII)
# Only what a unit needs reaches pint's expression parser: large or stacked powers could run for hours.
UNIT = re.compile(r"(?:[^\W\d_]|[°%*/^().·\s²³⁴⁻-]|_|(?<![\d.])\d(?![\d.]))*")
STACKED = re.compile(r"(?:\^|\*\*)\s*[-+]?\d\s*(?:\^|\*\*)|\)\s*(?:\^|\*\*)")


class UnitError(ValueError):
    """A value that is not the wanted quantity.

    Parameters
    ----------
    wanted, got, hint : str
        As in :class:`towercrane.schema.faults.Fault`.
    """

    def __init__(self, wanted: str, got: str, hint: str = "") -> None:
        super().__init__(f"wanted {wanted}, got {got}" + (f" ({hint})" if hint else ""))
        self.wanted, self.got, self.hint = wanted, got, hint


@cache
def registry() -> pint.UnitRegistry[float]:
    """The registry of known units."""
    import pint

    units: pint.UnitRegistry[float] = pint.UnitRegistry(None)
    units.load_definitions(DEFINITIONS.strip().splitlines())
    return units


def wanted(unit: str) -> str:
    """What a quantity in the SI unit ``unit`` is called, with an example."""
    name, example = QUANTITIES[unit]
    return (
        f"{name}, such as {example}" if unit == "1" else f'{name}, such as "{example}" (a plain number is in {unit})'
    )


def split(value: object) -> tuple[float, str]:
    """Number and unit text of a quantity as written; a plain number has the unit text "".

    Raises
    ------
    UnitError
        If the value does not begin with a finite number.
    """
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise UnitError("a quantity", shown(value))
    text, unit = str(value) if isinstance(value, float) else value, ""
    if isinstance(text, str):
        match = NUMBER.fullmatch(text)
        if not match:
            raise UnitError("a quantity", shown(value), "a quantity begins with its number")
        text, unit = match[1], match[2]
        if re.match(r",\d", unit):
            raise UnitError("a quantity", shown(value), "the decimal sign is a point, not a comma")
    try:
        number = float(text)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise UnitError("a finite number", shown(value))
    return number, unit


def to_si(value: object, unit: str) -> float:
    """Value of a quantity in the SI unit ``unit``.

    Parameters
    ----------
    value : str or float
        Text with a unit, such as ``"18 m"``, or a number that is in SI already.
    unit : str
        One of `QUANTITIES`.

    Raises
    ------
    UnitError
        If the value is no finite number, or its unit is unknown or of another dimension.
    """
    # Many runs of a case read the same texts.
    return _text_in_si(value, unit) if isinstance(value, str) else _in_si(value, unit)


@lru_cache(4096)
def _text_in_si(value: str, unit: str) -> float:
    return _in_si(value, unit)


def _in_si(value: object, unit: str) -> float:
    try:
        number, text = split(value)
    except UnitError as error:
        name = "a finite number: " + wanted(unit) if error.wanted == "a finite number" else wanted(unit)
        raise UnitError(name, error.got, error.hint) from None
    if isinstance(value, str):
        if not text and unit != "1":
            hint = f'write "{number:g} {unit}"; without quotes a number is taken as {unit}'
            raise UnitError(wanted(unit), f"{shown(value)}, which has no unit", hint)
        number *= _factor(value, text or "1", unit)
    if not math.isfinite(number):
        raise UnitError("a finite number: " + wanted(unit), shown(value))
    return number


def _factor(value: str, text: str, unit: str) -> float:
    """Size of the unit ``text`` in ``unit``."""
    if text == unit:
        return 1.0
    if (text, unit) in USUAL:
        return USUAL[text, unit]
    units = registry()
    source = units.Unit("dimensionless") if text == "1" else _parse(value, text, unit)
    for target in (unit, *ALSO.get(unit, ())):
        goal = units.Unit("dimensionless") if target == "1" else units.Unit(target)
        if source.dimensionality == goal.dimensionality:
            return float(units.convert(1.0, source, goal))
    raise UnitError(wanted(unit), f"{shown(value)}, which is {_kind(source)}")


def _parse(value: str, text: str, unit: str) -> pint.Unit:
    """The unit ``text``; ``value`` and ``unit`` are for the message."""
    import pint

    got = f"{shown(value)}, whose unit cannot be read"
    unreadable = UnitError(wanted(unit), got, f'write the unit like "{unit}"')
    # "m/s2" and "cm4" are how data sheets print powers.
    powers = re.sub(r"(?<=[^\W\d_])(?=\d)", "^", text)
    if len(powers) > 60 or not UNIT.fullmatch(powers) or STACKED.search(powers):
        raise unreadable
    try:
        return registry().parse_units(powers)
    except pint.UndefinedUnitError as error:
        name = str(error).split("'")[1]
        hint = did_you_mean(name, COMMON, f"known units: {', '.join(COMMON)}")
        raise UnitError(wanted(unit), f'{shown(value)}, whose unit "{name}" is unknown', hint) from None
    except Exception:
        # pint's parser lets tokenizer, type, value and assertion errors escape on malformed text.
        raise unreadable from None


def _kind(unit: pint.Unit) -> str:
    """A unit's dimension in words."""
    for known, (name, _) in QUANTITIES.items():
        if known != "1" and registry().Unit(known).dimensionality == unit.dimensionality:
            return name
    if unit.dimensionless:
        return "a ratio"
    return "a quantity in " + format(registry().get_base_units(unit)[1], "~C").replace("**", "^")

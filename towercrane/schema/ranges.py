"""Ranges of values that are plausible, and values of a case's tables before they are checked."""

from __future__ import annotations

from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, Any

from towercrane.schema.faults import Fault, shown
from towercrane.schema.units import UnitError, split, to_si

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping, Sequence

FARTHEST = 1e9
"""How many times beyond its range a value may lie that the case allows: numbers farther off overflow in products."""


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

    def is_for(self, key: str) -> bool:
        """Whether it is the range of a dotted key."""
        # To compile the patterns of all rows takes longer than all other checks of a case.
        beginning, wild, _ = self.key.partition("*")
        return fnmatchcase(key, self.key) if wild and key.startswith(beginning) else key == self.key

    def fault(self, key: str, value: object, *, allowed: bool = False) -> Fault | None:
        """Fault if ``value`` lies outside the range, or so far outside that it may not be ``allowed``.

        A value that cannot be read is for others to report.
        """
        try:
            size = to_si(value, self.unit)
        except UnitError:
            return None
        beyond = FARTHEST if allowed else 1.0
        low, high, size = self.low / beyond, self.high * beyond, abs(size) if self.signed else size
        if size <= 0.0 or low <= size <= high:
            return None
        wanted = f"a value from {low:g} to {high:g} {self.unit}".removesuffix(" 1")
        if self.signed:
            wanted += " of either sign, or 0"
        if allowed:
            return Fault("", key, wanted, shown(value), "beyond that an implausible value cannot be computed with")
        allow = f'if it is right, put allow_implausible = ["{key}"] at the top of the case file'
        number = abs(split(value)[0])
        unit = next((unit for unit in self.likely if self._holds(f"{number!r} {unit}")), None)
        hint = f"{unit} meant? {allow}" if unit else allow
        return Fault("", key, wanted, f"{shown(value)}, which is not plausible", hint)

    def _holds(self, text: str) -> bool:
        """Whether a quantity lies within the range; one too large for a number does not."""
        try:
            return self.low <= to_si(text, self.unit) <= self.high
        except UnitError:
            return False


def ranges_of(keys: Iterable[str], rows: Sequence[Range]) -> dict[str, Range]:
    """Ranges of those dotted keys that have one: of several rows that fit a key the last."""
    found = {key: next((row for row in reversed(rows) if row.is_for(key)), None) for key in keys}
    return {key: row for key, row in found.items() if row}


def out_of_range(values: Mapping[str, object], ranges: Mapping[str, Range], allowed: Collection[str]) -> list[Fault]:
    """Faults of values that lie outside the ranges of their keys, those at ``allowed`` keys far outside."""
    faults = [row.fault(key, values[key], allowed=key in allowed) for key, row in ranges.items()]
    return [fault for fault in faults if fault]


LENGTHS = ("mm", "cm", "km", "ft")


AREAS = ("cm^2", "mm^2")


SPRINGS = ("kN/m", "MN/m", "N/mm")


ROTARY_SPRINGS = ("kN m/rad", "MN m/rad")


ANGLES = ("deg", "mrad")


TURNS = ("rpm", "deg/s", "mrad/s")


def at(tree: Any, key: str) -> Any:
    """Value at a dotted key, None if there is none."""
    for name in key.split("."):
        tree = tree.get(name) if isinstance(tree, dict) else None
    return tree


def si(value: object, unit: str) -> float | None:
    """SI value; None if it cannot be read."""
    try:
        return to_si(value, unit)
    except UnitError:
        return None


def si_at(tree: dict[str, Any], key: str, unit: str, default: float | None = None) -> float | None:
    """SI value at a dotted key; None if it cannot be read."""
    value = at(tree, key)
    return default if value is None else si(value, unit)

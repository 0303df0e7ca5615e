"""Arguments that are checked alike everywhere: one message that names the argument, what was wanted, what came."""

from __future__ import annotations

import sys
from math import nan
from numbers import Integral, Real

SMALLEST, LARGEST = 5e-324, sys.float_info.max
"""The first number above zero and the last below infinity."""


def is_whole(value: object) -> bool:
    """Whether a value is an integer, of whatever type; truth is none."""
    return isinstance(value, Integral) and not isinstance(value, bool)


def whole_number(name: str, value: object, least: int = 0) -> int:
    """An integer of at least so much, whatever integer type it comes in.

    Raises
    ------
    ValueError
        If it is no whole number or less.
    """
    whole = is_whole(value)
    if not whole or int(value) < least:  # type: ignore[call-overload]
        wanted = {0: "zero or more", 1: "one or more"}.get(least, f"{least} or more")
        raise ValueError(f"{name}: wanted {'' if whole else 'a whole number, '}{wanted}, got {value!r}")
    return int(value)  # type: ignore[call-overload, no-any-return]


def number_in(name: str, value: object, wanted: str, *, least: float = -LARGEST, most: float = LARGEST) -> float:
    """A real number from the least to the most, both included; the text says which.

    Raises
    ------
    ValueError
        If it is no number or lies outside.
    """
    real = isinstance(value, (float, Real)) and not isinstance(value, bool)
    try:
        number = float(value) if real else nan  # type: ignore[arg-type]
    except OverflowError:
        number = nan
    if not least <= number <= most:
        raise ValueError(f"{name}: wanted {wanted}, got {value!r}")
    return number


def check_positive(name: str, value: object) -> float:
    """A finite number above zero.

    Raises
    ------
    ValueError
    """
    return number_in(name, value, "a positive finite number", least=SMALLEST)


def check_not_negative(name: str, value: object) -> float:
    """A finite number of zero or more.

    Raises
    ------
    ValueError
    """
    return number_in(name, value, "a finite number, zero or more", least=0.0)


def check_fields(owner: object, *, positive: tuple[str, ...] = (), not_negative: tuple[str, ...] = ()) -> None:
    """Refuse an object some of whose fields are not positive and finite, or negative or infinite.

    Raises
    ------
    ValueError
    """
    for name in positive:
        check_positive(f"{type(owner).__name__}.{name}", getattr(owner, name))
    for name in not_negative:
        check_not_negative(f"{type(owner).__name__}.{name}", getattr(owner, name))

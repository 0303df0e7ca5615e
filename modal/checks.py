"""Arguments that are checked alike everywhere: one message that names the argument, what was wanted, what came."""

from __future__ import annotations

from math import inf
from operator import index


def whole_number(name: str, value: object, least: int = 0) -> int:
    """An integer of at least so much, whatever integer type it comes in.

    Raises
    ------
    ValueError
        If it is no whole number or less.
    """
    wanted = {0: "zero or more", 1: "one or more"}.get(least, f"{least} or more")
    try:
        number = index(value)  # type: ignore[arg-type]
    except TypeError:
        number = None
    if number is None or isinstance(value, bool) or number < least:
        raise ValueError(f"{name}: wanted {wanted}, got {value!r}")
    return number


def number_in(name: str, value: object, wanted: str, *, least: float = -inf, most: float = inf) -> float:
    """A real number inside an open interval; the text says which.

    Raises
    ------
    ValueError
        If it is no number or lies outside.
    """
    try:
        inside = least < value < most  # type: ignore[operator]
    except TypeError:
        inside = False
    if not inside or isinstance(value, bool):
        raise ValueError(f"{name}: wanted {wanted}, got {value!r}")
    return float(value)  # type: ignore[arg-type]

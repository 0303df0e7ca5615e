"""Arguments that are no numbers of a crane: one message that names the argument, what was wanted and what came."""

from __future__ import annotations

from math import inf, isfinite
from numbers import Integral, Real
from typing import Any

import numpy as np

TIGHTEST, LEAST_ATOL = 1e-13, 1e-20
"""Least rtol, a few roundings of a state; and least atol, below which what is meant is none."""


def check_number(name: str, value: Any, wanted: str = "a finite number", *, least: float = -inf) -> None:
    """Refuse what is no finite number of at least so much.

    Raises
    ------
    ValueError
    """
    if isinstance(value, bool) or not isinstance(value, Real) or not isfinite(value) or value < least:
        raise ValueError(f"{name}: wanted {wanted}, got {value!r}")


def check_positive(name: str, value: Any) -> None:
    """Refuse what is no finite number above zero.

    Raises
    ------
    ValueError
    """
    check_number(name, value, "a positive number", least=5e-324)


def check_not_negative(name: str, value: Any) -> None:
    """Refuse what is no finite number of zero or more.

    Raises
    ------
    ValueError
    """
    check_number(name, value, "zero or more", least=0.0)


def check_count(name: str, value: Any, least: int = 0) -> None:
    """Refuse what is no whole number of at least so much.

    Raises
    ------
    ValueError
    """
    whole = isinstance(value, Integral) and not isinstance(value, bool)
    if not whole or value < least:
        wanted = {0: "zero or more", 1: "one or more"}.get(least, f"{least} or more")
        raise ValueError(f"{name}: wanted {'' if whole else 'a whole number, '}{wanted}, got {value!r}")


def check_fields(owner: Any, *, positive: tuple[str, ...] = (), not_negative: tuple[str, ...] = ()) -> None:
    """Refuse an object some of whose fields are not positive, or negative.

    Raises
    ------
    ValueError
    """
    for name in positive:
        check_positive(f"{type(owner).__name__}.{name}", getattr(owner, name))
    for name in not_negative:
        check_not_negative(f"{type(owner).__name__}.{name}", getattr(owner, name))


def check_between(name: str, value: Any, least: float, most: float) -> None:
    """Refuse what is no number from the least to the most.

    Raises
    ------
    ValueError
    """
    wanted = f"a number from {least:g} to {most:g}"
    check_number(name, value, wanted, least=least)
    if value > most:
        raise ValueError(f"{name}: wanted {wanted}, got {value!r}")


def check_tolerances(rtol: Any, atol: Any) -> None:
    """Refuse tolerances that no solver keeps.

    Raises
    ------
    ValueError
    """
    check_between("rtol", rtol, TIGHTEST, 1.0)
    check_between("atol", atol, LEAST_ATOL, 1.0)


def check_times(times: Any) -> None:
    """Refuse times that do not follow each other.

    Raises
    ------
    ValueError
    """
    if np.ndim(times) != 1 or not np.all(np.isfinite(times)) or not np.all(np.diff(times) >= 0.0):
        raise ValueError(f"sample_times: wanted finite, increasing times in one row, got {times!r}")

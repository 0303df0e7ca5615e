"""Arguments of a solver that are checked alike by all: tolerances that one can keep, times that follow each other."""

from __future__ import annotations

from typing import Any

import numpy as np

from modal.checks import number_in

TIGHTEST, LEAST_ATOL = 1e-13, 1e-20
"""Least rtol, a few roundings of a state; and least atol, below which what is meant is none."""


def check_tolerances(rtol: Any, atol: Any) -> None:
    """Refuse tolerances that no solver keeps.

    Raises
    ------
    ValueError
    """
    for name, value, least in (("rtol", rtol, TIGHTEST), ("atol", atol, LEAST_ATOL)):
        number_in(name, value, f"a number from {least:g} to 1", least=least, most=1.0)


def check_times(times: Any) -> None:
    """Refuse times that do not follow each other.

    Raises
    ------
    ValueError
    """
    if np.ndim(times) != 1 or not np.all(np.isfinite(times)) or not np.all(np.diff(times) >= 0.0):
        raise ValueError(f"sample_times: wanted finite, increasing times in one row, got {times!r}")

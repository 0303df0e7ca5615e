"""Prescribed motions inside equations."""

from __future__ import annotations

from typing import Any


def polynomial(coefficients: Any, t: Any) -> tuple[Any, Any, Any]:
    """Value and first two derivatives of an input channel at a time since its phase began [s].

    ``coefficients`` are ascending, of any degree.
    """
    value, rate, half_second = 0.0, 0.0, 0.0
    for coefficient in coefficients[::-1]:
        half_second = half_second * t + rate
        rate = rate * t + value
        value = value * t + coefficient
    return value, rate, 2.0 * half_second

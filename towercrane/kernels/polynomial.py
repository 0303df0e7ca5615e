"""Prescribed motions inside compiled equations."""

from __future__ import annotations

from typing import Any

from modal.compiler.compiled import kernel


@kernel()
def polynomial(inputs: Any, channel: int, t: float) -> tuple[float, float, float]:
    """Value and first two derivatives of an input channel.

    Parameters
    ----------
    inputs : ndarray, shape (channels, k)
        Ascending coefficients of any degree.
    channel : int
        Row of ``inputs``.
    t : float
        Time since the phase began [s].
    """
    value, rate, half_second = 0.0, 0.0, 0.0
    for c in range(inputs.shape[1] - 1, -1, -1):
        half_second = half_second * t + rate
        rate = rate * t + value
        value = value * t + inputs[channel, c]
    return value, rate, 2.0 * half_second

"""How long steps are: the first, the next one, and the shortest.

The step control is that of Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993), section II.4,
except that steps grow slowly.

The error estimate of a vibration comes and goes with its phase. A step that grew as far as a small estimate allows
would be rejected at the next peak: steps of a quarter of a period, of which every other one saw nothing, were tried
twice each. So a step shrinks at once as far as its estimate says, and grows by a small power of that. Steps of nearly
the same length are also those that leave the smallest error for their number.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from modal.compiler.kinds import Row

SAFETY, SHRINK, GROW = 0.87, 0.2, 10.0

FREELY, SLOWLY = 1.0, 0.2
"""Power by which steps grow: up to a run's first rejected one, of which the length is a guess, and from then on."""

SHORTEST = 16.0 * float(np.finfo(np.float64).eps)
"""Part of a phase that is the shortest step."""


def step_factor(norm: float, error_order: int, growth: float) -> float:
    """Length of the next step over that of one whose error estimate had this norm; below 1 where it was rejected."""
    if not np.isfinite(norm):
        # A trial left the model's domain.
        return SHRINK
    factor = SAFETY * norm ** (-1.0 / (error_order + 1))
    return float(max(SHRINK, factor) if factor < 1.0 else min(GROW, factor**growth))


def first_step(y: Row, slope: Row, rtol: float, atol: Row, limit: float) -> float:
    """First guess of a step, from the size of state and slope."""
    size, speed = 0.0, 0.0
    for m in range(y.size):
        if not np.isinf(atol[m]):
            scale = atol[m] + rtol * abs(y[m])
            size += (y[m] / scale) * (y[m] / scale)
            speed += (slope[m] / scale) * (slope[m] / scale)
    if speed == 0.0:
        return limit
    # A state at the origin says nothing of its scale: begin small, the control grows it tenfold a step.
    guess = 0.01 * np.sqrt(size / speed) if size > 1e-10 else 0.0
    guess = guess if guess > 1e-6 * limit else 1e-6 * limit
    return guess if guess < limit else limit

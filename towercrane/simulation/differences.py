"""Derivatives of a function that can only be evaluated, by extrapolated central differences."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

LARGEST = 2.0**-5
"""Largest step per scale; each further step is half the one before."""

STEPS = 16
"""Steps per column, down to 1e-6 of the scale."""

WINDOW = 6
"""Neighbouring steps that one extrapolation uses."""


def jacobian(function: Callable[[Floats], Floats], at: Floats, scale: Floats) -> tuple[Floats, Floats]:
    """Derivatives of a vector function and how far they are uncertain.

    Differences of several steps are extrapolated to step zero through all powers of the step, not the even ones
    alone: a drag v|v| at rest has odd powers too. Of all sequences of neighbouring steps, each entry takes the one
    whose extrapolation agrees best with itself, so a friction that saturates within 0.01 rad/s needs no smaller
    scale. Where one-sided derivatives differ, the result is their mean.

    Parameters
    ----------
    function : callable
        From shape (n, p) to shape (m, p), a column for each of p places.
    at, scale : ndarray, shape (n,)
        Where, and the size of a step that is large for each argument.

    Returns
    -------
    values, errors : ndarray, shape (m, n)
    """
    inner, outer = _extrapolation(WINDOW - 1), _extrapolation(WINDOW)
    values, errors = [], []
    columns = np.arange(len(at)).repeat(STEPS)
    places, count = np.tile(at[:, None], (2, 1, len(columns))), np.arange(len(columns))
    steps = np.outer(LARGEST * scale, 0.5 ** np.arange(STEPS)).ravel()
    places[0, columns, count] += steps
    places[1, columns, count] -= steps
    ahead, behind = np.split(function(np.hstack([*places])), 2, axis=1)
    slopes = (ahead - behind) / (places[0, columns, count] - places[1, columns, count])
    for own in np.split(slopes.T, len(at)):
        windows = np.lib.stride_tricks.sliding_window_view(own, WINDOW, axis=0)
        # What all steps agree on is kept to the last digit.
        last = windows[..., -1]
        departures = windows - last[..., None]
        best = departures @ outer
        error = np.maximum(abs(best - departures[..., :-1] @ inner), abs(best - departures[..., 1:] @ inner))
        best += last
        error[~np.isfinite(error)] = np.inf
        chosen = np.argmin(error, axis=0)[None]
        values.append(np.take_along_axis(best, chosen, axis=0)[0])
        errors.append(np.take_along_axis(error, chosen, axis=0)[0])
    return np.array(values).T, np.array(errors).T


def _extrapolation(count: int) -> Floats:
    """Weights that carry values at steps 1, 1/2, 1/4, ... to step zero."""
    steps = 0.5 ** np.arange(count)
    return np.array([np.prod([h / (h - own) for h in steps if h != own]) for own in steps])

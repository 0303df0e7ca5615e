"""The two bases that span the mode shapes of a clamped uniform beam, each where it is accurate.

On the unit length, with characteristic root x,

* from `SERIES_BELOW` on: ``A cos xz + B sin xz + D e^{-xz} + E e^{-x(1-z)}``; nothing grows, so nothing
  overflows or cancels, however high the mode;
* below it: ``P (cosh xz - cos xz) / x^2 + Q (sinh xz - sin xz) / x^3`` as power series, since the four
  functions above come closer and closer to being linearly dependent as x goes to zero, and digits are lost.

Measured, both are good to rounding from 0.4 to 2.5; the border between them lies well inside.

Coefficients are rows (A, B, D, E) or (P, Q, 0, 0).
"""

from __future__ import annotations

from math import isinf
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

SERIES_BELOW = 1.0
_SERIES_TERMS = 8


def shares(ratio: float) -> tuple[float, float]:
    """Share of the body and share of the beam, a / (1 + a) and 1 / (1 + a); finite for infinite a too."""
    return (1.0, 0.0) if isinf(ratio) else (ratio / (1.0 + ratio), 1.0 / (1.0 + ratio))


def clamped_pair(
    roots: NDArray[np.float64], first: NDArray[np.float64], second: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Coefficients of shapes with no deflection and no slope at the root.

    Parameters
    ----------
    roots : ndarray, shape (n,)
        Characteristic roots [rad].
    first, second : ndarray, shape (n,)
        The two free coefficients: P and Q below `SERIES_BELOW`, A and E from there on.

    Returns
    -------
    ndarray, shape (n, 4)
        Coefficients in the basis that belongs to each root.
    """
    decay, none = np.exp(-roots), np.zeros_like(roots)
    exponential = np.stack([first, -first - 2.0 * second * decay, -first - second * decay, second], axis=-1)
    series = np.stack([first, second, none, none], axis=-1)
    return np.where(roots[:, None] < SERIES_BELOW, series, exponential)


def evaluate(
    roots: NDArray[np.float64], coefficients: NDArray[np.float64], z: NDArray[np.float64], derivative: int
) -> NDArray[np.float64]:
    """Derivatives of shapes with respect to z.

    Parameters
    ----------
    roots : ndarray, shape (n,)
        Characteristic roots [rad].
    coefficients : ndarray, shape (n, 4)
        Coefficients in the basis that belongs to each root.
    z : ndarray, shape (s,)
        Positions between 0 and 1 [1].
    derivative : int
        Order of the derivative, zero or more.

    Returns
    -------
    ndarray, shape (n, s)
        Derivatives, in the coefficients' unit.
    """
    values = np.empty((roots.size, z.size))
    low = roots < SERIES_BELOW
    cycle = derivative % 4
    if low.any():
        x = roots[low, None]
        P, Q = coefficients[low, 0, None], coefficients[low, 1, None]
        first = _series(x, z, 2 - cycle) if cycle < 3 else x**4 * _series(x, z, 3)
        values[low] = x ** (derivative - cycle) * (P * first + Q * _series(x, z, 3 - cycle))

    x = roots[~low, None]
    A, B, D, E = (coefficients[~low, k, None] for k in range(4))
    A, B = ((A, B), (B, -A), (-A, -B), (-B, A))[cycle]
    xz = x * z
    waves = A * np.cos(xz) + B * np.sin(xz)
    values[~low] = x**derivative * (waves + (-1) ** derivative * D * np.exp(-xz) + E * np.exp(xz - x))
    return values


def _series(x: NDArray[np.float64], z: NDArray[np.float64], lowest: int) -> NDArray[np.float64]:
    """Sum over k of 2 x^(4k) z^(4k + lowest) / (4k + lowest)!."""
    term = 2.0 * z**lowest / (1, 1, 2, 6)[lowest] * np.ones_like(x)
    total = np.zeros_like(term)
    quartic = (x * z) ** 4
    for k in range(_SERIES_TERMS):
        total += term
        n = 4 * k + lowest
        term = term * quartic / ((n + 1) * (n + 2) * (n + 3) * (n + 4))
    return total

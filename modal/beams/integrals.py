"""Integrals of mode shapes and of their products over the unit length, exact but for rounding."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Literal

import numpy as np

from modal.beams.basis import SERIES_BELOW, evaluate

if TYPE_CHECKING:
    from numpy.typing import NDArray

Weight = Literal["one", "from_root", "from_end"]

_GAUSS_POINTS = 16
_PANEL_PHASE = 3.0


def shape_integrals(
    roots: NDArray[np.float64], coefficients: NDArray[np.float64], weight: Weight = "one"
) -> NDArray[np.float64]:
    """Integrals of the shapes over (0, 1) with weight 1, z or 1 - z.

    Parameters
    ----------
    roots : ndarray, shape (n,)
        Characteristic roots [rad].
    coefficients : ndarray, shape (n, 4)
        Coefficients of the shapes, see `modal.beams.basis`.
    weight : {"one", "from_root", "from_end"}
        Weight 1, z or 1 - z.

    Returns
    -------
    ndarray, shape (n,)
        Integrals, in the coefficients' unit.
    """
    result = np.zeros(roots.size)
    for amplitude, left, right in _exponentials(roots, coefficients, 0):
        result += (amplitude * _exponential_integral(left, right, weight)).real
    low = np.flatnonzero(roots < SERIES_BELOW)
    if low.size:
        z, weights = _quadrature(SERIES_BELOW, weight)
        result[low] = evaluate(roots[low], coefficients[low], z, 0) @ weights
    return result


def product_integrals(
    roots: NDArray[np.float64], coefficients: NDArray[np.float64], derivative: int, weight: Weight = "one"
) -> NDArray[np.float64]:
    """Integrals over (0, 1) of all products of two shapes' derivatives, with weight 1, z or 1 - z.

    A shape is a sum of exponentials of z, and so is a product of two; each has an elementary integral. The
    few shapes kept as power series (roots below `SERIES_BELOW`, two at most) are integrated with all others
    by Gauss-Legendre panels, short enough for the shortest wave to come out to rounding.

    Parameters
    ----------
    roots : ndarray, shape (n,)
        Characteristic roots [rad].
    coefficients : ndarray, shape (n, 4)
        Coefficients of the shapes, see `modal.beams.basis`.
    derivative : int
        Order of the derivative with respect to z taken of both factors.
    weight : {"one", "from_root", "from_end"}
        Weight 1, z or 1 - z.

    Returns
    -------
    ndarray, shape (n, n)
        Symmetric matrix of integrals, in the coefficients' unit squared.
    """
    terms = np.array(_exponentials(roots, coefficients, derivative))
    wave = terms[:1] * np.array([0.5, 1.0, 1.0])[:, None]
    # With the second factor written out in full, real, the real part of the first can be taken at the end.
    amplitude, left, right = (terms[:, None, k, :, None] for k in range(3))
    others = np.concatenate([wave, wave.conj(), terms[1:]])
    other_amplitude, other_left, other_right = (others[:, k, None, :] for k in range(3))
    integral = _exponential_integral(left + other_left, right + other_right, weight)
    result: NDArray[np.float64] = (amplitude * other_amplitude * integral).real.sum(axis=(0, 1))
    low = np.flatnonzero(roots < SERIES_BELOW)
    if low.size:
        z, weights = _quadrature(roots.max(), weight)
        values = evaluate(roots, coefficients, z, derivative)
        rows = (values[low] * weights) @ values.T
        result[low, :] = rows
        result[:, low] = rows.T
    return 0.5 * (result + result.T)


def _exponentials(
    roots: NDArray[np.float64], coefficients: NDArray[np.float64], derivative: int
) -> list[tuple[NDArray[np.complex128], NDArray[np.complex128], NDArray[np.complex128]]]:
    """Wave and two decaying exponentials, whose real parts add up to the shape.

    Each is given by its amplitude and its exponents at z = 0 and z = 1, all of shape (n,).
    """
    A, B, D, E = coefficients.T
    x, zero = roots.astype(complex), np.zeros(roots.size, complex)
    return [
        ((A - 1j * B) * (1j * x) ** derivative, zero, 1j * x),
        (D * (-x) ** derivative, zero, -x),
        (E * x**derivative, -x, zero),
    ]


def _exponential_integral(
    left: NDArray[np.complex128], right: NDArray[np.complex128], weight: Weight
) -> NDArray[np.complex128]:
    """Integral over (0, 1) of weight times an exponential with the given exponents at z = 0 and z = 1."""
    # Measured from the end where it is larger the exponential decays, and no intermediate value can overflow.
    flip = right.real > left.real
    rate = np.where(flip, left - right, right - left)
    anchor = np.exp(np.where(flip, right, left))
    safe = np.where(rate == 0.0, 1.0, rate)
    plain = np.where(rate == 0.0, 1.0, np.expm1(safe) / safe)
    if weight == "one":
        return anchor * plain
    small = np.abs(rate) < 1.0
    near = np.where(small, rate, 0.0)
    far = np.where(small, 1.0, rate)
    # Weight (1 - distance from the anchored end): (e^r - 1 - r) / r^2, by its series where that cancels.
    series = np.zeros_like(near)
    for k in range(18, 1, -1):
        series = (series * near + 1.0) / k
    towards = np.where(small, series, (np.expm1(far) - far) / far**2)
    return anchor * np.where(flip == (weight == "from_root"), towards, plain - towards)


def _quadrature(phase: float, weight: Weight) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Gauss-Legendre points and weights on (0, 1), in panels short for waves of that phase over (0, 1)."""
    panels = max(1, int(np.ceil(phase / _PANEL_PHASE)))
    points, weights = _gauss_rule()
    z = ((np.arange(panels)[:, None] + 0.5 * (points + 1.0)) / panels).ravel()
    scale = {"one": np.ones_like(z), "from_root": z, "from_end": 1.0 - z}[weight]
    return z, np.tile(0.5 * weights / panels, panels) * scale


@cache
def _gauss_rule() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Gauss-Legendre points and weights on (-1, 1)."""
    points, weights = np.polynomial.legendre.leggauss(_GAUSS_POINTS)
    return points, weights

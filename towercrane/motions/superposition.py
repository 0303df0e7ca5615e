"""Sums and integrals of motions, again exact piecewise polynomials."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.motions.motion import Motion, distinct

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


def total(motions: Sequence[Motion], delays: Sequence[float], weights: Sequence[float]) -> Motion:
    """Weighted sum of motions, each begun after its delay: y(t) = sum w_i m_i(t - d_i).

    Parameters
    ----------
    motions : sequence of Motion
        One or more.
    delays : sequence of float
        Zero or more [s].
    weights : sequence of float
    """
    if not motions or min(delays) < 0.0:
        raise ValueError(f"total: wanted motions and delays of zero or more, got {len(motions)} and {list(delays)}")
    begun = [_delayed(m, d) for m, d in zip(motions, delays, strict=True)]
    times = distinct(np.concatenate([m.switch_times for m in begun]))
    pieces = np.zeros((max(len(times) - 1, 1), max(m.coefficients.shape[1] for m in motions)))
    for motion, weight in zip(begun, weights, strict=True):
        for row, time in zip(pieces, times, strict=False):
            piece = motion.pieces(np.array([time]))[0]
            row[: len(piece)] += weight * piece
    end_rate = sum(weight * motion.end_rate for motion, weight in zip(motions, weights, strict=True))
    return Motion(times if len(times) > 1 else np.zeros(2), pieces, end_rate)


def _delayed(motion: Motion, delay: float) -> Motion:
    """The motion after a wait in which it rests."""
    waits = np.zeros((1, motion.coefficients.shape[1]))
    waits[0, 0] = motion.coefficients[0, 0]
    pieces = np.vstack([waits, motion.coefficients])
    return Motion(np.append(0.0, motion.switch_times + delay), pieces, motion.end_rate)


def integral(rate: Motion, start: float) -> Motion:
    """Motion that begins at ``start`` and changes at this rate, which must end at zero: the motion rests after it."""
    pieces = np.zeros((rate.coefficients.shape[0], rate.coefficients.shape[1] + 1))
    pieces[:, 1:] = rate.coefficients / np.arange(1, pieces.shape[1])
    value = start
    for piece, span in zip(pieces, np.diff(rate.switch_times), strict=True):
        piece[0] = value
        value = float(np.polynomial.polynomial.polyval(span, piece))
    return Motion(rate.switch_times, pieces)


def rate(motion: Motion) -> Motion:
    """Derivative of a motion over time, as a motion that ends where the motion's last piece does."""
    pieces = np.asarray(np.polynomial.polynomial.polyder(motion.coefficients, axis=1), dtype=float)
    return Motion(motion.switch_times, pieces)

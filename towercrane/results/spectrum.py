"""Frequencies read off a time series: amplitude spectrum, its peaks, the period of a swing."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

PADDING = 8
"""Zero padding, so that a peak is seen between two bins."""

SHORTEST = 16
"""Samples below which a spectrum says nothing."""

SAMPLES_PER_PERIOD = 8.0
"""Samples of a swing below which its period could be that of a faster one."""


STILL = 1e-9
"""Signals that vary by less than this fraction of their size are rounding."""


def amplitude_spectrum(times: Floats, values: Floats) -> tuple[Floats, Floats]:
    """One-sided amplitude spectrum of a uniformly sampled signal.

    The straight line through the signal is taken off and a Hann window applied (Gao et al. 2023, Eq. 29, uses
    neither, which smears the slow drift of a travelling trolley over all frequencies). A sine of amplitude a gives
    a peak of height a.

    Parameters
    ----------
    times, values : ndarray, shape (p,)

    Returns
    -------
    frequencies : ndarray, shape (k,)
        [Hz]
    amplitudes : ndarray, shape (k,)
        In the unit of the values; empty if the signal is too short or at rest.
    """
    if len(times) > 2 and abs(times[-1] - times[-2] - (times[1] - times[0])) > 1e-6 * (times[1] - times[0]):
        times, values = times[:-1], values[:-1]  # a run that ended early closes with a row off the grid
    if len(times) < SHORTEST or np.ptp(values) <= STILL * np.max(abs(values)):
        return np.empty(0), np.empty(0)
    line = np.polynomial.Polynomial.fit(times, values, 1)
    window = np.hanning(len(times))
    padded = PADDING * len(times)
    amplitudes = 2.0 / window.sum() * abs(np.fft.rfft(window * (values - line(times)), padded))
    return np.fft.rfftfreq(padded, (times[-1] - times[0]) / (len(times) - 1)), amplitudes


def spectrum_peaks(times: Floats, values: Floats, *, most: int = 5, floor: float = 0.1) -> list[float]:
    """Frequencies of the highest peaks, ascending [Hz].

    Parameters
    ----------
    times, values : ndarray, shape (p,)
    most : int
        Number of peaks at most.
    floor : float
        Peaks lower than this fraction of the highest are left out: the window's side lobes (0.027) and those of
        the travelling trolley's drift are.
    """
    frequencies, amplitudes = amplitude_spectrum(times, values)
    if len(amplitudes) < 3:
        return []
    middle = amplitudes[1:-1]
    tops = np.flatnonzero((middle > amplitudes[:-2]) & (middle >= amplitudes[2:])) + 1
    # Below three periods in the record a "peak" is the drift that the window has bent.
    tops = tops[frequencies[tops] > 3.0 / (times[-1] - times[0])]
    tops = tops[np.array([_stands_out(amplitudes, k) for k in tops], dtype=bool)]
    if not len(tops):
        return []
    tops = tops[amplitudes[tops] >= floor * amplitudes[tops].max()]
    highest = sorted(tops[np.argsort(amplitudes[tops])[::-1]][:most])
    return [_vertex(frequencies[k - 1 : k + 2], amplitudes[k - 1 : k + 2]) for k in highest]


def _stands_out(amplitudes: Floats, top: int) -> bool:
    """Whether the spectrum falls by a third on both sides before it rises above the peak."""
    for side in (amplitudes[top::-1], amplitudes[top:]):
        higher = np.flatnonzero(side > side[0])
        if side[: higher[0] if len(higher) else None].min() > side[0] / 1.5:
            return False
    return True


def _vertex(x: Floats, y: Floats) -> float:
    """Abscissa of the parabola's top through three equidistant points."""
    curve = y[0] - 2.0 * y[1] + y[2]
    return float(x[1] if curve == 0.0 else x[1] + 0.5 * (x[1] - x[0]) * (y[0] - y[2]) / curve)


def swing_period(times: Floats, angle: Floats, *, smallest: float = 1e-6) -> float | None:
    """Median time between upward passages through the middle [s].

    Returns
    -------
    float or None
        None where there is no one period: fewer than two passages, a swing below ``smallest`` [rad], fewer than
        eight samples a period, or intervals that differ from their median by more than a tenth.
    """
    if len(times) < 3 or np.ptp(angle) < 2.0 * smallest:
        return None
    centred = angle - 0.5 * (angle.max() + angle.min())
    up = np.flatnonzero((centred[:-1] < 0.0) & (centred[1:] >= 0.0))
    fraction = -centred[up] / (centred[up + 1] - centred[up])
    intervals = np.diff(times[up] + fraction * (times[up + 1] - times[up]))
    if not len(intervals):
        return None
    period = float(np.median(intervals))
    scattered = np.max(abs(intervals / period - 1.0)) > 0.1
    return None if scattered or period < SAMPLES_PER_PERIOD * (times[1] - times[0]) else period

"""Motions that leave the load at rest: shapers that spread a ramp so that its parts cancel each other's vibration.

A shaper is a positive weight over time with sum 1: impulses, moving averages, or both one after the other. A motion
convolved with it travels as far and never faster, nor with more acceleration.

References
----------
O. J. M. Smith, Posicast control of damped oscillatory systems, Proc. IRE 45 (1957): ZV.
N. C. Singer, W. P. Seering, Preshaping command inputs to reduce system vibration, ASME J. Dynamic Systems,
Measurement, and Control 112 (1990): ZV, ZVD, the residual and several modes.
W. E. Singhose, W. P. Seering, N. C. Singer, Residual vibration reduction using vector diagrams to generate shaped
inputs, ASME J. Mechanical Design 116 (1994): EI.
L. Biagiotti, C. Melchiorri, FIR filters for online trajectory planning with time- and frequency-domain
specifications, Control Engineering Practice 20 (2012): moving averages.
T. Flash, N. Hogan, The coordination of arm movements, J. Neuroscience 5 (1985): minimum jerk.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce
from math import exp, pi, sqrt
from typing import TYPE_CHECKING

import numpy as np

from modal.checks import check_positive, number_in
from towercrane.motions.motion import SAME_INSTANT, Motion, rest
from towercrane.motions.superposition import integral, total

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]

TOLERATED = 0.05
"""Residual of an EI shaper at its design frequency, as a fraction of the unshaped vibration."""


@dataclass(frozen=True, slots=True)
class Shaper:
    """Impulses, followed by moving averages.

    Parameters
    ----------
    delays : tuple of float
        Of the impulses [s]; from 0, ascending.
    amplitudes : tuple of float
        Of the impulses; not negative, with sum 1.
    widths : tuple of float
        Of the moving averages [s].

    Raises
    ------
    ValueError
        If the impulses are not such.
    """

    delays: tuple[float, ...] = (0.0,)
    amplitudes: tuple[float, ...] = (1.0,)
    widths: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        d, a = self.delays, self.amplitudes
        if not d or d[0] != 0.0 or list(d) != sorted(d) or not d[-1] < np.inf:
            raise ValueError(f"Shaper.delays: wanted finite ascending times from 0, got {d}")
        if len(a) != len(d) or min(a) < 0.0 or abs(sum(a) - 1.0) > 1e-9:
            raise ValueError(f"Shaper.amplitudes: wanted {len(d)} of zero or more with sum 1, got {a}")
        if not all(0.0 < width < np.inf for width in self.widths):
            raise ValueError(f"Shaper.widths: wanted positive times, got {self.widths}")

    @property
    def duration(self) -> float:
        """Time by which it prolongs a motion [s]."""
        return self.delays[-1] + sum(self.widths)

    @property
    def mean_delay(self) -> float:
        """Time by which it shifts a motion's centre [s]."""
        return sum(a * d for a, d in zip(self.amplitudes, self.delays, strict=True)) + sum(self.widths) / 2

    def then(self, other: Shaper) -> Shaper:
        """Both, one after the other: impulses in all pairs, those at the same instant as one."""
        pairs = sorted(
            (s + t, a * b)
            for s, a in zip(self.delays, self.amplitudes, strict=True)
            for t, b in zip(other.delays, other.amplitudes, strict=True)
        )
        delays, amplitudes = [pairs[0][0]], [0.0]
        for delay, amplitude in pairs:
            if delay - delays[-1] > SAME_INSTANT:
                delays.append(delay)
                amplitudes.append(0.0)
            amplitudes[-1] += amplitude
        return Shaper(tuple(delays), tuple(amplitudes), self.widths + other.widths)

    def residual(self, frequency: ArrayLike, damping_ratio: float = 0.0) -> Floats:
        """Vibration left by a shaped ramp over what the ramp itself leaves, right after the last impulse or average.

        Singer and Seering (1990), Eq. 14, with e^(lambda t) for cosine and sine, so that a moving average is one
        more factor, (e^(lambda w) - 1) / (lambda w).

        Parameters
        ----------
        frequency : array_like
            Natural frequency of the oscillator [Hz], positive.
        damping_ratio : float
            Of critical, less than 1.
        """
        w = 2.0 * pi * np.asarray(frequency, dtype=float)
        pole = w * (damping_ratio + 1j * sqrt(1.0 - damping_ratio**2))
        response = sum(a * np.exp(pole * d) for a, d in zip(self.amplitudes, self.delays, strict=True))
        for width in self.widths:
            response = response * np.expm1(pole * width) / (pole * width)
        return np.asarray(np.abs(response) * np.exp(-damping_ratio * w * self.duration))

    def __call__(self, motion: Motion) -> Motion:
        """The motion convolved with the shaper."""
        if motion.duration == 0.0:
            return motion
        if len(self.delays) > 1:
            motion = total([motion] * len(self.delays), self.delays, self.amplitudes)
        for width in self.widths:
            start = float(motion.coefficients[0, 0])
            motion = integral(total([motion, motion], (0.0, width), (1.0 / width, -1.0 / width)), start)
        return motion


def zv(frequencies: Sequence[float], damping_ratio: float = 0.0) -> Shaper:
    """Zero vibration: two impulses half a damped period apart for each frequency.

    Parameters
    ----------
    frequencies : sequence of float
        Natural frequencies [Hz].
    damping_ratio : float
        Of every mode, as a fraction of critical.
    """
    return _impulses(frequencies, damping_ratio, lambda k: (1.0, k))


def zvd(frequencies: Sequence[float], damping_ratio: float = 0.0) -> Shaper:
    """Zero vibration and zero derivative over the frequency: three impulses for each frequency.

    Parameters
    ----------
    frequencies : sequence of float
        Natural frequencies [Hz].
    damping_ratio : float
        Of every mode, as a fraction of critical.
    """
    return _impulses(frequencies, damping_ratio, lambda k: (1.0, 2 * k, k * k))


def ei(frequencies: Sequence[float], damping_ratio: float = 0.0, tolerated: float = TOLERATED) -> Shaper:
    """Extra-insensitive: three impulses that leave ``tolerated`` at the frequency and nothing on either side of it.

    Parameters
    ----------
    frequencies : sequence of float
        Natural frequencies [Hz].
    damping_ratio : float
        Zero: with damping there is no closed form.
    tolerated : float
        Residual at the frequency, as a fraction of the unshaped vibration; at least 0 and less than 1.
    """
    if damping_ratio != 0.0:
        raise ValueError(
            f"ei: damping_ratio wants 0, got {damping_ratio!r}; zv and zvd have a closed form with damping"
        )
    if not 0.0 <= tolerated < 1.0:
        raise ValueError(f"ei: tolerated wants a fraction from 0 to less than 1, got {tolerated!r}")
    v = tolerated
    return _impulses(frequencies, 0.0, lambda _: (1.0 + v, 2.0 - 2.0 * v, 1.0 + v))


def boxes(frequencies: Sequence[float], damping_ratio: float = 0.0) -> Shaper:
    """Moving averages over one period of each frequency, which turn a trapezoid into an S-curve.

    Parameters
    ----------
    frequencies : sequence of float
        Natural frequencies [Hz].
    damping_ratio : float
        Zero: an even average cancels undamped vibration alone.
    """
    if damping_ratio != 0.0:
        raise ValueError(
            f"boxes: damping_ratio wants 0, got {damping_ratio!r}; zv and zvd have a closed form with damping"
        )
    return Shaper(widths=tuple(1.0 / f for f in _checked(frequencies)))


DESIGNS: dict[str, Callable[[Sequence[float], float], Shaper]] = {"zv": zv, "zvd": zvd, "ei": ei, "boxes": boxes}
"""Shapers by the name that cases give them; from frequencies [Hz] and the damping ratio."""


def minimum_jerk(start: float, end: float, duration: float) -> Motion:
    """Motion of least mean squared jerk between two rests: 10 x^3 - 15 x^4 + 6 x^5, with x from 0 to 1.

    Parameters
    ----------
    start, end : float
        First and last value [m or rad].
    duration : float
        Positive [s].
    """
    number_in("minimum_jerk: start", start, "a finite number")
    number_in("minimum_jerk: end", end, "a finite number")
    check_positive("minimum_jerk: duration", duration)
    if start == end:
        return rest(start, duration)
    shares = np.array([0.0, 0.0, 0.0, 10.0, -15.0, 6.0]) * (end - start) / float(duration) ** np.arange(6)
    shares[0] = start
    return Motion(np.array([0.0, duration]), shares[None])


def _impulses(
    frequencies: Sequence[float], damping_ratio: float, weights: Callable[[float], tuple[float, ...]]
) -> Shaper:
    """Impulses half a damped period apart, weighted as the decay over that time asks, for each frequency."""
    if not isinstance(damping_ratio, int | float) or not 0.0 <= damping_ratio < 1.0:
        raise ValueError(f"damping_ratio: wanted a fraction of critical from 0 to less than 1, got {damping_ratio!r}")
    damped = sqrt(1.0 - damping_ratio**2)
    sizes = weights(exp(-pi * damping_ratio / damped))
    amplitudes = tuple(size / sum(sizes) for size in sizes)
    each = [
        Shaper(tuple(i * 0.5 / (f * damped) for i in range(len(sizes))), amplitudes) for f in _checked(frequencies)
    ]
    return reduce(Shaper.then, each)


def _is_frequency(value: object) -> bool:
    """Whether something is a positive number."""
    try:
        check_positive("frequency", value)
    except ValueError:
        return False
    return True


def _checked(frequencies: Sequence[float]) -> Sequence[float]:
    if len(frequencies) == 0 or not all(_is_frequency(f) for f in frequencies):
        raise ValueError(f"frequencies: wanted one or more positive numbers in Hz, got {list(frequencies)}")
    return frequencies

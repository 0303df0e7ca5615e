"""An oscillator under a drive's acceleration: what it is left with, exactly, from the motion's own polynomials."""

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.polynomial.polynomial import polyder, polyval

POINTS, WEIGHTS = leggauss(24)


def residual(motion, frequency: float, damping_ratio: float = 0.0, until: float | None = None) -> float:
    """Amplitude of x'' + 2 z w x' + w^2 x = a(t) at the motion's end, times w: |int a e^(pole t) dt|, decayed."""
    w = 2 * np.pi * frequency
    pole = w * (damping_ratio + 1j * np.sqrt(1 - damping_ratio**2))
    response = 0.0
    for begin, span, piece in zip(
        motion.switch_times, np.diff(motion.switch_times), motion.coefficients, strict=False
    ):
        parts = max(1, int(np.ceil(span * frequency)))
        for i in range(parts):
            t = span / parts * (i + 0.5 * (POINTS + 1))
            a = polyval(t, polyder(piece, 2))
            response += 0.5 * span / parts * np.sum(WEIGHTS * a * np.exp(pole * (begin + t)))
    end = motion.duration if until is None else until
    return float(abs(response) * np.exp(-damping_ratio * w * end))

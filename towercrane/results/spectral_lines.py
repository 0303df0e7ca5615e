"""Peaks of a spectrum told apart: those at the frequencies of the crane, others, and what is out of sight."""

from __future__ import annotations

from itertools import combinations_with_replacement
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from towercrane.results.spectrum import spectrum_peaks

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

NEAR = 0.03
"""Part of a frequency by which a wide swing, a moving trolley or a near peak may shift its line."""


class Lines(NamedTuple):
    """Frequencies in a spectrum [Hz], ascending.

    Parameters
    ----------
    own : list of float
        Peaks at natural frequencies, or at twice the swing's, sums and differences of two swings', by which the
        rope's tension shakes the structure.
    others : list of float
        Peaks at none of them: lines of drives, wind or a frequency that changes.
    highest : float or None
        Nyquist's frequency; None without a spectrum.
    beyond : list of float
        Natural frequencies above it.
    """

    own: list[float]
    others: list[float]
    highest: float | None
    beyond: list[float]


def lines(times: Floats, values: Floats, natural: Sequence[float], swings: Sequence[float], coarsest: float) -> Lines:
    """Peaks of a signal's spectrum beside the frequencies that the crane has.

    Parameters
    ----------
    times, values : ndarray, shape (p,)
    natural, swings : sequence of float
        Natural frequencies, and those of the load's swing [Hz].
    coarsest : float
        Sampling step up to which fast modes, whose share in the signal is small, may be out of sight [s]. At coarser
        ones no peak can be told from one that is folded back.
    """
    if len(times) < 3:
        return Lines([], [], None, [])
    step = float(times[1] - times[0])
    highest = 0.5 / step
    beyond = sorted({f for f in natural if f > highest})
    if beyond and step > coarsest * (1.0 + 1e-9):
        return Lines([], [], None, beyond)
    pairs = list(combinations_with_replacement(swings, 2))
    causes = np.array([*natural, *swings, *(a + b for a, b in pairs), *(abs(a - b) for a, b in pairs)])
    folded = abs(np.array(beyond) - np.round(np.array(beyond) * step) / step)
    width = 1.0 / (times[-1] - times[0])
    found = spectrum_peaks(times, values)
    own = [f for f in found if _near(f, causes, width)]
    others = [f for f in found if f not in own and not _near(f, folded, width)]
    return Lines(own, others, highest if found else None, beyond)


def _near(frequency: float, known: Floats, width: float) -> bool:
    """Whether a peak is at one of the known frequencies, as near as a record of the length 1 / width tells."""
    return bool(np.any(abs(frequency - known) < np.maximum(width, NEAR * known)))

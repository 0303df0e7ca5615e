"""Selective mass scaling: mass that makes fast modes slow and leaves their stiffness."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

FREE_MODES = 2
"""Modes of each member that a cap never slows: they vibrate."""


def added_mass(angular_frequencies: Floats, order: NDArray[np.int64], cap: float) -> Floats:
    """Mass that slows modes of unit mass to a frequency [Hz], shape (n,).

    Parameters
    ----------
    angular_frequencies : ndarray, shape (n,)
        Of each mode by itself [rad/s].
    order : ndarray of int, shape (n,)
        Number of each mode in its member, from 0; the first `FREE_MODES` are left as they are.
    cap : float
        [Hz]
    """
    ratio = angular_frequencies / (2.0 * np.pi * cap)
    return np.asarray(np.where((order >= FREE_MODES) & (ratio > 1.0), ratio**2 - 1.0, 0.0))

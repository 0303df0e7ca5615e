"""Spectra of turbulence, one-sided, over the frequency f made dimensionless with length scale L and mean speed V.

S(f) f / sigma^2 is a function of n = f L / V; each integrates to the variance sigma^2.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

CLASSES = {"A+": 0.18, "A": 0.16, "B": 0.14, "C": 0.12}
"""Reference intensity at 15 m/s of the classes of IEC 61400-1:2019, table 1."""


class Spectrum(NamedTuple):
    """Longitudinal and lateral turbulence.

    Parameters
    ----------
    source : str
        Where it stands.
    along, across : callable
        S V / (sigma^2 L) of either component over n = f L / V.
    scale : callable
        Length scale L of the longitudinal component [m] over heights [m] for a roughness length [m].
    scale_across, deviation_across : float
        Of the lateral component, over those of the longitudinal one.
    """

    source: str
    along: Callable[[Floats], Floats]
    across: Callable[[Floats], Floats]
    scale: Callable[[Floats, float], Floats]
    scale_across: float
    deviation_across: float

    def density(
        self, frequencies: Floats, component: str, deviation: float, scales: Floats, speeds: Floats
    ) -> Floats:  # fmt: skip
        """Power spectral density of a component, "along" or "across" [m^2/s^2/Hz].

        Parameters
        ----------
        frequencies : ndarray, shape (k,)
            [Hz]
        component : {"along", "across"}
        deviation : float
            Standard deviation of this component [m/s].
        scales, speeds : ndarray, shape (p,)
            Of the longitudinal component [m], and mean wind [m/s].

        Returns
        -------
        ndarray, shape (k, p)
        """
        shape = self.along if component == "along" else self.across
        times = scales * (1.0 if component == "along" else self.scale_across) / speeds
        return np.asarray(deviation**2 * times * shape(frequencies[:, None] * times))


def turbulence_scale(height: float) -> float:
    """Scale parameter Lambda_1 over the height [m], IEC 61400-1:2019, Eq. 5."""
    return 0.7 * min(height, 60.0)


def class_deviation(intensity: float, speed: float) -> float:
    """Standard deviation of the longitudinal wind [m/s], IEC 61400-1:2019, Eq. 11, of a reference intensity."""
    return intensity * (0.75 * speed + 5.6)


def eurocode_intensity(height: float, roughness: float) -> float:
    """Intensity of turbulence on flat ground, EN 1991-1-4:2005, Eq. 4.7."""
    return 1.0 / float(np.log(height / roughness))


def _kaimal(n: Floats) -> Floats:
    return 4.0 / (1.0 + 6.0 * n) ** (5.0 / 3.0)


def _eurocode(n: Floats) -> Floats:
    return 6.8 / (1.0 + 10.2 * n) ** (5.0 / 3.0)


def _von_karman(n: Floats) -> Floats:
    return 4.0 / (1.0 + 70.8 * n * n) ** (5.0 / 6.0)


def _von_karman_across(n: Floats) -> Floats:
    return 2.0 * (1.0 + 188.8 * n * n) / (1.0 + 70.8 * n * n) ** (11.0 / 6.0)


def _iec_scale(factor: float) -> Callable[[Floats, float], Floats]:
    return lambda heights, _: factor * np.array([turbulence_scale(z) for z in heights])


SPECTRA = {
    "kaimal": Spectrum(
        "IEC 61400-1:2019, C.14 and table C.1", _kaimal, _kaimal, _iec_scale(8.1), 2.7 / 8.1, 0.8,
    ),
    "von-karman": Spectrum(
        "IEC 61400-1:1999, B.1: isotropic", _von_karman, _von_karman_across, _iec_scale(3.5), 1.0, 1.0,
    ),
    # The Eurocode has no lateral component: it is related to the longitudinal one as Kaimal's.
    "en-1991-1-4": Spectrum(
        "EN 1991-1-4:2005, B.1; across the wind as IEC 61400-1:2019", _eurocode, _eurocode,
        lambda heights, roughness: 300.0 * (heights / 200.0) ** (0.67 + 0.05 * np.log(roughness)), 2.7 / 8.1, 0.8,
    ),
}  # fmt: skip
"""Spectra by the names that case files give them."""

"""Series of turbulence at several places, with given spectra and coherence (Veers 1988; Shinozuka)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.parts.turbulence.spectra import turbulence_scale

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.parts.turbulence.spectra import Spectrum

    Floats = NDArray[np.float64]

SEPARATE = 1e-12
"""Part of the variance that two places have apart which are one."""

AT_ONCE = 2048
"""Frequencies whose matrices are in memory together."""


@dataclass(frozen=True, eq=False)
class Turbulence:
    """Turbulence as its statistics describe it.

    Parameters
    ----------
    spectrum : Spectrum
    deviation, deviation_across : float
        Standard deviations along and across the mean wind, the same at every height [m/s].
    step, duration : float
        Between two values, and of the record, after which it would repeat itself [s].
    seed : int
        Of the phases.
    length_scale : float, optional
        Of the longitudinal component [m]; without, that of the spectrum at every height.
    roughness_length : float
        Of the ground [m].
    decay : float
        Coefficient of the coherence.
    coherence_scale : float, optional
        Its length [m]; without, 8.1 Lambda_1 at the hub's height.
    across : bool
        Whether it blows across the mean wind as well.
    ramp : float
        Time over which the fluctuation rises from none [s].
    """

    spectrum: Spectrum
    deviation: float
    deviation_across: float
    step: float
    duration: float
    seed: int
    length_scale: float | None = None
    roughness_length: float = 0.05
    decay: float = 12.0
    coherence_scale: float | None = None
    across: bool = True
    ramp: float = 0.0

    @property
    def count(self) -> int:
        """Number of values in a record, even."""
        return 2 * int(np.ceil(0.5 * self.duration / self.step * (1.0 - 1e-12)))

    @property
    def components(self) -> tuple[str, ...]:
        """Directions in which it blows."""
        return ("along", "across") if self.across else ("along",)

    def coherence(self, frequencies: Floats, distances: Floats, speed: float, hub: float) -> Floats:
        """Share of the spectra that two places have in common, IEC 61400-1:2019, Eq. C.16.

        exp(-12 sqrt((f d / V)^2 + (0.12 d / L_c)^2)), here with the whole distance of the places, so that it is the
        same whichever way the wind blows.

        Parameters
        ----------
        frequencies : ndarray, shape (k,)
            [Hz]
        distances : ndarray, shape (...)
            [m]
        speed, hub : float
            Mean wind [m/s] at the hub's height [m].

        Returns
        -------
        ndarray, shape (k, ...)
        """
        length = self.coherence_scale or 8.1 * turbulence_scale(hub)
        waves = np.reshape(frequencies / speed, (-1, *[1] * np.ndim(distances)))
        return np.asarray(np.exp(-self.decay * distances * np.hypot(waves, 0.12 / length)))

    def densities(self, frequencies: Floats, component: str, heights: Floats, speeds: Floats) -> Floats:
        """Spectra at places of these heights [m] and mean winds [m/s]; shape (k, p), see `Spectrum.density`."""
        if self.length_scale is None:
            scales = self.spectrum.scale(heights, self.roughness_length)
        else:
            scales = np.full(len(heights), self.length_scale)
        deviation = self.deviation if component == "along" else self.deviation_across
        return self.spectrum.density(frequencies, component, deviation, scales, speeds)

    def series(self, places: Floats, speeds: Floats, speed: float, hub: float) -> Floats:
        """Fluctuations from 0 on, one step after the other; their mean is zero.

        The phases of every frequency k / T are drawn for each place; a lower Cholesky factor of the matrix of cross
        spectra mixes them, and an inverse Fourier transform sums them up.

        Parameters
        ----------
        places : ndarray, shape (p, 3)
            [m], the third the height over the ground.
        speeds : ndarray, shape (p,)
            Mean wind there [m/s].
        speed, hub : float
            Mean wind [m/s] at the hub's height [m].

        Returns
        -------
        ndarray, shape (components, p, count)
            [m/s]
        """
        count, places_count = self.count, len(places)
        lines = np.arange(1, count // 2) / (count * self.step)
        distances = np.linalg.norm(places[:, None] - places, axis=-1)
        phases = np.random.default_rng(self.seed).uniform(
            0.0, 2.0 * np.pi, (len(self.components), len(lines), places_count)
        )
        found = np.zeros((len(self.components), places_count, count // 2 + 1), dtype=complex)
        for begin in range(0, len(lines), AT_ONCE):
            part = slice(begin, begin + AT_ONCE)
            # Two components have the same coherence: the factor of one scales to the other.
            shared = self.coherence(lines[part], distances, speed, hub)
            mixed = np.linalg.cholesky(shared + SEPARATE * np.eye(places_count))
            for own, component, drawn in zip(found, self.components, phases[:, part], strict=True):
                size = np.sqrt(
                    self.densities(lines[part], component, places[:, 2], speeds) / (2.0 * count * self.step)
                )
                waves = size * np.einsum("kij,kj->ki", mixed, np.exp(1j * drawn))
                own[:, 1 + begin : 1 + begin + len(drawn)] = waves.T
        return count * np.fft.irfft(found, count, axis=-1)

    def risen(self, series: Floats) -> Floats:
        """Series whose fluctuation rises from none over the ramp, by (1 - cos) / 2; their mean stays zero.

        A run begins where the crane rests in the mean wind. The last value, one step after the record, is that of
        the record's repetition: shape (..., count + 1).
        """
        closed = np.concatenate([series, series[..., :1]], axis=-1)
        times = np.arange(closed.shape[-1]) * self.step
        rise = 0.5 - 0.5 * np.cos(np.pi * np.clip(times / self.ramp, 0.0, 1.0)) if self.ramp else np.ones_like(times)
        risen = rise * closed
        return np.asarray(risen - rise * (_mean(risen)[..., None] / _mean(rise)))


def _mean(values: Floats) -> Floats:
    """Mean of what is linear between values at even steps."""
    return np.asarray((values[..., 1:] + values[..., :-1]).mean(axis=-1) / 2.0)

"""Pendulums of any swing, planar and spherical, by elliptic functions."""

from dataclasses import dataclass

import numpy as np
from scipy.special import ellipj, ellipk


@dataclass(frozen=True)
class Pendulum:
    """Starts at a polar angle from the vertical, turning about it at ``turning`` times sqrt(g / length)."""

    length: float
    angle: float
    turning: float = 0.0

    def direction(self, gravity: float, times: np.ndarray) -> np.ndarray:
        """Unit vector x, y, up over time; shape (p, 3)."""
        s = np.sqrt(gravity / self.length) * times
        return self._plane(s) if self.turning == 0.0 else self._spherical(s)

    def _plane(self, s):
        """Sin(theta / 2) = k cd(s, k)."""
        k = np.sin(0.5 * self.angle)
        _, cn, dn, _ = ellipj(np.remainder(s, 4.0 * ellipk(k * k)), k * k)
        half = k * cn / dn
        return np.stack([2.0 * half * np.sqrt(1.0 - half**2), 0.0 * s, 2.0 * half**2 - 1.0], axis=1)

    def _spherical(self, s):
        """Height u'^2 = 2 (e - u) (1 - u^2) - h^2; azimuth' = h / (1 - u^2), summed as a Fourier series."""
        u, h = -np.cos(self.angle), self.turning * np.sin(self.angle) ** 2
        e = 0.5 * (self.turning * np.sin(self.angle)) ** 2 + u
        # The start is a turning point, and so one of the three roots.
        other, top = np.sort(np.roots(np.polydiv([2.0, -2.0 * e, -2.0, 2.0 * e - h * h], [1.0, -u])[0]).real)
        low, high = min(u, other), max(u, other)
        m, rate = (high - low) / (top - low), np.sqrt(0.5 * (top - low))
        quarter = ellipk(m)

        def height(s):
            return low + (high - low) * ellipj(np.remainder(rate * s + quarter * (u > other), 2 * quarter), m)[0] ** 2

        period, count = 2.0 * quarter / rate, 1024
        parts = np.fft.rfft(h / (1.0 - height(np.arange(count) * period / count) ** 2)) / count
        waves = 2j * np.pi * np.arange(1, count // 4) / period
        turned = (np.exp(np.outer(np.remainder(s, period), waves)) - 1.0) / waves @ parts[1 : count // 4]
        azimuth, across = parts[0].real * s + 2.0 * turned.real, np.sqrt(1.0 - height(s) ** 2)
        return np.stack([across * np.cos(azimuth), across * np.sin(azimuth), height(s)], axis=1)

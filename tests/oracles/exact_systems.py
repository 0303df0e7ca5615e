"""Equations with known solutions, kept apart from the tests that use them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from samples.bare_systems import plain_system

from towercrane.kernels.polynomial import polynomial
from towercrane.motions.motion import Motion, rest
from towercrane.motions.profiles import trapezoid

if TYPE_CHECKING:
    from collections.abc import Callable

    from towercrane.simulation.system import System


@dataclass(frozen=True, eq=False)
class Exact:
    name: str
    system: System
    duration: float
    solution: Callable[[np.ndarray], np.ndarray]
    motion: Motion


@dataclass(frozen=True)
class Frequency:
    omega: float


def _oscillator(own, t, y, inputs):
    return (y[1], -(own.omega * own.omega) * y[0]), ()


def _kepler(own, t, y, inputs):
    square = y[0] * y[0] + y[1] * y[1]
    cubed = square * np.sqrt(square)
    return (y[2], y[3], -y[0] / cubed, -y[1] / cubed), ()


def _growth_and_decay(own, t, y, inputs):
    # Explicit time: y' = y cos t, z' = -z / (1 + t).
    return (y[0] * np.cos(t), -y[1] / (1.0 + t)), ()


def _driven(own, t, y, inputs):
    # Oscillator on a support whose acceleration jumps at the switch points.
    _, _, acceleration = polynomial(inputs[0], t)
    return (y[1], -(own.omega * own.omega) * y[0] - acceleration), ()


def oscillator(omega: float = 3.0, duration: float = 10.0) -> Exact:
    def solution(t):
        return np.stack([np.cos(omega * t), -omega * np.sin(omega * t)], axis=1)

    return Exact("oscillator", plain_system(_oscillator, 2, Frequency(omega)), duration, solution, rest(0.0))


def kepler(eccentricity: float = 0.3, duration: float = 12.0) -> Exact:
    e = eccentricity

    def solution(t):
        anomaly = t.copy()
        for _ in range(60):
            anomaly -= (anomaly - e * np.sin(anomaly) - t) / (1 - e * np.cos(anomaly))
        s, c, root = np.sin(anomaly), np.cos(anomaly), np.sqrt(1 - e * e)
        rate = 1 / (1 - e * c)
        return np.stack([c - e, root * s, -s * rate, root * c * rate], axis=1)

    return Exact("kepler", plain_system(_kepler, 4), duration, solution, rest(0.0))


def growth_and_decay(duration: float = 8.0) -> Exact:
    def solution(t):
        return np.stack([np.exp(np.sin(t)), 1 / (1 + t)], axis=1)

    return Exact("growth and decay", plain_system(_growth_and_decay, 2), duration, solution, rest(0.0))


def driven(omega: float = 0.7382, duration: float = 60.0) -> Exact:
    """Pendulum-like oscillator under a trapezoidal trolley: closed form by superposed ramps."""
    motion = trapezoid(5.0, 41.0, 0.8, 0.1)

    def solution(t):
        y = np.zeros((len(t), 2))
        jumps = zip(motion.switch_times, np.diff(np.r_[0.0, motion(motion.switch_times, 2)]), strict=True)
        for at, jump in jumps:
            s = np.maximum(t - at, 0.0)
            y[:, 0] -= jump * (1 - np.cos(omega * s)) / omega**2
            y[:, 1] -= jump * np.sin(omega * s) / omega
        return y

    return Exact("driven", plain_system(_driven, 2, Frequency(omega)), duration, solution, motion)


ALL = [oscillator(), kepler(), growth_and_decay(), driven()]

"""Equations with known solutions, kept apart from the tests that use them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from modal.compiler.compiled import kernel
from towercrane.motions.motion import Motion, rest
from towercrane.motions.profiles import trapezoid
from towercrane.simulation.system import System, plain_system, rhs_signature

if TYPE_CHECKING:
    from collections.abc import Callable


@dataclass(frozen=True, eq=False)
class Exact:
    name: str
    system: System
    duration: float
    solution: Callable[[np.ndarray], np.ndarray]
    motion: Motion


@kernel(rhs_signature())
def _oscillator(t, y, dy, inputs, numbers, vectors, matrices, tables, work, guards):
    dy[0] = y[1]
    dy[1] = -(numbers[0] ** 2) * y[0]


@kernel(rhs_signature())
def _kepler(t, y, dy, inputs, numbers, vectors, matrices, tables, work, guards):
    cubed = (y[0] ** 2 + y[1] ** 2) ** 1.5
    dy[0] = y[2]
    dy[1] = y[3]
    dy[2] = -y[0] / cubed
    dy[3] = -y[1] / cubed


@kernel(rhs_signature())
def _growth_and_decay(t, y, dy, inputs, numbers, vectors, matrices, tables, work, guards):
    # Explicit time: y' = y cos t, z' = -z / (1 + t).
    dy[0] = y[0] * np.cos(t)
    dy[1] = -y[1] / (1.0 + t)


@kernel(rhs_signature())
def _driven(t, y, dy, inputs, numbers, vectors, matrices, tables, work, guards):
    # Oscillator on a support whose acceleration jumps at the switch points.
    acceleration = 0.0
    for c in range(inputs.shape[1] - 1, 1, -1):
        acceleration = acceleration * t + c * (c - 1) * inputs[0, c]
    dy[0] = y[1]
    dy[1] = -(numbers[0] ** 2) * y[0] - acceleration


def oscillator(omega: float = 3.0, duration: float = 10.0) -> Exact:
    def solution(t):
        return np.stack([np.cos(omega * t), -omega * np.sin(omega * t)], axis=1)

    return Exact("oscillator", plain_system(_oscillator, 2, (omega,)), duration, solution, rest(0.0))


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

    return Exact("driven", plain_system(_driven, 2, (omega,)), duration, solution, motion)


ALL = [oscillator(), kepler(), growth_and_decay(), driven()]

"""What a run has reached on its way through the phases of its motions, and the states that it leaves behind."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from towercrane.motions.motion import SAME_INSTANT

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from towercrane.motions.motion import Phases
    from towercrane.simulation.system import System

    Floats = NDArray[np.float64]
    Progress = Callable[[float], None]

ACCEPTED, REJECTED, EVALUATIONS, WRITTEN = range(4)
"""Entries of a run's counts, as in :mod:`towercrane.simulation.stepper`."""


@dataclass(frozen=True, eq=False)
class Trajectory:
    """States at the sample times that were reached, and how the run ended.

    Parameters
    ----------
    times : ndarray, shape (p,)
        Sample times [s].
    states : ndarray, shape (p, size)
    outcome : str
        "finished", the name of a guard, "step size collapsed", "state not finite", "switching without progress" or
        "interrupted".
    end_time : float
        Time at which the run ended [s].
    end_state : ndarray, shape (size,)
    evaluations, accepted, rejected : int
        Right-hand sides; steps taken; steps tried again (-1: SciPy does not tell).
    smallest_step : float
        Smallest step [s].
    cpu_seconds, wall_seconds : float
        Time in the solver [s].
    switch_times, switch_states : ndarray, shapes (k,) and (k, size)
        When equations were changed by a switch, and the states right after [s].
    """

    times: Floats
    states: Floats
    outcome: str
    end_time: float
    end_state: Floats
    evaluations: int
    accepted: int
    rejected: int
    smallest_step: float
    cpu_seconds: float
    wall_seconds: float
    switch_times: Floats
    switch_states: Floats


class Run:
    """What a run has reached: both kinds of solver carry it on."""

    def __init__(self, system: System, rtol: float, atol: float, state: Floats, samples: Floats) -> None:
        self.system, self.rtol, self.atol = system, rtol, atol * system.scale
        self.state, self.samples = state, samples
        self.time, self.smallest_step = 0.0, np.inf
        self.counts = np.zeros(5, dtype=np.int64)
        self.switched: list[tuple[float, Floats]] = []


def leapt(run: Run, phases: Phases, phase: int) -> Floats:
    """State of a run at the start of a phase, from that at the end of the one before."""
    before, after, crossings = phases.inputs[phase - 1], phases.inputs[phase], run.system.crossings
    if crossings is None or not crossings.crossed(before, after):
        return run.state
    return crossings.leap(run.state, before, float(phases.times[phase] - phases.times[phase - 1]), after)


def phase_of(times: Floats, phases: Phases) -> NDArray[np.int64]:
    """Index of the phase that each time belongs to; a switch time belongs to the phase it begins, the end to none.

    The end, and what is beyond it, has the index after the last phase's.
    """
    return np.maximum(np.searchsorted(phases.times, times + SAME_INSTANT, side="right") - 1, 0)

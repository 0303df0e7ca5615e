"""The balance of energy of many runs where they end."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.motions.motion import SAME_INSTANT
from towercrane.simulation.energy_balance import ROUNDING, explained
from towercrane.simulation.lanes.queue import ACCEPTED

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from towercrane.simulation.lanes.crane import LaneCrane, LaneRun
    from towercrane.simulation.lanes.queue import Answers, Queue

    Floats = NDArray[np.float64]

BEGIN, END = range(2)


def off_balance(
    crane: LaneCrane, runs: Sequence[LaneRun], queue: Queue, answers: Answers, rtol: float, atol: float
) -> NDArray[np.bool_]:
    """Whether each run's balance is off at its end by more than its tolerances explain.

    Parameters
    ----------
    crane : LaneCrane
    runs : sequence of LaneRun
    queue, answers
        The same runs before their lanes, and after.
    rtol, atol : float
    """
    starts, ends = queue.starts, answers.end_states
    drives = np.stack([_drives(queue, np.zeros(len(runs))), _drives(queue, answers.end_times)])
    models = [run.model for run in runs]
    # Begin and end together.
    both = crane.energy(2 * models, np.concatenate(drives), np.concatenate([starts, ends]))
    energies, scales = (values.reshape(2, -1) for values in both)
    work = ends[:, -1] - starts[:, -1]
    steps = answers.counts[:, ACCEPTED]
    limit = explained(steps, rtol, atol, scales.max(axis=0) + abs(work)) + ROUNDING * abs(energies).max(axis=0)
    with np.errstate(invalid="ignore"):
        return np.asarray(abs(energies[END] - energies[BEGIN] - work) > limit)


def _drives(queue: Queue, times: Floats) -> Floats:
    """Values and rates of the channels in each run at its own time; shape (runs, channels, 2)."""
    runs = np.arange(len(times))
    begun = (queue.phase_times <= times[:, None] + SAME_INSTANT).sum(axis=1) - 1
    phase = np.minimum(begun, queue.phase_counts - 1)
    inputs, local = queue.inputs[runs, phase], times - queue.phase_times[runs, phase]
    powers = np.arange(inputs.shape[2])
    values = local[:, None] ** powers
    rates = powers[1:] * values[:, :-1]
    return np.stack(
        [np.einsum("rci,ri->rc", inputs, values), np.einsum("rci,ri->rc", inputs[..., 1:], rates)], axis=2
    )

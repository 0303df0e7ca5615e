"""The rows at the ends of many runs, which no step of theirs writes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.kernels.polynomial import polynomial
from towercrane.simulation.integrate import evaluate
from towercrane.simulation.lanes.queue import FINISHED, LARGEST, SMALLEST, WAITING, WRITTEN
from towercrane.simulation.observed import observed_rows
from towercrane.simulation.trajectory import phase_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from towercrane.simulation.lanes.queue import Answers, Queue
    from towercrane.simulation.lanes.run import LaneRun

    Floats = NDArray[np.float64]


def record_ends(outputs: tuple[str, ...], runs: Sequence[LaneRun], queue: Queue, answers: Answers) -> None:
    """Let the states in which runs ended count among their extremes, as they do in the rows of single runs.

    Parameters
    ----------
    outputs : tuple of str
    runs : sequence of LaneRun
    queue, answers
        The same runs before their lanes, and after.
    """
    times, states, samples = answers.end_times, answers.end_states, queue.sample_times
    written, finished = answers.counts[:, WRITTEN], answers.outcomes == FINISHED
    # The rows at the end of the last phase belong to none; a run that ends early ends between two rows.
    at = np.where(finished, np.append(samples, np.inf)[written], times)
    last = np.append(samples, -np.inf)[written - 1]
    due = np.flatnonzero(np.where(finished, written < len(samples), (answers.outcomes != WAITING) & (last < times)))
    if not len(due):
        return
    found = [_evaluated(runs[run], times[run], states[run]) for run in due.tolist()]
    slopes, guards, drives = (np.array(part) for part in zip(*found, strict=True))
    values = observed_rows([runs[run].model for run in due.tolist()], outputs, states[due], slopes, guards, drives)
    for extreme, beyond in ((LARGEST, np.greater), (SMALLEST, np.less)):
        farther, place = np.nonzero(beyond(values, answers.extremes[due, :, extreme]))
        answers.extremes[due[farther], place, extreme] = values[farther, place]
        answers.extremes[due[farther], place, extreme + 1] = at[due[farther]]
    if len(answers.series):
        for run, row in zip(due, values, strict=True):
            if finished[run]:
                answers.series[run, written[run] :] = row


def _evaluated(run: LaneRun, time: float, state: Floats) -> tuple[Floats, Floats, Floats]:
    """Slope, guards and drives of a run where it ended; at a switch time those of the phase which begins."""
    cut = run.phases
    phase = int(phase_of(np.asarray(time), cut))
    inputs = cut.inputs[phase] if phase < len(cut.inputs) else cut.after
    drives = np.transpose(polynomial(inputs[: len(run.model.channels)].T, time - cut.times[phase]))
    slopes, guards = evaluate(run.model.system, cut, np.array([time]), state[None])
    return slopes[0], guards[0], drives

"""The balance of energy of many runs where they end."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.kernels.polynomial import polynomial
from towercrane.motions.motion import SAME_INSTANT
from towercrane.simulation.energy_balance import ROUNDING, explained
from towercrane.simulation.integrate import evaluate
from towercrane.simulation.lanes.queue import ACCEPTED
from towercrane.simulation.observed import observed_rows

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from towercrane.simulation.lanes.queue import Answers, Queue
    from towercrane.simulation.lanes.run import LaneRun

    Floats = NDArray[np.float64]

BEGIN, END = range(2)

ENERGY, ROPE = "total_energy", "rope_length"
"""Outputs that the balance is judged by."""


def off_balance(
    runs: Sequence[LaneRun], queue: Queue, answers: Answers, rtol: float, atol: float
) -> NDArray[np.bool_]:
    """Whether each run's balance is off at its end by more than its tolerances explain.

    Parameters
    ----------
    runs : sequence of LaneRun
    queue, answers
        The same runs before their lanes, and after.
    rtol, atol : float
    """
    models = [run.model for run in runs]
    if not {ENERGY, ROPE} <= set(models[0].about):
        # A linear model keeps no account of its energy.
        return np.zeros(len(runs), dtype=bool)
    starts, ends = queue.starts, answers.end_states
    drives = np.concatenate([_drives(queue, np.zeros(len(runs))), _drives(queue, answers.end_times)])
    drives = drives[:, : len(models[0].channels)]
    # Begin and end together; energies ask for no slopes, and for guards where rates jump or a rope stretches.
    states = np.concatenate([starts, ends])
    guards = np.zeros((len(states), len(models[0].system.guards)))
    if models[0].system.crossings is not None or models[0].system.rope is not None:
        for row, (run, time) in enumerate(
            zip([*runs, *runs], [*np.zeros(len(runs)), *answers.end_times], strict=True)
        ):
            guards[row] = evaluate(run.model.system, run.phases, np.array([time]), states[row, None])[1][0]
    found = observed_rows(2 * models, (ENERGY, ROPE), states, np.zeros_like(states), guards, drives)
    energies, ropes = (column.reshape(2, -1) for column in found.T)
    weights = np.array([model.provenance()["payload_mass"] * model.provenance()["gravity"] for model in models])
    work = ends[:, -1] - starts[:, -1]
    steps = answers.counts[:, ACCEPTED]
    scale = weights * ropes.max(axis=0) + abs(work)
    limit = explained(steps, rtol, atol, scale) + ROUNDING * abs(energies).max(axis=0)
    with np.errstate(invalid="ignore"):
        return np.asarray(abs(energies[END] - energies[BEGIN] - work) > limit)


def _drives(queue: Queue, times: Floats) -> Floats:
    """Values, rates and accelerations of the channels in each run at its own time; shape (runs, channels, 3)."""
    runs = np.arange(len(times))
    begun = (queue.phase_times <= times[:, None] + SAME_INSTANT).sum(axis=1) - 1
    phase = np.minimum(begun, queue.phase_counts - 1)
    inputs, local = queue.inputs[runs, phase], times - queue.phase_times[runs, phase]
    return np.transpose(polynomial(inputs.transpose(2, 1, 0), local), (2, 1, 0))

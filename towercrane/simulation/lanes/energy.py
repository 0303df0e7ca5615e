"""The balance of energy of many runs of cranes in radial motion, where they end."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.tower.kernels import layout
from towercrane.cranes.tower.outputs.energy import total_energy
from towercrane.cranes.tower.outputs.kinematics import FlexibleMotion
from towercrane.motions.motion import SAME_INSTANT
from towercrane.simulation.energy_balance import ROUNDING, explained
from towercrane.simulation.lanes.queue import ACCEPTED

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from towercrane.simulation.lanes.many import LaneRun
    from towercrane.simulation.lanes.queue import Answers, Queue

    Floats = NDArray[np.float64]

BEGIN, END = range(2)


@dataclass(frozen=True, eq=False)
class _DrivenMotion(FlexibleMotion):
    """States of several runs, one each, with the values and rates that their drives have there; (runs, 2, 2)."""

    drives: Floats

    def drive(self, channel: str, derivative: int = 0) -> Floats:
        """Value or rate of a channel in every run."""
        channels = self.model.channels
        if channel not in channels or derivative > 1:
            return np.zeros(len(self.times))
        return np.asarray(self.drives[:, channels.index(channel), derivative])


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
    starts, ends = queue.starts, answers.end_states
    drives = np.stack([_drives(queue, np.zeros(len(runs))), _drives(queue, answers.end_times)])
    energies = np.empty((2, len(runs)))
    # Energies of runs that share a crane are summed in one go, begin and end together.
    cranes: dict[int, list[int]] = {}
    for number, run in enumerate(runs):
        cranes.setdefault(id(run.model.scene.crane), []).append(number)
    for members in cranes.values():
        alike = [runs[number] for number in members]
        motions, states = (np.concatenate(both[:, members]) for both in (drives, np.stack([starts, ends])))
        energies[:, members] = _energies(2 * alike, motions, states).reshape(2, -1)
    weights = np.array([run.model.load.mass * run.model.crane.gravity for run in runs])
    work, lengths = ends[:, -1] - starts[:, -1], drives[..., layout.ROPE, 0].max(axis=0)
    steps = answers.counts[:, ACCEPTED]
    limit = explained(steps, rtol, atol, weights * lengths + abs(work)) + ROUNDING * abs(energies).max(axis=0)
    with np.errstate(invalid="ignore"):
        return np.asarray(abs(energies[END] - energies[BEGIN] - work) > limit)


def _drives(queue: Queue, times: Floats) -> Floats:
    """Values and rates of trolley and rope in each run at its own time; shape (runs, 2, 2)."""
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


def _energies(runs: list[LaneRun], drives: Floats, states: Floats) -> Floats:
    """Total energy of runs of one crane, each with its own load, drives (runs, 2, 2) and state."""
    scene = runs[0].model.scene
    motion = _DrivenMotion(scene, {}, np.zeros(len(runs)), states, drives)
    place, velocity = motion.load_in_space
    heavier = np.array([run.model.load.mass for run in runs]) - scene.load.mass
    softer = np.array([run.model.system.matrices[layout.STIFFNESS] for run in runs])
    softer -= scene.system.matrices[layout.STIFFNESS]
    energy = total_energy(motion) + 0.5 * np.einsum("ri,rij,rj->r", motion.coordinates, softer, motion.coordinates)
    specific = 0.5 * (velocity**2).sum(axis=1) + scene.crane.gravity * place[:, 2]
    return np.asarray(energy + heavier * specific)

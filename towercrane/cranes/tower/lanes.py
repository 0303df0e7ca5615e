"""Cranes in radial motion side by side: what lanes ask of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.tower.kernels import layout
from towercrane.cranes.tower.kernels.lane_rhs import JIB_TIP, SWING, TENSION, TOWER_TIP, observe, rhs
from towercrane.cranes.tower.outputs.energy import total_energy
from towercrane.cranes.tower.outputs.kinematics import FlexibleMotion
from towercrane.simulation.lanes.crane import LaneCrane
from towercrane.simulation.outcomes import TOWER_BUCKLED

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from towercrane.cranes.tower.planar import RadialModel

    Floats = NDArray[np.float64]

OUTPUTS = ("tower_tip_displacement", "jib_tip_deflection", "swing_angle", "rope_tension")
"""Names of what is observed."""


def observed(watched: Floats, states: Floats, guards: Floats) -> Floats:
    """The same outputs in rows of states; shape (rows, outputs)."""
    n = watched.shape[2]
    values = np.empty((len(states), len(OUTPUTS)))
    values[:, [TOWER_TIP, JIB_TIP]] = np.einsum("roi,ri->ro", watched, states[:, :n])
    values[:, SWING] = np.arctan2(states[:, n], -states[:, n + 1])
    values[:, TENSION] = guards[:, layout.TENSION]
    return values


def energy(models: Sequence[RadialModel], drives: Floats, states: Floats) -> tuple[Floats, Floats]:
    """Total energy, and the load's weight times the length of its rope, of models that are driven so (runs, 2, 2)."""
    energies = np.empty(len(models))
    # Energies of runs that share a crane are summed in one go.
    cranes: dict[int, list[int]] = {}
    for number, model in enumerate(models):
        cranes.setdefault(id(model.scene.crane), []).append(number)
    for members in cranes.values():
        energies[members] = _of_one_crane([models[number] for number in members], drives[members], states[members])
    weights = np.array([model.load.mass * model.crane.gravity for model in models])
    return energies, weights * drives[:, layout.ROPE, 0]


def _of_one_crane(models: Sequence[RadialModel], drives: Floats, states: Floats) -> Floats:
    """Total energy of runs of one crane, each with its own load, drives and state."""
    scene = models[0].scene
    motion = _DrivenMotion(scene, {}, np.zeros(len(models)), states, drives)
    place, velocity = motion.load_in_space
    heavier = np.array([model.load.mass for model in models]) - scene.load.mass
    softer = np.array([model.system.matrices[layout.STIFFNESS] for model in models])
    softer -= scene.system.matrices[layout.STIFFNESS]
    found = total_energy(motion) + 0.5 * np.einsum("ri,rij,rj->r", motion.coordinates, softer, motion.coordinates)
    specific = 0.5 * (velocity**2).sum(axis=1) + scene.crane.gravity * place[:, 2]
    return np.asarray(found + heavier * specific)


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


RADIAL = LaneCrane(
    rhs=rhs,
    observe=observe,
    outputs=OUTPUTS,
    watched=lambda model: model.tip_shapes,
    observed=observed,
    energy=energy,
    # A crane without a stable equilibrium has buckled under its weights.
    unstable=TOWER_BUCKLED,
)
"""Cranes in radial motion, moving in the plane of their jib; :class:`towercrane.cranes.tower.planar.RadialModel`."""

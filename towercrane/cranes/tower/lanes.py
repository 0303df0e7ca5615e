"""Tower cranes that move in the plane of their jib, side by side: what lanes ask of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.kind import Lane
from towercrane.cranes.tower.file.plane import stays_in_plane
from towercrane.cranes.tower.kernels import layout
from towercrane.cranes.tower.kernels.lane_outputs import JIB_TIP, SWING, TENSION, TOWER_TIP, observe
from towercrane.cranes.tower.outputs.energy import total_energy
from towercrane.cranes.tower.outputs.kinematics import FlexibleMotion
from towercrane.simulation.lanes.crane import LaneCrane
from towercrane.simulation.outcomes import TOWER_BUCKLED

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from towercrane.cranes.tower.file.case_tables import TowerCase
    from towercrane.cranes.tower.model import FlexibleModel

    Floats = NDArray[np.float64]

LANE_OUTPUTS = {
    "tower_tip_displacement": ("m", "horizontal displacement of the tower top, positive outward"),
    "jib_tip_deflection": ("m", "deflection of the jib tip from the tilted straight jib, positive up"),
    "sway_radial": ("rad", "sway along the jib, positive outward"),
    "rope_tension": ("N", "rope tension"),
}
"""What is observed: units and long names."""


def observed(watched: Floats, states: Floats, guards: Floats) -> Floats:
    """The same outputs in rows of states; shape (rows, outputs)."""
    n = watched.shape[2]
    values = np.empty((len(states), len(LANE_OUTPUTS)))
    values[:, [TOWER_TIP, JIB_TIP]] = np.einsum("roi,ri->ro", watched, states[:, :n])
    values[:, SWING] = np.arctan2(states[:, n], -states[:, n + 1])
    values[:, TENSION] = guards[:, layout.TENSION]
    return values


def _tips(model: FlexibleModel) -> Floats:
    """Displacement of the tower's top and deflection of the jib's tip per coordinate; shape (2, coordinates)."""
    shapes = np.zeros((2, model.coordinates))
    shapes[0] = model.system.vectors[layout.SLIDE_X]
    shapes[1, model.parts["jib_vertical"]] = model.crane.tip_shapes[:, 0]
    return shapes


def energy(models: Sequence[FlexibleModel], drives: Floats, states: Floats) -> tuple[Floats, Floats]:
    """Total energy, and the load's weight times the length of its rope, of models that are driven so (runs, 2, 2)."""
    energies = np.empty(len(models))
    # Energies of runs that share a crane are summed in one go.
    cranes: dict[int, list[int]] = {}
    for number, model in enumerate(models):
        cranes.setdefault(id(model.crane), []).append(number)
    for members in cranes.values():
        energies[members] = _of_one_crane([models[number] for number in members], drives[members], states[members])
    weights = np.array([model.load.mass * model.crane.gravity for model in models])
    return energies, weights * drives[:, layout.ROPE, 0]


def _of_one_crane(models: Sequence[FlexibleModel], drives: Floats, states: Floats) -> Floats:
    """Total energy of runs of one crane, each with its own load, drives and state."""
    first = models[0]
    motion = _DrivenMotion(first, {}, np.zeros(len(models)), states, drives)
    place, velocity = motion.load_in_space
    heavier = np.array([model.load.mass for model in models]) - first.load.mass
    softer = np.array([model.system.matrices[layout.STIFFNESS] for model in models])
    softer -= first.system.matrices[layout.STIFFNESS]
    found = total_energy(motion) + 0.5 * np.einsum("ri,rij,rj->r", motion.coordinates, softer, motion.coordinates)
    specific = 0.5 * (velocity**2).sum(axis=1) + first.crane.gravity * place[:, 2]
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


def _alike(model: FlexibleModel) -> str:
    # Written out, floats to the last digit: equal text is equal data.
    made_of = (model.crane.written, model.counts, model.damping, model.cap, model.heading)
    return repr((*made_of, model.weight_softening, model.self_weight, model.rope_as_rod))


PLANE_CRANES = LaneCrane(
    observe=observe,
    outputs=LANE_OUTPUTS,
    watched=_tips,
    observed=observed,
    energy=energy,
    alike=_alike,
    # A crane without a stable equilibrium has buckled under its weights.
    unstable=TOWER_BUCKLED,
)
"""Tower cranes whose scenes stay in the jib's plane."""


def lane_of(tables: TowerCase) -> Lane | None:
    """What a case's run needs to share lanes; None where it leaves the plane or a wind blows."""
    if tables.wind is not None or not stays_in_plane(tables):
        return None
    # A hauled rope begins its motion at its length, and what a tolerance of frequencies leaves out hangs on the load.
    return Lane(PLANE_CRANES, plain=tables.motion.hoist is None and tables.accuracy.frequency is None)

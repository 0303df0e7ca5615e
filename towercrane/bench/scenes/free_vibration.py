"""Free vibration that should keep its energy for ever, for every method to show what it does to it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.bench.clock import whole
from towercrane.bench.scenes.prepared import unwatched
from towercrane.cases.case import load_case
from towercrane.cranes.tower.equations.small_motions import plane_modes
from towercrane.cranes.tower.file.build import tower_model
from towercrane.cranes.tower.file.case_tables import TowerCase
from towercrane.cranes.tower.outputs.energy import total_energy
from towercrane.cranes.tower.outputs.kinematics import Kinematics
from towercrane.motions.motion import phases, rest
from towercrane.simulation.integrate import integrate
from towercrane.simulation.methods.method import ATOL_SHARE
from towercrane.simulation.observed import Instant
from towercrane.simulation.outcomes import FINISHED
from towercrane.simulation.starts.begin import begin
from towercrane.simulation.starts.start import Start

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.simulation.trajectory import Trajectory

    Floats = NDArray[np.float64]

CASE = "qtz5613/condition-3"
TROLLEY, ROPE, SWING = 23.0, 18.0, 0.1
"""Where the trolley is parked [m], length of the rope [m], swing at the start [rad]."""


class FreeVibration:
    """Parked crane with its weights switched on at once and the load let go: nothing drives it, nothing damps it.

    Parameters
    ----------
    tower_modes, jib_modes : int
    """

    def __init__(self, tower_modes: int, jib_modes: int) -> None:
        self.model = tower_model(
            load_case(CASE).tables(TowerCase), tower_modes=tower_modes, jib_vertical_modes=jib_modes, rope_as_rod=True
        )
        self.motions = {"trolley": rest(TROLLEY), "rope": rest(ROPE)}
        self.frequency = float(plane_modes(self.model, TROLLEY, ROPE)[0][-1] / (2.0 * np.pi))

    def run(self, method: str, rtol: float, span: float, step: float = 1.0) -> Trajectory:
        """Run over ``span`` seconds with rows ``step`` apart."""
        cut = phases((self.motions["trolley"], self.motions["rope"]), span)
        start = begin(self.model, cut.inputs[0], Start("zero", along=SWING))
        grid = np.linspace(0.0, span, round(span / step) + 1)
        with np.errstate(all="ignore"):  # A run that blows up says so by its outcome.
            return whole(
                integrate(
                    unwatched(self.model.system), cut, start, grid, method=method, rtol=rtol, atol=ATOL_SHARE * rtol
                )
            )

    def energy_changes(self, states: Floats) -> Floats:
        """Change of the vibration's energy since the first of the states, relative; shape (p,)."""
        cut = phases((self.motions["trolley"], self.motions["rope"]), 1.0)
        rows = np.vstack([self.model.start(cut.inputs[0]), states])
        with np.errstate(all="ignore"):
            instant = Instant(rows.T, (), (), [(TROLLEY, 0.0, 0.0), (ROPE, 0.0, 0.0)])
            least, *energy = total_energy(Kinematics(self.model.seen, instant))
            return np.asarray((np.array(energy) - energy[0]) / (energy[0] - least))

    def energy_change(self, run: Trajectory) -> float:
        """Change of the vibration's energy over the run, relative; infinite for a run that did not finish."""
        if run.outcome != FINISHED:
            return np.inf
        change = float(self.energy_changes(run.states[[0, -1]])[-1])
        return change if np.isfinite(change) else np.inf

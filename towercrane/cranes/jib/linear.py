"""Small motions of the jib crane: linear sway along a plan, and matrices about a pose at rest.

Source: Al-Ajmi, Abu-El Yazied, Abu-El-Hagag, Makady, Eq. 17-25, derived anew: the printed equations keep products
of small rates, drop the nominal motion's first-order terms, and have the torque D_22 for its derivative.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.jib import equations
from towercrane.cranes.jib.model import PlannedJibCrane
from towercrane.cranes.jib.outputs import SWAY_ABOUT, Seen, sway_outputs
from towercrane.simulation.observed import observe
from towercrane.simulation.starts.start import OUT_OF_PLANE
from towercrane.simulation.system import System

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.jib.parameters import JibCrane
    from towercrane.kernels.load import Load

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class LinearSway:
    """Sway about the hanging position on the joints' exact paths, linear in the sway alone.

    With xi the horizontal inertial components of the rope's direction and a the suspension point's acceleration,
    l xi'' + 2 l' xi' + (g + a_z) xi = -(a_x, a_y). There are no Coriolis terms because the axes do not turn.

    Parameters
    ----------
    crane : JibCrane
    load : Load
        Its mass is of no consequence here.
    heave : bool
        Include a_z; without it the stiffness is frozen at g, as a linear time-invariant model has it.
    """

    crane: JibCrane
    load: Load
    heave: bool = True

    outputs = staticmethod(sway_outputs)
    about = SWAY_ABOUT
    observe = observe
    sways = OUT_OF_PLANE

    @property
    def channels(self) -> tuple[str, ...]:
        """Motions: the three joint angles [rad] and the rope's length [m]."""
        return self._planned.channels

    @property
    def _planned(self) -> PlannedJibCrane:
        return PlannedJibCrane(self.crane, self.load)

    @cached_property
    def system(self) -> System:
        """The model as the solver sees it; the state is (xi, xi')."""
        return System(
            equations=equations.linear_sway,
            size=4,
            guards=(),
            floors=np.empty(0),
            scale=np.ones(4),
            constants=equations.Constants(self.crane, self.load, heave=self.heave),
        )

    def start(self, inputs: Floats, state: str = "equilibrium") -> Floats:
        """State at rest; arguments as of :meth:`towercrane.cranes.jib.model.PlannedJibCrane.start`."""
        return np.zeros_like(self._planned.start(inputs, state)[:4])

    def rope_direction(self, state: Floats, _inputs: Floats) -> Floats:
        """Unit vector from where the rope hangs to the load; shape (3,)."""
        return np.array([*state[:2], -np.sqrt(1.0 - state[:2] @ state[:2])])

    def hang(self, _state: Floats, _inputs: Floats, direction: Floats, rate: Floats) -> Floats:
        """State with the load along a direction."""
        return np.concatenate([direction[:2], rate[:2]])

    def jib_heading(self, _state: Floats, inputs: Floats) -> float:
        """Slewing angle of the booms [rad]."""
        return float(inputs[0, 0])

    @property
    def seen(self) -> Seen:
        """What outputs are told beside the instant."""
        return Seen(self.system.constants)

    def provenance(self) -> dict[str, Any]:
        """Crane and load, for a result's attributes."""
        return self._planned.provenance()


def static_matrices(
    crane: JibCrane, load: Load, luff: float, fold: float, rope_length: float
) -> tuple[Floats, Floats]:
    """Mass and stiffness of small motions about a pose at rest whose torques are held.

    Parameters
    ----------
    crane : JibCrane
    load : Load
    luff, fold : float
        Elevation of the primary boom and, relative to it, of the secondary boom [rad].
    rope_length : float
        Length of the rope [m].

    Returns
    -------
    mass, stiffness : ndarray, shape (5, 5)
        Coordinates are slew, luff, fold, in-plane and lateral sway [rad]. The booms' stiffness is negative above the
        horizontal: they are inverted pendulums.
    """
    booms = equations.structure(crane, (0.0, luff, fold), (0.0, 0.0, 0.0))
    # Velocity of the load per rate of each coordinate, booms along x.
    load_rates = np.hstack([booms.jacobian, rope_length * np.eye(3)[:, :2]])
    mass = load.mass * load_rates.T @ load_rates
    lower = np.zeros((3, 3))
    lower[np.tril_indices(3)] = np.concatenate(booms.mass)
    mass[:3, :3] += lower + np.tril(lower, -1).T

    primary, secondary = crane.primary_mass, crane.secondary_mass
    folding = -crane.gravity * crane.secondary_length * np.sin(luff + fold) * (secondary / 2 + load.mass)
    luffing = -crane.gravity * crane.primary_length * np.sin(luff) * (primary / 2 + secondary + load.mass)
    stiffness = np.zeros((5, 5))
    stiffness[1:3, 1:3] = folding
    stiffness[1, 1] += luffing
    stiffness[3, 3] = stiffness[4, 4] = load.mass * crane.gravity * rope_length
    return mass, stiffness


def static_torques(crane: JibCrane, load: Load, luff: float, fold: float) -> Floats:
    """Joint torques that hold crane and load at rest; shape (3,) [N m]."""
    booms = equations.structure(crane, (0.0, luff, fold), (0.0, 0.0, 0.0))
    return np.asarray(load.mass * crane.gravity * np.array(booms.jacobian[2]) - booms.force)


def growth_rates(
    crane: JibCrane,
    load: Load,
    luff: float,
    fold: float,
    rope_length: float,
    free: tuple[int, ...] = (0, 1, 2, 3, 4),
) -> Floats:
    """Rates at which small errors grow under held torques, largest first [1/s].

    Parameters
    ----------
    crane, load, luff, fold, rope_length
        As in :func:`static_matrices`.
    free : tuple of int
        Coordinates that move; the others are held.

    Returns
    -------
    ndarray, shape (k,)
        One for each unstable mode.
    """
    from scipy.linalg import eigh

    mass, stiffness = (matrix[np.ix_(free, free)] for matrix in static_matrices(crane, load, luff, fold, rope_length))
    squared = eigh(stiffness, mass, eigvals_only=True)
    # Slew has no stiffness: its eigenvalue is zero but for rounding.
    unstable = squared < -1e-9 * abs(squared).max()
    return np.asarray(np.sqrt(-squared[unstable]))

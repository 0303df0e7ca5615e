"""Crane in radial motion: tower, jib, trolley and load in the vertical plane of the jib.

Source: Gao et al. (2023); the equations are derived anew, see :mod:`towercrane.cranes.radial_kernel`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from towercrane.cranes import radial_kernel as kernel
from towercrane.cranes.radial_structure import modes_of, structure_of
from towercrane.equilibrium import Unstable, stable_equilibrium
from towercrane.payload import FORCE, JACOBIAN, MASS, Load, restore, work_shape
from towercrane.system import NoEquilibrium, System

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from modal.shapes import Modes
    from towercrane.cranes.tower_crane import TowerCrane
    from towercrane.motion import Motion
    from towercrane.results import Quantity

    Floats = NDArray[np.float64]

SLACK_ROPE = "slack rope"
TROLLEY_OFF_JIB = "trolley off the jib"
TOWER_BUCKLED = "tower buckled"

TILT_LIMIT = 0.5
"""Tilt of the tower top at which a run ends as buckled [rad]: far beyond what a beam theory of small slopes holds."""

ROUNDING = 1e-9
"""Way beyond an end of the jib that counts as parked on it [m]."""


@dataclass(frozen=True, eq=False)
class RadialModel:
    """Equations of motion in chosen coordinates: any numbers of tower and jib modes, 0 meaning rigid.

    Parameters
    ----------
    crane : TowerCrane
    load : Load
    tower_modes, jib_modes : int
        Numbers of modes.
    weight_softening : bool
        Include the geometric stiffness of the weight above each section of the tower.
    tower_damping_ratio, jib_damping_ratio : float
        Modal damping as a fraction of critical.
    self_weight : bool
        Whether the structure has weight; without it, as in Gao et al. (2023), Eq. 15, only trolley and load do.
    rope_as_rod : bool
        Let the rope push, as most published models do. Without it a slack rope ends the run.
    axes : int
        2 for motion in the plane of the jib, 3 for a load that may swing out of it.
    """

    crane: TowerCrane
    load: Load
    tower_modes: int = 2
    jib_modes: int = 3
    weight_softening: bool = False
    tower_damping_ratio: float = 0.0
    jib_damping_ratio: float = 0.0
    self_weight: bool = True
    rope_as_rod: bool = False
    axes: Literal[2, 3] = 2

    def __post_init__(self) -> None:
        for name in ("tower_modes", "jib_modes"):
            if getattr(self, name) < 0:
                raise ValueError(f"RadialModel.{name}: wanted zero or more, got {getattr(self, name)!r}")

    @property
    def channels(self) -> tuple[str, ...]:
        """Motions: position of the trolley along the jib and length of the rope [m]."""
        return ("trolley", "rope")

    @property
    def channel_units(self) -> tuple[str, ...]:
        """Units of the channels."""
        return ("m", "m")

    @property
    def state_names(self) -> dict[str, str]:
        """Name and unit of every coordinate."""
        parts = (("tower", self.tower_modes), ("jib", self.jib_modes))
        return {f"{part}_mode_{i + 1}": "kg^0.5 m" for part, count in parts for i in range(count)}

    @property
    def coordinates(self) -> int:
        """Number of modal coordinates."""
        return self.tower_modes + self.jib_modes

    @property
    def size(self) -> int:
        """Number of states: coordinates and rope direction with their rates, and the work done."""
        return 2 * (self.coordinates + self.axes) + 1

    @cached_property
    def tower(self) -> Modes:
        """Modes of the tower with the slewing part on its end."""
        return modes_of(self.crane.tower, self.tower_modes, self.crane.end_body)

    @cached_property
    def jib(self) -> Modes:
        """Modes of the jib, clamped at the tower top and free at its end."""
        return modes_of(self.crane.jib, self.jib_modes)

    @cached_property
    def geometric_stiffness(self) -> Floats:
        """Stiffness that the weight takes from the tower modes, int N phi' phi' (tower, tower) [1/s^2].

        N(s) = (m_r + m_c + m_p + m_t (l_t - s)) g at the height s.
        """
        crane = self.crane
        own = 1.0 if self.self_weight else 0.0
        above = own * crane.slewing_mass + crane.trolley_mass + self.load.mass
        along = own * crane.tower.mass_per_length * self.tower.weighted_slope_matrix()
        return crane.gravity * (above * self.tower.slope_matrix() + along)

    @property
    def tip_shapes(self) -> Floats:
        """Displacement of the tower top and deflection of the jib tip per coordinate; shape (2, coordinates)."""
        return structure_of(self.crane, self.tower, self.jib).tip_shapes

    @cached_property
    def system(self) -> System:
        """The model as the solver sees it."""
        crane, load = self.crane, self.load
        structure = structure_of(crane, self.tower, self.jib)
        n, tower = self.coordinates, self.tower_modes
        omega = np.concatenate([self.tower.angular_frequencies, self.jib.angular_frequencies])
        ratio = np.repeat([self.tower_damping_ratio, self.jib_damping_ratio], [tower, self.jib_modes])
        vectors = np.vstack([structure.vectors, 2.0 * ratio * omega])
        stiffness = np.diag(omega**2)
        if self.weight_softening:
            stiffness[:tower, :tower] -= self.geometric_stiffness

        numbers = np.zeros(9)
        numbers[kernel.TROLLEY_MASS] = crane.trolley_mass
        numbers[kernel.GRAVITY] = crane.gravity
        numbers[kernel.SELF_GRAVITY] = crane.gravity if self.self_weight else 0.0
        numbers[kernel.STATIC_MOMENT] = crane.static_moment
        numbers[kernel.JIB_LENGTH] = crane.jib.length
        numbers[kernel.TILT_LIMIT] = TILT_LIMIT
        numbers[kernel.LOAD_MASS] = load.mass
        numbers[kernel.DRAG] = load.drag
        numbers[kernel.HINGE_DAMPING] = load.rope_damping
        # Tolerances are metres where a mode moves most, radians of swing; the work steers nothing.
        scale = np.concatenate([structure.mode_scale, np.ones(self.axes)])
        return System(
            rhs=kernel.rhs,
            size=self.size,
            guards=(SLACK_ROPE, TROLLEY_OFF_JIB, TROLLEY_OFF_JIB, TOWER_BUCKLED),
            floors=np.array([-np.inf if self.rope_as_rod else 0.0, -ROUNDING, -ROUNDING, 0.0]),
            scale=np.concatenate([scale, scale, [np.inf]]),
            numbers=numbers,
            vectors=vectors,
            matrices=np.array([structure.base, stiffness]),
            tables=structure.shape_table,
            work_shape=work_shape(n),
            restore=lambda state: restore(state, n, self.axes),
        )

    def start(self, inputs: Floats, state: str = "equilibrium", swing_angle: float = 0.0) -> Floats:
        """State at rest at the start.

        Parameters
        ----------
        inputs : ndarray
            Polynomials of the first phase.
        state : str
            "equilibrium" (the static solution) or "zero" (undeformed, all weights on).
        swing_angle : float
            Angle of the rope from the vertical, positive outward [rad].

        Returns
        -------
        ndarray, shape (size,)

        Raises
        ------
        NoEquilibrium
            If there is no stable equilibrium.
        ValueError
            If the state is not one of the two.
        """
        if state not in ("equilibrium", "zero"):
            raise ValueError(f"state: wanted 'equilibrium' or 'zero', got {state!r}")
        y = np.zeros(self.size)
        if state == "equilibrium":
            y[: self.coordinates] = self.equilibrium(inputs)
        y[self.coordinates] = np.sin(swing_angle)
        y[self.coordinates + self.axes - 1] = -np.cos(swing_angle)
        return y

    def observe(
        self, motions: dict[str, Motion], times: Floats, states: Floats, guards: Floats
    ) -> dict[str, Quantity]:
        """Outputs over time, see :func:`towercrane.cranes.radial_outputs.observe`."""
        from towercrane.cranes.radial_outputs import observe

        return observe(self, motions, times, states, guards[:, kernel.TENSION])

    def provenance(self) -> dict[str, Any]:
        """Crane, modes and load, for a result's attributes."""
        return {
            "crane": self.crane.name,
            "tower_modes": self.tower_modes,
            "jib_modes": self.jib_modes,
            "payload_mass": self.load.mass,
            "gravity": self.crane.gravity,
        }

    def equilibrium(self, inputs: Floats) -> Floats:
        """Coordinates at rest under all weights, load hanging straight down; shape (coordinates,).

        Newton's method on f(q) - m_p g J_D^T e_z = 0. The rope's direction is known, so the inverted pendulum
        cannot be found; the solution is refused unless it is stable.

        Raises
        ------
        NoEquilibrium
            If the stiffness is not positive definite, or no equilibrium is found.
        """
        n, load_weight = self.coordinates, self.load.mass * self.crane.gravity
        at_rest = self._at_rest(inputs)

        def residual(at: Floats) -> Floats:
            work = at_rest(at)
            return work[FORCE, :n] - load_weight * work[JACOBIAN + self.axes - 1, :n]

        try:
            return stable_equilibrium(residual, self.system.scale[:n])
        except Unstable as failure:
            raise NoEquilibrium(TOWER_BUCKLED, f"{failure}; {self._buckling_message()}") from failure

    def _buckling_message(self) -> str:
        if not self.tower_modes:
            return "the tower is rigid"
        geometric = np.linalg.eigvals(self.geometric_stiffness / self.tower.angular_frequencies**2)
        return f"the tower alone would carry {1.0 / geometric.real.max():.3g} times the weight upon it"

    def _at_rest(self, inputs: Floats) -> Callable[[Floats], Floats]:
        """Scratch array of the structure at rest at given coordinates, the same array every time."""
        n, constants = self.coordinates, self.system.constants
        y, work, fixed = np.zeros(self.size), np.zeros(self.system.work_shape), np.zeros_like(inputs)
        fixed[:, 0] = inputs[:, 0]

        def structure(q: Floats) -> Floats:
            y[:n] = q
            kernel.structure(self.axes, 0.0, y, fixed, *constants, work)
            return work

        return structure

    def linear_matrices(self, trolley_position: float, rope_length: float) -> tuple[Floats, Floats]:
        """Mass and stiffness of small motions about the undeformed crane; shapes (n + 1, n + 1).

        The last coordinate is the load's horizontal distance from the trolley [m]. The second-order effect of the
        static deflection is not in it, as in any linear frame.
        """
        n, load = self.coordinates, self.load.mass
        inputs = np.array([[trolley_position, 0.0, 0.0], [rope_length, 0.0, 0.0]])
        work = self._at_rest(inputs)(np.zeros(n))
        lower = np.tril(work[MASS : MASS + n, :n])
        forward, up = work[JACOBIAN, :n], work[JACOBIAN + self.axes - 1, :n]
        mass = np.zeros((n + 1, n + 1))
        mass[:n, :n] = lower + np.tril(lower, -1).T
        mass[:n, :n] += load * (np.outer(forward, forward) + np.outer(up, up))
        mass[n, :n] = mass[:n, n] = load * forward
        mass[n, n] = load
        stiffness = np.zeros((n + 1, n + 1))
        stiffness[:n, :n] = self.system.matrices[kernel.STIFFNESS]
        stiffness[n, n] = load * self.crane.gravity / rope_length
        return mass, stiffness

    def natural_frequencies(self, trolley_position: float, rope_length: float) -> Floats:
        """Angular frequencies of small motions, pendulum included; shape (coordinates + 1,) [rad/s]."""
        return self.natural_modes(trolley_position, rope_length)[0]

    def natural_modes(self, trolley_position: float, rope_length: float) -> tuple[Floats, int]:
        """Small motions about the undeformed crane.

        Returns
        -------
        frequencies : ndarray, shape (coordinates + 1,)
            Angular frequencies, ascending [rad/s].
        swing : int
            Index of the mode in which the load swings most: the one with the largest share of its elastic and
            potential energy in the pendulum.

        Raises
        ------
        NoEquilibrium
            If the weight's softening leaves the tower no stiffness.
        """
        from scipy.linalg import eigh

        mass, stiffness = self.linear_matrices(trolley_position, rope_length)
        if np.linalg.eigvalsh(stiffness).min() <= 0.0:
            raise NoEquilibrium(TOWER_BUCKLED, self._buckling_message())
        # The reciprocal problem keeps the low modes exact to rounding, however stiff the highest is. Its vectors
        # have unit energy in the stiffness.
        reciprocal, vectors = eigh(mass, stiffness)
        frequencies = 1.0 / np.sqrt(reciprocal[::-1])
        swing = int(np.argmax(stiffness[-1, -1] * vectors[-1, ::-1] ** 2))
        return frequencies, swing

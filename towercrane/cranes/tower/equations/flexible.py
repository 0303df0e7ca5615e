"""Equations of motion of a flexible crane in space, and the states of rest that they have."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from towercrane.cranes.parts.corner import Corner
from towercrane.cranes.tower.equations.constants import geometric_stiffness, matrices, numbers, scale, vectors
from towercrane.cranes.tower.equations.coordinates import Coordinates
from towercrane.cranes.tower.kernels import drive as drive_kernel
from towercrane.cranes.tower.kernels import layout
from towercrane.cranes.tower.kernels import structure as flexible_kernel
from towercrane.cranes.tower.modes.shape_table import shape_table
from towercrane.kernels.payload import FORCE, JACOBIAN, MASS, SLACK, WIND, Load, work_shape
from towercrane.kernels.straight.written import Known
from towercrane.simulation.equilibrium import Unstable, stable_equilibrium
from towercrane.simulation.outcomes import SLACK_ROPE, TOWER_BUCKLED, TROLLEY_OFF_JIB
from towercrane.simulation.system import NoEquilibrium, System

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

ROUNDING = 1e-9
"""Way beyond an end of the jib that counts as parked on it [m]."""


@dataclass(frozen=True, eq=False)
class Equations(Coordinates):
    """Equations of motion of a flexible crane with its load."""

    @cached_property
    def system(self) -> System:
        """The model as the solver sees it."""
        n, drive = self.coordinates, self.drive
        floors = np.full(layout.GUARDS, -np.inf)
        floors[layout.TENSION] = -np.inf if self.rope_as_rod else SLACK
        floors[[layout.INNER_END, layout.OUTER_END]] = -ROUNDING
        floors[layout.TILT] = 0.0
        rows, columns = work_shape(n)
        recorded = ("corner", "corner", "slewing torque", "trolley force")
        return System(
            equations=_equations,
            size=self.size,
            guards=(SLACK_ROPE, TROLLEY_OFF_JIB, TROLLEY_OFF_JIB, TOWER_BUCKLED, *recorded),
            floors=floors,
            scale=scale(self),
            numbers=numbers(self),
            vectors=vectors(self),
            matrices=matrices(self),
            tables=shape_table((self.crane.lateral, self.crane.vertical), self.crane.jib_length),
            work_shape=(rows + layout.ROWS, columns),
            known=Known(layout.KNOWN),
            directions=np.array([[n, 2 * n + self.axes, self.axes]]),
            switch=Corner(layout.INSIDE, layout.OUTSIDE, drive.soft != drive.stiff) if drive else None,
            fastest=lambda: self.fastest,
        )

    @cached_property
    def fastest(self) -> float:
        """Highest angular frequency of its small motions [rad/s]; zero without coordinates.

        Without load, its trolley at the tower, its drive at its stiffest: a load can only lower it, by its inertia
        along the rope, and so does the trolley further out, but for one per cent where that hardly moves.
        """
        from scipy.linalg import eigh

        n = self.coordinates
        if not n:
            return 0.0
        inputs = np.zeros((len(self.channels), 3))
        inputs[1, 0] = 1.0
        # Only the lower triangle is there, and read.
        mass = self.at_rest(np.zeros(n), inputs)[MASS : MASS + n, :n]
        stiffness = self.system.matrices[layout.STIFFNESS].copy()
        if self.drive is not None:
            turned = self.parts["slewing"].start
            stiffness[turned, turned] += max(self.drive.soft, self.drive.stiff)
        return float(np.sqrt(max(eigh(stiffness, mass, eigvals_only=True)[-1], 0.0)))

    def with_load(self, load: Load) -> Self:
        """The same crane with another load: what does not depend on the load is shared, not made again."""
        other = replace(self, load=load)
        steered = np.append(self.system.scale[:-1], load.work_scale(self.crane.gravity, self.crane.jib_length))
        system = replace(self.system, numbers=numbers(other), scale=steered)
        if self.weight_softening:
            # The load's weight takes stiffness, and with it speed, from the tower.
            system = replace(system, matrices=matrices(other), fastest=lambda: other.fastest)
        # A cached property that is filled beforehand.
        vars(other)["system"] = system
        return other

    def start(self, inputs: Floats, state: str = "equilibrium", swing_angle: float = 0.0) -> Floats:
        """State at rest at the start.

        Parameters
        ----------
        inputs : ndarray
            Polynomials of the first phase, the wind's at the value that counts, see
            :func:`towercrane.simulation.system.start_inputs`.
        state : str
            "equilibrium" (the static solution, in the wind) or "zero" (undeformed, all weights on, in still air).
        swing_angle : float
            Turn of the rope in the vertical plane of the head from where it would hang, positive outward [rad].

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
        n, y = self.coordinates, np.zeros(self.size)
        heading = 0.0 if self.slewing == "fixed" else float(inputs[layout.SLEWING, 0])
        if self.drive is not None:
            y[self.parts["slewing"]] = heading
        hung, outward = -np.eye(self.axes)[-1], np.zeros(self.axes)
        if state == "equilibrium":
            y[:n] = self.equilibrium(inputs)
            force = self.load_force(self.at_rest(y[:n], inputs))
            # Without weight and wind any direction will do.
            hung = force / np.linalg.norm(force) if force.any() else hung
        outward[: self.axes - 1] = np.array([np.cos(heading), np.sin(heading)])[: self.axes - 1]
        along, rise = hung @ outward, hung[-1]
        c, s = np.cos(swing_angle), np.sin(swing_angle)
        hung += (along * (c - 1.0) - rise * s) * outward
        hung[-1] = rise * c + along * s
        y[n : n + self.axes] = hung
        return y

    def equilibrium(self, inputs: Floats) -> Floats:
        """Coordinates at rest under all weights and the wind; shape (coordinates,).

        Newton's method on f(q) + J_D^T F = 0 with the weight and the wind's force F of the load. The rope's direction
        is that of F, so the inverted pendulum cannot be found; the solution is refused unless it is stable.

        Raises
        ------
        NoEquilibrium
            If the stiffness is not positive definite, or no equilibrium is found.
        """
        n, origin = self.coordinates, np.zeros(self.coordinates)
        if self.drive is not None:
            origin[self.parts["slewing"]] = inputs[layout.SLEWING, 0]
        at_rest = self.rests(inputs)
        # The wind does not depend on where the crane is.
        pull = self.load_force(at_rest(origin))

        def residual(departure: Floats) -> Floats:
            return _static_force(at_rest(origin + departure), pull, n)

        try:
            return origin + stable_equilibrium(residual, self.system.scale[:n])
        except Unstable as failure:
            raise NoEquilibrium(TOWER_BUCKLED, f"{failure}; {self.buckling_message()}") from failure

    def static_force(self, q: Floats, inputs: Floats) -> Floats:
        """Generalised forces on the crane at rest with its load hanging at rest; shape (coordinates,)."""
        work = self.at_rest(q, inputs)
        return _static_force(work, self.load_force(work), self.coordinates)

    def load_force(self, work: Floats) -> Floats:
        """Force of weight and wind on the load at rest, as scratch knows the wind [N]; shape (axes,)."""
        wind = work[WIND, : self.axes]
        force = self.load.drag * np.linalg.norm(wind) * wind
        force[-1] -= self.load.mass * self.crane.gravity
        return np.asarray(force)

    def buckling_message(self) -> str:
        """How far the tower is from buckling."""
        if not self.crane.tower.count:
            return "the tower is rigid"
        geometric = np.linalg.eigvals(np.linalg.solve(self.crane.tower.stiffness_matrix(), geometric_stiffness(self)))
        return f"the tower alone would carry {1.0 / geometric.real.max():.3g} times the weight upon it"

    def at_rest(self, q: Floats, inputs: Floats) -> Floats:
        """Scratch array of the structure at rest at these coordinates, in the wind of the inputs."""
        return self.rests(inputs)(q)

    def rests(self, inputs: Floats) -> Callable[[Floats], Floats]:
        """:meth:`at_rest` with these inputs, for many coordinates: every call fills the same array."""
        n, axes, driven, constants = self.coordinates, self.axes, self.drive is not None, self.system.constants
        y, work, fixed = np.zeros(self.size), np.zeros(self.system.work_shape), np.zeros_like(inputs)
        fixed[:, 0] = inputs[:, 0]

        def at_rest(q: Floats) -> Floats:
            y[:n] = q
            flexible_kernel.structure(axes, 0.0, y, fixed, *constants, work)
            if driven:
                drive_kernel.drive(0.0, y, fixed, constants[0], work)
            return work

        return at_rest


def _equations() -> Any:
    # Here, since what is asked at rest need not wait until these are compiled.
    from towercrane.cranes.tower.kernels.rhs import rhs

    return rhs


def _static_force(work: Floats, pull: Floats, n: int) -> Floats:
    """Forces on the coordinates in a scratch array, with a force on the load."""
    return np.asarray(work[FORCE, :n] + pull @ work[JACOBIAN : JACOBIAN + len(pull), :n])

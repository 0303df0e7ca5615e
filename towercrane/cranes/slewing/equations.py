"""Equations of motion of lumped cranes, for any description in :mod:`towercrane.cranes.slewing.description`."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.slewing import kernel
from towercrane.cranes.slewing.friction import Transitions
from towercrane.kernels.payload import FORCE, JACOBIAN, MASS, SLACK, Load, work_shape
from towercrane.kernels.straight.written import Known
from towercrane.simulation.equilibrium import Unstable, stable_equilibrium
from towercrane.simulation.outcomes import SLACK_ROPE, UNSTABLE
from towercrane.simulation.system import NoEquilibrium, System

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.slewing.description import LumpedCrane

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Equations:
    """Equations of motion of a lumped crane with its load, always in space.

    Parameters
    ----------
    crane : LumpedCrane
    load : Load
    rope_as_rod : bool
        Let the rope push. Without it a slack rope ends the run.
    """

    crane: LumpedCrane
    load: Load
    rope_as_rod: bool = False

    @property
    def channels(self) -> tuple[str, ...]:
        """Motions: angle of the drive's shaft [rad] and length of the unstretched rope [m]."""
        return ("shaft", "rope")

    @property
    def coordinates(self) -> int:
        """Number of structural coordinates."""
        return len(self.crane.coordinates)

    @property
    def elastic(self) -> bool:
        """Whether the rope stretches."""
        return self.crane.rope_stiffness > 0.0

    @property
    def rope(self) -> int:
        """Where the rope's direction begins in the state: after the coordinates and the stretch, if there is one."""
        return self.coordinates + self.elastic

    @property
    def size(self) -> int:
        """Number of states."""
        return 2 * (self.rope + 3) + 1

    @property
    def channel_units(self) -> tuple[str, ...]:
        """Units of the motions."""
        return ("rad", "m")

    @property
    def state_names(self) -> dict[str, str]:
        """Coordinates with their units, and the rope's stretch."""
        names = {name: "rad" if name in self.crane.angles else "m" for name in self.crane.coordinates}
        return names | ({"rope_stretch": "m"} if self.elastic else {})

    @cached_property
    def system(self) -> System:
        """The model as the solver sees it."""
        crane, drive, n = self.crane, self.crane.drive, self.coordinates
        names = list(crane.points)
        links = [(p, link) for p, point in enumerate(crane.points.values()) for link in point.links]
        tables = np.zeros((len(links) + len(names), 3, max(n + 1, 4)))
        for row, (p, link) in enumerate(links):
            turned = crane.coordinates.index(link.turns_with) if link.turns_with else -1
            tables[row, kernel.AHEAD, : n + 1] = crane.row(link.ahead)
            tables[row, kernel.ACROSS, : n + 1] = crane.row(link.across)
            tables[row, kernel.OWNER, :2] = p, turned
        for p, point in enumerate(crane.points.values()):
            tables[len(links) + p, kernel.HEIGHT, : n + 1] = crane.row(point.height)
            tables[len(links) + p, kernel.PROPERTIES, :4] = point.mass, *np.broadcast_to(point.drag, 3)
        matrices = np.zeros((2, n, n))
        for spring in crane.springs:
            stretch = crane.row(spring.stretch)[:-1]
            matrices[kernel.STIFFNESS] += spring.stiffness * np.outer(stretch, stretch)
            matrices[kernel.DAMPING] += spring.damping * np.outer(stretch, stretch)
        laws = {"none": kernel.NO_FRICTION, "tanh": kernel.TANH, "stick-slip": kernel.STICK_SLIP}
        numbers = np.zeros(18)
        numbers[kernel.GRAVITY] = crane.gravity
        numbers[kernel.LOAD_MASS] = self.load.mass
        numbers[kernel.DRAG] = self.load.drag
        numbers[kernel.HINGE_DAMPING] = self.load.rope_damping
        numbers[kernel.ROPE_STIFFNESS] = crane.rope_stiffness
        numbers[kernel.ROPE_LOSS] = crane.rope_damping
        numbers[kernel.LINKS], numbers[kernel.POINTS] = len(links), len(names)
        numbers[kernel.SUSPENSION] = names.index(crane.suspension)
        numbers[kernel.DRIVEN] = crane.coordinates.index(drive.on)
        numbers[kernel.SOFT], numbers[kernel.STIFF] = drive.soft, drive.stiff
        numbers[kernel.CORNER], numbers[kernel.DRIVE_DAMPING] = drive.corner, drive.damping
        numbers[kernel.FRICTION_LAW] = laws[drive.friction]
        numbers[kernel.FRICTION_TORQUE], numbers[kernel.FRICTION_RATE] = drive.friction_torque, drive.friction_rate
        numbers[kernel.FRICTION_STATE] = kernel.BY_RATE
        scale = np.ones(self.size)
        reach = sum(abs(link.ahead.get("", 0.0)) for link in crane.points[crane.suspension].links)
        scale[-1] = self.load.work_scale(crane.gravity, reach)
        rows, width = work_shape(n)
        owners = tuple((link, kernel.OWNER, k) for link in range(len(links)) for k in range(2))
        return System(
            equations=lambda: kernel.rhs,
            size=self.size,
            guards=(SLACK_ROPE, "corner", "corner", "slip", "stick", "needed"),
            floors=np.array([-np.inf if self.rope_as_rod else SLACK, *[-np.inf] * 5]),
            scale=scale,
            numbers=numbers,
            vectors=np.array([crane.row(crane.inertias)[:-1], crane.row(crane.steady_force)[:-1]]),
            matrices=matrices,
            tables=tables,
            # Three rows more for the point that is being added, or for the row of a coordinate that sticks.
            work_shape=(rows + 3, max(width, 4)),
            known=Known(kernel.KNOWN, owners, (kernel.FRICTION_STATE,)),
            directions=np.array([[self.rope, (self.size - 1) // 2 + self.rope, 3]]),
            switch=Transitions(
                driven=crane.coordinates.index(drive.on),
                rates=(self.size - 1) // 2,
                changes_equations=drive.friction == "stick-slip",
            ),
            fastest=lambda: self.fastest,
        )

    @cached_property
    def fastest(self) -> float:
        """Highest angular frequency of its small motions, the coupling at its stiffest [rad/s].

        A load on an inextensible rope only adds inertia; on an elastic one it vibrates along the rope, whose
        direction is taken along each of the axes.
        """
        from scipy.linalg import eigh

        n, rope = self.coordinates, self.crane.rope_stiffness
        work, constants = np.zeros(self.system.work_shape), self.system.constants
        kernel.structure(0.0, np.zeros(self.size), np.array([[0.0] * 3, [1.0, 0.0, 0.0]]), *constants, work)
        lower = np.tril(work[MASS : MASS + n, :n])
        driven = self.crane.coordinates.index(self.crane.drive.on)
        stiffness = np.zeros((n + self.elastic, n + self.elastic))
        stiffness[:n, :n] = constants[2][kernel.STIFFNESS]
        stiffness[driven, driven] += max(self.crane.drive.soft, self.crane.drive.stiff)
        stiffness[n:, n:] = rope
        squares = []
        for axis in range(3):
            mass = np.zeros_like(stiffness)
            mass[:n, :n] = lower + np.tril(lower, -1).T
            if self.elastic:
                along = np.append(work[JACOBIAN + axis, :n], 1.0)
                mass += self.load.mass * np.outer(along, along)
            squares.append(eigh(stiffness, mass, eigvals_only=True)[-1])
        return float(np.sqrt(max(squares)))

    def start(self, inputs: Floats, state: str = "equilibrium", swing_angle: float = 0.0) -> Floats:
        """State at rest at the start: "equilibrium", or "zero" with all weights on; swing positive outward.

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
        y[:n] = self.equilibrium(inputs) if state == "equilibrium" else self.undeformed(inputs)
        if self.elastic and state == "equilibrium":
            y[n] = self.load.mass * self.crane.gravity * np.cos(swing_angle) / self.crane.rope_stiffness
        heading = y[self.crane.coordinates.index(self.crane.jib_angle)]
        sideways = np.sin(swing_angle)
        y[self.rope : self.rope + 3] = sideways * np.cos(heading), sideways * np.sin(heading), -np.cos(swing_angle)
        return y

    def undeformed(self, inputs: Floats) -> Floats:
        """Coordinates that stretch no spring and do not twist the drive's coupling; shape (n,)."""
        crane = self.crane
        forms = [*(spring.stretch for spring in crane.springs), {crane.drive.on: 1.0}]
        held = np.array([crane.row(form)[:-1] for form in forms])
        values = np.append(np.zeros(len(crane.springs)), inputs[kernel.SHAFT, 0])
        return np.asarray(np.linalg.lstsq(held, values, rcond=None)[0])

    def equilibrium(self, inputs: Floats) -> Floats:
        """Coordinates at rest under all weights, load hanging straight down; shape (n,)."""
        n, origin = self.coordinates, self.undeformed(inputs)
        fixed = np.zeros_like(inputs)
        fixed[:, 0] = inputs[:, 0]

        def residual(departure: Floats) -> Floats:
            y = np.zeros(self.size)
            y[:n] = origin + departure
            work = np.zeros(self.system.work_shape)
            kernel.structure(0.0, y, fixed, *self.system.constants, work)
            return work[FORCE, :n] - self.load.mass * self.crane.gravity * work[JACOBIAN + 2, :n]

        try:
            return origin + stable_equilibrium(residual, np.ones(n))
        except Unstable as failure:
            raise NoEquilibrium(UNSTABLE, str(failure)) from failure

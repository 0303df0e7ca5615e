"""A lumped crane of any description as the solver sees it, and its states at rest."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.parts.air import load_force
from towercrane.cranes.parts.corner import Corners
from towercrane.cranes.parts.wind import wind_channels
from towercrane.cranes.slewing import equations
from towercrane.cranes.slewing.equations import Arm, Body, Constants, structure
from towercrane.cranes.slewing.friction import Transitions
from towercrane.kernels.payload import SLACK, Load
from towercrane.kernels.straight.leaves import place_of
from towercrane.kernels.straight.written import written
from towercrane.simulation.equilibrium import Unstable, stable_equilibrium
from towercrane.simulation.outcomes import SLACK_ROPE, UNSTABLE
from towercrane.simulation.starts.turning import Turning
from towercrane.simulation.system import NoEquilibrium, System, check_start

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.slewing.description import Link, LumpedCrane, Point

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class LumpedSystem:
    """A lumped crane with its load, always in space.

    Parameters
    ----------
    crane : LumpedCrane
    load : Load
    rope_as_rod : bool
        Let the rope push. Without it a slack rope ends the run.
    wind : int
        Number of places that see a wind of their own: 1, one wind for all; each of the points and the load; 0: none.
    """

    crane: LumpedCrane
    load: Load
    rope_as_rod: bool = False
    wind: int = 0

    @property
    def channels(self) -> tuple[str, ...]:
        """Motions: angle of the drive's shaft [rad], length of the unstretched rope [m], wind [m/s]."""
        return ("shaft", "rope", *self.value_channels)

    @property
    def value_channels(self) -> tuple[str, ...]:
        """Channels that act by their value alone, of which a crane at rest knows the mean: the wind's components."""
        return wind_channels(self.wind)

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
        return ("rad", "m", *("m/s" for _ in self.value_channels))

    @property
    def state_names(self) -> dict[str, str]:
        """Coordinates with their units, and the rope's stretch."""
        names = {name: "rad" if name in self.crane.angles else "m" for name in self.crane.coordinates}
        return names | ({"rope_stretch": "m"} if self.elastic else {})

    @cached_property
    def constants(self) -> Constants:
        """The crane as its equations know it."""
        crane = self.crane

        def arm(link: Link) -> Arm:
            turned_by = crane.coordinates.index(link.turns_with) if link.turns_with else None
            return Arm(turned_by, crane.row(link.ahead), crane.row(link.across))

        def body(point: Point) -> Body:
            drag = np.array(np.broadcast_to(point.drag, 3), dtype=float)
            return Body(point.mass, drag, tuple(map(arm, point.links)), crane.row(point.height))

        stiffness, damping = np.zeros((2, self.coordinates, self.coordinates))
        for spring in crane.springs:
            stretch = crane.row(spring.stretch)[:-1]
            stiffness += spring.stiffness * np.outer(stretch, stretch)
            damping += spring.damping * np.outer(stretch, stretch)
        return Constants(
            bodies=tuple(map(body, crane.points.values())),
            suspension=list(crane.points).index(crane.suspension),
            inertia=crane.row(crane.inertias)[:-1],
            steady_force=crane.row(crane.steady_force)[:-1],
            stiffness=stiffness,
            damping=damping,
            driven=crane.coordinates.index(crane.drive.on),
            drive=crane.drive,
            rope_stiffness=crane.rope_stiffness,
            rope_damping=crane.rope_damping,
            gravity=crane.gravity,
            load=self.load,
            wind=self.wind,
        )

    @cached_property
    def system(self) -> System:
        """The model as the solver sees it."""
        crane, rates, scale = self.crane, (self.size - 1) // 2, np.ones(self.size)
        reach = sum(abs(link.ahead.get("", 0.0)) for link in crane.points[crane.suspension].links)
        scale[-1] = self.load.work_scale(crane.gravity, reach)
        return System(
            equations=equations.equations,
            size=self.size,
            guards=(SLACK_ROPE, "corner", "corner", "slip", "stick", "needed"),
            floors=np.array([-np.inf if self.rope_as_rod else SLACK, *[-np.inf] * 5]),
            scale=scale,
            constants=self.constants,
            directions=np.array([[self.rope, rates + self.rope, equations.AXES]]),
            switch=self._switch,
            fastest=lambda: self.fastest,
        )

    @property
    def _switch(self) -> Transitions | None:
        """What its guards do; nothing where the coupling is a straight line and friction has one value."""
        drive, rates = self.crane.drive, (self.size - 1) // 2
        corner = Corners(((equations.INSIDE, equations.OUTSIDE),)) if drive.soft != drive.stiff else None
        sticks = drive.friction == "stick-slip"
        if corner is None and not sticks:
            return None
        friction_state = place_of(self.constants, "friction_state")
        return Transitions(rates + self.constants.driven, friction_state, corner, changes_equations=sticks)

    @cached_property
    def fastest(self) -> float:
        """Highest angular frequency of its small motions, the coupling at its stiffest [rad/s].

        A load on an inextensible rope only adds inertia; on an elastic one it vibrates along the rope, whose
        direction is taken along each of the axes.
        """
        from scipy.linalg import eigh

        n, drive, constants = self.coordinates, self.crane.drive, self.constants
        still = [(0.0, 0.0, 0.0)] * (len(constants.bodies) + 1)
        bare, _ = structure(constants, np.zeros(n), np.zeros(n), (0.0, 0.0), still)
        stiffness, mass = np.zeros((2, n + self.elastic, n + self.elastic))
        stiffness[:n, :n] = constants.stiffness
        stiffness[constants.driven, constants.driven] += max(drive.soft, drive.stiff)
        stiffness[n:, n:] = constants.rope_stiffness
        mass[:n, :n] = bare.mass_matrix()
        loads = [np.append(row, 1.0) for row in bare.jacobian] if self.elastic else [np.zeros(n)]
        carried = [self.load.mass * np.outer(along, along) for along in loads]
        return float(np.sqrt(max(eigh(stiffness, mass + own, eigvals_only=True)[-1] for own in carried)))

    def start(self, inputs: Floats, state: str = "equilibrium") -> Floats:
        """State at rest, the load hanging at rest: "equilibrium", or "zero" with all weights on.

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
        check_start(state)
        n, y = self.coordinates, np.zeros(self.size)
        y[:n] = self.equilibrium(inputs) if state == "equilibrium" else self.undeformed(inputs)
        y[self.rope + 2] = -1.0
        if state == "equilibrium":
            *_, wind = equations.winds_of(self.constants, inputs)
            pull = np.array(load_force(self.load, self.crane.gravity, wind))
            y[self.rope : self.rope + 3] = pull / np.linalg.norm(pull)
            y[n : self.rope] = np.linalg.norm(pull) / (self.crane.rope_stiffness or 1.0)
        return y

    def hang(self, state: Floats, _inputs: Floats, direction: Floats, rate: Floats) -> Floats:
        """The state with its load along another direction, an elastic rope stretched by the part of the weight
        along it."""
        found, moved = np.array(state), self.size // 2 + self.rope
        found[self.coordinates : self.rope] *= direction[2] / state[self.rope + 2]
        found[self.rope : self.rope + 3], found[moved : moved + 3] = direction, rate
        return found

    def jib_heading(self, state: Floats, _inputs: Floats) -> float:
        """Angle of the jib from the fixed x axis [rad]."""
        return float(state[self.crane.coordinates.index(self.crane.jib_angle)])

    @cached_property
    def turning(self) -> Turning:
        """What turns with the platform."""
        rates = self.size // 2
        angles = [i for i, name in enumerate(self.crane.coordinates) if name in self.crane.angles]
        vectors = (self.rope, self.rope + 1), (rates + self.rope, rates + self.rope + 1)
        return Turning(vectors, angles, equations.SHAFT)

    def undeformed(self, inputs: Floats) -> Floats:
        """Coordinates that stretch no spring and do not twist the drive's coupling; shape (n,)."""
        crane = self.crane
        forms = [*(spring.stretch for spring in crane.springs), {crane.drive.on: 1.0}]
        held = np.array([crane.row(form)[:-1] for form in forms])
        values = np.append(np.zeros(len(crane.springs)), inputs[equations.SHAFT, 0])
        return np.asarray(np.linalg.lstsq(held, values, rcond=None)[0])

    def equilibrium(self, inputs: Floats) -> Floats:
        """Coordinates at rest under all weights and the wind, the load hanging at rest; shape (n,)."""
        n, origin, numbers = self.coordinates, self.undeformed(inputs), self.system.numbers
        code = written(equations.forces_at_rest, self.constants, [numbers], n, inputs.shape)
        forces = code.values(numbers, self.system.table)

        def residual(departures: Floats) -> Floats:
            return forces(origin[:, None] + departures, inputs)

        try:
            return origin + stable_equilibrium(residual, np.ones(n))
        except Unstable as failure:
            raise NoEquilibrium(UNSTABLE, str(failure)) from failure

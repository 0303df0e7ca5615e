"""A lumped crane of any description as the solver sees it, and its states at rest."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.parts.air import load_force
from towercrane.cranes.parts.corner import Corners
from towercrane.cranes.parts.friction import Transitions
from towercrane.cranes.parts.hoisting.elastic import fastest_on, on_its_rope
from towercrane.cranes.parts.hoisting.on_rope import OnRope
from towercrane.cranes.parts.wind import wind_channels
from towercrane.cranes.slewing import equations
from towercrane.cranes.slewing.equations import Arm, Body, Constants, structure
from towercrane.kernels.elastic_rope import TAUT
from towercrane.kernels.payload import SLACK, Structure
from towercrane.kernels.polynomial import polynomial
from towercrane.kernels.straight.leaves import place_of
from towercrane.kernels.straight.written import written
from towercrane.simulation.equilibrium import Unstable, stable_equilibrium
from towercrane.simulation.outcomes import SLACK_ROPE, UNSTABLE
from towercrane.simulation.starts.turning import Turning
from towercrane.simulation.system import NoEquilibrium, System, check_start

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.slewing.description import Link, LumpedCrane, Point
    from towercrane.kernels.load import Load

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class LumpedSystem(OnRope):
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
    def size(self) -> int:
        """Number of states."""
        return 2 * (self.coordinates + equations.AXES * len(self.load.bodies)) + 1

    @property
    def freedoms(self) -> int:
        """Degrees of freedom of crane and load; an inextensible rope takes one, as does a sling."""
        own = equations.AXES - 1
        return self.coordinates + own * len(self.load.bodies) + (self.carried.elasticity is not None)

    @cached_property
    def carried(self) -> Load:
        """The load, on the crane's own rope if it has one."""
        rope = self.crane.rope or self.load.elasticity
        if rope is not None and self.rope_as_rod:
            rope = replace(rope, mode=TAUT)
        return replace(self.load, elasticity=rope)

    @property
    def axes(self) -> int:
        """Components of the load's place."""
        return equations.AXES

    @property
    def rope(self) -> int:
        """Where the load's part of the state begins, and of its rates."""
        return self.coordinates

    @property
    def channel_units(self) -> tuple[str, ...]:
        """Units of the motions."""
        return ("rad", "m", *("m/s" for _ in self.value_channels))

    @property
    def state_names(self) -> dict[str, str]:
        """Coordinates with their units."""
        return {name: "rad" if name in self.crane.angles else "m" for name in self.crane.coordinates}

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
            gravity=crane.gravity,
            load=self.carried,
            wind=self.wind,
        )

    @cached_property
    def system(self) -> System:
        """The model as the solver sees it."""
        crane, rates, scale = self.crane, self.size // 2, np.ones(self.size)
        reach = sum(abs(link.ahead.get("", 0.0)) for link in crane.points[crane.suspension].links)
        scale[-1] = self.load.work_scale(crane.gravity, reach)
        system = System(
            equations=equations.equations,
            size=self.size,
            guards=(SLACK_ROPE, "corner", "corner", "slip", "stick", "needed"),
            floors=np.array([-np.inf if self.rope_as_rod else SLACK, *[-np.inf] * 5]),
            scale=scale,
            constants=self.constants,
            directions=np.array([[self.coordinates, rates + self.coordinates, equations.AXES]]),
            switch=self._switch,
            fastest=partial(self.fastest_on, np.inf),
        )
        return on_its_rope(system, self.carried, equations.ROPE, self.fastest_on, self.rope_as_rod)

    @property
    def _switch(self) -> Transitions | None:
        """What its guards do; nothing where the coupling is a straight line and friction has one value."""
        drive, rates = self.crane.drive, self.size // 2
        corner = Corners(((equations.INSIDE, equations.OUTSIDE),)) if drive.soft != drive.stiff else None
        sticks = drive.friction == "stick-slip"
        if corner is None and not sticks:
            return None
        friction_state = place_of(self.constants, "friction_state")
        guards = equations.SLIDING, equations.HOLDING, equations.NEEDED
        return Transitions(rates + self.constants.driven, friction_state, corner, guards, changes_equations=sticks)

    def fastest_on(self, length: float) -> float:
        """Highest angular frequency of its small motions with so much rope, the coupling at its stiffest [rad/s]."""
        n, drive, constants = self.coordinates, self.crane.drive, self.constants
        still = [(0.0, 0.0, 0.0)] * (len(constants.bodies) + 1)
        bare, _ = structure(constants, np.zeros(n), np.zeros(n), (0.0, 0.0), still)
        stiffness = constants.stiffness.copy()
        stiffness[constants.driven, constants.driven] += max(drive.soft, drive.stiff)
        return fastest_on(stiffness, bare, self.carried, length)

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
        return self.hung(y, inputs, state)

    def suspended(self, state: Floats, inputs: Floats) -> Structure:
        """The crane in a state."""
        q, rates = (state[first : first + self.rope] for first in (0, self.size // 2))
        winds = equations.winds_of(self.constants, inputs)
        return structure(self.constants, q, rates, inputs[equations.SHAFT], winds)[0]

    def below(self, _state: Floats, inputs: Floats) -> tuple[float, float, float]:
        """Rope below the jib's tip, what the winch has given of it and its rate [m, m, m/s]."""
        length, rate, _ = polynomial(inputs[equations.ROPE], 0.0)
        return length, length, rate

    def load_at_rest(self, inputs: Floats, load: Load) -> Floats:
        """Force of weight and wind on a load at rest [N]; shape (3,)."""
        *_, wind = equations.winds_of(self.constants, inputs)
        return np.array(load_force(load, self.crane.gravity, wind))

    def jib_heading(self, state: Floats, _inputs: Floats) -> float:
        """Angle of the jib from the fixed x axis [rad]."""
        return float(state[self.crane.coordinates.index(self.crane.jib_angle)])

    @cached_property
    def turning(self) -> Turning:
        """What turns with the platform."""
        rates = self.size // 2
        angles = [i for i, name in enumerate(self.crane.coordinates) if name in self.crane.angles]
        ropes = range(self.rope, rates, self.axes)
        vectors = [(half + first, half + first + 1) for half in (0, rates) for first in ropes]
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

"""The load on its rope, the structure that it hangs on, and their state, for every crane.

A crane states only its structure without the load: mass matrix, forces, and the motion of the point D that the
rope hangs from. What is here adds a rope of prescribed length and a point load. The rope's direction is a unit
vector, so there is no angle chart and no singular position; angles are outputs.

Vectors have ``d`` inertial components, the vertical last: (x, z) in a plane, (x, y, z) in space. The state is
``y = (q, n, q', p, work)``: coordinates, unit vector from D to the load, rates, rate of the unit vector, and the
work [J] that inputs and dissipation have put into the crane since the start. On an elastic rope n and p are the
load's place and velocity instead: its tension is known before anything is solved, and a load may fly free.

Under a hook block the load hangs on slings: the rope then carries the hook, and the unit vector of each sling, from
the body above it to that below, follows n, its rate p.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from modal.checks import check_fields
from towercrane.kernels.choices import below, choose

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from towercrane.kernels.algebra import Row
    from towercrane.kernels.elastic_rope import Elasticity
    from towercrane.kernels.ground import Ground

AIR_DENSITY = 1.225
"""Density of air at 15 degrees Celsius and sea level [kg/m^3] (ISO 2533)."""

SLACK = -1e-6
"""Tension below which a rope is slack [N]: where a whole crane is let fall, rounding decides the sign of none."""


@dataclass(frozen=True, slots=True)
class Sling:
    """A body on the rope, and the rigid link by which the next one hangs below it.

    Parameters
    ----------
    mass : float
        Of the body above the link, such as a hook block [kg].
    length : float
        Of the link [m].
    drag_area : float
        Drag coefficient times area of that body [m^2].

    Raises
    ------
    ValueError
        If mass or length is not positive, or the drag area is negative.
    """

    mass: float
    length: float
    drag_area: float = 0.0

    def __post_init__(self) -> None:
        check_fields(self, positive=("mass", "length"), not_negative=("drag_area",))

    @property
    def drag(self) -> float:
        """Drag force per squared speed, rho C_d A / 2 [kg/m]."""
        return 0.5 * AIR_DENSITY * self.drag_area


@dataclass(frozen=True, slots=True)
class Release:
    """What of a load lets go during a run.

    Parameters
    ----------
    mass : float
        [kg]
    drag_area : float
        Of its drag coefficient times area [m^2].

    Raises
    ------
    ValueError
        If the mass is not positive or the area is negative.
    """

    mass: float
    drag_area: float = 0.0

    def __post_init__(self) -> None:
        check_fields(self, positive=("mass",), not_negative=("drag_area",))


class Momentary(NamedTuple):
    """A load of which some has let go.

    Parameters
    ----------
    mass, drag, rope_damping, elasticity, ground, slings
        As of a `Load`; without mass nothing damps, and there is neither ground nor a hook.
    hangs : number
        1 while there is mass, else 0.
    inertia : number
        The mass, or any where there is none, to divide by [kg].
    leaving : number
        Rate at which mass goes [kg/s].
    """

    mass: Any
    drag: Any
    rope_damping: Any
    elasticity: Elasticity | None
    hangs: Any
    inertia: Any
    leaving: Any
    ground: None = None
    slings: tuple[Sling, ...] = ()

    @property
    def bodies(self) -> tuple[Momentary]:
        """All that hang on the rope."""
        return (self,)

    @property
    def whole_mass(self) -> Any:
        """Mass of all that hangs on the rope [kg]."""
        return self.mass

    @property
    def whole_drag(self) -> Any:
        """Drag force of all of it per squared speed [kg/m]."""
        return self.drag


@dataclass(frozen=True, slots=True)
class Load:
    """The load and its rope.

    Parameters
    ----------
    mass : float
        Mass of the load, with its hook where that is no body of its own [kg].
    rope_damping : float
        Damping where the rope hangs, a torque per rate of swing [N m s/rad].
    drag_area : float
        Drag coefficient times area [m^2].
    elasticity : Elasticity or None
        Of a rope that stretches.
    ground : Ground or None
        Under a load on such a rope.
    release : Release or None
        What of it lets go.
    slings : tuple of Sling
        What hangs between rope and load, from above.

    Raises
    ------
    ValueError
        If the mass is not positive or another value is negative, or if more is to go than there is.
    """

    mass: float
    rope_damping: float = 0.0
    drag_area: float = 0.0
    elasticity: Elasticity | None = None
    ground: Ground | None = None
    release: Release | None = None
    slings: tuple[Sling, ...] = ()

    def __post_init__(self) -> None:
        check_fields(self, positive=("mass",), not_negative=("rope_damping", "drag_area"))
        if (own := self.release) is not None and (own.mass > self.mass or own.drag_area > self.drag_area):
            raise ValueError(f"Load.release: wanted no more than mass and drag area of the load, got {own}")
        if self.release is not None and self.ground is not None:
            raise ValueError("Load.release: wanted None over ground, got what lets go")

    @property
    def lightest(self) -> float:
        """Least mass that its rope carries [kg]."""
        return self.bodies[0].mass - (0.0 if self.release is None else self.release.mass) or self.mass

    def now(self, gone: Sequence[Any]) -> Load | Momentary:
        """The load at a time; of what lets go the part that is gone, 0 to 1, and the rate of that."""
        if self.release is None:
            return self
        part, rate, *_ = gone
        mass = self.mass - self.release.mass * part
        hangs = below(0.0, mass)
        return Momentary(
            mass=mass,
            drag=0.5 * AIR_DENSITY * (self.drag_area - self.release.drag_area * part),
            rope_damping=hangs * self.rope_damping,
            elasticity=self.elasticity,
            hangs=hangs,
            inertia=choose(hangs, mass, 1.0),
            leaving=self.release.mass * rate,
        )

    def work_scale(self, gravity: float, length: float) -> float:
        """Tolerance of the work per unit of that of swing, by gravity [m/s^2] and a length of the crane [m]; [J].

        Work steers where nothing else does, as where the load hangs while its rope is let out, and where it is worse
        than the balance of energy allows. Without gravity nothing says which work is small: it then steers no step.
        """
        return self.whole_mass * gravity * length or np.inf

    @property
    def drag(self) -> float:
        """Drag force per squared speed, rho C_d A / 2 [kg/m]."""
        return 0.5 * AIR_DENSITY * self.drag_area

    @property
    def bodies(self) -> tuple[Sling | Load, ...]:
        """All that hang on the rope, from above."""
        return (*self.slings, self)

    @property
    def whole_mass(self) -> Any:
        """Mass of all that hangs on the rope [kg]."""
        return sum((sling.mass for sling in self.slings), self.mass)

    @property
    def whole_drag(self) -> Any:
        """Drag force of all of it per squared speed [kg/m]."""
        return sum((sling.drag for sling in self.slings), self.drag)

    def under(self, count: int) -> Load:
        """What hangs below so many of the bodies, on rigid links."""
        return replace(self, slings=self.slings[count:], elasticity=None) if count else self


class Structure(NamedTuple):
    """A crane of n coordinates without its load, as the load on it sees it.

    Parameters
    ----------
    mass : sequence of n sequences
        Rows of the lower triangle of the mass matrix.
    force : sequence of n
        Forces on the coordinates while nothing accelerates.
    place, velocity, bias : sequence of d
        Of D: where it is, its velocity, and its acceleration while no coordinate accelerates.
    jacobian : sequence of d sequences of n
        What a rate of each coordinate moves D.
    wind : sequence of d
        Velocity of the air at the load, as seen from the ground.
    ground : sequence of d
        Acceleration of the ground that all places, velocities and accelerations are relative to.
    """

    mass: Sequence[Sequence[Any]]
    force: Sequence[Any]
    place: Sequence[Any]
    velocity: Sequence[Any]
    bias: Sequence[Any]
    jacobian: Sequence[Sequence[Any]]
    wind: Sequence[Any] = (0.0, 0.0, 0.0)
    ground: Sequence[Any] = (0.0, 0.0, 0.0)

    def mass_matrix(self) -> NDArray[np.float64]:
        """The whole mass matrix, of numbers; shape (n, n)."""
        matrix = np.zeros((len(self.mass), len(self.mass)))
        for i, row in enumerate(self.mass):
            matrix[i, : i + 1] = matrix[: i + 1, i] = row
        return matrix


class State(NamedTuple):
    """Parts of a state: coordinates, rope direction and their rates; of an elastic rope the load's place instead.

    Directions of slings, one after the other, and their rates stand behind those of the rope.
    """

    coordinates: Row
    direction: Row
    rates: Row
    swing: Row
    slings: Row = ()
    slings_swing: Row = ()

    def links(self) -> list[tuple[Row, Row]]:
        """Direction of each sling, and its rate."""
        axes = len(self.direction)
        return [
            (self.slings[first : first + axes], self.slings_swing[first : first + axes])
            for first in range(0, len(self.slings), axes)
        ]


class Rope(NamedTuple):
    """The rope from D to the load.

    Parameters
    ----------
    length : number
        Unstretched [m].
    rate, acceleration : number
        What the winch gives to its rate, and its acceleration while no coordinate accelerates [m/s, m/s^2].
    paid : sequence of n
        What a rate of each coordinate adds to the length, as where a rope is led over a jib that moves; nothing where
        the winch alone decides.
    wound : number, optional
        Length that the winch gives it [m], where it is not the whole.
    """

    length: Any
    rate: Any
    acceleration: Any
    paid: Sequence[Any] = ()
    wound: Any = None


class Hung(NamedTuple):
    """Crane and load in motion.

    Parameters
    ----------
    tension : number
        Force of the rope [N].
    power : number
        Of winch, drag, hinge, rope and, on the load, ground [W].
    accelerations : list of n
    turning : list of d
        Second derivative of the rope's direction; of an elastic rope the acceleration of what it carries. Those of
        the slings' directions follow.
    direction, hinge, suspension : list of d
        Unit vector from D to the load, hinge force on the load, acceleration of D with that of the ground.
    guards : list
        Tensions of slings [N]; of the ground, if there is any; of an elastic rope: how far it is from slack and from
        taut, as strains, and energy stored in it [J].
    """

    tension: Any
    power: Any
    accelerations: list[Any]
    turning: list[Any]
    direction: list[Any]
    hinge: list[Any]
    suspension: list[Any]
    guards: Sequence[Any] = ()

    def pull(self, axis: int) -> Any:
        """Force of rope and hinge on D along an axis."""
        return self.tension * self.direction[axis] - self.hinge[axis]


def state_of(y: Row, coordinates: int, axes: int) -> State:
    """Parts of a state with so many coordinates and axes of space."""
    half, ropes = (len(y) - 1) // 2, coordinates + axes
    places, rates = y[:half], y[half : 2 * half]
    return State(
        places[:coordinates], places[coordinates:ropes], rates[:coordinates], rates[coordinates:ropes],
        places[ropes:], rates[ropes:],
    )  # fmt: skip


def slopes(state: State, hung: Hung, power: Any) -> list[Any]:
    """Derivative of a state, with the power that inputs put in less what is lost [W]."""
    return [*state.rates, *state.swing, *state.slings_swing, *hung.accelerations, *hung.turning, power]

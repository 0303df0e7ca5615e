"""What hangs on a rope: the load with its losses, hook and slings, what of it lets go."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from modal.checks import check_fields
from towercrane.kernels.choices import below, choose

if TYPE_CHECKING:
    from collections.abc import Sequence

    from towercrane.kernels.elastic_rope import Elasticity
    from towercrane.kernels.ground import Ground

AIR_DENSITY = 1.225
"""Density of air at 15 degrees Celsius and sea level [kg/m^3] (ISO 2533)."""


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

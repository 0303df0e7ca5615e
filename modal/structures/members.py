"""What a plane structure is made of: segments and rigid bodies on common unknowns."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field, replace
from math import inf, isinf
from typing import TYPE_CHECKING

import numpy as np

from modal.checks import check_positive, number_in

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from modal.beams.beam import EndBody
    from modal.beams.chain import Chain, Foundation, ShearTheory
    from modal.beams.segment import Segment

    Floats = NDArray[np.float64]
    Points = defaultdict[tuple[int, int], float]

HELD = -1
"""Unknown of an end that does not move."""

POINTS = "springs", "geometric", "bodies"
"""What a structure has on its unknowns besides its members."""


class Unstable(ValueError):
    """The structure cannot carry its weights and loads: it buckles under a part of them."""


class FewModes(ValueError):
    """More modes are asked for than there are below the frequency of masses on a flexibility of their own."""


@dataclass(frozen=True, eq=False)
class Member:
    """A segment between two nodes of a structure.

    Parameters
    ----------
    segment : Segment
    unknowns : tuple of int
        Unknowns that deflection and rotation at the near and at the far end follow; `HELD` where they are held.
    factors : tuple of float
        By which to multiply them.
    compression : float
        Axial force at the far end [N].
    gravity : float
        Acceleration of gravity along the segment towards its near end [m/s^2]: its own weight compresses it.
    part : str
        Chain that the segment belongs to: "tower", "jib", "counter-jib".
    position : float
        Distance of the near end from that chain's foot [m].
    """

    segment: Segment
    unknowns: tuple[int, int, int, int]
    factors: tuple[float, float, float, float] = (1.0, 1.0, 1.0, 1.0)
    compression: float = 0.0
    gravity: float = 0.0
    part: str = "tower"
    position: float = 0.0

    def split(self, distance: float, first: int) -> tuple[Member, Member]:
        """The same member as two, cut at a distance from its near end [m], on the unknowns ``first`` and the next."""
        near, far = self.segment.split(distance)
        lower = replace(
            self,
            segment=near,
            unknowns=(self.unknowns[0], self.unknowns[1], first, first + 1),
            factors=(self.factors[0], self.factors[1], 1.0, 1.0),
            compression=self.compression + self.gravity * far.mass,
        )
        upper = replace(
            self,
            segment=far,
            unknowns=(first, first + 1, self.unknowns[2], self.unknowns[3]),
            factors=(1.0, 1.0, self.factors[2], self.factors[3]),
            position=self.position + near.length,
        )
        return lower, upper

    def cut(self, parts: int, first: int, spread: float = 0.0) -> list[Member]:
        """The same member as several, on new unknowns from ``first`` on.

        The parts are alternately shorter and longer than their mean by ``spread`` times it.
        """
        members, rest = [], self
        lengths = self.segment.length / parts * (1.0 + spread * (-1.0) ** np.arange(1, parts + 1))
        for i in range(parts - 1):
            near, rest = rest.split(float(lengths[i]), first + 2 * i)
            members.append(near)
        return [*members, rest]


@dataclass(eq=False)
class Members:
    """Segments and bodies on common unknowns.

    Parameters
    ----------
    unknowns : tuple of str
        Unit of every unknown, "m" for deflections and "rad" for rotations.
    members : list of Member
    shear_theory : {"haringx", "engesser"}
        See `modal.beams.chain.Chain`.

    Attributes
    ----------
    springs, geometric, bodies : dict of (int, int) to float
        Entries of symmetric matrices on the unknowns, those that are not zero: stiffness of springs [N/m, N, N m],
        geometric stiffness of bodies' weights, mass matrix of bodies.
    """

    unknowns: tuple[str, ...]
    members: list[Member] = field(default_factory=list)
    shear_theory: ShearTheory = "haringx"

    def __post_init__(self) -> None:
        self.springs: Points = defaultdict(float)
        self.geometric: Points = defaultdict(float)
        self.bodies: Points = defaultdict(float)

    def add_unknown(self, unit: str, stiffness: float = 0.0) -> int:
        """A further unknown on a spring to the ground; `HELD` where that is infinitely stiff."""
        if isinf(number_in("stiffness", stiffness, "zero or more", least=0.0, most=inf)):
            return HELD
        number = len(self.unknowns)
        self.unknowns += (unit,)
        if stiffness:
            self.springs[number, number] = stiffness
        return number

    def add_foundation(self, foundation: Foundation) -> tuple[int, int]:
        """Deflection and rotation of a foot on its springs, `HELD` where it is held."""
        springs = (("m", foundation.translation_stiffness), ("rad", foundation.rotation_stiffness))
        deflection, rotation = (self.add_unknown(unit, stiffness) for unit, stiffness in springs)
        if foundation.coupling:
            self.springs[deflection, rotation] = self.springs[rotation, deflection] = foundation.coupling
        return deflection, rotation

    def add_chain(
        self, chain: Chain, foot: tuple[int, int], factors: tuple[float, float] = (1.0, 1.0), part: str = "tower"
    ) -> tuple[int, int]:
        """Put a chain with its bodies and collars on two unknowns, times factors, that move its foot; its end's
        unknowns."""
        near, position = foot, 0.0
        nodes = [foot]
        for segment, (_, above) in zip(chain.segments, chain.end_compressions(), strict=True):
            far = self.add_unknown("m"), self.add_unknown("rad")
            member = Member(segment, (*near, *far), (*factors, 1.0, 1.0), above, chain.gravity, part, position)
            self.members.append(member)
            near, factors, position = far, (1.0, 1.0), position + segment.length
            nodes.append(far)
        for node, body in chain.bodies.items():
            self.add_body(body, *nodes[node], chain.gravity * body.mass)
        for node, collar in chain.collars.items():
            for unknown, stiffness in zip(nodes[node], (collar.stiffness, collar.rotation_stiffness), strict=True):
                if stiffness:
                    self.springs[unknown, unknown] += stiffness
        return near

    def add_body(self, body: EndBody, deflection: int, rotation: int, weight: float = 0.0) -> None:
        """Put a rigid body on a node; its weight [N] topples it where it stands above the node."""
        arm = body.offset
        entries = {
            (deflection, deflection): body.mass,
            (deflection, rotation): body.mass * arm,
            (rotation, deflection): body.mass * arm,
            (rotation, rotation): body.rotary_inertia + body.mass * arm**2,
        }
        for (i, j), value in entries.items():
            if i != HELD and j != HELD and value:
                self.bodies[i, j] += value
        if rotation != HELD and weight * arm:
            self.geometric[rotation, rotation] += weight * arm

    def add_pendulum(self, stiffness: float, mass: float, suspension: int, load: int) -> None:
        """Hang a load, which is an unknown of its own, from an unknown."""
        check_positive("stiffness", stiffness)
        check_positive("mass", mass)
        for i, j, sign in (
            (suspension, suspension, 1),
            (load, load, 1),
            (suspension, load, -1),
            (load, suspension, -1),
        ):
            self.springs[i, j] += sign * stiffness
        self.bodies[load, load] += mass

    @property
    def mass_frequency(self) -> float:
        """Angular frequency that no mode of bending reaches [rad/s], see `modal.beams.segment.Segment`."""
        return min(member.segment.mass_frequency for member in self.members)

    @property
    def is_loaded(self) -> bool:
        """Whether there is any weight or axial load that a factor could raise."""
        return bool(self.geometric) or any(member.compression or member.gravity for member in self.members)

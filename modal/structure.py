"""Plane structure of segments and rigid bodies: exact natural frequencies, critical loads and mode shapes."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from math import inf, isinf, sqrt
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from modal.beam import EndBody
    from modal.chain import Chain, ShearTheory
    from modal.segment import Segment

    Floats = NDArray[np.float64]

LONGEST = 5
"""Pieces, see `modal.stiffness`, that a member may have without a node of its own; each is some 1.7 rad of wave."""

HELD = -1
"""Unknown of an end that does not move."""


class Unstable(ValueError):
    """The structure cannot carry its weights and loads: it buckles under a part of them."""


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
        Axial force at the near end [N].
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

    def cut(self, parts: int, first: int, spread: float = 0.0) -> list[Member]:
        """The same member as several, on new unknowns from ``first`` on.

        The parts are alternately shorter and longer than their mean by ``spread`` times it.
        """
        members, rest = [], self
        lengths = self.segment.length / parts * (1.0 + spread * (-1.0) ** np.arange(1, parts + 1))
        for i in range(parts - 1):
            near, far = rest.segment.split(float(lengths[i]))
            node = (first + 2 * i, first + 2 * i + 1)
            members.append(
                replace(
                    rest,
                    segment=near,
                    unknowns=(rest.unknowns[0], rest.unknowns[1], *node),
                    factors=(rest.factors[0], rest.factors[1], 1.0, 1.0),
                )
            )
            rest = replace(
                rest,
                segment=far,
                unknowns=(*node, rest.unknowns[2], rest.unknowns[3]),
                factors=(1.0, 1.0, rest.factors[2], rest.factors[3]),
                compression=rest.compression - rest.gravity * near.mass,
                position=rest.position + near.length,
            )
        return [*members, rest]


@dataclass(eq=False)
class Structure:
    """Segments and bodies on common unknowns; made by `chain_structure` or `modal.crane_frame.crane_structure`.

    Parameters
    ----------
    unknowns : tuple of str
        Unit of every unknown, "m" for deflections and "rad" for rotations.
    members : list of Member
    shear_theory : {"haringx", "engesser"}
        See `modal.chain.Chain`.

    Attributes
    ----------
    springs, geometric, bodies : ndarray, shape (n, n)
        Stiffness of springs [N/m, N, N m], geometric stiffness of bodies' weights, mass matrix of bodies.
    """

    unknowns: tuple[str, ...]
    members: list[Member] = field(default_factory=list)
    shear_theory: ShearTheory = "haringx"

    def __post_init__(self) -> None:
        n = len(self.unknowns)
        self.springs, self.geometric, self.bodies = np.zeros((n, n)), np.zeros((n, n)), np.zeros((n, n))

    def add_unknown(self, unit: str, stiffness: float = 0.0) -> int:
        """A further unknown on a spring to the ground; `HELD` where that is infinitely stiff."""
        if isinf(stiffness):
            return HELD
        self.unknowns += (unit,)
        for name in ("springs", "geometric", "bodies"):
            setattr(self, name, np.pad(getattr(self, name), (0, 1)))
        self.springs[-1, -1] = stiffness
        return len(self.unknowns) - 1

    def add_chain(
        self, chain: Chain, foot: tuple[int, int], factors: tuple[float, float] = (1.0, 1.0), part: str = "tower"
    ) -> tuple[int, int]:
        """Put a chain with its bodies on two unknowns, times factors, that move its foot; its end's unknowns."""
        near, position = foot, 0.0
        nodes = [foot]
        for segment, (below, _) in zip(chain.segments, chain.end_compressions(), strict=True):
            far = self.add_unknown("m"), self.add_unknown("rad")
            member = Member(segment, (*near, *far), (*factors, 1.0, 1.0), below, chain.gravity, part, position)
            self.members.append(member)
            near, factors, position = far, (1.0, 1.0), position + segment.length
            nodes.append(far)
        for node, body in chain.bodies.items():
            self.add_body(body, *nodes[node], chain.gravity * body.mass)
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
            if i != HELD and j != HELD:
                self.bodies[i, j] += value
        if rotation != HELD:
            self.geometric[rotation, rotation] += weight * arm

    def add_pendulum(self, stiffness: float, mass: float, suspension: int, load: int) -> None:
        """Hang a load, which is an unknown of its own, from an unknown."""
        for i, j, sign in (
            (suspension, suspension, 1),
            (load, load, 1),
            (suspension, load, -1),
            (load, suspension, -1),
        ):
            self.springs[i, j] += sign * stiffness
        self.bodies[load, load] += mass

    @cached_property
    def units(self) -> tuple[float, float, float]:
        """Length [m], force [N] and circular frequency [rad/s] that numbers are counted in."""
        segments = [member.segment for member in self.members]
        length = max(segment.length for segment in segments)
        bending = max(segment.bending_stiffness for segment in segments)
        mass = max(segment.mass_per_length for segment in segments)
        return length, bending / length**2, sqrt(bending / mass) / length**2

    @cached_property
    def arrays(self) -> tuple[Floats, NDArray[np.int64], Floats, Floats]:
        """The structure as `modal.structure_kernel` takes it, in the units of `units`."""
        length, force, frequency = self.units
        mass = force / (length * frequency**2)
        rows = []
        for member in self.members:
            s = member.segment
            flexibility = 0.0 if isinf(s.shear_stiffness) else force / s.shear_stiffness
            rows.append(
                [
                    s.length / length, s.mass_per_length * length / mass, s.bending_stiffness / (force * length**2),
                    flexibility, s.rotary_inertia / (mass * length), s.end_ratio,
                    s.mass_power, s.bending_power, s.shear_power,
                    member.compression / force, member.gravity * mass / force, float(self.shear_theory == "engesser"),
                ]
            )  # fmt: skip
        # A rotation counts as it is, a deflection in units of length.
        size = np.array([length if unit == "m" else 1.0 for unit in self.unknowns])
        product = np.outer(size, size)
        energy = force * length
        points = np.array([self.springs, self.geometric, self.bodies * frequency**2]) * product / energy
        unknowns = np.array([member.unknowns for member in self.members], dtype=np.int64).reshape(-1, 4)
        factors = np.array([member.factors for member in self.members]).reshape(-1, 4)
        return np.array(rows), unknowns, factors, np.ascontiguousarray(points)

    def count_below(self, angular_frequency: float) -> int:
        """Number of natural frequencies below one [rad/s], each with its multiplicity."""
        return self._count((angular_frequency / self.units[2]) ** 2, 1.0)

    def _count(self, omega2: float, load: float) -> int:
        from modal.structure_kernel import dynamic_stiffness

        n = len(self.unknowns)
        static, matrix = np.zeros((n, n)), np.zeros((n, n))
        dynamic_stiffness(0.0, 0.0, *self.arrays, static)
        inside = dynamic_stiffness(omega2, load, *self.arrays, matrix)
        _, geometric, bodies = self.arrays[-1]
        # Heavy bodies are scaled down, or their rounding errors would drown light ones.
        scale = 1.0 / np.sqrt(np.diag(static) + load * np.abs(np.diag(geometric)) + omega2 * np.diag(bodies))
        return int(inside) + int((np.linalg.eigvalsh(matrix * np.outer(scale, scale)) < 0.0).sum())

    def angular_frequencies(self, count: int) -> Floats:
        """Lowest natural angular frequencies [rad/s], ascending, each as often as it is one; shape (count,).

        Raises
        ------
        ValueError
            If the count is negative.
        Unstable
            If the structure buckles under its weights and loads.
        """
        from modal.structure_kernel import find_roots

        if count < 0:
            raise ValueError(f"count: wanted zero or more, got {count!r}")
        if self._count(0.0, 1.0) > 0:
            raise Unstable(f"the structure carries only {self.buckling_factor():.4g} times its weights and loads")
        highest = 1.0
        while self._count(highest**2, 1.0) < count:
            highest *= 2.0
        roots = np.zeros(count)
        find_roots(*self.refined(highest * self.units[2]).arrays, False, 1.0, inf, roots)
        return roots * self.units[2]

    def refined(self, angular_frequency: float) -> Structure:
        """The same structure with nodes inside members that are long for the waves at a frequency [rad/s].

        Between its ends a long member has fixed-end frequencies exponentially close to natural ones of the structure,
        and its condensed stiffness no longer tells one from the other: e^x digits are lost, x the length in waves.
        """
        from modal.structure_kernel import piece_ends

        fine = Structure(self.unknowns, shear_theory=self.shear_theory)
        omega2, none = (angular_frequency / self.units[2]) ** 2, np.empty(1)
        for member, row in zip(self.members, self.arrays[0], strict=True):
            parts = -(-piece_ends(row, omega2, 1.0, none) // LONGEST)
            # Equal ones would all have the same fixed-end frequencies.
            fine.members += member.cut(parts, len(fine.unknowns), spread=0.1)
            fine.unknowns += ("m", "rad") * (parts - 1)
        extra = len(fine.unknowns) - len(self.unknowns)
        for name in ("springs", "geometric", "bodies"):
            setattr(fine, name, np.pad(getattr(self, name), (0, extra)))
        # The same units, so that roots can be compared.
        fine.__dict__["units"] = self.units
        return fine

    def buckling_factor(self) -> float:
        """Factor on all weights and axial loads at which the structure buckles [1]; ``inf``: it never does."""
        from modal.structure_kernel import find_roots

        roots = np.zeros(1)
        return float(roots[0]) if find_roots(*self.arrays, True, 1.0, 1e9, roots) else inf


def chain_structure(chain: Chain) -> Structure:
    """A chain as a structure.

    The unknowns are deflection and rotation of every node that can move, from the foot up, then the load's motion.
    """
    foot = chain.foundation
    stiffnesses = foot.translation_stiffness, foot.rotation_stiffness
    structure = Structure((), shear_theory=chain.shear_theory)
    springs = [structure.add_unknown(unit, k) for unit, k in zip(("m", "rad"), stiffnesses, strict=True)]
    end = structure.add_chain(chain, (springs[0], springs[1]))
    if chain.pendulum is not None:
        load = structure.add_unknown("m")
        structure.add_pendulum(chain.pendulum.stiffness, chain.pendulum.mass, end[0], load)
    return structure


def chain_frequencies(chain: Chain, count: int) -> Floats:
    """Lowest natural angular frequencies of a chain [rad/s], exact but for rounding; shape (count,).

    Raises
    ------
    ValueError
        If the count is negative.
    Unstable
        If the chain buckles under its weights and loads.
    """
    return chain_structure(chain).angular_frequencies(count)

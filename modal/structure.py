"""Plane structure of segments and rigid bodies: exact natural frequencies, critical loads and mode shapes."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from math import inf, isinf, sqrt
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from modal.beam import EndBody
    from modal.chain import Chain, Segment, ShearTheory

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
    """

    segment: Segment
    unknowns: tuple[int, int, int, int]
    factors: tuple[float, float, float, float] = (1.0, 1.0, 1.0, 1.0)
    compression: float = 0.0
    gravity: float = 0.0

    def cut(self, parts: int, first: int) -> list[Member]:
        """The same member as several, on new unknowns from ``first`` on.

        The parts are alternately a little shorter and longer than their mean: equal ones would all have the same
        fixed-end frequencies.
        """
        members, rest = [], self
        lengths = self.segment.length / parts * (1.0 + 0.1 * (-1.0) ** np.arange(1, parts + 1))
        for i in range(parts - 1):
            near, far = rest.segment.split(float(lengths[i]))
            node = (first + 2 * i, first + 2 * i + 1)
            lower, upper = rest.unknowns[:2], rest.unknowns[2:]
            below, above = rest.factors[:2], rest.factors[2:]
            force = rest.compression - rest.gravity * near.mass
            members.append(Member(near, (*lower, *node), (*below, 1.0, 1.0), rest.compression, self.gravity))
            rest = Member(far, (*node, *upper), (1.0, 1.0, *above), force, self.gravity)
        return [*members, rest]


@dataclass(eq=False)
class Structure:
    """Segments and bodies on common unknowns; made by `chain_structure` or `modal.crane.crane_structure`.

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

        matrix = np.zeros((len(self.unknowns), len(self.unknowns)))
        inside = dynamic_stiffness(omega2, load, *self.arrays, matrix)
        scale = 1.0 / np.sqrt(np.maximum(np.abs(np.diag(matrix)), 1e-300))
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
            fine.members += member.cut(parts, len(fine.unknowns))
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
    held = isinf(foot.translation_stiffness), isinf(foot.rotation_stiffness)
    numbers: list[tuple[int, int]] = []
    units: list[str] = []
    for node in range(len(chain.segments) + 1):
        fixed = held if node == 0 else (False, False)
        numbers.append((HELD if fixed[0] else len(units), HELD if fixed[1] else len(units) + (not fixed[0])))
        units += [unit for unit, still in zip(("m", "rad"), fixed, strict=True) if not still]
    if chain.pendulum is not None:
        units.append("m")
    structure = Structure(tuple(units), shear_theory=chain.shear_theory)
    for k, (segment, (below, _)) in enumerate(zip(chain.segments, chain.end_compressions(), strict=True)):
        ends = (*numbers[k], *numbers[k + 1])
        structure.members.append(Member(segment, ends, compression=below, gravity=chain.gravity))
    for node, body in chain.bodies.items():
        structure.add_body(body, *numbers[node], chain.gravity * body.mass)
    for unknown, stiffness in zip(numbers[0], (foot.translation_stiffness, foot.rotation_stiffness), strict=True):
        if unknown != HELD:
            structure.springs[unknown, unknown] += stiffness
    if chain.pendulum is not None:
        structure.add_pendulum(chain.pendulum.stiffness, chain.pendulum.mass, numbers[-1][0], len(units) - 1)
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

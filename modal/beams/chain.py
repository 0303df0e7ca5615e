"""Chain: a tower or jib of beam segments one on the other, with what stands, hangs and rests on it; SI units."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from math import inf, sqrt
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np

from modal.checks import SMALLEST, check_fields, is_whole, number_in

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from modal.beams.beam import EndBody
    from modal.beams.segment import Segment

    Floats = NDArray[np.float64]

ShearTheory = Literal["haringx", "engesser"]

_GAUSS_POINTS = 12
"""Enough for any power of the breadth that a section has."""


@dataclass(frozen=True, slots=True)
class Foundation:
    """Springs between the foot of a chain and the ground.

    Parameters
    ----------
    rotation_stiffness : float
        Moment per rotation of the foot [N m/rad]; ``inf`` clamps it.
    translation_stiffness : float
        Force per sideways motion of the foot [N/m]; ``inf`` holds it.
    coupling : float
        Force per rotation of the foot, which is the moment per sideways motion [N]; positive where the ground resists
        sideways motion above the foot. Not zero between two springs alone, and less than the root of their product.

    Raises
    ------
    ValueError
        If a stiffness is not positive, or the coupling leaves a motion of the foot without resistance.
    """

    rotation_stiffness: float = inf
    translation_stiffness: float = inf
    coupling: float = 0.0

    def __post_init__(self) -> None:
        for name in ("rotation_stiffness", "translation_stiffness"):
            number_in(f"Foundation.{name}", getattr(self, name), "a positive number", least=SMALLEST, most=inf)
        number_in("Foundation.coupling", self.coupling, "a finite number")
        limit = self.strongest_coupling
        if self.coupling and not (limit < inf and abs(self.coupling) < limit):
            what = f"less than {limit:g} N, the root of both stiffnesses" if limit < inf else "0 where one is rigid"
            raise ValueError(f"Foundation.coupling: wanted {what}, got {self.coupling!r}")

    @property
    def strongest_coupling(self) -> float:
        """Coupling at which a motion of the foot meets no resistance [N]."""
        return sqrt(self.translation_stiffness * self.rotation_stiffness)


@dataclass(frozen=True, slots=True)
class Collar:
    """Springs between a node of a chain and a building that it is tied to.

    Parameters
    ----------
    stiffness : float
        Force per sideways motion of the chain against the building [N/m].
    rotation_stiffness : float
        Moment per rotation of the section, which with shear strain is not the slope [N m/rad].

    Raises
    ------
    ValueError
        If a stiffness is negative or not finite.
    """

    stiffness: float
    rotation_stiffness: float = 0.0

    def __post_init__(self) -> None:
        check_fields(self, not_negative=self.__slots__)


@dataclass(frozen=True, slots=True)
class Pendulum:
    """Load on a rope that hangs from the end of a chain and swings across it.

    Parameters
    ----------
    mass : float
        Mass of the load [kg].
    rope_length : float
        Length of the rope [m].
    gravity : float
        Acceleration of gravity [m/s^2].

    Raises
    ------
    ValueError
        If a value is not a positive finite number.
    """

    mass: float
    rope_length: float
    gravity: float = 9.81

    def __post_init__(self) -> None:
        check_fields(self, positive=self.__slots__)

    @property
    def stiffness(self) -> float:
        """Horizontal force per horizontal distance between load and suspension [N/m]."""
        return self.mass * self.gravity / self.rope_length


@dataclass(frozen=True, slots=True)
class Chain:
    """Segments end to end from the foot up, in one plane of bending.

    Parameters
    ----------
    segments : tuple of Segment
        From the foot to the end; at least one.
    bodies : dict of int to EndBody
        Rigid bodies by node: 0 is the foot, n the end of the n-th segment. Their offset counts along the chain.
    foundation : Foundation
        What the foot stands on; clamped by default.
    axial_load : float
        Compression at the end of the chain, besides the weights [N]; negative: tension.
    gravity : float
        Acceleration that gives segments and bodies their weight, which compresses what is below [m/s^2];
        0: weight softens nothing.
    pendulum : Pendulum, optional
        Load that hangs from the end; its weight compresses the chain where `gravity` is not zero.
    shear_theory : {"haringx", "engesser"}
        Whether the axial force acts normal to the section or along the deflected axis; they differ only where
        there is both shear strain and axial force.
    collars : dict of int to Collar
        What ties the chain to a building, by node above the foot.

    Raises
    ------
    ValueError
        If there is no segment, the node of a body or collar does not exist, a body is infinite, or a number is out of
        range.
    """

    segments: tuple[Segment, ...]
    bodies: dict[int, EndBody] = field(default_factory=dict)
    foundation: Foundation = Foundation()
    axial_load: float = 0.0
    gravity: float = 0.0
    pendulum: Pendulum | None = None
    shear_theory: ShearTheory = "haringx"
    collars: dict[int, Collar] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if not self.segments:
            raise ValueError("Chain.segments: wanted at least one, got none")
        for node, body in self.bodies.items():
            if not is_whole(node) or not 0 <= node <= len(self.segments):
                raise ValueError(f"Chain.bodies: wanted nodes 0 to {len(self.segments)}, got {node!r}")
            if not (body.mass < inf and body.rotary_inertia < inf):
                raise ValueError(f"Chain.bodies[{node}]: wanted finite mass and inertia, got {body!r}")
        for node in self.collars:
            if not is_whole(node) or not 1 <= node <= len(self.segments):
                raise ValueError(f"Chain.collars: wanted nodes 1 to {len(self.segments)}, got {node!r}")
        number_in("Chain.axial_load", self.axial_load, "a finite number")
        check_fields(self, not_negative=("gravity",))
        if self.shear_theory not in get_args(ShearTheory):
            raise ValueError(f"Chain.shear_theory: wanted one of {get_args(ShearTheory)}, got {self.shear_theory!r}")

    @property
    def length(self) -> float:
        """Length of all segments together [m]."""
        return sum(segment.length for segment in self.segments)

    @property
    def mass(self) -> float:
        """Mass of all segments together, without bodies [kg]."""
        return sum(segment.mass for segment in self.segments)

    @property
    def nodes(self) -> tuple[float, ...]:
        """Positions of the nodes, from 0 to the length [m]."""
        positions = [0.0]
        for segment in self.segments:
            positions.append(positions[-1] + segment.length)
        return tuple(positions)

    @property
    def inertia(self) -> tuple[float, float, float, float]:
        """Mass [kg], sums of m x [kg m] and m x^2 [kg m^2] from the foot, and own rotary inertia; bodies included."""
        mass = first = second = rotary = 0.0
        points, weights = np.polynomial.legendre.leggauss(_GAUSS_POINTS)
        for segment, near in zip(self.segments, self.nodes[:-1], strict=True):
            distance = 0.5 * segment.length * (points + 1.0)
            weight = 0.5 * segment.length * weights
            moving = weight * segment.section("mass_per_length", distance)
            mass += segment.mass
            first += float(moving @ (near + distance))
            second += float(moving @ (near + distance) ** 2)
            rotary += float(weight @ segment.section("rotary_inertia", distance))
        for node, body in self.bodies.items():
            place = self.nodes[node] + body.offset
            mass, first, second = mass + body.mass, first + body.mass * place, second + body.mass * place**2
            rotary += body.rotary_inertia
        return mass, first, second, rotary

    def with_node(self, position: float) -> tuple[Chain, int]:
        """The same chain with a node at a position [m], and that node's number.

        Raises
        ------
        ValueError
            If the position is off the chain.
        """
        nodes = self.nodes
        number_in("position", position, f"0 to {nodes[-1]!r} m", least=0.0, most=nodes[-1])
        nearest = min(range(len(nodes)), key=lambda node: abs(nodes[node] - position))
        # A piece far shorter than all else would only cost digits.
        if abs(nodes[nearest] - position) < 1e-9 * nodes[-1]:
            return self, nearest
        before = sum(node < position for node in nodes) - 1
        pieces = self.segments[before].split(position - nodes[before])
        segments = (*self.segments[:before], *pieces, *self.segments[before + 1 :])
        bodies = {node + (node > before): body for node, body in self.bodies.items()}
        collars = {node + (node > before): collar for node, collar in self.collars.items()}
        return replace(self, segments=segments, bodies=bodies, collars=collars), before + 1

    def end_compressions(self) -> list[tuple[float, float]]:
        """Axial force at the near and the far end of each segment, compression positive [N]."""
        above = self.axial_load
        if self.pendulum is not None:
            above += self.gravity * self.pendulum.mass
        forces = []
        for k in range(len(self.segments), 0, -1):
            if k in self.bodies:
                above += self.gravity * self.bodies[k].mass
            below = above + self.gravity * self.segments[k - 1].mass
            forces.append((below, above))
            above = below
        return forces[::-1]

    def compression(self, positions: Floats) -> Floats:
        """Axial force at positions along the chain, compression positive [N]; at a node, that above it."""
        segment = self._segment_at(positions)
        below = np.array([force for force, _ in self.end_compressions()])[segment]
        passed = self._each(positions, lambda one, distance: one.mass_within(distance))
        return below - self.gravity * passed

    def section(self, positions: Floats, name: str) -> Floats:
        """A property of the section, by the name of the segments' field, at positions along the chain."""
        return self._each(positions, lambda one, distance: one.section(name, distance))

    def incline(self, positions: Floats) -> Floats:
        """What couples bending and shear, of inclined chords and of parallel diagonals, at positions [1/m]."""
        return self._each(
            positions,
            lambda one, distance: (
                one.coupling + one.inclined_chords * (one.end_ratio - 1.0) / (one.length * one.breadth(distance))
            ),
        )

    def _segment_at(self, positions: Floats) -> NDArray[np.intp]:
        inner = np.searchsorted(self.nodes, positions, side="right") - 1
        return np.clip(inner, 0, len(self.segments) - 1)

    def _each(self, positions: Floats, value: Callable[[Segment, Floats], Floats]) -> Floats:
        """A value that depends on the segment and the distance from its near end."""
        at, values = self._segment_at(positions), np.zeros_like(positions)
        for k, (segment, near) in enumerate(zip(self.segments, self.nodes[:-1], strict=True)):
            values[at == k] = value(segment, positions[at == k] - near)
        return values

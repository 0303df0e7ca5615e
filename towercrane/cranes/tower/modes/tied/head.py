"""Sums over the mass of all that is on a head with tie bars, and how its coordinates move the ties' ends."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from modal.structures.part_shapes import SLOPE

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from modal.structures.chain_modes import ChainModes
    from towercrane.cranes.tower.modes.mass_sums import MassSums
    from towercrane.cranes.tower.modes.tied.bars import TieBars

    Floats = NDArray[np.float64]

POINTS = 40
"""Of the quadrature along a tie or the cat-head: exact to rounding."""


@dataclass(frozen=True, eq=False)
class FieldSums:
    """Sums over points at s0 + sum psi_i q_i in the axes of the head, for n coordinates.

    Parameters
    ----------
    mass : float
    first, inertia : ndarray, shapes (3,), (3, 3)
        int s0, and the tensor of inertia.
    momentum, spun : ndarray, shape (n, 3)
        int psi_i, and moment of momentum of sections that turn about their own axes.
    moved, products : ndarray, shapes (n, 3, 3), (n, n, 3, 3)
        int psi_i s0^T and int psi_i psi_j^T.
    """

    mass: float
    first: Floats
    inertia: Floats
    momentum: Floats
    spun: Floats
    moved: Floats
    products: Floats

    def __add__(self, other: FieldSums) -> FieldSums:
        return FieldSums(*(getattr(self, name) + getattr(other, name) for name in self.__dataclass_fields__))


def sums_of_points(places: Floats, fields: Floats, masses: Floats) -> FieldSums:
    """Sums over points of mass; shapes (p, 3), (n, p, 3), (p,)."""
    crossed = np.einsum("pa,p,pb->ab", places, masses, places)
    return FieldSums(
        float(masses.sum()),
        masses @ places,
        np.trace(crossed) * np.eye(3) - crossed,
        np.einsum("ipa,p->ia", fields, masses),
        np.zeros((len(fields), 3)),
        np.einsum("ipa,p,pb->iab", fields, masses, places),
        np.einsum("ipa,p,jpb->ijab", fields, masses, fields),
    )


def sums_on_axis(sums: MassSums, lateral: int, count: int) -> FieldSums:
    """Sums over mass on the axis that moves across it, the first shapes to the left; among ``count`` coordinates."""
    shapes = len(sums.first)
    axes = np.where(np.arange(shapes) < lateral, 1, 2)
    units = np.eye(3)[axes]
    momentum, spun, moved = np.zeros((count, 3)), np.zeros((count, 3)), np.zeros((count, 3, 3))
    momentum[:shapes] = sums.first[:, None] * units
    # A section that bends to the left turns about e3, one that bends up about -e2.
    spun[:shapes] = sums.turned[:, None] * np.where(axes == 1, 1.0, -1.0)[:, None] * np.eye(3)[3 - axes]
    moved[:shapes, :, 0] = sums.second[:, None] * units
    products = np.zeros((count, count, 3, 3))
    products[:shapes, :shapes] = np.einsum("ij,ia,jb->ijab", sums.products, units, units)
    tensor = np.diag([sums.roll, sums.pitch, sums.yaw])
    return FieldSums(sums.mass, np.array([sums.moment, 0.0, 0.0]), tensor, momentum, spun, moved, products)


@dataclass(frozen=True, eq=False)
class TiedHead:
    """Cat-head and ties in shapes: coordinates are those of the jibs in their groups, of the cat-head, and of each
    tie its sag and, out of the plane, its bow to the left.

    Parameters
    ----------
    bars : TieBars
    groups : tuple of 4 ChainModes
        Of jib and counter-jib to the left, then up.
    column : ChainModes
        Of the cat-head, forward.
    sideways : bool
        Whether ties bow out of the plane.
    """

    bars: TieBars
    groups: tuple[ChainModes, ChainModes, ChainModes, ChainModes]
    column: ChainModes
    sideways: bool

    @property
    def counts(self) -> tuple[int, ...]:
        """How many coordinates each group, the column, and the ties down and to the left have."""
        ties = len(self.bars.ties)
        return (*(own.count for own in self.groups), self.column.count, ties, ties * self.sideways)

    @property
    def bows(self) -> Floats:
        """Zero for each bow of a tie: the stiffness of none follows from its own shape; shape (bows,)."""
        return np.zeros(sum(self.counts[5:]))

    @property
    def count(self) -> int:
        """All of them."""
        return sum(self.counts)

    @property
    def lengths(self) -> Floats:
        """Of the straight ties [m], shape (ties,)."""
        return np.asarray(np.hypot(*self.bars.spans.T))

    @property
    def sagging(self) -> Floats:
        """Unit vectors across the straight ties, down, shape (ties, 3)."""
        x, z = self.bars.spans.T / self.lengths
        return np.stack([np.sign(x) * z, 0.0 * x, -abs(x)], axis=1)

    @property
    def masses(self) -> Floats:
        """Of the ties [kg], shape (ties,)."""
        return self.lengths * [tie.mass_per_length for tie in self.bars.ties]

    def part(self, group: int) -> slice:
        """Which of the coordinates are a group's."""
        ends = np.cumsum([0, *self.counts])
        return slice(int(ends[group]), int(ends[group + 1]))

    def ends(self) -> tuple[Floats, Floats]:
        """What each coordinate moves the upper and the lower end of each tie, shapes (ties, n, 3)."""
        ties = len(self.bars.ties)
        upper, lower = np.zeros((2, ties, self.count, 3))
        upper[:, self.part(4), 0] = self.column(self.bars.head.height)
        for k, (side, tie) in enumerate(zip(self.bars.sides, self.bars.ties, strict=True)):
            left, up = self._members(side)
            lower[k, self.part(left), 1] = self.groups[left](tie.position)
            lower[k, self.part(up), 2] = self.groups[up](tie.position)
            lower[k, self.part(up), 0] = -side * tie.height * self.groups[up].rotation(tie.position)
        return upper, lower

    def bowing(self) -> tuple[Floats, Floats]:
        """Second derivatives of the way from the upper to the lower end, forward and up; shapes (ties, n, n).

        The end above the jib nears the foot as the jib is bowed, and sinks as it turns; the column's top sinks.
        """
        ties = len(self.bars.ties)
        along, across = np.zeros((2, ties, self.count, self.count))
        column = self.part(4)
        across[:, column, column] = _slopes(self.column, self.bars.head.height)
        for k, (side, tie) in enumerate(zip(self.bars.sides, self.bars.ties, strict=True)):
            for group in self._members(side):
                own = self.part(group)
                along[k, own, own] = -side * _slopes(self.groups[group], tie.position)
            turned = self.groups[group].rotation(tie.position)
            across[k, own, own] = -tie.height * np.outer(turned, turned)
        return along, across

    def sums(self, slewing: MassSums) -> FieldSums:
        """Sums over all that turns, of which jibs, ballast and what is on the axis are given."""
        lateral = self.groups[0].count + self.groups[1].count
        points, weights = np.polynomial.legendre.leggauss(POINTS)
        part, weights = 0.5 * (points + 1.0), 0.5 * weights
        height, none = self.bars.head.height, np.zeros(POINTS)
        fields = np.zeros((self.count, POINTS, 3))
        fields[self.part(4), :, 0] = self.column(height * part)
        places = np.stack([none, none, height * part], axis=1)
        found = sums_on_axis(slewing, lateral, self.count)
        found = found + sums_of_points(places, fields, self.bars.head.mass_per_length * height * weights)
        for k, mass in enumerate(self.masses):
            found = found + sums_of_points(*self.points(k, part), mass * weights)
        return found

    def points(self, k: int, part: Floats) -> tuple[Floats, Floats]:
        """Places on the k-th straight tie, by parts of it from its upper end, and what each coordinate moves them.

        Shapes (p, 3) and (n, p, 3).
        """
        upper, lower = (ends[k] for ends in self.ends())
        fields = upper[:, None] * (1.0 - part)[:, None] + lower[:, None] * part[:, None]
        for group, direction in ((5, self.sagging[k]), (6, (0.0, 1.0, 0.0))):
            if self.counts[group]:
                fields[self.part(group).start + k] = np.outer(np.sin(np.pi * part), direction)
        x, z = self.bars.spans[k]
        return np.stack([part * x, 0.0 * part, self.bars.head.height + part * z], axis=1), fields

    def lines(self, moved: Floats) -> dict[str, tuple[Floats, Floats]]:
        """Cat-head and ties in the head's axes, moved and straight, shapes (f, p, 3) and (1, p, 3).

        Parameters
        ----------
        moved : ndarray, shape (f, n)
            Coordinates.
        """
        part, height = np.linspace(0.0, 1.0, POINTS), self.bars.head.height
        up = np.stack([0.0 * part, 0.0 * part, height * part], axis=1)
        forward = moved[:, self.part(4)] @ self.column(height * part)
        found = {"cat-head": (up + forward[..., None] * [1.0, 0.0, 0.0], up[None])}
        for k, (upper, lower) in enumerate(zip(*self.ends(), strict=True)):
            x, z = self.bars.spans[k]
            straight = np.stack([part * x, 0.0 * part, height + part * z], axis=1)
            ends = (moved @ upper)[:, None] * (1.0 - part)[:, None] + (moved @ lower)[:, None] * part[:, None]
            for group, direction in ((5, self.sagging[k]), (6, np.array([0.0, 1.0, 0.0]))):
                if self.counts[group]:
                    bow = moved[:, self.part(group).start + k]
                    ends = ends + bow[:, None, None] * np.outer(np.sin(np.pi * part), direction)
            found[f"tie {k + 1}"] = straight + ends, straight[None]
        return found

    @staticmethod
    def _members(side: float) -> tuple[int, int]:
        """Groups of the member on a side: to the left, up."""
        return (0, 2) if side > 0.0 else (1, 3)


def _slopes(basis: ChainModes, length: float) -> Floats:
    """Products of slopes over so much of a member's length, shape (count, count)."""
    shapes = basis.shapes
    return shapes.product(np.where(shapes.points < length, 1.0, 0.0), SLOPE, SLOPE)

"""Frame in space of straight members, pinned or rigidly joined: one element for each member, consistent masses."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from modal.checks import whole_number
from modal.elements.sparse import Entries, factorised, lowest_modes

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Numbers = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class SpaceFrame:
    """Straight members between nodes in space, some of which are held.

    Parameters
    ----------
    nodes : ndarray, shape (n, 3)
        Positions [m].
    members : ndarray of int, shape (m, 2)
        Nodes at both ends.
    axial_stiffnesses : ndarray, shape (m,)
        E A [N].
    masses_per_length : ndarray, shape (m,)
        [kg/m]
    held : ndarray of int
        Nodes that do not move, nor turn.
    bending_stiffnesses, torsional_stiffnesses : ndarray, shape (m,), optional
        E I, alike in all directions, and G J [N m^2] of rigidly joined members; without them all are pinned.
    """

    nodes: Floats
    members: Numbers
    axial_stiffnesses: Floats
    masses_per_length: Floats
    held: Numbers
    bending_stiffnesses: Floats | None = None
    torsional_stiffnesses: Floats | None = None

    @property
    def freedoms(self) -> int:
        """Unknowns of a node: displacements and, of rigid joints, rotations."""
        return 3 if self.bending_stiffnesses is None else 6

    @property
    def mass(self) -> float:
        """Mass of all members [kg]."""
        return float(self.masses_per_length @ self._lengths)

    def moments_of_mass(self) -> Floats:
        """Sum over all mass of its distance along x times its mass matrix for motions of a section, shape (6, 6).

        The motions are those of `modal.elements.space_beam.SpaceBeam`; members count as lines.
        """
        found = np.zeros((6, 6))
        for point, weight in zip(*np.polynomial.legendre.leggauss(2), strict=True):
            x, y, z = (self.nodes[self.members[:, 0]] + 0.5 * (1.0 + point) * self._along).T
            one, none = np.ones_like(x), np.zeros_like(x)
            moved = np.array([
                [one, none, none, none, z, -y], [none, one, none, -z, none, none], [none, none, one, y, none, none],
            ])  # fmt: skip
            mass = 0.5 * weight * self.masses_per_length * self._lengths
            found += np.einsum("aim,ajm,m->ij", moved, moved, mass * x)
        return found

    @cached_property
    def matrices(self) -> tuple[Any, Any]:
        """Stiffness and consistent mass of all unknowns, node by node, sparse, shape (k n, k n)."""
        k, count = self.freedoms, len(self.nodes)
        unknowns = (k * self.members[:, :, np.newaxis] + np.arange(k)).reshape(len(self.members), 2 * k)
        stiffness, mass = self._bars() if k == 3 else self._beams()
        axes = np.zeros((len(self.members), 2 * k, 2 * k))
        for start in range(0, 2 * k, 3):
            axes[:, start : start + 3, start : start + 3] = self._axes
        found = []
        for local in (stiffness, mass):
            entries = Entries()
            turned = axes.transpose(0, 2, 1) @ local @ axes
            entries.add(turned, unknowns, np.ones(unknowns.shape))
            found.append(entries.matrix(k * count))
        return found[0], found[1]

    def displacements(self, forces: Floats) -> Floats:
        """Displacements of the nodes [m] under forces on them [N], shape (..., n, 3).

        Raises
        ------
        ValueError
            If the frame can move without strain.
        """
        k, free = self.freedoms, self._free
        loads = np.zeros((*forces.shape[:-1], k))
        loads[..., :3] = forces
        moved = np.zeros((loads[..., 0, 0].size, k * len(self.nodes)))
        moved[:, free] = self._solve(loads.reshape(moved.shape)[:, free].T).T
        return np.asarray(moved.reshape(loads.shape)[..., :3])

    def modes(self, count: int) -> tuple[Floats, Floats]:
        """Lowest natural angular frequencies [rad/s], and displacements of the nodes in modes of unit mass.

        Ascending; shapes (count,) and (count, n, 3).

        Raises
        ------
        ValueError
            If the count is negative or more than there are, or the frame can move without strain.
        """
        whole_number("count", count)
        k, free = self.freedoms, self._free
        stiffness, mass = (matrix[free][:, free] for matrix in self.matrices)
        values, vectors = lowest_modes(stiffness, mass, count, self._solve)
        shapes = np.zeros((count, k * len(self.nodes)))
        shapes[:, free] = vectors.T.real
        return np.sqrt(values), shapes.reshape(count, -1, k)[..., :3]

    @cached_property
    def _free(self) -> Numbers:
        moves = np.ones(len(self.nodes), dtype=bool)
        moves[self.held] = False
        return np.flatnonzero(np.repeat(moves, self.freedoms))

    @cached_property
    def _solve(self) -> Any:
        solve = factorised(self.matrices[0][self._free][:, self._free])
        if solve is None:
            raise ValueError(
                "frame: wanted members that hold every node, got one that moves without strain; "
                "has a wall of zigzag lacing no posts?"
            )
        return solve

    @cached_property
    def _lengths(self) -> Floats:
        return np.asarray(np.linalg.norm(self._along, axis=1))

    @property
    def _along(self) -> Floats:
        return np.asarray(self.nodes[self.members[:, 1]] - self.nodes[self.members[:, 0]])

    @cached_property
    def _axes(self) -> Floats:
        """Rows: directions of each member and across it, shape (m, 3, 3)."""
        along = self._along / self._lengths[:, np.newaxis]
        aside = np.eye(3)[np.argmin(np.abs(along), axis=1)]
        second = np.cross(along, aside)
        second /= np.linalg.norm(second, axis=1)[:, np.newaxis]
        return np.stack([along, second, np.cross(along, second)], axis=1)

    def _bars(self) -> tuple[Floats, Floats]:
        stiffness = np.zeros((len(self.members), 6, 6))
        spring = self.axial_stiffnesses / self._lengths
        stiffness[:, [0, 3], [0, 3]] = spring[:, np.newaxis]
        stiffness[:, [0, 3], [3, 0]] = -spring[:, np.newaxis]
        even = np.kron([[2.0, 1.0], [1.0, 2.0]], np.eye(3)) / 6.0
        return stiffness, (self.masses_per_length * self._lengths)[:, np.newaxis, np.newaxis] * even

    def _beams(self) -> tuple[Floats, Floats]:
        """Beams without shear strain or rotary inertia; that of torsion counts as of round tubes, 2 I / A."""
        assert self.bending_stiffnesses is not None
        assert self.torsional_stiffnesses is not None
        h = self._lengths
        stiffness, mass = np.zeros((2, len(h), 12, 12))
        bar, even = np.array([[1.0, -1.0], [-1.0, 1.0]]), np.array([[2.0, 1.0], [1.0, 2.0]]) / 6.0
        polar = 2.0 * self.bending_stiffnesses / self.axial_stiffnesses
        for at, stiff, heavy in (
            ([0, 6], self.axial_stiffnesses, 1.0),
            ([3, 9], self.torsional_stiffnesses, polar),
        ):
            stiffness[np.ix_(range(len(h)), at, at)] = _each(stiff / h, bar)
            mass[np.ix_(range(len(h)), at, at)] = _each(heavy * self.masses_per_length * h, even)
        # Deflection along the second axis goes with rotation about the third, along the third against that about the
        # second.
        for at, sign in (([1, 5, 7, 11], 1.0), ([2, 4, 8, 10], -1.0)):
            turn = sign * h
            size = np.stack([np.ones_like(h), turn, np.ones_like(h), turn], axis=1)
            size = size[:, :, np.newaxis] * size[:, np.newaxis, :]
            stiffness[np.ix_(range(len(h)), at, at)] = size * _each(self.bending_stiffnesses / h**3, _HERMITE)
            mass[np.ix_(range(len(h)), at, at)] = size * _each(self.masses_per_length * h / 420.0, _HERMITE_MASS)
        return stiffness, mass


_HERMITE = np.array(
    [[12.0, 6.0, -12.0, 6.0], [6.0, 4.0, -6.0, 2.0], [-12.0, -6.0, 12.0, -6.0], [6.0, 2.0, -6.0, 4.0]]
)
_HERMITE_MASS = np.array(
    [[156.0, 22.0, 54.0, -13.0], [22.0, 4.0, 13.0, -3.0], [54.0, 13.0, 156.0, -22.0], [-13.0, -3.0, -22.0, 4.0]]
)


def _each(factors: Floats, matrix: Floats) -> Floats:
    return factors[:, np.newaxis, np.newaxis] * matrix

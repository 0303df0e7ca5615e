"""Beam in space of any section law: elements whose stiffness and shapes are those of the law, clamped at the root."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from modal.checks import whole_number
from modal.elements.sparse import Entries, factorised, lowest_modes
from modal.structures.members import HELD

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

POINTS, WEIGHTS = np.polynomial.legendre.leggauss(4)
"""Of Gauss on -1 to 1: exact for the products of an element's shapes, polynomials of the third degree."""


@dataclass(frozen=True, eq=False)
class SpaceBeam:
    """Beam along a straight reference line, uniform from piece to piece, clamped at its root.

    A node has the displacements u, v, w of the reference line and the rotations ph, ty, tz of the section, as
    `modal.lattices.section.LatticeSection` has them.

    Parameters
    ----------
    lengths : ndarray, shape (n,)
        Of the elements [m].
    flexibilities : ndarray, shape (n, 6, 6)
        Strains by forces on a section, as `modal.lattices.section.LatticeSection.flexibility`.
    masses : ndarray, shape (n, 6, 6)
        Mass of a section per length for the six motions of a node.
    """

    lengths: Floats
    flexibilities: Floats
    masses: Floats

    @property
    def positions(self) -> Floats:
        """Distances of the nodes but the root from it [m], shape (n,)."""
        return np.cumsum(self.lengths)

    @cached_property
    def matrices(self) -> tuple[Any, Any]:
        """Stiffness and mass of the nodes but the root, sparse, shape (6 n, 6 n).

        An element is a cantilever on its near end, which yields at its far end by what the section forces of a load
        there strain it; moving with its near end it is rigid.
        """
        count = len(self.lengths)
        number = 6 * np.arange(count + 1)[:, np.newaxis] + np.arange(6) - 6
        number[0] = HELD
        unknowns = np.concatenate([number[:-1], number[1:]], axis=1)
        stiffness, mass = np.zeros((2, count, 12, 12))
        for i, (h, law, heavy) in enumerate(zip(self.lengths, self.flexibilities, self.masses, strict=True)):
            whole = _yield(law, h, h)
            # Displacement of the far end beyond the rigid motion of the near one, by all unknowns.
            beyond = np.hstack([-carried(h), np.eye(6)])
            force = np.linalg.solve(whole, beyond)
            stiffness[i] = beyond.T @ force
            for point, weight in zip(POINTS, WEIGHTS, strict=True):
                s = 0.5 * h * (1.0 + point)
                shape = np.hstack([carried(s), np.zeros((6, 6))]) + _yield(law, s, h) @ force
                mass[i] += 0.5 * h * weight * shape.T @ heavy @ shape
        found = []
        for matrices in (stiffness, mass):
            entries = Entries()
            entries.add(matrices, unknowns, np.ones(unknowns.shape))
            found.append(entries.matrix(6 * count))
        return found[0], found[1]

    def motions(self, nodes: Floats, places: Floats) -> Floats:
        """Displacements u, v, w of points that move with the sections between nodes [m].

        Parameters
        ----------
        nodes : ndarray, shape (..., n, 6)
            Motions of the nodes but the root.
        places : ndarray, shape (k, 3)
            Of the points: along the reference line from the root, and in the section [m].

        Returns
        -------
        ndarray, shape (..., k, 3)
        """
        ends = np.concatenate([np.zeros((*nodes.shape[:-2], 1, 6)), nodes], axis=-2)
        lines = np.concatenate([[0.0], self.positions])
        x, y, z = places.T
        after = np.clip(np.searchsorted(lines, x), 1, len(self.lengths))
        part = ((x - lines[after - 1]) / self.lengths[after - 1])[:, np.newaxis]
        u, v, w, ph, ty, tz = np.moveaxis((1.0 - part) * ends[..., after - 1, :] + part * ends[..., after, :], -1, 0)
        return np.stack([u + z * ty - y * tz, v - z * ph, w + y * ph], axis=-1)

    def displacements(self, forces: Floats) -> Floats:
        """Motions of the nodes but the root [m, rad] under forces and moments on them, shape (..., n, 6)."""
        size = 6 * len(self.lengths)
        return np.asarray(self._solve(forces.reshape(-1, size).T).T.reshape(forces.shape))

    def modes(self, count: int) -> tuple[Floats, Floats]:
        """Lowest natural angular frequencies [rad/s], and motions of the nodes but the root in modes of unit mass.

        Shapes (count,) and (count, n, 6).
        """
        whole_number("count", count)
        values, vectors = lowest_modes(*self.matrices, count, self._solve)
        return np.sqrt(values), vectors.T.real.reshape(count, -1, 6)

    @cached_property
    def _solve(self) -> Any:
        solve = factorised(self.matrices[0])
        assert solve is not None, "a beam of sections that hold together is held by its clamp"
        return solve


def carried(s: float) -> Floats:
    """Motion at a distance [m] from a node that moves rigidly, shape (6, 6)."""
    found = np.eye(6)
    found[1, 5], found[2, 4] = s, -s
    return found


def _yield(law: Floats, s: float, length: float) -> Floats:
    """Motion at s by a load at the end of an element that is clamped at its near end, shape (6, 6).

    ``int_0^s carried(s - x) F carried(length - x)^T dx``.
    """
    found = np.zeros((6, 6))
    for point, weight in zip(POINTS, WEIGHTS, strict=True):
        x = 0.5 * s * (1.0 + point)
        found += 0.5 * s * weight * carried(s - x) @ law @ carried(length - x).T
    return found

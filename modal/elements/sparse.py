"""Sparse symmetric matrices of structures: put together, factorised, their lowest modes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from modal.checks import whole_number
from modal.structures.members import HELD

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

ROUNDING = 1e-14
"""What a pivot keeps of its diagonal entry where only rounding keeps it from zero."""

FEW = 16
"""Unknowns of which so few are left over by a search for some modes that all are found at once."""


class Entries:
    """Entries of a sparse matrix, element by element."""

    def __init__(self) -> None:
        self._values: list[Floats] = [np.empty(0)]
        self._rows: list[NDArray[np.int64]] = [np.empty(0, dtype=np.int64)]
        self._columns: list[NDArray[np.int64]] = [np.empty(0, dtype=np.int64)]

    def add(self, matrices: Floats, unknowns: NDArray[np.int64], factors: Floats) -> None:
        """Add element matrices (n, k, k) whose unknowns follow those of the structure (n, k), times factors."""
        scaled = matrices * factors[:, :, np.newaxis] * factors[:, np.newaxis, :]
        i, j = np.broadcast_arrays(unknowns[:, :, np.newaxis], unknowns[:, np.newaxis, :])
        free = (i != HELD) & (j != HELD)
        self._values.append(scaled[free])
        self._rows.append(i[free])
        self._columns.append(j[free])

    def matrix(self, size: int, points: Mapping[tuple[int, int], float] | None = None) -> Any:
        """Sum of all, with single entries besides."""
        from scipy.sparse import coo_array, csc_array

        values, rows, columns = (np.concatenate(part) for part in (self._values, self._rows, self._columns))
        found = csc_array(coo_array((values, (rows, columns)), shape=(size, size)))
        if not points:
            return found
        i, j = np.array(list(points)).T
        return found + csc_array(coo_array((np.array(list(points.values())), (i, j)), shape=(size, size)))


def factorised(matrix: Any) -> Callable[[Any], Any] | None:
    """Solver of a sparse symmetric or Hermitian matrix; None where it is not positive definite beyond rounding."""
    from scipy.sparse import csc_array
    from scipy.sparse.linalg import splu

    # Without a change of rows the pivots have the signs of the eigenvalues.
    options = {"SymmetricMode": True}
    try:
        factor = splu(csc_array(matrix), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
    except RuntimeError:
        return None
    least = np.empty(matrix.shape[0])
    least[factor.perm_c] = ROUNDING * np.abs(matrix.diagonal())
    kept = (factor.perm_r == factor.perm_c).all()
    return factor.solve if kept and (factor.U.diagonal().real > least).all() else None


def lowest_modes(
    stiffness: Any, mass: Any, count: int, solve: Callable[[Any], Any]
) -> tuple[Floats, NDArray[np.inexact[Any]]]:
    """Lowest eigenvalues of a stiffness and a mass matrix and their vectors of unit mass, by inversion.

    Parameters
    ----------
    stiffness, mass : sparse array, shape (n, n)
        Symmetric or Hermitian, positive definite and semidefinite.
    count : int
        Number of eigenvalues, less than the number of unknowns that have mass.
    solve : callable
        Displacements under forces.

    Returns
    -------
    tuple of ndarray, shapes (count,) and (n, count)
        Ascending, in units of stiffness over mass.

    Raises
    ------
    ValueError
        If the count is negative or not less than that.
    """
    from scipy.linalg import eigh
    from scipy.sparse.linalg import LinearOperator, eigsh

    moved = int(np.count_nonzero(mass.diagonal()))
    whole_number("count", count)
    if count >= max(moved, 1):
        raise ValueError(f"count: wanted less than the {moved} unknowns of the mesh that have mass, got {count!r}")
    if count == 0:
        return np.empty(0), np.empty((stiffness.shape[0], 0))
    if count > 0.5 * stiffness.shape[0] or stiffness.shape[0] < FEW:
        values, vectors = eigh(mass.toarray(), stiffness.toarray())
        values, vectors = values[: -count - 1 : -1], vectors[:, : -count - 1 : -1]
        return 1.0 / values, vectors / np.sqrt(values)
    # The inverse makes the lowest eigenvalues the largest and keeps them accurate, where a factorisation of
    # the mass matrix would drown them in the rounding of the highest. A fixed start makes results repeatable.
    inverse = LinearOperator(stiffness.shape, solve, dtype=stiffness.dtype)
    start = np.ones(stiffness.shape[0], dtype=stiffness.dtype)
    values, vectors = eigsh(stiffness, count, mass, sigma=0.0, OPinv=inverse, v0=start)
    order = np.argsort(values)
    return np.asarray(values[order]), np.asarray(vectors[:, order])

"""Sums, products and solutions of small systems, of numbers, arrays of numbers, or operands that record."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce
from itertools import chain
from operator import add
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from towercrane.kernels.straight.graph import graph_of

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable

Vector = tuple[Any, Any, Any]

Row = Sequence[Any] | NDArray[Any]


def dot(a: Collection[Any], b: Collection[Any]) -> Any:
    """Sum of products, from left to right, without those with a number that is zero; zero of nothing."""
    products = [x * y for x, y in zip(a, b, strict=False) if not (_vanishes(x) or _vanishes(y))]
    return reduce(add, products) if products else 0.0


def _vanishes(value: Any) -> bool:
    return isinstance(value, float) and value == 0.0


def form(left: Collection[Any], matrix: Iterable[Any], right: Collection[Any]) -> Any:
    """Bilinear form of two rows of numbers."""
    return dot(left, [dot(row, right) for row in matrix])


def cross(a: Vector, b: Vector) -> Vector:
    """Cross product."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


MOST_UNROLLED = 10
"""Unknowns of the largest system whose solution is written out as straight code; for more it is code with loops."""


def solve(matrix: Sequence[Sequence[Any]], right: Sequence[Any]) -> list[Any]:
    """Solution of a symmetric positive definite system, of which the lower triangle is given, by Cholesky."""
    entries = [*right, *chain.from_iterable(matrix)]
    if len(right) > MOST_UNROLLED and (graph := graph_of(entries)) is not None:
        return graph.solve(entries, len(right))
    return solved(matrix, right)


def solved(matrix: Sequence[Sequence[Any]], right: Sequence[Any]) -> list[Any]:
    """:func:`solve`, operation by operation."""
    factor: list[list[Any]] = []
    found: list[Any] = []
    for i, row in enumerate(matrix):
        own: list[Any] = []
        for j in range(i):
            own.append(_less(row[j], own, factor[j]) * factor[j][j])
        # The inverse of the diagonal is stored: each entry is divided by once and multiplied by often.
        own.append(1.0 / np.sqrt(_less(row[i], own, own)))
        factor.append(own)
        found.append(_less(right[i], own[:i], found) * own[i])
    for i in reversed(range(len(found))):
        column = [factor[m][i] for m in range(i + 1, len(found))]
        found[i] = _less(found[i], column, found[i + 1 :]) * factor[i][i]
    return found


def _less(value: Any, a: Sequence[Any], b: Sequence[Any]) -> Any:
    """A value less the products of two sequences, one after the other."""
    for one, other in zip(a, b, strict=False):
        value = value - one * other
    return value


def vibrations(stiffness: NDArray[np.float64], mass: NDArray[np.float64]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Values v, ascending, with stiffness x = v mass x, and in the columns such x with x mass x = 1.

    Both symmetric, the mass positive definite. SciPy has the same, and takes a fifth of a run's start to load.
    """
    factor = np.linalg.cholesky(mass)
    halved = np.linalg.solve(factor, stiffness)
    values, vectors = np.linalg.eigh(np.linalg.solve(factor, halved.T))
    return values, np.linalg.solve(factor.T, vectors)

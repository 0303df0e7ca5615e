"""Signs of a symmetric matrix's eigenvalues, and its determinant, by elimination."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from modal.compiler.kinds import Table

BALANCE = 0.6403882032022076
"""Part of the largest entry beside it that a pivot must have to stand alone, (1 + sqrt 17) / 8."""


def _swap(A: Table, p: int, q: int) -> None:
    """Exchange two unknowns, p before q, of what is left of a matrix; only its upper half counts."""
    for j in range(q + 1, A.shape[0]):
        A[p, j], A[q, j] = A[q, j], A[p, j]
    for j in range(p + 1, q):
        A[p, j], A[j, q] = A[j, q], A[p, j]
    A[p, p], A[q, q] = A[q, q], A[p, p]


def _pivot(A: Table, k: int) -> int:
    """Bring a good pivot to the k-th place: 1, or 2 for one of two unknowns (Bunch and Kaufman 1977)."""
    n, largest, r = A.shape[0], 0.0, k
    for j in range(k + 1, n):
        if abs(A[k, j]) > largest:
            largest, r = abs(A[k, j]), j
    if abs(A[k, k]) >= BALANCE * largest:
        return 1
    beside = 0.0
    for j in range(k, r):
        beside = max(beside, abs(A[j, r]))
    for j in range(r + 1, n):
        beside = max(beside, abs(A[r, j]))
    if abs(A[k, k]) * beside >= BALANCE * largest * largest:
        return 1
    if abs(A[r, r]) >= BALANCE * beside:
        _swap(A, k, r)
        return 1
    if r > k + 1:
        # The column of the first unknown is exchanged along with the second.
        A[k, k + 1], A[k, r] = A[k, r], A[k, k + 1]
        _swap(A, k + 1, r)
    return 2


def inertia(A: Table) -> tuple[int, float]:
    """Number of negative eigenvalues of a symmetric matrix, whose upper half is used up, and log of its determinant.

    The logarithm is that of the determinant's size, ``-inf`` where it vanishes. Zeros at the end of a row cost
    nothing, so that a narrow band costs in proportion to its length.
    """
    n, k, negative, size = A.shape[0], 0, 0, 0.0
    while k < n:
        step = _pivot(A, k)
        end = n
        while end > k + step and A[k, end - 1] == 0.0 and A[k + step - 1, end - 1] == 0.0:
            end -= 1
        a = A[k, k]
        if step == 1:
            negative += 1 if a < 0.0 else 0
            size += np.log(abs(a))
            for i in range(k + 1, end):
                x = A[k, i] / a if a != 0.0 else 0.0
                if x != 0.0:
                    for j in range(i, end):
                        A[i, j] -= x * A[k, j]
        else:
            b, c = A[k, k + 1], A[k + 1, k + 1]
            determinant = a * c - b * b
            # Such a pivot has one negative eigenvalue.
            negative += 1
            size += np.log(abs(determinant))
            for i in range(k + 2, end):
                x = (c * A[k, i] - b * A[k + 1, i]) / determinant
                y = (a * A[k + 1, i] - b * A[k, i]) / determinant
                if x != 0.0 or y != 0.0:
                    for j in range(i, end):
                        A[i, j] -= x * A[k, j] + y * A[k + 1, j]
        k += step
    return negative, size

"""Loops that solve a symmetric system: straight code of a large one would outgrow the processor."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from modal.compiler.kinds import NumberRow, NumberTable


def solve_in_place(matrix: NumberTable, right: NumberRow) -> None:
    """The operations of :func:`towercrane.kernels.algebra.solved`, in their order.

    Parameters
    ----------
    matrix : array, shape (n, n)
        Its lower triangle; overwritten.
    right : array, shape (n,)
        Right sides; overwritten by the solution.
    """
    count = right.size
    for i in range(count):
        for j in range(i):
            entry = matrix[i, j]
            for m in range(j):
                entry = entry - matrix[i, m] * matrix[j, m]
            matrix[i, j] = entry * matrix[j, j]
        entry = matrix[i, i]
        value = right[i]
        for m in range(i):
            entry = entry - matrix[i, m] * matrix[i, m]
            value = value - matrix[i, m] * right[m]
        matrix[i, i] = 1.0 / np.sqrt(entry)
        right[i] = value * matrix[i, i]
    for i in range(count - 1, -1, -1):
        value = right[i]
        for m in range(i + 1, count):
            value = value - matrix[m, i] * right[m]
        right[i] = value * matrix[i, i]

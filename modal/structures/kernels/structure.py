"""Assembly of runs of segments and bodies into a dynamic stiffness."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from modal.structures.kernels.nodes import BODIES, GEOMETRIC, SPRINGS
from modal.structures.kernels.stiffness import KEPT, MEASURE, TOTAL, UNSTABLE, run_stiffness

if TYPE_CHECKING:
    from modal.compiler.kinds import Row, Stack, Table, Whole


def dynamic_stiffness(
    omega2: float, load: float, segments: Table, nodes: Stack, runs: Whole, motions: Stack, points: Stack,
    work: Table, out: Table,
) -> int:  # fmt: skip
    """Dynamic stiffness (n, n) into ``out``; count of fixed-end modes. ``work`` (ROWS, TERMS) is scratch."""
    kept, total, n, count = work[KEPT:MEASURE], work[TOTAL:], out.shape[0], 0
    for i in range(n):
        for j in range(i, n):
            out[i, j] = points[SPRINGS, i, j] - load * points[GEOMETRIC, i, j] - omega2 * points[BODIES, i, j]
    for r in range(runs.shape[0]):
        inside = run_stiffness(
            segments, nodes, runs[r, 0], runs[r, 1], runs[r, 2] == 1, omega2, omega2, load, work, kept, total
        )
        if inside >= UNSTABLE:
            return UNSTABLE
        count += inside
        _add(total, motions[r], out)
    for i in range(n):
        for j in range(i):
            out[i, j] = out[j, i]
    return count


def _add(total: Table, motion: Table, out: Table) -> None:
    """Add a run's stiffness (4, 4) to the upper half of that of unknowns which move its ends by ``motion`` (4, n)."""
    first, last = motion.shape[1], 0
    for j in range(motion.shape[1]):
        if motion[0, j] != 0.0 or motion[1, j] != 0.0 or motion[2, j] != 0.0 or motion[3, j] != 0.0:
            first, last = min(first, j), j + 1
    for a in range(4):
        for i in range(first, last):
            moved = motion[a, i]
            if moved != 0.0:
                t0, t1, t2, t3 = moved * total[a, 0], moved * total[a, 1], moved * total[a, 2], moved * total[a, 3]
                for j in range(i, last):
                    out[i, j] += t0 * motion[0, j] + t1 * motion[1, j] + (t2 * motion[2, j] + t3 * motion[3, j])


def at_rest(
    segments: Table, nodes: Stack, runs: Whole, motions: Stack, points: Stack, work: Table, out: Table, static: Row
) -> None:
    """Diagonal of the stiffness without motion or load into ``static`` (n,); ``out`` (n, n) is used up."""
    dynamic_stiffness(0.0, 0.0, segments, nodes, runs, motions, points, work, out)
    for i in range(static.size):
        static[i] = out[i, i]


def scale_to(
    omega2: float, load: float, segments: Table, nodes: Stack, runs: Whole, motions: Stack, points: Stack,
    work: Table, static: Row, scale: Row, out: Table,
) -> int:  # fmt: skip
    """Dynamic stiffness with every unknown brought to the size of what springs, segments and bodies put on it.

    So that neither a heavy body nor a stiff member drowns the rest in rounding. ``static`` is from `at_rest`;
    ``scale`` (n,) takes the factors, ``out`` (n, n) the matrix; count of fixed-end modes.
    """
    inside = dynamic_stiffness(omega2, load, segments, nodes, runs, motions, points, work, out)
    for i in range(static.size):
        size = static[i] + load * abs(points[GEOMETRIC, i, i]) + omega2 * points[BODIES, i, i] + abs(out[i, i])
        scale[i] = 1.0 / np.sqrt(size) if size > 0.0 else 1.0
    for i in range(static.size):
        for j in range(static.size):
            out[i, j] *= scale[i] * scale[j]
    return inside


def scaled_stiffness(
    omega2: float, load: float, segments: Table, nodes: Stack, runs: Whole, motions: Stack, points: Stack,
    work: Table, out: Table,
) -> int:  # fmt: skip
    """The same, of shape (n, n), and the factors in the row after it, into ``out`` (n + 2, n)."""
    n = points.shape[1]
    matrix, scale, static = out[:n], out[n], out[n + 1]
    at_rest(segments, nodes, runs, motions, points, work, matrix, static)
    return scale_to(omega2, load, segments, nodes, runs, motions, points, work, static, scale, matrix)

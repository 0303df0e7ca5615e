"""Assembly of runs of segments and bodies into a dynamic stiffness."""

from __future__ import annotations

from typing import TYPE_CHECKING

from modal.structures.kernels.nodes import BODIES, GEOMETRIC, SPRINGS
from modal.structures.kernels.stiffness import KEPT, MEASURE, TOTAL, UNSTABLE, run_stiffness

if TYPE_CHECKING:
    from modal.compiler.kinds import Stack, Table, Whole


def dynamic_stiffness(
    omega2: float, load: float, segments: Table, nodes: Stack, runs: Whole, motions: Stack, points: Stack,
    work: Table, out: Table,
) -> int:  # fmt: skip
    """Dynamic stiffness (n, n) into ``out``; count of fixed-end modes. ``work`` (ROWS, TERMS) is scratch."""
    kept, total, n, count = work[KEPT:MEASURE], work[TOTAL:], out.shape[0], 0
    for i in range(n):
        for j in range(n):
            out[i, j] = points[SPRINGS, i, j] - load * points[GEOMETRIC, i, j] - omega2 * points[BODIES, i, j]
    for r in range(runs.shape[0]):
        inside = run_stiffness(
            segments, nodes, runs[r, 0], runs[r, 1], runs[r, 2] == 1, omega2, omega2, load, work, kept, total
        )
        if inside >= UNSTABLE:
            return UNSTABLE
        count += inside
        for a in range(4):
            for j in range(n):
                force = 0.0
                for b in range(4):
                    force += total[a, b] * motions[r, b, j]
                if force != 0.0:
                    for i in range(n):
                        out[i, j] += motions[r, a, i] * force
    return count

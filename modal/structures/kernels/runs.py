"""Segments joined to runs, and where their pieces end."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from modal.structures.kernels.blocks import SIZES, blocks_of, clear, laden
from modal.structures.kernels.cut import (
    BENDING,
    BENDING_POWER,
    LENGTH,
    RATIO,
    SHEAR_FLEXIBILITY,
    SHEAR_POWER,
    cell,
    cells,
    piece_of,
    pieces_within,
)

if TYPE_CHECKING:
    from modal.compiler.kinds import Row, Stack, Table, Whole


def _contrast(segment: Row, extremes: Row) -> float:
    """Largest ratio of two bending or two shear stiffnesses, this segment's and the extremes before it."""
    for i in range(2):
        near = segment[BENDING] if i == 0 else segment[SHEAR_FLEXIBILITY]
        far = near * segment[RATIO] ** (segment[BENDING_POWER] if i == 0 else -segment[SHEAR_POWER])
        if near > 0.0:
            extremes[2 * i] = min(extremes[2 * i], near, far)
            extremes[2 * i + 1] = max(extremes[2 * i + 1], near, far)
    return float(max(extremes[1] / extremes[0], extremes[3] / extremes[2]))


def find_runs(
    segments: Table, nodes: Stack, free: Row, omega2: float, load: float, longest: int, strongest: float,
    scratch: Table, runs: Whole,
) -> int:  # fmt: skip
    """Join segments to runs of so many blocks at most, and of no stronger contrast of stiffness; number of runs.

    ``free`` (s,): whether the node before a segment may lie inside a run, where it is 1; ``scratch`` (4, SIZES).
    """
    found, blocks, more = 0, 0, 0
    now, then, extremes, wider = scratch[0], scratch[1], scratch[2], scratch[3]
    for s in range(segments.shape[0]):
        fits = False
        if s > 0 and free[s] == 1.0:
            for i in range(SIZES):
                then[i], wider[i] = now[i], extremes[i]
            more = 0 if laden(then, nodes[s], omega2, load) else 1
            own = blocks_of(segments[s], omega2, load, then)
            more += own
            # Equal runs would all have the same fixed-end frequencies.
            fits = own >= 0 and blocks + more <= longest - found % 2 and _contrast(segments[s], wider) <= strongest
        if fits:
            blocks += more
            for i in range(SIZES):
                now[i], extremes[i] = then[i], wider[i]
        else:
            runs[found, 0], found = s, found + 1
            clear(now)
            extremes[0], extremes[1], extremes[2], extremes[3] = np.inf, 0.0, np.inf, 0.0
            _contrast(segments[s], extremes)
            blocks = 1 + max(0, blocks_of(segments[s], omega2, load, now))
        runs[found - 1, 1], runs[found - 1, 2] = s + 1, 1 if blocks == 1 else 0
    return found


def block_counts(segments: Table, omega2: float, load: float, sizes: Row, counts: Row) -> None:
    """Number of blocks of each segment alone into ``counts`` (s,); ``sizes`` (SIZES,) is scratch."""
    for s in range(segments.shape[0]):
        clear(sizes)
        counts[s] = 1 + max(0, blocks_of(segments[s], omega2, load, sizes))


def piece_ends(segments: Table, omega2: float, load: float, counts: Row, out: Row) -> int:
    """Number of pieces of all segments; that of each into ``counts`` (s,).

    Distances of the pieces' far ends from their segment's near end go one after the other into ``out`` as far as it
    reaches.
    """
    total = 0
    for s in range(segments.shape[0]):
        segment, before, number = segments[s], total, cells(segments[s])
        for k in range(number):
            ends = cell(segment, k, number)
            count = max(1, pieces_within(segment, ends, omega2, load))
            for i in range(count):
                if total < out.size:
                    part = piece_of(ends, i, count)
                    left = 0.0 if i + 1 == count and k + 1 == number else part[3] - part[2]
                    out[total] = segment[LENGTH] - left
                total += 1
        counts[s] = total - before
    return total

"""Measure of a block: pieces one after the other that cannot vibrate or buckle with their ends held."""

from __future__ import annotations

from typing import TYPE_CHECKING

from modal.structures.kernels.cut import bounds, cell, cells, piece_of, pieces_within
from modal.structures.kernels.nodes import BODIES, GEOMETRIC

if TYPE_CHECKING:
    from modal.compiler.kinds import Four, Row, Table

BLOCK = 0.8
"""The same as `modal.structures.kernels.cut.PIECE` for a block of several pieces."""

SIZES = 7
"""Numbers that measure a block: its length; ``int dx/EI``, ``int x dx/EI`` and ``int x^2 dx/EI`` with x the distance
from the far end; ``int dx/S``; what inertia takes under unit circular frequency; the largest force, see
`modal.structures.kernels.cut.bounds`."""


def clear(sizes: Row) -> None:
    """Begin a block."""
    for i in range(SIZES):
        sizes[i] = 0.0


def _strained(sizes: Row, omega2: float) -> float:
    """Part of a block's energy that inertia and compression take at most, see
    `modal.structures.kernels.cut.pieces_within`."""
    return float(omega2 * sizes[5] + sizes[6] * sizes[0] * sizes[1])


def grown(sizes: Row, segment: Row, ends: Four, omega2: float, load: float) -> bool:
    """Add a piece to the measure of a block; False where that needs a block of its own, which then begins with it."""
    bending, mass, flexibility, rotary, force, _ = bounds(segment, ends, omega2, load)
    length, turn, before = ends[2], ends[2] / bending, sizes[0]
    for attempt in range(2):
        # Integrals over the piece of the flexibilities of its sections.
        sway = sizes[3] + length * (sizes[2] + length * sizes[1] / 3.0 + length * turn / 12.0)
        sway += sizes[4] + 0.5 * length * flexibility
        sizes[5] += length * (mass * sway + rotary * (sizes[1] + 0.5 * turn))
        sizes[3] += length * (2.0 * sizes[2] + length * sizes[1] + length * turn / 3.0)
        sizes[2] += length * (sizes[1] + 0.5 * turn)
        sizes[1] += turn
        sizes[0] += length
        sizes[4] += length * flexibility
        sizes[6] = max(sizes[6], force)
        # A piece alone is short enough by `pieces_within`.
        if attempt == 1 or before == 0.0 or _strained(sizes, omega2) < BLOCK:
            return attempt == 0
        clear(sizes)
    return False


def laden(sizes: Row, node: Table, omega2: float, load: float) -> bool:
    """Add what acts on a node to the measure of the block below it; False where that must end there instead."""
    if sizes[0] == 0.0:
        return True
    sway, turn = sizes[3] + sizes[4], sizes[1]
    arm = abs(node[BODIES, 1])
    sizes[5] += (node[BODIES, 0] + arm) * sway + (node[BODIES, 2] + arm) * turn
    arm = abs(node[GEOMETRIC, 1])
    taken = load * ((abs(node[GEOMETRIC, 0]) + arm) * sway + (abs(node[GEOMETRIC, 2]) + arm) * turn)
    if _strained(sizes, omega2) + taken < BLOCK:
        return True
    clear(sizes)
    return False


def blocks_of(segment: Row, omega2: float, load: float, sizes: Row) -> int:
    """Number of blocks that end before the end of a segment which follows what is measured; -1: unstable in shear."""
    ended, number = 0, cells(segment)
    for k in range(number):
        ends = cell(segment, k, number)
        pieces = pieces_within(segment, ends, omega2, load)
        if pieces == 0:
            return -1
        for i in range(pieces):
            if not grown(sizes, segment, piece_of(ends, i, pieces), omega2, load):
                ended += 1
    return ended

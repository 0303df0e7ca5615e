"""Dynamic stiffness of a run of segments between its two ends, and its count of fixed-end modes.

Short pieces, see `modal.structures.kernels.piece`, are put together as transfers of their states while no more than a
block comes about that cannot vibrate or buckle with its ends held: however finely a beam is cut, its stiffness is
that of blocks of the size of its waves. Blocks are joined by condensing the node between them. Joining keeps the
count of Wittrick and Williams (1971): a negative eigenvalue of the condensed node is one more fixed-end mode below
the frequency. So neither the count of a closed form with its blind spots at simply supported frequencies nor growing
exponentials appear anywhere.
"""

from __future__ import annotations

from itertools import accumulate
from typing import TYPE_CHECKING

from modal.structures.kernels.block_stiffness import extended, join, make_absolute, negative, relative_stiffness
from modal.structures.kernels.blocks import SIZES, clear, grown, laden
from modal.structures.kernels.cut import RATIO, WEIGHT, cell, cells, piece_of, pieces_within
from modal.structures.kernels.nodes import load_node
from modal.structures.kernels.piece import SERIES, TERMS, piece_transfer

if TYPE_CHECKING:
    from modal.compiler.kinds import Stack, Table

UNSTABLE = 1 << 30
"""Count where a segment has no shear stiffness left (Engesser)."""

SLOT = 7
"""Rows that keep a block: its relative stiffness (4, 4); what gives the node before it (2, 4), see
`modal.structures.kernels.block_stiffness.join`; its length, the pieces to its end, whether what acts on the node
before it belongs to it, and whether it is stiff."""

STATE, SCALED, PIECE, TRANSFER, KEPT, MEASURE, TOTAL, ROWS = accumulate((SERIES, TERMS + 1, 4, 4, 4, SLOT, 1, 4))
"""Rows of the scratch array where its parts begin, after a piece's series; the last is their number."""


def follow(total: Table, length: float, piece: Table, step: float) -> None:
    """Append a piece's transfer (4, 4), see `modal.structures.kernels.piece.piece_transfer`, to that of a block.

    In place.
    """
    # (R2 + D2) (R1 + D1) - R2 R1 = R2 D1 + D2 R1 + D2 D1
    for j in range(4):
        d0, d1, d2, d3 = total[0, j], total[1, j], total[2, j], total[3, j]
        r0, r1 = (1.0 if j == 0 else (length if j == 1 else 0.0)), (1.0 if j == 1 else 0.0)
        r2, r3 = (1.0 if j == 2 else 0.0), (1.0 if j == 3 else (-length if j == 2 else 0.0))
        for i in range(4):
            moved = piece[i, 0] * (r0 + d0) + piece[i, 1] * (r1 + d1)
            total[i, j] += moved + piece[i, 2] * (r2 + d2) + piece[i, 3] * (r3 + d3)
        total[0, j] += step * d1
        total[3, j] -= step * d2


def _end_block(work: Table, kept: Table, length: float, pieces: int, single: bool, joined: bool, total: Table) -> int:
    """Stiffness of the block in scratch onto that of those before; negative eigenvalues of the node between.

    The next block's transfer begins.
    """
    transfer, matrix, count = work[TRANSFER:KEPT], work[SCALED:PIECE], 0
    relative_stiffness(transfer, length, matrix, kept)
    kept[SLOT - 1, 0], kept[SLOT - 1, 1] = length, pieces
    for i in range(4):
        for j in range(4):
            matrix[i, j] = kept[i, j]
    if not single:
        make_absolute(matrix, length)
    if joined:
        count = negative(total[2, 2] + matrix[0, 0], total[2, 3] + matrix[0, 1], total[3, 3] + matrix[1, 1])
        kept[SLOT - 1, 3] = 1.0
        if not extended(total, transfer, length, kept[4:], work[STATE:SCALED]):
            join(total, matrix, kept[4:])
            kept[SLOT - 1, 3] = 0.0
    for i in range(4):
        for j in range(4):
            transfer[i, j] = 0.0
            if not joined:
                total[i, j] = matrix[i, j]
    return count


def run_stiffness(
    segments: Table, nodes: Stack, first: int, last: int, single: bool, highest: float, omega2: float, load: float,
    work: Table, kept: Table, total: Table,
) -> int:  # fmt: skip
    """Dynamic stiffness (4, 4) of segments one after the other into ``total``; their count of fixed-end modes.

    Parameters
    ----------
    segments : ndarray, shape (s, 15)
    nodes : ndarray, shape (s, 3, 3)
        What acts on the node before each segment but the first of a run: rows `SPRINGS`, `GEOMETRIC` and `BODIES`,
        each of entries (v, v), (v, theta) and (theta, theta).
    first, last : int
        The run is ``segments[first:last]``.
    single : bool
        It is one block, whatever the frequency: the caller sees to that; the far end's unknowns are its departure.
    highest : float
        Square of the circular frequency that the pieces are short enough for.
    work : ndarray, shape (ROWS, TERMS)
        Scratch.
    kept : ndarray, shape (b SLOT, ...)
        Takes the blocks, the last in what is left where they are more.
    """
    piece, transfer, sizes = work[PIECE:TRANSFER], work[TRANSFER:KEPT], work[MEASURE, :SIZES]
    clear(sizes)
    for i in range(4):
        for j in range(4):
            transfer[i, j] = 0.0
    count, blocks, pieces, length, most = 0, 0, 0, 0.0, kept.shape[0] // SLOT - 1
    kept[SLOT - 1, 2] = 0.0
    for s in range(first, last):
        segment = segments[s]
        if s > first:
            if not laden(sizes, nodes[s], omega2, load) and not single:
                slot = SLOT * min(blocks, most)
                count += _end_block(work, kept[slot : slot + SLOT], length, pieces, single, blocks > 0, total)
                blocks, length = blocks + 1, 0.0
                kept[SLOT * min(blocks, most) + SLOT - 1, 2] = 1.0
            load_node(transfer, length, nodes[s], omega2, load)
        uniform = segment[RATIO] == 1.0 and load * segment[WEIGHT] == 0.0
        number = cells(segment)
        for k in range(number):
            ends = cell(segment, k, number)
            parts = pieces_within(segment, ends, highest, load)
            if parts == 0:
                return UNSTABLE
            for i in range(parts):
                part = piece_of(ends, i, parts)
                if i == 0 or not uniform:
                    piece_transfer(segment, part, omega2, load, work[:STATE], work[STATE:SCALED], piece)
                if not grown(sizes, segment, part, omega2, load) and not single and length > 0.0:
                    slot = SLOT * min(blocks, most)
                    count += _end_block(work, kept[slot : slot + SLOT], length, pieces, single, blocks > 0, total)
                    blocks, length = blocks + 1, 0.0
                    kept[SLOT * min(blocks, most) + SLOT - 1, 2] = 0.0
                follow(transfer, length, piece, part[2])
                length, pieces = length + part[2], pieces + 1
    slot = SLOT * min(blocks, most)
    return int(count + _end_block(work, kept[slot : slot + SLOT], length, pieces, single, blocks > 0, total))

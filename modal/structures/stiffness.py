"""Dynamic stiffness of a run of segments between its two ends, and its count of fixed-end modes.

Short pieces, see `modal.structures.piece`, are put together as transfers of their states while no more than a block
comes about that cannot vibrate or buckle with its ends held: however finely a beam is cut, its stiffness is that of
blocks of the size of its waves. Blocks are joined by condensing the node between them. Joining keeps the count of
Wittrick and Williams (1971): a negative eigenvalue of the condensed node is one more fixed-end mode below the
frequency. So neither the count of a closed form with its blind spots at simply supported frequencies nor growing
exponentials appear anywhere.
"""

from __future__ import annotations

from itertools import accumulate
from typing import Any

from modal.compiler.compiled import kernel
from modal.compiler.traced import traced
from modal.structures.blocks import SIZES, clear, grown, laden
from modal.structures.nodes import load_node
from modal.structures.piece import (
    RATIO,
    SERIES,
    TERMS,
    WEIGHT,
    cell,
    cells,
    piece_of,
    piece_transfer,
    pieces_within,
)

UNSTABLE = 1 << 30
"""Count where a segment has no shear stiffness left (Engesser)."""

STIFF = 0.3
"""Largest part of a motion that the flexibility of a block may add where it counts as stiff beside those before."""

SLOT = 7
"""Rows that keep a block: its relative stiffness (4, 4); what gives the node before it (2, 4), see `join`; its
length, the pieces to its end, whether what acts on the node before it belongs to it, and whether it is stiff."""

STATE, SCALED, PIECE, TRANSFER, KEPT, MEASURE, TOTAL, ROWS = accumulate((SERIES, TERMS + 1, 4, 4, 4, SLOT, 1, 4))
"""Rows of the scratch array where its parts begin, after a piece's series; the last is their number."""


@traced
def _from_transfer(T: Any, unit: float, length: float, out: Any) -> None:
    """Stiffness for near end and departure into ``out``, from what the near state gives at the far end, ``T``."""
    # Departure d' = E d + F p, far forces p' = G d + (R^-T + H) p with the near motion d and the near forces p; R
    # moves the far end rigidly. F is the block above right, inverted here.
    determinant = T[0, 2] * T[1, 3] - T[0, 3] * T[1, 2]
    i00, i01 = T[1, 3] / determinant, -T[0, 3] / determinant
    i10, i11 = -T[1, 2] / determinant, T[0, 2] / determinant
    # R^T H and R^T G, R = [[1, 1], [0, 1]] in lengths of the piece.
    h00, h01 = T[2, 2], T[2, 3]
    h10, h11 = T[2, 2] + T[3, 2], T[2, 3] + T[3, 3]
    g00, g01 = T[2, 0], T[2, 1]
    g11 = T[2, 1] + T[3, 1]
    # Near, with departure: R^T H F^-1.
    out[0, 2], out[0, 3] = h00 * i00 + h01 * i10, h00 * i01 + h01 * i11
    out[1, 2], out[1, 3] = h10 * i00 + h11 * i10, h10 * i01 + h11 * i11
    out[0, 0] = g00 - out[0, 2] * T[0, 0] - out[0, 3] * T[1, 0]
    out[0, 1] = g01 - out[0, 2] * T[0, 1] - out[0, 3] * T[1, 1]
    out[1, 1] = g11 - out[1, 2] * T[0, 1] - out[1, 3] * T[1, 1]
    # Departure: (R^-T + H) F^-1, R^-T = [[1, 0], [-1, 1]].
    out[2, 2] = (1.0 + T[2, 2]) * i00 + T[2, 3] * i10
    out[2, 3] = (1.0 + T[2, 2]) * i01 + T[2, 3] * i11
    out[3, 3] = (T[3, 2] - 1.0) * i01 + (1.0 + T[3, 3]) * i11
    for i in range(4):
        for j in range(i, 4):
            value = out[i, j] * unit
            if i % 2 == 1:
                value = value * length
            if j % 2 == 1:
                value = value * length
            out[i, j] = value
            out[j, i] = value


@kernel()
def relative_stiffness(transfer: Any, length: float, T: Any, out: Any) -> None:
    """Dynamic stiffness (4, 4) for (v, theta) at the near end and the far end's departure from it, from a transfer.

    The far end departs from where it would be if the block were rigid. Bending then works on the departure alone, and
    the large stiffness of a short block takes no digits from the motion of the whole. ``T`` (4, 4) is scratch.
    """
    for i in range(4):
        for j in range(4):
            value = transfer[i, j]
            if i == 0 or i == 3:
                value /= length
            if j == 0 or j == 3:
                value *= length
            T[i, j] = value
    _from_transfer(T, 1.0 / length, length, out)


@traced
def make_absolute(matrix: Any, length: float) -> None:
    """Turn a relative stiffness (4, 4) into that for (v, theta) at both ends, in place."""
    a, b, c = matrix[2, 2], matrix[2, 3], matrix[3, 3]
    # R^T C, then near with far B - R^T C, then near A - B R - R^T B^T + R^T C R.
    rows = (a, b, length * a + b, length * b + c)
    b00, b01, b10, b11 = matrix[0, 2], matrix[0, 3], matrix[1, 2], matrix[1, 3]
    matrix[0, 0] = matrix[0, 0] + rows[0] - 2.0 * b00
    matrix[0, 1] = matrix[0, 1] + (rows[0] * length + rows[1] - b00 * length - b01 - b10)
    matrix[1, 1] = matrix[1, 1] + (rows[2] * length + rows[3] - 2.0 * (b10 * length + b11))
    matrix[0, 2], matrix[0, 3] = b00 - rows[0], b01 - rows[1]
    matrix[1, 2], matrix[1, 3] = b10 - rows[2], b11 - rows[3]
    for i in range(4):
        for j in range(i):
            matrix[i, j] = matrix[j, i]


@traced
def _condense(near: Any, piece: Any, recovery: Any, i00: float, i01: float, i11: float) -> None:
    """Take the node between out, of whose stiffness this is the inverse."""
    for j in range(2):
        recovery[0, j] = -(i00 * near[2, j] + i01 * near[3, j])
        recovery[1, j] = -(i01 * near[2, j] + i11 * near[3, j])
        recovery[0, 2 + j] = -(i00 * piece[0, 2 + j] + i01 * piece[1, 2 + j])
        recovery[1, 2 + j] = -(i01 * piece[0, 2 + j] + i11 * piece[1, 2 + j])
    for i in range(2):
        for j in range(2):
            near[i, j] = near[i, j] + (near[i, 2] * recovery[0, j] + near[i, 3] * recovery[1, j])
    for i in range(2):
        deflection, rotation = near[i, 2], near[i, 3]
        for j in range(2, 4):
            near[i, j] = deflection * recovery[0, j] + rotation * recovery[1, j]
            near[j, i] = near[i, j]
            near[2 + i, j] = piece[2 + i, j] + piece[2 + i, 0] * recovery[0, j] + piece[2 + i, 1] * recovery[1, j]


@kernel()
def negative(a: float, b: float, c: float) -> int:
    """Number of negative eigenvalues of [[a, b], [b, c]]."""
    return 1 if a * c - b * b < 0.0 else (2 if a + c < 0.0 else 0)


@kernel()
def join(near: Any, piece: Any, recovery: Any) -> None:
    """Append a block to a run's stiffness ``near`` (4, 4), in place.

    ``recovery`` (2, 4) takes what gives the node's (v, theta) from those at the near and at the block's far end.
    """
    a = near[2, 2] + piece[0, 0]
    b = near[2, 3] + piece[0, 1]
    c = near[3, 3] + piece[1, 1]
    determinant = a * c - b * b
    if determinant == 0.0:
        # On a fixed-end mode to the last bit: a nearby frequency would do as well.
        a *= 1.0 + 1e-15
        determinant = a * c - b * b
    _condense(near, piece, recovery, c / determinant, -b / determinant, a / determinant)


@kernel()
def follow(total: Any, length: float, piece: Any, step: float) -> None:
    """Append a piece's transfer (4, 4), see `modal.structures.piece.piece_transfer`, to that of a block, in place."""
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


@kernel()
def _extended(total: Any, transfer: Any, length: float, recovery: Any, scratch: Any) -> bool:
    """Append a block that is stiff beside what is before it, in place, see `join`; False where it is not stiff.

    Its large stiffness would drown that of the rest in rounding; its flexibility is a small correction.
    """
    # Far motion and forces d' = A d + B p, p' = C d + D p; before it p = K21 d0 + K22 d, so d' = E d + B K21 d0.
    a, b = scratch[0:2], scratch[2:4]
    for i in range(2):
        for j in range(2):
            a[i, j] = transfer[i, 2] * total[2, 2 + j] + transfer[i, 3] * total[3, 2 + j]
            b[i, j] = transfer[i, 2] * total[2, j] + transfer[i, 3] * total[3, j]
    if max(abs(a[0, 0]), abs(a[0, 1]) / length, abs(a[1, 0]) * length, abs(a[1, 1])) > STIFF:
        return False
    for i in range(2):
        for j in range(2):
            a[i, j] += transfer[i, j] + (1.0 if i == j else 0.0)
    a[0, 1] += length
    determinant = a[0, 0] * a[1, 1] - a[0, 1] * a[1, 0]
    e00, e01 = a[1, 1] / determinant, -a[0, 1] / determinant
    e10, e11 = -a[1, 0] / determinant, a[0, 0] / determinant
    for j in range(2):
        recovery[0, j], recovery[1, j] = -(e00 * b[0, j] + e01 * b[1, j]), -(e10 * b[0, j] + e11 * b[1, j])
    recovery[0, 2], recovery[0, 3], recovery[1, 2], recovery[1, 3] = e00, e01, e10, e11
    # C + D K22, D differing from the identity by the lever arm.
    for j in range(2):
        v, m = total[2, 2 + j], total[3, 2 + j]
        a[0, j] = transfer[2, j] + transfer[2, 2] * v + transfer[2, 3] * m + v
        a[1, j] = transfer[3, j] + transfer[3, 2] * v + transfer[3, 3] * m + m - length * v
    k00, k11 = a[0, 0] * e00 + a[0, 1] * e10, a[1, 0] * e01 + a[1, 1] * e11
    k01 = 0.5 * (a[0, 0] * e01 + a[0, 1] * e11 + a[1, 0] * e00 + a[1, 1] * e10)
    for i in range(2):
        for j in range(2):
            total[i, j] += total[i, 2] * recovery[0, j] + total[i, 3] * recovery[1, j]
    for i in range(2):
        v, m = total[i, 2], total[i, 3]
        total[i, 2], total[i, 3] = v * e00 + m * e10, v * e01 + m * e11
        total[2, i], total[3, i] = total[i, 2], total[i, 3]
    total[2, 2], total[2, 3], total[3, 2], total[3, 3] = k00, k01, k01, k11
    return True


@kernel()
def _end_block(work: Any, kept: Any, length: float, pieces: int, single: bool, joined: bool, total: Any) -> int:
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
        if not _extended(total, transfer, length, kept[4:], work[STATE:SCALED]):
            join(total, matrix, kept[4:])
            kept[SLOT - 1, 3] = 0.0
    for i in range(4):
        for j in range(4):
            transfer[i, j] = 0.0
            if not joined:
                total[i, j] = matrix[i, j]
    return count


@kernel()
def run_stiffness(
    segments: Any, nodes: Any, first: int, last: int, single: bool, highest: float, omega2: float, load: float,
    work: Any, kept: Any, total: Any,
) -> int:  # fmt: skip
    """Dynamic stiffness (4, 4) of segments one after the other into ``total``; their count of fixed-end modes.

    Parameters
    ----------
    segments : ndarray, shape (s, 13)
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

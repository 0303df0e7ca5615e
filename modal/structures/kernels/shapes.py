"""Compiled shape of a run of segments between its two ends, at a circular frequency and a load factor."""

from __future__ import annotations

from typing import TYPE_CHECKING

from modal.structures.kernels.cut import BENDING, BENDING_POWER, cell, cells, piece_of, pieces_within
from modal.structures.kernels.nodes import node_stiffness
from modal.structures.kernels.piece import TERMS, coefficients, state_series
from modal.structures.kernels.stiffness import KEPT, MEASURE, SCALED, SLOT, STATE, TOTAL, run_stiffness

if TYPE_CHECKING:
    from modal.compiler.kinds import Row, Stack, Table


def _begin(block: Table, near: Row, far: Row, single: bool, state: Row) -> None:
    """State (v, theta, V, M) at the near end of a block from the motions (v, theta) of its ends.

    That at the far end of the block before goes on where this one is so stiff that its ends hardly tell.
    """
    if block[SLOT - 1, 3] == 1.0:
        return
    length = block[SLOT - 1, 0]
    d0, d1 = far[0], far[1]
    if not single:
        d0, d1 = d0 - near[0] - length * near[1], d1 - near[1]
    # Force on the far end, then on the near end with the far one held, with which the state begins, negative.
    far_force, far_moment, force, moment = 0.0, 0.0, 0.0, 0.0
    for j in range(2):
        departure = d0 if j == 0 else d1
        far_force += block[2, j] * near[j] + block[2, 2 + j] * departure
        far_moment += block[3, j] * near[j] + block[3, 2 + j] * departure
        force -= block[0, j] * near[j] + block[0, 2 + j] * departure
        moment -= block[1, j] * near[j] + block[1, 2 + j] * departure
    state[0], state[1] = near[0], near[1]
    state[2], state[3] = force + far_force, moment + length * far_force + far_moment


def run_shape(
    segments: Table, nodes: Stack, first: int, last: int, single: bool, highest: float, omega2: float, load: float,
    held: Row, work: Table, scratch: Table, out: Stack, motions: Table,
) -> None:  # fmt: skip
    """Taylor coefficients of (v, theta, V, M, v') in every piece of a run, from (v, theta) at its two ends.

    Parameters
    ----------
    segments, nodes, first, last, single, highest
        As `modal.structures.kernels.stiffness.run_stiffness` takes them.
    held : ndarray, shape (4,)
        (v, theta) at the near and the far end; of a single block the far end's departure.
    work : ndarray, shape (ROWS, TERMS)
    scratch : ndarray, shape (SLOT p + p + 1, 4)
    out : ndarray, shape (p, TERMS + 1, 5)
        Coefficients in the fraction of the piece's length.
    motions : ndarray, shape (last - first + 1, 2)
        (v, theta) of the nodes from the run's near to its far end.
    """
    most = SLOT * out.shape[0]
    kept, ends, total, current = scratch[:most], scratch[most:], work[TOTAL:], work[KEPT]
    run_stiffness(segments, nodes, first, last, single, highest, omega2, load, work, kept, total)
    blocks = 1
    while kept[SLOT * blocks - 1, 1] < out.shape[0]:
        blocks += 1
    for j in range(2):
        ends[0, j], ends[blocks, j] = held[j], held[2 + j]
    for b in range(blocks - 1, 0, -1):
        for i in range(2):
            row = kept[SLOT * b + 4 + i]
            ends[b, i] = row[0] * ends[0, 0] + row[1] * ends[0, 1] + row[2] * ends[b + 1, 0] + row[3] * ends[b + 1, 1]

    series, state, p, b = work[:STATE], work[STATE:SCALED], 0, -1
    for s in range(first, last):
        segment, number = segments[s], cells(segments[s])
        here = b + 1
        if here == 0 or (here < blocks and p == kept[SLOT * here - 1, 1] and kept[SLOT * here + SLOT - 1, 2] == 1.0):
            _begin(kept[SLOT * here : SLOT * here + SLOT], ends[here], ends[here + 1], single, current)
            b = here
        if s > first:
            k0, k1, k2 = node_stiffness(nodes[s], omega2, load)
            current[2] += k0 * current[0] + k1 * current[1]
            current[3] += k1 * current[0] + k2 * current[1]
        motions[s - first, 0], motions[s - first, 1] = current[0], current[1]
        for k in range(number):
            of_cell = cell(segment, k, number)
            parts = pieces_within(segment, of_cell, highest, load)
            for i in range(parts):
                if b + 1 < blocks and p == kept[SLOT * (b + 1) - 1, 1]:
                    b += 1
                    _begin(kept[SLOT * b : SLOT * b + SLOT], ends[b], ends[b + 1], single, current)
                part = piece_of(of_cell, i, parts)
                terms, length = coefficients(segment, part, omega2, load, series), part[2]
                bending = segment[BENDING] * part[0] ** segment[BENDING_POWER]
                # What (v, theta, V, M, v') are in the piece's units.
                work[MEASURE, 0], work[MEASURE, 1], work[MEASURE, 4] = length, 1.0, 1.0
                work[MEASURE, 2], work[MEASURE, 3] = bending / length**2, bending / length
                for j in range(4):
                    state[0, j] = current[j] / work[MEASURE, j]
                state_series(series, terms, state)
                for j in range(5):
                    unit = work[MEASURE, j]
                    end = 0.0
                    for t in range(TERMS + 1):
                        out[p, t, j] = state[t, j] * unit
                        end += out[p, t, j]
                    if j < 4:
                        current[j] = end
                p += 1
    motions[last - first, 0], motions[last - first, 1] = current[0], current[1]

"""Compiled shape of a segment between its two ends, at a circular frequency and a load factor."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import types

from modal.compiled import kernel
from modal.stiffness import (
    BENDING,
    BENDING_POWER,
    LENGTH,
    RATIO,
    SHORT,
    TERMS,
    coefficients,
    join,
    make_absolute,
    relative_stiffness,
    state_series,
)

_one, _three = types.float64[::1], types.float64[:, :, ::1]


@kernel(types.void(_one, _one, types.float64, types.float64, _one, _three), allocates=True)
def segment_shape(segment: Any, ends: Any, omega2: float, load: float, held: Any, out: Any) -> None:
    """Taylor coefficients of (v, theta, V, M, v') in every piece of a segment, from (v, theta) at its two ends.

    Parameters
    ----------
    segment : ndarray, shape (13,)
    ends : ndarray, shape (p + 1,)
        Ends of the pieces.
    held : ndarray, shape (4,)
        (v, theta) at the near and the far end; of a short segment the far end's departure.
    out : ndarray, shape (p, TERMS + 1, 5)
        Coefficients in the fraction of the piece's length.
    """
    pieces = ends.size - 1
    series, state, T = np.zeros((8, TERMS)), np.zeros((TERMS + 1, 5)), np.zeros((4, 4))
    total, piece, recovery = np.zeros((4, 4)), np.zeros((4, 4)), np.zeros((pieces, 2, 4))
    relative, nodes, departure = np.zeros((pieces, 4, 4)), np.zeros((pieces + 1, 2)), np.zeros(2)
    for p in range(pieces):
        length = ends[p + 1] - ends[p]
        relative_stiffness(segment, ends[p], length, omega2, load, series, state, T, relative[p])
        for i in range(4):
            for j in range(4):
                piece[i, j] = relative[p, i, j]
        make_absolute(piece, length)
        if p == 0:
            for i in range(4):
                for j in range(4):
                    total[i, j] = piece[i, j]
        else:
            join(total, piece, recovery[p])
    nodes[0, 0], nodes[0, 1], nodes[pieces, 0], nodes[pieces, 1] = held[0], held[1], held[2], held[3]
    for p in range(pieces - 1, 0, -1):
        for i in range(2):
            nodes[p, i] = (
                recovery[p, i, 0] * nodes[0, 0]
                + recovery[p, i, 1] * nodes[0, 1]
                + recovery[p, i, 2] * nodes[p + 1, 0]
                + recovery[p, i, 3] * nodes[p + 1, 1]
            )
    for p in range(pieces):
        length = ends[p + 1] - ends[p]
        terms = coefficients(segment, ends[p], length, omega2, load, series)
        breadth = 1.0 + (segment[RATIO] - 1.0) * ends[p] / segment[LENGTH]
        bending = segment[BENDING] * breadth ** segment[BENDING_POWER]
        departure[0], departure[1] = nodes[p + 1, 0], nodes[p + 1, 1]
        if segment[SHORT] == 0.0:
            departure[0] -= nodes[p, 0] + length * nodes[p, 1]
            departure[1] -= nodes[p, 1]
        # Force on the far end, then on the near end with the far one held, with which the state begins, negative.
        K = relative[p]
        far_force, far_moment, force, moment = 0.0, 0.0, 0.0, 0.0
        for j in range(2):
            far_force += K[2, j] * nodes[p, j] + K[2, 2 + j] * departure[j]
            far_moment += K[3, j] * nodes[p, j] + K[3, 2 + j] * departure[j]
            force -= K[0, j] * nodes[p, j] + K[0, 2 + j] * departure[j]
            moment -= K[1, j] * nodes[p, j] + K[1, 2 + j] * departure[j]
        force += far_force
        moment += length * far_force + far_moment
        units = (length, 1.0, bending / length**2, bending / length, 1.0)
        state[0, 0], state[0, 1] = nodes[p, 0] / length, nodes[p, 1]
        state[0, 2], state[0, 3] = force / units[2], moment / units[3]
        state_series(series, terms, state)
        for k in range(TERMS + 1):
            for i in range(5):
                out[p, k, i] = state[k, i] * units[i]

"""Compiled assembly of segments and bodies into a dynamic stiffness, the count of its modes and their search.

Kernels take a structure as three arrays: ``segments`` (s, 13), properties of `modal.stiffness`; ``motions``
(s, 4, n), how (v, theta) of a segment's near and far end follow the n unknowns; ``points`` (3, n, n), stiffness of
springs, geometric stiffness of bodies under unit load (to be taken away), mass of bodies. A circular frequency and a
load factor say which dynamic stiffness is meant.
"""

from __future__ import annotations

from itertools import accumulate
from typing import Any

import numpy as np
from numba import types

from modal.compiled import kernel
from modal.stiffness import (
    LENGTH,
    RATIO,
    SHORT,
    TERMS,
    WEIGHT,
    cell_end,
    join,
    make_absolute,
    pieces_within,
    relative_stiffness,
)

UNSTABLE = 1 << 30
"""Count where a segment has no shear stiffness left (Engesser)."""

STATE, TRANSFER, PIECE, TOTAL, RECOVERY, ROWS = accumulate((8, TERMS + 1, 4, 4, 4, 2))
"""Rows of the scratch array where its parts begin, after a segment's series; the last is their number."""

SPRINGS, GEOMETRIC, BODIES = range(3)
"""Entries of ``points``."""

_one, _two, _three = types.float64[::1], types.float64[:, ::1], types.float64[:, :, ::1]
_structure = (_two, _three, _three)


@kernel(inline=True)
def _segment_stiffness(
    segment: Any, omega2: float, load: float, series: Any, state: Any, T: Any, piece: Any, recovery: Any, total: Any
) -> int:
    """Dynamic stiffness (4, 4) of a whole segment into ``total``; its count of fixed-end modes.

    A short segment is one piece, whatever the frequency: the caller sees to that.
    """
    count, first, near = 0, True, 0.0
    uniform = segment[RATIO] == 1.0 and load * segment[WEIGHT] == 0.0
    while near < segment[LENGTH]:
        far = cell_end(segment, near)
        pieces = 1 if segment[SHORT] != 0.0 else pieces_within(segment, near, far, omega2, load)
        if pieces == 0:
            return UNSTABLE
        length = (far - near) / pieces
        for i in range(pieces):
            if i == 0 or not uniform:
                relative_stiffness(segment, near + i * length, length, omega2, load, series, state, T, piece)
                if segment[SHORT] == 0.0:
                    make_absolute(piece, length)
            if first:
                for row in range(4):
                    for column in range(4):
                        total[row, column] = piece[row, column]
                first = False
            else:
                count += join(total, piece, recovery)
        near = far
    return count


_stiffness = types.int64(types.float64, types.float64, *_structure, _two, _two)


@kernel(_stiffness)
def dynamic_stiffness(
    omega2: float, load: float, segments: Any, motions: Any, points: Any, work: Any, out: Any
) -> int:
    """Dynamic stiffness (n, n) into ``out``; count of fixed-end modes. ``work`` (ROWS, TERMS) is scratch."""
    series, state, T = work[:STATE], work[STATE:TRANSFER], work[TRANSFER:PIECE]
    piece, total, recovery = work[PIECE:TOTAL], work[TOTAL:RECOVERY], work[RECOVERY:]
    n = out.shape[0]
    for i in range(n):
        for j in range(n):
            out[i, j] = points[SPRINGS, i, j] - load * points[GEOMETRIC, i, j] - omega2 * points[BODIES, i, j]
    count = 0
    for s in range(segments.shape[0]):
        inside = _segment_stiffness(segments[s], omega2, load, series, state, T, piece, recovery, total)
        if inside == UNSTABLE:
            return UNSTABLE
        count += inside
        for a in range(4):
            for j in range(n):
                force = 0.0
                for b in range(4):
                    force += total[a, b] * motions[s, b, j]
                if force != 0.0:
                    for i in range(n):
                        out[i, j] += motions[s, a, i] * force
    return count


@kernel(inline=True)
def _eigenvalues(matrix: Any, scale: Any, values: Any) -> None:
    """Eigenvalues (n,) of a symmetric matrix, scaled in place, into ``values``, ascending."""
    for i in range(matrix.shape[0]):
        for j in range(matrix.shape[0]):
            matrix[i, j] *= scale[i] * scale[j]
    # Copied one by one: numba takes seconds to compile the assignment of a slice, for its error message.
    found = np.linalg.eigvalsh(matrix)
    for i in range(found.size):
        values[i] = found[i]


@kernel(inline=True)
def _crossing(inside: int, values: Any, k: int) -> float:
    """The eigenvalue that crosses zero, downward, at the k-th root."""
    if inside >= k:
        return -np.inf
    index = k - inside - 1
    return float(values[index]) if index < values.size else np.inf


@kernel(inline=True)
def _between(near: float, f_near: float, far: float, f_far: float, third: float, f_third: float) -> float:
    """Next trial in a bracket: inverse quadratic interpolation where it is safe, else halving (Chandrupatla 1997)."""
    middle = 0.5 * (near + far)
    if not np.isfinite(f_third) or f_third in (f_near, f_far) or third in (near, far):
        x = near - f_near * (far - near) / (f_far - f_near)
    else:
        # The bracket's newest end is the one that is not beside the third point.
        xi, phi = (near - far) / (third - far), (f_near - f_far) / (f_third - f_far)
        if not (phi * phi < xi and (1.0 - phi) * (1.0 - phi) < 1.0 - xi):
            return middle
        x = (
            near * f_far / (f_near - f_far) * f_third / (f_near - f_third)
            + far * f_near / (f_far - f_near) * f_third / (f_far - f_third)
            + third * f_near / (f_third - f_near) * f_far / (f_third - f_far)
        )
    # Keep off the ends by a little, so that a trial next to the root closes the bracket from its other side.
    margin = max(2.3e-16 * far, 1e-3 * min(x - near, far - x))
    return min(max(x, near + margin), far - margin)


@kernel(
    types.boolean(
        types.FunctionType(_stiffness), *_structure, _two, types.boolean, types.float64, types.float64, _one
    ),
    allocates=True,
)
def find_roots(
    stiffness: Any,
    segments: Any,
    motions: Any,
    points: Any,
    work: Any,
    by_load: bool,
    guess: float,
    limit: float,
    roots: Any,
) -> bool:
    """Lowest circular frequencies, or critical load factors, ascending and with their multiplicity, into ``roots``.

    ``stiffness`` is :func:`dynamic_stiffness`: behind a pointer it is not compiled into this kernel once more.

    The k-th is bracketed by counts and then followed as the zero of one eigenvalue, whose sign changes at no other
    place in the bracket; where a fixed-end mode of a segment lies in the bracket, by halving alone. False if there
    are fewer below ``limit``.
    """
    n = points.shape[1]
    # Scratch is all of two axes: numba compiles what makes an array anew for each number of them.
    matrix, sizes, bounds = np.zeros((n, n)), np.zeros((3, n)), np.zeros((2, roots.size))
    (values, static, scale), (low, high) = (sizes[0], sizes[1], sizes[2]), (bounds[0], bounds[1])
    stiffness(0.0, 0.0, segments, motions, points, work, matrix)
    for i in range(n):
        static[i] = matrix[i, i]
    for i in range(roots.size):
        high[i] = np.inf

    for k in range(1, roots.size + 1):
        near, f_near, inside_near = low[k - 1], np.inf, -1
        far, f_far, inside_far = high[k - 1], -np.inf, -2
        x = max(guess, 2.0 * near) if np.isinf(far) else 0.5 * (near + far)
        third, f_third = far, f_far
        for _ in range(400):
            omega2, load = (0.0, x) if by_load else (x * x, 1.0)
            inside = stiffness(omega2, load, segments, motions, points, work, matrix)
            count = inside
            if inside != UNSTABLE:
                # Every unknown is scaled by what springs, segments at rest and bodies put on it, so that no heavy
                # body drowns the eigenvalue sought in its rounding errors.
                for i in range(n):
                    size = static[i] + load * abs(points[GEOMETRIC, i, i]) + omega2 * points[BODIES, i, i]
                    scale[i] = 1.0 / np.sqrt(size)
                _eigenvalues(matrix, scale, values)
                for i in range(n):
                    if values[i] < 0.0:
                        count += 1
            for i in range(roots.size):
                if count > i:
                    high[i] = min(high[i], x)
                else:
                    low[i] = max(low[i], x)
            f = _crossing(inside, values, k)
            if f > 0.0:
                third, f_third = near, f_near
                near, f_near, inside_near = x, f, inside
            else:
                third, f_third = far, f_far
                far, f_far, inside_far = x, f, inside
            if np.isinf(far):
                if x > limit:
                    return False
                x = max(guess, 2.0 * x)
                continue
            if f == 0.0 or far - near <= 2.3e-16 * far:
                break
            x = 0.5 * (near + far)
            if inside_near == inside_far and np.isfinite(f_near) and np.isfinite(f_far):
                x = _between(near, f_near, far, f_far, third, f_third)
            if not near < x < far:
                break
        roots[k - 1] = near if f_near < -f_far else far
    return True


@kernel(types.int64(_one, types.float64, types.float64, _one))
def piece_ends(segment: Any, omega2: float, load: float, out: Any) -> int:
    """Ends of a segment's pieces into ``out`` as far as it reaches; number of pieces."""
    total, near = 0, 0.0
    out[0] = 0.0
    while near < segment[LENGTH]:
        far = cell_end(segment, near)
        pieces = pieces_within(segment, near, far, omega2, load)
        for i in range(1, pieces + 1):
            total += 1
            if total < out.size:
                out[total] = far if i == pieces else near + (far - near) * i / pieces
        near = far
    return total

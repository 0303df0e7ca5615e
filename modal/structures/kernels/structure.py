"""Compiled assembly of runs of segments and bodies into a dynamic stiffness, the count of its modes and their search.

Kernels take a structure as five arrays: ``segments`` (s, 14) and ``nodes`` (s, 3, 3), see
`modal.structures.kernels.stiffness`; ``runs`` (r, 3), the first segment of each run, the first after it, and whether
it is a single block; ``motions`` (r, 4, n), how (v, theta) of a run's near and far end follow the n unknowns;
``points`` (3, n, n), stiffness of springs, geometric stiffness of bodies under unit load (to be taken away), mass of
bodies. A circular frequency and a load factor say which dynamic stiffness is meant.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import types

from modal.compiler.compiled import kernel
from modal.structures.kernels.blocks import SIZES, blocks_of, clear, laden
from modal.structures.kernels.nodes import BODIES, GEOMETRIC, SPRINGS
from modal.structures.kernels.piece import (
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
from modal.structures.kernels.stiffness import KEPT, MEASURE, TOTAL, UNSTABLE, run_stiffness

_one, _two, _three = types.float64[::1], types.float64[:, ::1], types.float64[:, :, ::1]
_runs = types.int64[:, ::1]
_structure = (_two, _three, _runs, _three, _three)


_stiffness = types.int64(types.float64, types.float64, *_structure, _two, _two)


@kernel(_stiffness)
def dynamic_stiffness(
    omega2: float, load: float, segments: Any, nodes: Any, runs: Any, motions: Any, points: Any, work: Any, out: Any
) -> int:
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


@kernel(inline=True)
def _scale(matrix: Any, static: Any, points: Any, omega2: float, load: float, scale: Any) -> None:
    """What brings every unknown to the size of what springs, segments and bodies put on it.

    So that neither a heavy body nor a stiff member drowns the eigenvalue sought in its rounding errors.
    """
    for i in range(static.size):
        size = static[i] + load * abs(points[GEOMETRIC, i, i]) + omega2 * points[BODIES, i, i] + abs(matrix[i, i])
        scale[i] = 1.0 / np.sqrt(size) if size > 0.0 else 1.0


@kernel(
    types.void(
        types.FunctionType(_stiffness),
        *_structure,
        _two,
        types.boolean,
        types.float64,
        types.float64,
        types.int64,
        _one,
    ),
    allocates=True,
)
def find_roots(
    stiffness: Any,
    segments: Any,
    nodes: Any,
    runs: Any,
    motions: Any,
    points: Any,
    work: Any,
    by_load: bool,
    above: float,
    below: float,
    known: int,
    roots: Any,
) -> None:
    """Circular frequencies, or critical load factors, ascending and with their multiplicity, into ``roots``.

    ``stiffness`` is :func:`dynamic_stiffness`: behind a pointer it is not compiled into this kernel once more. All
    roots lie between ``above`` and ``below``; ``known`` lie under them.

    Each is bracketed by counts and then followed as the zero of one eigenvalue, whose sign changes at no other
    place in the bracket; where a fixed-end mode of a run lies in the bracket, by halving alone.
    """
    n = points.shape[1]
    # Scratch is all of two axes: numba compiles what makes an array anew for each number of them.
    matrix, sizes, bounds = np.zeros((n, n)), np.zeros((3, n)), np.zeros((2, roots.size))
    (values, static, scale), (low, high) = (sizes[0], sizes[1], sizes[2]), (bounds[0], bounds[1])
    stiffness(0.0, 0.0, segments, nodes, runs, motions, points, work, matrix)
    for i in range(n):
        static[i] = matrix[i, i]
    for i in range(roots.size):
        low[i], high[i] = above, below

    for index in range(roots.size):
        k = known + index + 1
        near, f_near, inside_near = low[index], np.inf, -1
        far, f_far, inside_far = high[index], -np.inf, -2
        third, f_third = far, f_far
        for _ in range(400):
            x = 0.5 * (near + far)
            if far > 2.0 * near:
                x = np.sqrt(near * far)
            elif inside_near == inside_far and np.isfinite(f_near) and np.isfinite(f_far):
                x = _between(near, f_near, far, f_far, third, f_third)
            if not near < x < far:
                break
            omega2, load = (0.0, x) if by_load else (x * x, 1.0)
            inside = stiffness(omega2, load, segments, nodes, runs, motions, points, work, matrix)
            count = inside
            if inside != UNSTABLE:
                _scale(matrix, static, points, omega2, load, scale)
                _eigenvalues(matrix, scale, values)
                for i in range(n):
                    if values[i] < 0.0:
                        count += 1
            for i in range(roots.size):
                if count > known + i:
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
            if f == 0.0 or far - near <= 2.3e-16 * far:
                break
        roots[index] = near if f_near < -f_far else far


@kernel()
def _contrast(segment: Any, extremes: Any) -> float:
    """Largest ratio of two bending or two shear stiffnesses, this segment's and the extremes before it."""
    for i, (value, power) in enumerate(((BENDING, BENDING_POWER), (SHEAR_FLEXIBILITY, SHEAR_POWER))):
        near = segment[value]
        far = near * segment[RATIO] ** (segment[power] if i == 0 else -segment[power])
        if near > 0.0:
            extremes[2 * i] = min(extremes[2 * i], near, far)
            extremes[2 * i + 1] = max(extremes[2 * i + 1], near, far)
    return float(max(extremes[1] / extremes[0], extremes[3] / extremes[2]))


@kernel(
    types.int64(_two, _three, _one, types.float64, types.float64, types.int64, types.float64, _runs), allocates=True
)
def find_runs(
    segments: Any, nodes: Any, free: Any, omega2: float, load: float, longest: int, strongest: float, runs: Any
) -> int:
    """Join segments to runs of so many blocks at most, and of no stronger contrast of stiffness; number of runs.

    ``free`` (s,): whether the node before a segment may lie inside a run, where it is 1.
    """
    scratch, found, blocks, more = np.zeros((4, SIZES)), 0, 0, 0
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


@kernel(types.int64(_one, types.float64, types.float64), allocates=True)
def block_count(segment: Any, omega2: float, load: float) -> int:
    """Number of blocks of a segment alone."""
    sizes = np.zeros((1, SIZES))[0]
    clear(sizes)
    return 1 + int(max(0, blocks_of(segment, omega2, load, sizes)))


@kernel(types.int64(_one, types.float64, types.float64, _one))
def piece_ends(segment: Any, omega2: float, load: float, out: Any) -> int:
    """Ends of a segment's pieces into ``out`` as far as it reaches; number of pieces."""
    total, number, count = 0, cells(segment), 0
    out[0] = 0.0
    for k in range(number):
        ends = cell(segment, k, number)
        count = max(1, pieces_within(segment, ends, omega2, load))
        for i in range(1, count + 1):
            total += 1
            if total < out.size:
                part = piece_of(ends, i - 1, count)
                left = 0.0 if i == count and k + 1 == number else part[3] - part[2]
                out[total] = segment[LENGTH] - left
    return total

"""Search for natural frequencies or critical loads between two bounds."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from modal.structures.kernels.inertia import inertia
from modal.structures.kernels.stiffness import UNSTABLE
from modal.structures.kernels.structure import at_rest, scale_to, scaled_stiffness

if TYPE_CHECKING:
    from modal.compiler.kinds import Row, Stack, Table, Whole


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


def count_below(
    omega2: float, load: float, segments: Table, nodes: Stack, runs: Whole, motions: Stack, points: Stack,
    work: Table, scratch: Table,
) -> int:  # fmt: skip
    """Number of natural frequencies below one, with their multiplicity; ``scratch`` is (n + 2, n)."""
    inside = scaled_stiffness(omega2, load, segments, nodes, runs, motions, points, work, scratch)
    negative, _ = inertia(scratch[: points.shape[1]])
    return inside + negative


def find_roots(
    segments: Table, nodes: Stack, runs: Whole, motions: Stack, points: Stack, work: Table, scratch: Table,
    bounds: Table, by_load: bool, above: float, below: float, known: int, roots: Row,
) -> None:  # fmt: skip
    """Circular frequencies, or critical load factors, ascending and with their multiplicity, into ``roots``.

    All roots lie between ``above`` and ``below``; ``known`` lie under them. ``scratch`` (n + 2, n) and ``bounds``
    (2, roots) are for use here.

    Each is bracketed by counts and then followed as a zero of the determinant, with the sign that the count gives
    it; where a fixed-end mode of a run lies in the bracket, by halving alone.
    """
    n, low, high = points.shape[1], bounds[0], bounds[1]
    matrix, static, scale = scratch[:n], scratch[n + 1], scratch[n]
    at_rest(segments, nodes, runs, motions, points, work, matrix, static)
    for i in range(roots.size):
        low[i], high[i] = above, below

    for index in range(roots.size):
        k = known + index + 1
        near, f_near, inside_near = low[index], np.inf, -1
        far, f_far, inside_far = high[index], -np.inf, -2
        third, f_third, unit = far, f_far, np.inf
        for _ in range(400):
            x = 0.5 * (near + far)
            if far > 2.0 * near:
                x = np.sqrt(near * far)
            elif inside_near == inside_far and np.isfinite(f_near) and np.isfinite(f_far):
                x = _between(near, f_near, far, f_far, third, f_third)
            if not near < x < far:
                break
            omega2, load = 0.0 if by_load else x * x, x if by_load else 1.0
            inside = scale_to(omega2, load, segments, nodes, runs, motions, points, work, static, scale, matrix)
            count, f = inside, -np.inf
            if inside != UNSTABLE:
                negative, size = inertia(matrix)
                count += negative
                # Only ratios of determinants matter, which are far too large or small as they are.
                unit = size if unit == np.inf else unit
                f = np.exp(size - unit) if count < k else -np.exp(size - unit)
            for i in range(roots.size):
                if count > known + i:
                    high[i] = min(high[i], x)
                else:
                    low[i] = max(low[i], x)
            if f > 0.0:
                third, f_third = near, f_near
                near, f_near, inside_near = x, f, inside
            else:
                third, f_third = far, f_far
                far, f_far, inside_far = x, f, inside
            if f == 0.0 or far - near <= 2.3e-16 * far:
                break
        roots[index] = near if f_near < -f_far else far

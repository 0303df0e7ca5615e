"""Mode shapes of a jib tabulated for compiled equations: Taylor polynomials about the middle of cells."""

from __future__ import annotations

from math import factorial
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from towercrane.cranes.tower.modes.mass_sums import Basis

    Floats = NDArray[np.float64]

POWERS = 8
"""Coefficients per cell."""

REACH = 0.04
"""Largest wave number times half a cell: the next Taylor term is then below 0.04^8/8! = 2e-16."""


def shape_table(bases: tuple[Basis, ...], ends: Sequence[float]) -> Floats:
    """Shapes of several bases along a jib, one after the other.

    Parameters
    ----------
    bases : tuple of Basis
    ends : sequence of float
        Ends of the sections in which the shapes are smooth, ascending from 0 [m]. Each has as many cells.

    Returns
    -------
    ndarray, shape (cells, shapes, POWERS)
    """
    spans = np.diff(ends)
    wave_number, along = 0.0, np.linspace(ends[0], ends[-1], 201)
    for basis in bases:
        if basis.count:
            largest = abs(basis(along)).max(axis=1)
            wave_number = max(wave_number, float(np.max(abs(basis(along, POWERS)).max(axis=1) / largest)))
    cells = max(1, int(np.ceil(spans.max() * wave_number ** (1.0 / POWERS) / (2.0 * REACH))))
    middles = (np.asarray(ends)[:-1, None] + (np.arange(cells) + 0.5) * spans[:, None] / cells).ravel()
    powers = [
        np.concatenate([basis(middles, derivative) for basis in bases]).T / factorial(derivative)
        for derivative in range(POWERS)
    ]
    shapes = sum(basis.count for basis in bases)
    return np.ascontiguousarray(np.stack(powers, axis=-1).reshape(len(middles), shapes, POWERS))

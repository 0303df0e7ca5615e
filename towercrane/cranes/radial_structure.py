"""Structure of the crane in radial motion in its modes: what many loads and ropes share."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import factorial
from typing import TYPE_CHECKING

import numpy as np

from modal.shapes import Modes, cantilever_modes
from towercrane.cranes import radial_kernel as kernel

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from modal.beam import Beam, EndBody
    from towercrane.cranes.tower_crane import TowerCrane

    Floats = NDArray[np.float64]

TABLE_POWERS = 8
"""Coefficients per cell of the tabulated jib shapes."""

TABLE_REACH = 0.04
"""Largest wave number times half a cell: the next Taylor term is then below 0.04^8/8! = 2e-16."""


@dataclass(frozen=True, eq=False)
class RadialStructure:
    """What of a crane's equations does not depend on its load, so that many loads share it.

    Parameters
    ----------
    vectors : ndarray, shape (4, coordinates)
        Without damping.
    base : ndarray, shape (coordinates, coordinates)
    tip_shapes : ndarray, shape (2, coordinates)
    mode_scale : ndarray, shape (coordinates,)
        Coordinate per metre where its mode moves most.
    shape_table : ndarray, shape (cells, jib modes, TABLE_POWERS)
        Jib shapes as Taylor polynomials about the middle of equal cells.
    """

    vectors: Floats
    base: Floats
    tip_shapes: Floats
    mode_scale: Floats
    shape_table: Floats


@lru_cache(maxsize=64)
def modes_of(beam: Beam, count: int, end_body: EndBody | None = None) -> Modes:
    """Modes of a beam, the same object for equal beams."""
    return cantilever_modes(beam, count) if end_body is None else cantilever_modes(beam, count, end_body)


@lru_cache(maxsize=32)
def structure_of(crane: TowerCrane, tower_modes: Modes, jib_modes: Modes) -> RadialStructure:
    """Structure of a crane in these modes, the same object for equal cranes."""
    tower, n = tower_modes.count, tower_modes.count + jib_modes.count
    tip_shapes, vectors = np.zeros((2, n)), np.zeros((4, n))
    tip_shapes[0, :tower] = tower_modes(crane.tower.length)
    tip_shapes[1, tower:] = jib_modes(crane.jib.length)
    vectors[kernel.TIP] = tip_shapes[0]
    vectors[kernel.SLOPE, :tower] = tower_modes(crane.tower.length, 1)
    vectors[kernel.JIB_MASS, tower:], vectors[kernel.JIB_MOMENT, tower:] = jib_modes.mass_moments()
    tip, slope = vectors[kernel.TIP], vectors[kernel.SLOPE]

    base = np.zeros((n, n))
    base[:tower, :tower] = tower_modes.mass_matrix()
    base += crane.slewing_mass * np.outer(tip, tip) + crane.slewing_inertia * np.outer(slope, slope)
    base[tower:, tower:] = jib_modes.mass_matrix()
    # Tilting the tower top moves the clamped jib through -gamma x: first order, absent in the source.
    base[:tower, tower:] = -np.outer(slope[:tower], vectors[kernel.JIB_MOMENT, tower:])
    base[tower:, :tower] = base[:tower, tower:].T
    # The tip alone would not do for the scale: higher tower modes move it little and the mast below it a lot.
    largest = [abs(m(np.linspace(0.0, m.beam.length, 201))).max(axis=1) for m in (tower_modes, jib_modes)]
    return RadialStructure(vectors, base, tip_shapes, 1.0 / np.concatenate(largest), _shape_table(jib_modes))


def _shape_table(jib: Modes) -> Floats:
    length, highest = jib.beam.length, jib.roots[-1] if jib.count else 0.0
    cells = max(1, int(np.ceil(highest / (2.0 * TABLE_REACH))))
    middles = (np.arange(cells) + 0.5) * length / cells
    shapes = [jib(middles, derivative).T / factorial(derivative) for derivative in range(TABLE_POWERS)]
    return np.ascontiguousarray(np.stack(shapes, axis=-1).reshape(cells, jib.count, TABLE_POWERS))

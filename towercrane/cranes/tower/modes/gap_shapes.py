"""Shapes of a tower that may meet collars with play: its modes while it is free, and how it bends under each collar.

Modes of the free tower alone converge slowly under a force at a height: the shear strain jumps there, which they
cannot. With one static shape more for each collar what the collar does slowly is exact.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from modal.structures.chain_modes import ChainModes, chain_modes
from towercrane.cranes.tower.modes.tied.shapes import Pull, static_shape

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from modal import Chain
    from modal.beams.beam import EndBody
    from modal.structures.part_shapes import PartShapes

    Floats = NDArray[np.float64]


def gap_shapes(chain: Chain, count: int, end_body: EndBody, heights: Sequence[float]) -> ChainModes:
    """Modes of a chain with a body on its end, and a shape for a force at each of some heights.

    Parameters
    ----------
    chain : Chain
        On its foundation, with the collars that always hold it.
    count : int
        Number of modes.
    end_body : EndBody
    heights : sequence of float
        [m]

    Returns
    -------
    ChainModes
        Orthonormal in the mass of chain and body and each with its stiffness; the modes come first, as they are.
    """
    for height in heights:
        chain, _ = chain.with_node(height)
    free = chain_modes(chain, count, end_body)
    modes, bent = free.shapes.coefficients, _bent(chain, free.shapes, heights)
    terms = max(modes.shape[2], bent.shape[2])
    rows = np.concatenate([np.pad(own, [(0, 0), (0, 0), (0, terms - own.shape[2]), (0, 0)]) for own in (modes, bent)])

    def mass(coefficients: Floats) -> Floats:
        own = ChainModes(chain, np.zeros(len(coefficients)), replace(free.shapes, coefficients=coefficients))
        turned = own.rotation(chain.length)
        moved = own(chain.length) + end_body.offset * turned
        body = end_body.mass * np.outer(moved, moved) + end_body.rotary_inertia * np.outer(turned, turned)
        return np.asarray(own.mass_matrix() + body)

    # What modes have of a shape is taken out twice: once leaves what rounding left.
    for _ in range(2):
        for own in range(count, len(rows)):
            products = mass(rows)
            known = slice(0, own)
            rows[own] -= np.tensordot(products[own, known], rows[known], 1)
            rows[own] /= np.sqrt(mass(rows[own : own + 1])[0, 0])
    left = ChainModes(chain, np.zeros(len(heights)), replace(free.shapes, coefficients=rows[count:]))
    squared, mix = np.linalg.eigh(left.stiffness_matrix())
    rows[count:] = np.tensordot(mix.T, rows[count:], 1)
    omega = np.concatenate([free.angular_frequencies, np.sqrt(squared)])
    return ChainModes(chain, omega, replace(free.shapes, coefficients=rows))


def _bent(chain: Chain, properties: PartShapes, heights: Sequence[float]) -> Floats:
    """How a chain on its springs bends under a unit force at each height, as coefficients of shapes.

    It bends as one that is clamped would under that force and those of its collars, and its foot moves: of these the
    one with the least energy.
    """
    ends, foot = properties.ends, chain.foundation
    shapes = [static_shape(chain, ends, Pull(height, 1.0, 0.0), hinged=False) for height in heights]
    for node, collar in chain.collars.items():
        place = chain.nodes[node]
        shapes += [
            static_shape(chain, ends, Pull(place, *loads), hinged=False)
            for stiffness, loads in ((collar.stiffness, (1.0, 0.0)), (collar.rotation_stiffness, (0.0, 1.0)))
            if stiffness
        ]
    rigid = np.zeros((2, *shapes[0].shape))
    rigid[0, :, 0, 0] = 1.0
    rigid[1, :, 0, 0], rigid[1, :, 1, 0], rigid[1, :, 0, [1, 4]] = ends[:-1], np.diff(ends), 1.0
    springs = foot.translation_stiffness, foot.rotation_stiffness
    shapes += [own for own, stiffness in zip(rigid, springs, strict=True) if np.isfinite(stiffness)]
    stiff = replace(chain, segments=tuple(replace(own, mass_flexibility=0.0) for own in chain.segments))
    # Each moves by one where it moves most, so that their energies compare.
    sizes = [np.max(abs(own[:, 0, :2])) for own in shapes]
    coefficients = np.array([own / size for own, size in zip(shapes, sizes, strict=True)])
    every = ChainModes(stiff, np.zeros(len(shapes)), replace(properties, coefficients=coefficients))
    mix = np.linalg.solve(every.stiffness_matrix(), every(heights))
    return np.asarray(np.tensordot(mix.T, coefficients, 1))

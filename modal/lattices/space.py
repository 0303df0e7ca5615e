"""Lattices in space: frames of round members, beams of sections, and what such a beam lacks at its end."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from modal.elements.space_beam import SpaceBeam
from modal.elements.space_frame import SpaceFrame

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from modal.lattices.section import LatticeSection

    Floats = NDArray[np.float64]

SHEAR_MODULUS = 1.0 / 2.6
"""Over Young's modulus, of steel."""


def frame_of_round(
    nodes: Floats,
    members: NDArray[np.int64],
    areas: Floats,
    moduli: Floats,
    masses_per_length: Floats,
    held: NDArray[np.int64],
    rigidity: float | None = None,
) -> SpaceFrame:
    """A frame whose members are pinned, or round and rigidly joined where a rigidity is given.

    Parameters
    ----------
    nodes, members, masses_per_length, held
        See `modal.elements.space_frame.SpaceFrame`.
    areas, moduli : ndarray, shape (m,)
        Areas [m^2] and Young's moduli [Pa].
    rigidity : float, optional
        Second moment of area over the square of the area [1].
    """
    stiff = areas * moduli
    if rigidity is None:
        return SpaceFrame(nodes, members, stiff, masses_per_length, held)
    bending = rigidity * areas * stiff
    return SpaceFrame(nodes, members, stiff, masses_per_length, held, bending, 2.0 * SHEAR_MODULUS * bending)


def beam_of(
    sections: Sequence[tuple[float, LatticeSection]], frame: SpaceFrame, reach: float, factors: Floats | float = 1.0
) -> SpaceBeam:
    """A beam of elements, their lengths [m] and sections, for a frame along x from its root on.

    A beam has its mass evenly all along, a frame has it at nodes, those of the root held, and chords that may end
    before it does. On a last reach [m], half a panel, the beam bears what brings each sum of mass times distance from
    the root to the frame's: half a frame of posts, less what of chords is not there. Masses of sections count times
    factors, one for each.
    """
    lengths = np.array([length for length, _ in sections])
    masses = np.array([section.mass_matrix for _, section in sections])
    masses *= np.broadcast_to(factors, len(sections))[:, np.newaxis, np.newaxis]
    flexibilities = np.array([section.flexibility for _, section in sections])
    ends = np.cumsum(lengths)
    moments = lengths * (ends - 0.5 * lengths)
    lacks = frame.moments_of_mass() - np.einsum("i,ijk->jk", moments, masses)
    # At least one element, however short the reach.
    last = ends > ends[-1] - reach * (1.0 - 1e-9)
    masses[last] += lacks / moments[last].sum()
    return SpaceBeam(lengths, flexibilities, masses)

"""What a uniform beam in place of a jib of segments would cost in the crane's frequencies."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from modal import Chain, Segment, crane_structure
from modal.structures.chain_modes import chain_modes

if TYPE_CHECKING:
    from collections.abc import Sequence

    from modal import CraneFrame

FIRST_ROOT = 1.8751040687119611
"""Of a clamped uniform beam."""


def uniform_jib_cost(frame: CraneFrame, positions: Sequence[float], count: int) -> list[dict[str, Any]]:
    """Relative changes of a crane's exact frequencies by a uniform jib as heavy as its own, with the same first one.

    Parameters
    ----------
    frame : CraneFrame
        With a jib of several segments, or with bodies or shear.
    positions : sequence of float
        Of the trolley [m].
    count : int
        Frequencies.

    Returns
    -------
    list of dict
        trolley_position_m and relative_difference, a number for each frequency, for every position.
    """
    assert frame.jib is not None, "jibs that bend alone are asked for"
    own = frame.jib
    mass = own.inertia[0] / own.length
    first = float(chain_modes(own, 1).angular_frequencies[0])
    bending = mass * (first * (own.length / FIRST_ROOT) ** 2) ** 2
    uniform = replace(frame, jib=Chain((Segment(own.length, mass, bending),)))
    found = []
    for position in positions:
        exact, other = (
            crane_structure(one, position).angular_frequencies(count) for one in (frame, uniform)
        )  # fmt: skip
        found.append({"trolley_position_m": position, "relative_difference": (other / exact - 1.0).tolist()})
    return found

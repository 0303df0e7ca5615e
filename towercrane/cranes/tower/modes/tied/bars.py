"""A cat-head with tie bars that hold jib and counter-jib, which hinge at their feet."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import hypot
from typing import TYPE_CHECKING

import numpy as np

from modal.checks import check_fields
from towercrane.cranes.tower.modes.tied.shapes import Pull

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

MOST_TIES = 6
"""On either side."""


@dataclass(frozen=True, slots=True)
class Tie:
    """Tie bar from the top of a cat-head to a jib or counter-jib.

    Parameters
    ----------
    position : float
        Of its end, from the tower's axis outward along the member [m].
    height : float
        Of that end above the member's axis [m].
    axial_stiffness : float
        E A [N].
    mass_per_length : float
        [kg/m]
    pretension : float, optional
        Tension under the crane's own weight, without trolley and load [N]; without it the tension at which the member
        is level there.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    position: float
    height: float
    axial_stiffness: float
    mass_per_length: float
    pretension: float | None = None

    def __post_init__(self) -> None:
        check_fields(self, positive=("position", "axial_stiffness", "mass_per_length"), not_negative=("height",))
        if self.pretension is not None:
            check_fields(self, positive=("pretension",))


@dataclass(frozen=True, slots=True)
class CatHead:
    """Upright column over the tower's top, from which the ties go.

    Parameters
    ----------
    height : float
        [m]
    mass_per_length, bending_stiffness, axial_stiffness : float
        [kg/m, N m^2, N]

    Raises
    ------
    ValueError
        If a number is not positive.
    """

    height: float
    mass_per_length: float
    bending_stiffness: float
    axial_stiffness: float

    def __post_init__(self) -> None:
        check_fields(self, positive=self.__slots__)


@dataclass(frozen=True, slots=True)
class TieBars:
    """Cat-head and ties of a crane.

    Parameters
    ----------
    head : CatHead
    jib, counter_jib : tuple of Tie
        One or more to either side, from the tower's axis outward.
    jib_axial, counter_jib_axial : tuple of (float, float)
        Axial stiffness of either member: distance up to which it holds [m], and E A [N].

    Raises
    ------
    ValueError
        If a side has no tie, ties are not in order, or one ends above the cat-head's top.
    """

    head: CatHead
    jib: tuple[Tie, ...]
    counter_jib: tuple[Tie, ...]
    jib_axial: tuple[tuple[float, float], ...]
    counter_jib_axial: tuple[tuple[float, float], ...]

    def __post_init__(self) -> None:
        for side in ("jib", "counter_jib"):
            ties: tuple[Tie, ...] = getattr(self, side)
            if not ties:
                raise ValueError(f"TieBars.{side}: wanted one tie or more, got none: its member would fall")
            if any(outer.position <= inner.position for inner, outer in pairwise(ties)):
                raise ValueError(f"TieBars.{side}: wanted ties from the tower's axis outward, got {ties!r}")
            if max(tie.height for tie in ties) >= self.head.height:
                raise ValueError(f"TieBars.{side}: wanted ends below the cat-head's top, got {ties!r}")

    @property
    def ties(self) -> tuple[Tie, ...]:
        """Those of the jib, then those of the counter-jib."""
        return (*self.jib, *self.counter_jib)

    @property
    def sides(self) -> tuple[float, ...]:
        """1 for a tie of the jib, -1 for one of the counter-jib."""
        return (1.0,) * len(self.jib) + (-1.0,) * len(self.counter_jib)

    @property
    def spans(self) -> Floats:
        """From the cat-head's top to the end of each straight tie: forward and up [m], shape (ties, 2)."""
        pairs = zip(self.sides, self.ties, strict=True)
        return np.array([[side * tie.position, tie.height - self.head.height] for side, tie in pairs])

    @property
    def compliance(self) -> Floats:
        """Lengthening of each tie per tension of each, that of jibs and cat-head with it [m/N], shape (ties, ties).

        Jibs and cat-head shorten under the ties as if they had no mass.
        """
        spans = self.spans
        lengths = np.hypot(*spans.T)
        cosines, sines = spans.T / lengths
        sides, height = self.sides, self.head.height
        found = np.outer(sines, sines) * height / self.head.axial_stiffness
        for i, one in enumerate(self.ties):
            found[i, i] += lengths[i] / one.axial_stiffness
            for j, other in enumerate(self.ties):
                if sides[i] == sides[j]:
                    axial = self.jib_axial if sides[i] > 0.0 else self.counter_jib_axial
                    found[i, j] += cosines[i] * cosines[j] * _shortening(axial, min(one.position, other.position))
        return np.asarray(found)

    def pulls(self, side: float) -> tuple[Pull, ...]:
        """What a unit tension of each tie of a side is to its member."""
        found = []
        for own, tie, span in zip(self.sides, self.ties, self.spans, strict=True):
            if own == side:
                length = hypot(*span)
                found.append(Pull(tie.position, -span[1] / length, tie.height * abs(span[0]) / length))
        return tuple(found)

    def inertia(self) -> tuple[float, float, float]:
        """Mass [kg], first moment forward [kg m], moment of inertia about the tower's axis [kg m^2]."""
        mass = moment = inertia = 0.0
        for side, tie, span in zip(self.sides, self.ties, self.spans, strict=True):
            own = tie.mass_per_length * hypot(*span)
            mass += own
            moment += 0.5 * own * side * tie.position
            inertia += own * tie.position**2 / 3.0
        return mass + self.head.mass_per_length * self.head.height, moment, inertia


def _shortening(axial: tuple[tuple[float, float], ...], length: float) -> float:
    """Shortening per force of a member's first so many metres [m/N]."""
    ends = [0.0, *(end for end, _ in axial)]
    pieces = zip(pairwise(ends), axial, strict=True)
    return sum(max(min(end, length) - begin, 0.0) / stiffness for (begin, end), (_, stiffness) in pieces)

"""What the wind meets of a flexible crane, by the place whose wind it is."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from modal.structures.part_shapes import gauss
from towercrane.cranes.parts import wind

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from towercrane.cranes.tower.modes.jib_shapes import JibShapes
    from towercrane.cranes.tower.modes.mass_sums import Basis, MassSums

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class HeadExposure:
    """What turns, as one place sees it.

    Parameters
    ----------
    node : int
        Place whose wind it is.
    jib, counter : MassSums
        Sums over the drag per squared speed [kg/m] of jib and counter-jib, in place of their mass; weighted with
        what is linear from one at this place to zero at its neighbours.
    """

    node: int
    jib: MassSums
    counter: MassSums


@dataclass(frozen=True, eq=False)
class TowerExposure:
    """A part of the tower.

    Parameters
    ----------
    node : int
        Place whose wind it is.
    area, moment : float
        Drag per squared speed of that place, and its first moment about the foot [kg/m, kg].
    swept : ndarray, shape (modes,)
        The same with the tower's shapes.
    """

    node: int
    area: float
    moment: float
    swept: Floats


@dataclass(frozen=True, eq=False)
class Exposure:
    """All that the wind meets but the load.

    Parameters
    ----------
    head : tuple of HeadExposure
    tower : tuple of TowerExposure
    """

    head: tuple[HeadExposure, ...]
    tower: tuple[TowerExposure, ...]


def exposure_of(
    shapes: JibShapes, tower: Basis, height: float, areas: wind.WindAreas, nodes: wind.WindNodes | None
) -> Exposure:
    """What the wind meets of a crane on a tower of this height [m]; without nodes one wind blows for all."""
    per_length = wind.drag(areas.tower)
    if nodes is None:
        whole = HeadExposure(0, *shapes.exposures(areas))
        swept = per_length * tower.deflection_integrals()
        return Exposure((whole,), (TowerExposure(0, per_length * height, per_length * height**2 / 2.0, swept),))
    parts, (points, weights) = [], gauss()
    for node, middle in enumerate(nodes.tower_heights(height)):
        length = height / nodes.tower
        z = middle + length * (points - 0.5)
        pressed = per_length * length * weights * (nodes.profile.share(z) / nodes.profile.share(middle)) ** 2
        parts.append(TowerExposure(node, float(pressed.sum()), float(pressed @ z), tower(z) @ pressed))
    if nodes.head == 1:
        return Exposure((HeadExposure(nodes.tower, *shapes.exposures(areas)),), tuple(parts))
    places = nodes.along_jib(shapes.crane.jib.length, shapes.crane.counter_jib_length)
    # From one neighbour it rises to the place, and falls to the other.
    panels = [
        (shapes.exposures(areas, (end, begin)), shapes.exposures(areas, (begin, end)))
        for begin, end in pairwise(places.tolist())
    ]
    falling, rising = [own[0] for own in panels], [own[1] for own in panels]
    sums = [falling[0], *map(_joined, rising, falling[1:]), rising[-1]]
    head = (HeadExposure(nodes.tower + node, *own) for node, own in enumerate(sums))
    return Exposure(tuple(head), tuple(parts))


def _joined(one: tuple[MassSums, MassSums], other: tuple[MassSums, MassSums]) -> tuple[MassSums, MassSums]:
    return one[0] + other[0], one[1] + other[1]

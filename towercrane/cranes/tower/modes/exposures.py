"""What the wind meets of a flexible crane, by the place whose wind it is."""

from __future__ import annotations

from dataclasses import dataclass, replace
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
    Sums = tuple[MassSums, MassSums]


@dataclass(frozen=True, eq=False)
class HeadExposure:
    """What turns, as one place sees it.

    Parameters
    ----------
    node : int
        Place whose wind it is.
    place : float
        Where it is along the jib, from the tower's axis [m].
    jib, counter : MassSums
        Sums over the drag per squared speed [kg/m] of jib and counter-jib, in place of their mass; weighted with
        what is linear from one at this place to zero at its neighbours.
    """

    node: int
    place: float
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
        Where the air knows that what turns moves itself, both ends of one panel after the other.
    tower : tuple of TowerExposure
    """

    head: tuple[HeadExposure, ...]
    tower: tuple[TowerExposure, ...]


def exposure_of(
    shapes: JibShapes, tower: Basis, height: float, areas: wind.WindAreas, nodes: wind.WindNodes | None,
    moves: bool = False,
) -> Exposure:  # fmt: skip
    """What the wind meets of a crane on a tower of this height [m].

    Without nodes one wind blows for all. Where the air knows that what turns ``moves`` itself, that is taken panel by
    panel.
    """
    head = _panels if moves else _places
    return Exposure(head(shapes, areas, nodes), _tower(tower, height, areas, nodes))


def _tower(
    tower: Basis, height: float, areas: wind.WindAreas, nodes: wind.WindNodes | None
) -> tuple[TowerExposure, ...]:
    per_length = wind.drag(areas.tower)
    if nodes is None:
        swept = per_length * tower.deflection_integrals()
        return (TowerExposure(0, per_length * height, per_length * height**2 / 2.0, swept),)
    parts, (points, weights) = [], gauss()
    for node, middle in enumerate(nodes.tower_heights(height)):
        length = height / nodes.tower
        z = middle + length * (points - 0.5)
        pressed = per_length * length * weights * (nodes.profile.share(z) / nodes.profile.share(middle)) ** 2
        parts.append(TowerExposure(node, float(pressed.sum()), float(pressed @ z), tower(z) @ pressed))
    return tuple(parts)


def _places(shapes: JibShapes, areas: wind.WindAreas, nodes: wind.WindNodes | None) -> tuple[HeadExposure, ...]:
    """What turns while it stands still for the wind, place by place."""
    if nodes is None or nodes.head == 1:
        return (HeadExposure(0 if nodes is None else nodes.tower, 0.0, *shapes.exposures(areas)),)
    places = nodes.along_jib(shapes.crane.jib.length, shapes.crane.counter_jib_length).tolist()
    # From one neighbour it rises to the place, and falls to the other.
    ends = _ends(shapes, areas, places)
    falling, rising = [own[0] for own in ends], [own[1] for own in ends]
    sums = [falling[0], *map(_joined, rising, falling[1:]), rising[-1]]
    parts = zip(places, sums, strict=True)
    return tuple(HeadExposure(nodes.tower + node, place, *own) for node, (place, own) in enumerate(parts))


def _panels(shapes: JibShapes, areas: wind.WindAreas, nodes: wind.WindNodes | None) -> tuple[HeadExposure, ...]:
    """What turns, both ends of each panel, the last of which is the counterweight."""
    crane = shapes.crane
    along = nodes if nodes is not None and nodes.head > 1 else wind.WindNodes()
    places = along.along_jib(crane.jib.length, crane.counter_jib_length).tolist()
    first, each = 0 if nodes is None else nodes.tower, int(nodes is along)
    jibs, weight = replace(areas, counterweight=0.0), replace(areas, jib=0.0, counter_jib=0.0)
    found = []
    for k, both in enumerate(_ends(shapes, jibs, places)):
        found += [HeadExposure(first + each * (k + m), places[k + m], *own) for m, own in enumerate(both)]
    for part in (weight, replace(weight, counterweight=0.0)):
        found.append(HeadExposure(first, places[0], *shapes.exposures(part)))
    return tuple(found)


def _ends(shapes: JibShapes, areas: wind.WindAreas, places: list[float]) -> list[tuple[Sums, Sums]]:
    """Of each panel between two places, what falls from its beginning to its end, and what rises."""
    return [
        (shapes.exposures(areas, (end, begin)), shapes.exposures(areas, (begin, end)))
        for begin, end in pairwise(places)
    ]


def _joined(one: Sums, other: Sums) -> Sums:
    return one[0] + other[0], one[1] + other[1]

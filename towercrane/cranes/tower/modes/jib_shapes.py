"""Shapes of jib and counter-jib, and sums over their mass and over what the wind meets of them."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from modal.beams.beam import Beam
from modal.beams.chain import Chain
from modal.beams.segment import Segment
from modal.beams.shapes import cantilever_modes
from modal.structures.chain_modes import ChainModes, chain_modes
from modal.structures.part_shapes import gauss
from towercrane.cranes.parts import wind
from towercrane.cranes.tower.modes.mass_sums import (
    Basis,
    MassSums,
    chain_sums,
    point_sums,
    rigid_sums,
    uniform_sums,
)
from towercrane.cranes.tower.modes.parameters import as_chain
from towercrane.cranes.tower.modes.tied.head import TiedHead
from towercrane.cranes.tower.modes.tied.shapes import column_shapes, hinged_shapes

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from modal import Modes
    from towercrane.cranes.tower.modes.mode_counts import ModeCounts
    from towercrane.cranes.tower.modes.parameters import TowerCrane
    from towercrane.cranes.tower.modes.tied.shapes import Pull


@dataclass(frozen=True, eq=False)
class JibShapes:
    """Shapes of what turns, in the groups of :class:`towercrane.cranes.tower.modes.modal_crane.FlexibleCrane`.

    Parameters
    ----------
    crane : TowerCrane
    lateral, vertical : Basis
        Of the jib.
    counter_lateral, counter_vertical : ChainModes or None
        Of a counter-jib that bends.
    jib, counter : MassSums
        Over the jib, and over what else turns but cat-head and ties.
    tied : TiedHead or None
    """

    crane: TowerCrane
    lateral: Basis
    vertical: Basis
    counter_lateral: ChainModes | None
    counter_vertical: ChainModes | None
    jib: MassSums
    counter: MassSums
    tied: TiedHead | None = None

    def exposures(
        self, areas: wind.WindAreas, rising: tuple[float, float] | None = None
    ) -> tuple[MassSums, MassSums]:
        """Sums over the drag per squared speed of jib and counter-jib, in place of their mass.

        Parameters
        ----------
        areas : WindAreas
        rising : tuple of 2 float, optional
            Places along the jib from the tower's axis [m]: between them the drag counts with a factor that rises
            from zero at the one to one at the other, and elsewhere not at all.
        """
        crane = self.crane
        per_length, tip = wind.drag(areas.counter_jib), wind.drag(areas.counterweight)
        if rising is None and isinstance(crane.jib, Beam) and crane.luffing is None:
            jib = self.jib.scaled(wind.drag(areas.jib) / crane.jib.mass_per_length)
        else:
            swept = _along(as_chain(crane.jib), wind.drag(areas.jib), self.lateral, self.vertical, rising=rising)
            jib = swept.among(*self._places("jib"))
        length = crane.counter_jib_length
        if self.counter_vertical is None or self.counter_lateral is None:
            if rising is None:
                total, moment = per_length * length + tip, -(per_length * length / 2 + tip) * length
                inertia = (per_length * length / 3 + tip) * length**2
                return jib, rigid_sums(total, moment, inertia, len(self.jib.first))
            distance, swept_area = _spread((0.0, length), per_length, -1.0, rising)
            x, pressed = -np.append(distance, length), np.append(swept_area, tip * _factor(-length, rising))
            total, moment, inertia = (float(pressed @ x**power) for power in range(3))
            return jib, rigid_sums(total, moment, inertia, len(self.jib.first))
        bases = self.counter_lateral, self.counter_vertical
        assert crane.counter_jib is not None
        end = point_sums(length, tip * _factor(-length, rising), *bases, side=-1.0)
        swept = _along(crane.counter_jib, per_length, *bases, -1.0, rising) + end
        return jib, swept.among(*self._places("counter"))

    def _places(self, member: str) -> tuple[NDArray[np.int64], int]:
        return _places(self.lateral, self.counter_lateral, self.vertical, self.counter_vertical)[member]


def shapes_of(crane: TowerCrane, modes: ModeCounts, planes: int = 2) -> JibShapes:
    """Shapes of a crane's jib and counter-jib, so many of each kind; in two planes ties bow to their sides."""
    lateral: Modes | ChainModes
    vertical: Modes | ChainModes
    bars = crane.tie_bars
    pulled = ((), ()) if bars is None else (bars.pulls(1.0), bars.pulls(-1.0))
    if bars is None and isinstance(crane.jib, Beam) and isinstance(crane.jib_lateral, Beam | None):
        lateral = cantilever_modes(crane.jib_lateral or crane.jib, modes.lateral)
        vertical = cantilever_modes(crane.jib, modes.vertical)
        # The shapes do not depend on the bending stiffness: the longer list serves both directions.
        both = max(lateral, vertical, key=lambda m: m.count)
        jib = uniform_sums(crane.jib.length, crane.jib.mass_per_length, both, modes.lateral, modes.vertical)
    else:
        lateral, vertical, jib = _of_chain(
            crane.jib, crane.jib_lateral, modes.lateral, modes.vertical, pulls=pulled[0]
        )
    counter_lateral = counter_vertical = None
    mass, moment, inertia = 0.0, 0.0, 0.0
    if crane.counter_jib is None:
        mass, moment, inertia = crane.counter_mass, crane.counter_moment, crane.counter_inertia
    else:
        members = crane.counter_jib, crane.counter_jib_lateral
        counts = modes.counter_lateral, modes.counter_vertical
        counter_lateral, counter_vertical, counter = _of_chain(*members, *counts, side=-1.0, pulls=pulled[1])
    places = _places(lateral, counter_lateral, vertical, counter_vertical)
    rest = rigid_sums(mass, moment, inertia, places["jib"][1], roll=crane.roll_inertia)
    if crane.counter_jib is not None:
        rest = counter.among(*places["counter"]) + rest
    tied, groups = None, (lateral, vertical, counter_lateral, counter_vertical)
    if bars is not None:
        assert isinstance(lateral, ChainModes), "both members are chains"
        assert isinstance(vertical, ChainModes), "both members are chains"
        assert counter_lateral is not None, "both members bend"
        assert counter_vertical is not None, "both members bend"
        column = Segment(bars.head.height, bars.head.mass_per_length, bars.head.bending_stiffness)
        tied = TiedHead(
            bars,
            (lateral, counter_lateral, vertical, counter_vertical),
            column_shapes(Chain((column,)), 0),
            planes > 1,
        )
    return JibShapes(crane, *groups, jib.among(*places["jib"]), rest, tied)


def _of_chain(
    vertical: Beam | Chain, lateral: Beam | Chain | None, left: int, up: int, side: float = 1.0,
    pulls: Sequence[Pull] = (),
) -> tuple[ChainModes, ChainModes, MassSums]:  # fmt: skip
    """Modes of a member to the left and up, so many of either, and sums over its mass.

    One that ties pull up hinges at its foot, and has shapes beside the modes.
    """
    upright, sideways = as_chain(vertical), None if lateral is None else as_chain(lateral)
    for pull in pulls:
        upright, _ = upright.with_node(pull.place)
        sideways = None if sideways is None else sideways.with_node(pull.place)[0]
    to_left = chain_modes(sideways or upright, left)
    upward = hinged_shapes(upright, up, pulls) if pulls else chain_modes(upright, up)
    return to_left, upward, chain_sums(upright, sideways, upward, to_left, side)


def _along(
    chain: Chain, per_length: float, lateral: Basis, vertical: Basis, side: float = 1.0,
    rising: tuple[float, float] | None = None,
) -> MassSums:  # fmt: skip
    """Sums over the same for every length of a member, with a factor as `JibShapes.exposures` has it."""
    return point_sums(*_spread(chain.nodes, per_length, side, rising), lateral, vertical, side)


def _spread(
    nodes: Sequence[float], per_length: float, side: float, rising: tuple[float, float] | None
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Distances from a member's root, and the same for every length at each of them."""
    points, weights = gauss()
    inside = [] if rising is None else [side * x for x in rising if 0.0 < side * x < nodes[-1]]
    ends = np.unique([*nodes, *inside])
    distance = (ends[:-1, None] + np.diff(ends)[:, None] * points).ravel()
    swept = per_length * (np.diff(ends)[:, None] * weights).ravel()
    return distance, swept * _factor(side * distance, rising)


def _factor(x: NDArray[np.float64] | float, rising: tuple[float, float] | None) -> NDArray[np.float64] | float:
    if rising is None:
        return 1.0
    if rising[0] == rising[1]:
        # Of a counter-jib without length both ends have half of what is there.
        return np.where(x == rising[1], 0.5, 0.0)
    share = (x - rising[0]) / (rising[1] - rising[0])
    return np.where((share >= 0.0) & (share <= 1.0), share, 0.0)


def _places(
    lateral: Basis, counter_lateral: Basis | None, vertical: Basis, counter_vertical: Basis | None
) -> dict[str, tuple[NDArray[np.int64], int]]:
    """Which of all shapes those of jib and counter-jib are, and how many there are."""
    counts = [0 if own is None else own.count for own in (lateral, counter_lateral, vertical, counter_vertical)]
    ends = np.cumsum([0, *counts])
    own = [np.arange(a, b) for a, b in pairwise(ends)]
    found = {"jib": np.concatenate(own[::2]), "counter": np.concatenate(own[1::2])}
    return {member: (places, int(ends[-1])) for member, places in found.items()}

"""Natural frequencies that a drive excites: what moves along the jib for trolley and hoist, across it for slewing."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.tower.equations.small_motions import natural_modes

if TYPE_CHECKING:
    from towercrane.cranes.tower.model import FlexibleModel
    from towercrane.cranes.tower.modes.modal_crane import FlexibleCrane

TURNS = ("slewing", "shaft")
"""Channels that turn the jib."""

ACROSS = ("lateral", "torsion", "lateral sway", "lateral sling")
"""Kinds of mode that turning excites."""

LATERAL_PAIR = 2
"""Modes that turning excites: torsion of the tower and lateral sway are near each other and share both motions. Each
sling has one more."""

ALONG = ("radial sway", "radial sling")
"""Kinds of mode that a trolley, or a jib that luffs, excites; the second where there are slings."""


@dataclass(frozen=True, eq=False)
class SwayFrequencies:
    """Frequencies of a flexible crane's sway, by drive and place.

    Parameters
    ----------
    model : FlexibleModel
    """

    model: FlexibleModel
    _known: dict[tuple[bool, float, float], tuple[float, ...]] = field(default_factory=dict, init=False, repr=False)

    def __call__(self, channel: str, place: float, rope: float) -> tuple[float, ...]:
        """Frequencies that a drive excites, ascending [Hz]: two across the jib, one along it; more with slings.

        Parameters
        ----------
        channel : str
            Of the model: what is driven.
        place, rope : float
            Trolley position [m] or luffing angle [rad], and rope length [m].

        Raises
        ------
        NoEquilibrium
            If the crane cannot stand there.
        """
        key = (channel in TURNS, place, rope)
        if key not in self._known:
            self._known[key] = self._found(*key)
        return self._known[key]

    def _found(self, turns: bool, place: float, rope: float) -> tuple[float, ...]:
        modes = natural_modes(self._scene, place, rope)
        if turns:
            across = [m for m in modes if sum(m.shares[kind] for kind in ACROSS) > 0.5]
            return tuple(m.frequency_hz for m in across[: LATERAL_PAIR + len(self.model.load.slings)])
        kinds = ALONG[: len(self.model.load.bodies)]
        most = {max(modes, key=lambda m: m.shares[kind]).frequency_hz for kind in kinds}
        return tuple(sorted(most))

    @cached_property
    def _scene(self) -> FlexibleModel:
        """The crane with a load that may swing to all sides."""
        return self.model if self.model.axes == 3 else dataclasses.replace(self.model, axes=3, heading=0.0)


@dataclass(frozen=True, slots=True)
class PendulumFrequencies:
    """Frequency of a load on a crane that does not give, sqrt(g / l) / 2 pi.

    Parameters
    ----------
    gravity : float
        [m/s^2]
    crane : FlexibleCrane, optional
        One whose jib pivots: as it luffs the rope that hangs from its head changes.
    below : float
        From the rope's end to the load, of slings below a hook that is taken for massless [m].
    """

    gravity: float
    crane: FlexibleCrane | None = None
    below: float = 0.0

    def __call__(self, channel: str, place: float, rope: float) -> tuple[float, ...]:
        """The pendulum's frequency [Hz], whatever is driven and wherever the trolley is."""
        if self.crane is not None and self.crane.luffing is not None:
            rope = self.crane.luffing.below(self.crane.jib_length, place, rope)
        return (float(np.sqrt(self.gravity / (rope + self.below)) / (2.0 * np.pi)),)

"""Cranes on ties and with a jib that pivots, in the plane: small motions of a rich model about its equilibrium."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.tower.crane_model import PLANE_MODES, described
from towercrane.cranes.tower.equations.small_motions import plane_matrices, reciprocal_modes
from towercrane.cranes.tower.file.build import crane_of, tower_model
from towercrane.simulation.outcomes import FINISHED
from towercrane.simulation.system import NoEquilibrium

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from towercrane.cranes.tower.file.case_tables import TowerCase
    from towercrane.cranes.tower.model import FlexibleModel

    Floats = NDArray[np.float64]

RICH = {"tower_modes": 4, "jib_vertical_modes": 6, "counter_jib_vertical_modes": 2}
"""Modes of the model whose frequencies are shown."""

RICHER = {"tower_modes": 6, "jib_vertical_modes": 10, "counter_jib_vertical_modes": 4}
"""Those of the model that says what they lack."""

HELD = {"ties": "tie", "luffing rope": "luffing"}
"""What holds a jib up, by the kind of coordinates that it moves in."""


def rich_crane(tables: TowerCase, counts: dict[str, int] = RICH) -> RitzCrane:
    """The crane of a case in so many modes of the kinds for which it has data."""
    known = described(crane_of(tables))
    modes = {kind: counts[kind] if kind in known else 0 for kind in PLANE_MODES}
    model = tower_model(tables, planar=True, heading=0.0, **modes)
    return RitzCrane(model, tables.rope.length)


@dataclass(frozen=True, eq=False)
class RitzCrane:
    """A crane in the modes of a model in the plane, ready to be asked at many places.

    Parameters
    ----------
    model : FlexibleModel
        Of a crane on ties or with a jib that pivots.
    rope_length : float
        As the winch has it [m].
    """

    model: FlexibleModel
    rope_length: float

    @cached_property
    def members(self) -> tuple[str, ...]:
        """Where the potential energy of a mode is. What holds the jib has all that is in no member, weight too."""
        holding = next(name for name, kind in HELD.items() if kind in self.model.counts)
        return ("tower", "jib", "counter-jib", holding, "load")

    @property
    def most(self) -> int:
        """Modes that it has."""
        return self.model.coordinates + 1

    def loaded(self, mass: float) -> RitzCrane:
        """The same crane with a load of another mass [kg]."""
        return RitzCrane(self.model.with_load(replace(self.model.load, mass=mass)), self.rope_length)

    def outcome(self, places: Sequence[float]) -> str:
        """What keeps the crane from standing at one of these places; "finished" where nothing does."""
        try:
            for place in places:
                plane_matrices(self.model, place, self.rope_length)
        except NoEquilibrium as failure:
            return failure.outcome
        return FINISHED

    def modes(self, position: float, count: int) -> RitzModes:
        """Lowest natural modes with the trolley at a distance [m], or the jib at an angle [rad].

        Raises
        ------
        NoEquilibrium
            If the crane cannot stand there.
        """
        model = self.model
        mass, stiffness = plane_matrices(model, position, self.rope_length)
        frequencies, vectors = reciprocal_modes(model, mass, stiffness)
        squared, axes = np.linalg.eigh(mass)
        moved = (axes * np.sqrt(squared)) @ axes.T @ vectors[:, :count]
        return RitzModes(
            frequencies[:count] / (2.0 * np.pi),
            (moved / np.linalg.norm(moved, axis=0)).T,
            self._shares(vectors[:, :count], stiffness[-1, -1]),
        )

    def _shares(self, vectors: Floats, pendulum: float) -> Floats:
        """Shares of `members` in modes of unit potential energy, shape (count, members)."""
        model, own = self.model, self.model.angular_frequencies**2
        tower = vectors[model.parts["tower_x"]]
        jibs = (model.parts[kind] for kind in ("jib_vertical", "counter_jib_vertical"))
        bent = [own[part] @ vectors[part] ** 2 for part in jibs]
        parts = [(tower * (model.crane.tower_matrices[1] @ tower)).sum(axis=0), *bent]
        swing = pendulum * vectors[-1] ** 2
        return np.stack([*parts, 1.0 - sum(parts) - swing, swing], axis=1)


@dataclass(frozen=True, eq=False)
class RitzModes:
    """Natural modes at one place.

    Parameters
    ----------
    frequencies : ndarray, shape (n,)
        [Hz]
    shapes : ndarray, shape (n, coordinates + 1)
        Coordinates times the root of their mass matrix, rows of unit length.
    energy_shares : ndarray, shape (n, members)
    """

    frequencies: Floats
    shapes: Floats
    energy_shares: Floats


def counts_in_words(crane: RitzCrane) -> str:
    """Its modes, for people."""
    counts: dict[str, Any] = crane.model.counts
    kinds = {"tower_x": "tower", "jib_vertical": "jib", "counter_jib_vertical": "counter-jib"}
    found = [f"{counts[kind]} shapes of the {name}" for kind, name in kinds.items() if counts[kind]]
    return ", ".join(found + ["one half-wave of each tie"] * ("tie" in counts))

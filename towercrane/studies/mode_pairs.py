"""Modes of a run's plane model beside those of the exact crane, paired by their shapes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from modal.structures.part_shapes import DEFLECTION
from towercrane.cranes.tower.equations.small_motions import plane_matrices, reciprocal_modes
from towercrane.studies.branches import CLEAR
from towercrane.studies.plane_modes import MEMBERS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.tower.model import FlexibleModel
    from towercrane.cranes.tower.modes.mass_sums import Basis
    from towercrane.studies.plane_modes import PlaneCrane

    Floats = NDArray[np.float64]

BELONGING = 0.5
"""Share of a mode's energy in what a model can do, below which the mode is missing from it."""

AHEAD = 1.2
"""Exact modes are looked at up to so many times the highest frequency of the model that is shown."""


@dataclass(frozen=True, slots=True)
class ModePairs:
    """The lowest modes of a model beside the exact crane's.

    Parameters
    ----------
    frequencies_hz : list of float
        Of the model, ascending [Hz].
    exact_hz : list of float or None
        Of the exact mode of the same shape [Hz]; None where the exact crane has none.
    missing : list of (float, str)
        Exact modes up to the model's highest here that it cannot have: frequency [Hz] and that one of
        `towercrane.studies.plane_modes.MEMBERS` which has most of the mode's potential energy.
    unlike : list of float
        Frequencies of the other exact modes up to there that no mode of the model is like [Hz].
    """

    frequencies_hz: list[float]
    exact_hz: list[float | None]
    missing: list[tuple[float, str]]
    unlike: list[float]


def paired_modes(model: FlexibleModel, crane: PlaneCrane, trolley_position: float, count: int) -> ModePairs:
    """Pair the lowest modes of a model with those of the exact crane by their shapes.

    Parameters
    ----------
    model : FlexibleModel
    crane : PlaneCrane
        The same crane with the same load.
    trolley_position : float
        Distance of the trolley from the tower's axis [m].
    count : int
        Number of the model's modes, at most as many as it has.

    Raises
    ------
    NoEquilibrium
        If the weight's softening leaves the model's tower no stiffness.
    modal.Unstable
        If it leaves the exact tower none.

    Notes
    -----
    Shapes are compared by the modal assurance criterion (Allemang and Brown 1982) with the stiffness K as its weight,
    ``(a' K b)^2 / (a' K a) (b' K b)``: the share of either mode's energy that is in the other. With the mass instead,
    a heavy counterweight that its jib lets swing would be like one that turns with the tower's top. As b is a mode
    of the exact crane, ``K b = omega_b^2 M b``, and the criterion is that with the mass M times
    ``(omega_b / omega_a)^2``. Over all modes a of the model it adds up to the share of b's energy in what the model
    can do.
    """
    frequencies, shapes = _model_modes(model, crane, trolley_position)
    highest = float(frequencies[count - 1])
    most = AHEAD * 2.0 * np.pi * highest
    theirs = crane.modes(trolley_position, max(1, crane.structure(trolley_position).count_below(most)))
    criteria = (shapes @ theirs.shapes.T * (theirs.frequencies / frequencies[:, None])) ** 2
    exact: list[float | None] = [None] * count
    taken = set()
    # Shapes of either crane are orthogonal, so a criterion above one half is had with one mode at the most.
    for a, b in np.argwhere(criteria[:count] >= CLEAR):
        exact[a] = float(theirs.frequencies[b])
        taken.add(b)
    missing, unlike = [], []
    for b in np.flatnonzero(theirs.frequencies <= highest):
        frequency = float(theirs.frequencies[b])
        if criteria[:, b].sum() < BELONGING:
            missing.append((frequency, MEMBERS[int(np.argmax(theirs.energy_shares[b]))]))
        elif b not in taken:
            unlike.append(frequency)
    return ModePairs(frequencies[:count].tolist(), exact, missing, unlike)


def _model_modes(model: FlexibleModel, crane: PlaneCrane, trolley_position: float) -> tuple[Floats, Floats]:
    """Frequencies of all modes of the model [Hz], and its shapes as those of the crane."""
    matrices = plane_matrices(model, trolley_position, crane.frame.rope_length)
    frequencies, columns = reciprocal_modes(model, *matrices)
    vectors, tower, bases = columns.T.copy(), model.counts["tower_x"], model.crane
    of_tower = vectors[:, :tower]
    turn, still = of_tower @ bases.top_slope, np.zeros(len(vectors))
    # The load's motion is relative to where it hangs.
    vectors[:, -1] += of_tower @ bases.tower(bases.tower_height)
    parts = {
        "tower": _Shapes(still, of_tower, bases.tower),
        "jib": _Shapes(-turn, vectors[:, model.parts["jib_vertical"]], bases.vertical),
        "counter-jib": _Shapes(turn, vectors[:, model.parts["counter_jib_vertical"]], bases.counter_vertical),
    }
    return frequencies / (2.0 * np.pi), crane.motion(trolley_position, parts, vectors[:, -1])


@dataclass(frozen=True, eq=False)
class _Shapes:
    """A part's shapes as the model has them: it turns with its foot, and its basis bends upon that."""

    turned: Floats
    amplitudes: Floats
    basis: Basis | None

    def evaluate(self, position: Floats | float, quantity: int = DEFLECTION) -> Floats:
        where = np.asarray(position, dtype=float)
        moves = quantity == DEFLECTION
        found: Floats = np.multiply.outer(self.turned, where if moves else np.ones_like(where))
        if self.basis is not None:
            found += self.amplitudes @ (self.basis(where) if moves else self.basis.rotation(where))
        return found

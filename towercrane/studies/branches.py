"""Branches of natural modes along a path: followed by their shapes through crossings and veerings, not by rank."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Generic, Protocol, TypeVar

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Ranks = NDArray[np.int64]

CLEAR = 0.8
"""Modal assurance criterion from which two shapes are the same mode: they are less than 27 degrees apart."""

FINEST = 10
"""Halvings of a step where modes are hard to tell apart; modes that exchange their shapes within a shorter piece of
the path than the step over 2^FINEST count as crossing."""

EQUAL = 1e-8
"""Relative distance of frequencies below which any mixture of their shapes is a mode as well."""


class Spectrum(Protocol):
    """Natural modes at one place of the path."""

    @property
    def frequencies(self) -> Floats:
        """Ascending, shape (n,)."""

    @property
    def shapes(self) -> Floats:
        """Motion of the same physical points, times the roots of their masses; rows of unit length, shape (n, p)."""


S = TypeVar("S", bound=Spectrum)


@dataclass(frozen=True, eq=False)
class _Here(Generic[S]):
    """What is known at one place: the modes in the order of the branches."""

    spectrum: S
    ranks: Ranks
    shapes: Floats

    @property
    def frequencies(self) -> Floats:
        return self.spectrum.frequencies[self.ranks]


@dataclass(frozen=True, eq=False)
class Branches(Generic[S]):
    """Modes that belong together along a path.

    Parameters
    ----------
    spectra : list
        Natural modes at every place, as they were computed.
    ranks : ndarray of int, shape (places, n)
        Which of a place's modes, counted from 0 by frequency, belongs to each branch.
    agreement : ndarray, shape (places, n)
        Modal assurance criterion between a branch's shape here and at the place before, the smallest of the steps
        that were taken between the two [1]; one at the first place.
    solved : int
        Number of spectra that were computed.
    """

    spectra: list[S]
    ranks: Ranks
    agreement: Floats
    solved: int


def follow(
    solve: Callable[[float], S], places: Sequence[float], kept: int, order: Ranks | None = None
) -> Branches[S]:
    """Follow modes along a path.

    Between neighbouring places modes are assigned to each other so that the sum of the modal assurance criteria
    (Allemang and Brown 1982), the squared cosines between shapes, is largest. Where an assigned pair is not `CLEAR`,
    or two branches change places in frequency, the step is halved, `FINEST` times at most: so a veering, whose modes
    exchange their shapes on a piece of the path, keeps its order, and a crossing goes straight through.

    Parameters
    ----------
    solve : callable
        Natural modes at a place; always the same number n of them.
    places : sequence of float
        Along the path.
    kept : int
        The first branches, which have to be told apart clearly. The others are there so that a branch that is kept
        may cross them.
    order : ndarray of int, shape (n,), optional
        Ranks of the branches at the first place; by frequency without it.

    Raises
    ------
    ValueError
        If there is no place or fewer modes than are kept.
    """
    if len(places) == 0:
        raise ValueError("places: wanted at least one, got none")
    solved = 0

    def counted(place: float) -> S:
        nonlocal solved
        solved += 1
        return solve(place)

    first = counted(places[0])
    count = len(first.frequencies)
    if not 0 < kept <= count:
        raise ValueError(f"kept: wanted 1 to {count} modes, got {kept!r}")
    ranks = np.arange(count) if order is None else np.asarray(order)
    here = _Here(first, ranks, first.shapes[ranks])
    found, agreement = [here], [np.ones(count)]

    def advance(here: _Here[S], start: float, there: S, end: float, halvings: int) -> tuple[_Here[S], Floats]:
        matched, likeness = _matched(here, there)
        middle = 0.5 * (start + end)
        settled = bool((likeness[:kept] >= CLEAR).all()) and not _exchanged(here, matched, likeness, kept)
        if settled or halvings == 0:
            return matched, likeness
        between, before = advance(here, start, counted(middle), middle, halvings - 1)
        matched, after = advance(between, middle, there, end, halvings - 1)
        return matched, np.minimum(before, after)

    for start, end in pairwise(places):
        here, likeness = advance(here, start, counted(end), end, FINEST)
        found.append(here)
        agreement.append(likeness)
    return Branches(
        [state.spectrum for state in found], np.array([state.ranks for state in found]), np.array(agreement), solved
    )


def _matched(here: _Here[S], there: S) -> tuple[_Here[S], Floats]:
    """The modes of another place in the order of the branches, and the assurance criterion of every pair."""
    from scipy.optimize import linear_sum_assignment

    shapes = _untangled(here.shapes, there)
    criteria = (here.shapes @ shapes.T) ** 2
    _, ranks = linear_sum_assignment(-criteria)
    return _Here(there, ranks, shapes[ranks]), criteria[np.arange(len(ranks)), ranks]


def _untangled(wanted: Floats, there: Spectrum) -> Floats:
    """Shapes of a place, those of equal frequency mixed so that they are most like the ones that are followed."""
    shapes, frequencies = there.shapes.copy(), there.frequencies
    start = 0
    for end in range(1, len(frequencies) + 1):
        if end < len(frequencies) and frequencies[end] - frequencies[end - 1] <= EQUAL * frequencies[end]:
            continue
        if end - start > 1:
            projected = wanted @ shapes[start:end].T
            nearest = np.sort(np.argsort((projected**2).sum(axis=1))[start - end :])
            # Orthogonal Procrustes: the rotation nearest to a matrix is that of its polar decomposition.
            left, _, right = np.linalg.svd(projected[nearest])
            shapes[start:end] = left @ right @ shapes[start:end]
        start = end
    return shapes


def _exchanged(here: _Here[S], there: _Here[S], likeness: Floats, kept: int) -> bool:
    """Whether a branch that is kept overtakes another, which is itself followed with certainty."""
    before, after = here.frequencies, there.frequencies
    apart_before = before[:kept, None] - before
    apart_after = after[:kept, None] - after
    scale = EQUAL * np.maximum(before, after)
    certain = (np.abs(apart_before) > scale) & (np.abs(apart_after) > scale) & (likeness > 0.5)
    return bool((certain & (apart_before * apart_after < 0.0)).any())

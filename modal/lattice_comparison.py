"""Three beams in place of a laced column, beside the truss that it is: deflections, frequencies, errors, times."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, get_args

import numpy as np

from modal.clock import timed
from modal.lattice import BeamModel

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from modal.beam import EndBody
    from modal.lattice import LacedColumn
    from modal.segment import Segment


@dataclass(frozen=True, slots=True)
class LatticeAnswers:
    """What a model of a clamped laced column says.

    Parameters
    ----------
    force_deflection : float
        Deflection of the top per force on it [m/N].
    moment_deflection : float
        Deflection of the top per moment on it [1/N].
    frequencies_hz : tuple of float
        Lowest natural frequencies of the bare column [Hz].
    body_frequencies_hz : tuple of float
        The same with the slewing part on top [Hz].
    """

    force_deflection: float
    moment_deflection: float
    frequencies_hz: tuple[float, ...]
    body_frequencies_hz: tuple[float, ...]

    def relative_to(self, other: LatticeAnswers) -> LatticeAnswers:
        """Every answer over another's, less one [1]."""
        return LatticeAnswers(
            self.force_deflection / other.force_deflection - 1.0,
            self.moment_deflection / other.moment_deflection - 1.0,
            _ratios(self.frequencies_hz, other.frequencies_hz),
            _ratios(self.body_frequencies_hz, other.body_frequencies_hz),
        )


@dataclass(frozen=True, slots=True)
class LatticeModel:
    """A model of a laced column, what it says and how far that is from the truss.

    Parameters
    ----------
    name : str
        "truss", "shear-flexible", "euler" or "code-equivalent", see `modal.lattice.LacedColumn.segment`.
    answers : LatticeAnswers
    errors : LatticeAnswers
        Relative to the truss [1].
    seconds : float
        Median time for all answers [s].
    """

    name: str
    answers: LatticeAnswers
    errors: LatticeAnswers
    seconds: float


def compare_lattice_models(
    column: LacedColumn,
    height: float,
    body: EndBody,
    mass_per_length: float | None = None,
    *,
    count: int = 2,
    repeats: int = 5,
) -> tuple[LatticeModel, ...]:
    """The truss of a laced column on a rigid foot and the three beams that stand for it.

    Parameters
    ----------
    column : LacedColumn
    height : float
        Height [m], a whole number of panels.
    body : EndBody
        The slewing part on its top.
    mass_per_length : float, optional
        Mass per height [kg/m]; without one, the members' own.
    count : int
        Number of frequencies.
    repeats : int
        Calls that the time is the median of.

    Returns
    -------
    tuple of LatticeModel
        The truss first.

    Raises
    ------
    ValueError
        If the truss is a mechanism or the height not a whole number of panels.
    """
    truss, seconds = timed(partial(truss_answers, column, height, body, mass_per_length, count), repeats)
    models = [LatticeModel("truss", truss, truss.relative_to(truss), seconds)]
    for name in get_args(BeamModel):
        segment = column.segment(height, mass_per_length, name)
        answers, seconds = timed(partial(beam_answers, segment, body, count), repeats)
        models.append(LatticeModel(name, answers, answers.relative_to(truss), seconds))
    return tuple(models)


def truss_answers(
    column: LacedColumn, height: float, body: EndBody, mass_per_length: float | None, count: int
) -> LatticeAnswers:
    """What the truss of a column says; see `compare_lattice_models`."""
    from modal.truss import ColumnTruss

    truss = ColumnTruss(column, height, mass_per_length)
    bare, loaded = (truss.bending_frequencies(count, there) for there in (None, body))
    return LatticeAnswers(truss.tip(force=1.0)[0], truss.tip(moment=1.0)[0], _hertz(bare), _hertz(loaded))


def beam_answers(segment: Segment, body: EndBody, count: int) -> LatticeAnswers:
    """What a clamped beam says: statically in closed form, its frequencies by dynamic stiffness."""
    from modal.chain import Chain
    from modal.structure import chain_frequencies

    L, EI, S = segment.length, segment.bending_stiffness, segment.shear_stiffness
    bare, loaded = (chain_frequencies(Chain((segment,), bodies), count) for bodies in ({}, {1: body}))
    return LatticeAnswers(L**3 / (3.0 * EI) + L / S, L**2 / (2.0 * EI), _hertz(bare), _hertz(loaded))


def _hertz(angular: NDArray[np.float64]) -> tuple[float, ...]:
    return tuple((angular / (2.0 * np.pi)).tolist())


def _ratios(found: tuple[float, ...], reference: tuple[float, ...]) -> tuple[float, ...]:
    return tuple(a / b - 1.0 for a, b in zip(found, reference, strict=True))

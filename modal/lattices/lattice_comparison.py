"""Beams in place of laced columns, beside the truss that they are: deflections, frequencies, errors, times."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, get_args

import numpy as np

from modal.checks import whole_number
from modal.clock import timed
from modal.lattices.lattice import BeamModel

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from modal.beams.beam import EndBody
    from modal.beams.segment import Segment
    from modal.lattices.lattice import LacedColumn
    from modal.lattices.truss import ColumnTruss


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
        "truss", "shear-flexible", "euler" or "code-equivalent", see `modal.lattices.lattice.LacedColumn.segment`.
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
    """The truss of a laced column on a rigid foot and the three beams that stand for it, see `compare_truss`.

    Raises
    ------
    ValueError
        If the truss is a mechanism or the height not a whole number of panels.
    """
    from modal.lattices.truss import ColumnTruss

    return compare_truss(ColumnTruss(column, height, mass_per_length), body, count=count, repeats=repeats)


def compare_truss(truss: ColumnTruss, body: EndBody, *, count: int = 2, repeats: int = 5) -> tuple[LatticeModel, ...]:
    """A truss on a rigid foot, of one column or of several, and the beams that stand for it.

    Parameters
    ----------
    truss : ColumnTruss
    body : EndBody
        The slewing part on its top.
    count : int
        Number of frequencies.
    repeats : int
        Calls that the time is the median of.

    Returns
    -------
    tuple of LatticeModel
        The truss first. The code's equivalent beam is that of a single column that does not taper.
    """
    whole_number("count", count, 1)
    whole_number("repeats", repeats, 1)
    answers, seconds = timed(partial(truss_answers, truss, body, count), repeats)
    models = [LatticeModel("truss", answers, answers.relative_to(answers), seconds)]
    uniform = truss.above is None and truss.top_ratio == 1.0
    for name in get_args(BeamModel):
        if uniform or name != "code-equivalent":
            found, seconds = timed(partial(beam_answers, beam_segments(truss, name), body, count), repeats)
            models.append(LatticeModel(name, found, found.relative_to(answers), seconds))
    return tuple(models)


def beam_segments(truss: ColumnTruss, beam: BeamModel) -> tuple[Segment, ...]:
    """Segments of the beam that stands for a truss, from the foot up."""
    from modal.lattices.lattice_taper import column_segments

    own = column_segments(truss.column, truss.height, truss.top_ratio, truss.mass_per_length, beam)
    return own if truss.above is None else own + beam_segments(truss.above, beam)


def truss_answers(truss: ColumnTruss, body: EndBody, count: int) -> LatticeAnswers:
    """What a truss says, building included; see `compare_truss`."""
    anew = replace(truss)
    bare, loaded = (anew.bending_frequencies(count, there) for there in (None, body))
    return LatticeAnswers(anew.tip(force=1.0)[0], anew.tip(moment=1.0)[0], _hertz(bare), _hertz(loaded))


def beam_answers(segments: tuple[Segment, ...], body: EndBody, count: int) -> LatticeAnswers:
    """What a clamped beam says, by dynamic stiffness."""
    from modal.beams.chain import Chain
    from modal.structures.structure import chain_frequencies, chain_structure

    structure = chain_structure(Chain(segments))
    loads = np.zeros((len(structure.unknowns), 2))
    loads[-2:] = np.eye(2)
    force, moment = structure.displacements(loads)[-2]
    bare, loaded = (chain_frequencies(Chain(segments, bodies), count) for bodies in ({}, {len(segments): body}))
    return LatticeAnswers(float(force), float(moment), _hertz(bare), _hertz(loaded))


def _hertz(angular: NDArray[np.float64]) -> tuple[float, ...]:
    return tuple((angular / (2.0 * np.pi)).tolist())


def _ratios(found: tuple[float, ...], reference: tuple[float, ...]) -> tuple[float, ...]:
    return tuple(a / b - 1.0 for a, b in zip(found, reference, strict=True))

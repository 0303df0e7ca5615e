"""A lattice in space: pinned, with rigid joints and as a beam of sections, beside each other."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from modal.clock import timed
from modal.structures.structure import chain_structure

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from modal.beams.chain import Chain
    from modal.elements.space_beam import SpaceBeam
    from modal.elements.space_frame import SpaceFrame

    Floats = NDArray[np.float64]

KINDS = "vertical", "lateral", "torsion"
COUNT = 3
"""Frequencies of each kind."""

SEARCHED = 12, 24, 48
"""Modes of the beam among which there are so many of each kind, tried in turn; a frame has some besides."""

ALIKE = 0.5
"""Least square of the cosine between shapes of one mode."""

TWINS = 1e-3
"""Relative; modes of a beam whose frequencies differ by less are taken together: any mixture of them is one."""


@dataclass(frozen=True, slots=True)
class SpaceAnswers:
    """What a model of a lattice that is clamped at its root says.

    Parameters
    ----------
    deflections : tuple of float
        Of the tip up and to the side per force there [m/N] and its twist per torque [rad/(N m)].
    frequencies_hz : dict of str to tuple
        Lowest natural frequencies by kind, "vertical", "lateral", "torsion" [Hz]; NaN: none that moves as the beam.
    """

    deflections: tuple[float, float, float]
    frequencies_hz: dict[str, tuple[float, ...]]


@dataclass(frozen=True, slots=True)
class SpaceModel:
    """A model, its answers and the median time for them [s]: "pinned", "rigid joints", "beam" or "in each plane"."""

    name: str
    answers: SpaceAnswers
    seconds: float


def plane_answers(up: Chain, aside: Chain) -> SpaceAnswers:
    """What beams of both planes say, by dynamic stiffness; of torsion nothing."""
    deflections, frequencies = [], {"torsion": (np.nan,) * COUNT}
    for kind, chain in (("vertical", up), ("lateral", aside)):
        structure = chain_structure(chain)
        load = np.zeros(len(structure.unknowns))
        load[-2] = 1.0
        deflections.append(float(structure.displacements(load)[-2]))
        frequencies[kind] = _hertz(structure.angular_frequencies(COUNT))
    return SpaceAnswers((deflections[0], deflections[1], np.nan), frequencies)


def compare_in_space(
    frame: Callable[[float | None], SpaceFrame],
    beam: Callable[[], SpaceBeam],
    rigidity: float,
    planes: tuple[Chain, Chain] | None = None,
    *,
    repeats: int = 1,
) -> tuple[SpaceModel, ...]:
    """A lattice along x from its root: pinned, rigidly joined, as a beam in space, and as beams in both planes.

    Parameters
    ----------
    frame, beam : callable
        What makes them; a frame of a rigidity, or pinned, as `modal.lattices.space.frame_of_round` has it.
    rigidity : float
        Of rigid joints.
    planes : tuple of Chain, optional
        Beams that bend up and to the side.
    repeats : int
        Calls that the time is the median of.
    """
    made = beam()
    of_beam, seconds = timed(lambda: beam_answers(beam()), repeats)
    found = []
    for name, given in (("pinned", None), ("rigid joints", rigidity)):
        answers, taken = timed(partial(_frame_answers, frame, given, made), repeats)
        found.append(SpaceModel(name, answers, taken))
    found.append(SpaceModel("beam", of_beam, seconds))
    if planes is not None:
        found.append(SpaceModel("in each plane", *timed(partial(plane_answers, *planes), repeats)))
    return tuple(found)


def beam_answers(beam: SpaceBeam) -> SpaceAnswers:
    """What a beam says."""
    loads = np.zeros((3, len(beam.lengths), 6))
    loads[range(3), -1, [2, 1, 3]] = 1.0
    moved = beam.displacements(loads)
    omegas, _, kinds = _beam_modes(beam)
    frequencies = {kind: _hertz(omegas[kinds == k][:COUNT]) for k, kind in enumerate(KINDS)}
    return SpaceAnswers(tuple(moved[range(3), -1, [2, 1, 3]].tolist()), frequencies)


def frame_answers(frame: SpaceFrame, beam: SpaceBeam) -> SpaceAnswers:
    """What a frame says; its modes are sorted by the shapes of the beam that stands for it."""
    loads = tip_loads(frame)
    compliance = np.einsum("kni,kni->k", loads, frame.displacements(loads))
    omegas, shapes, kinds = _beam_modes(beam)
    half = 0.5 * frame.masses_per_length * np.linalg.norm(np.subtract(*frame.nodes[frame.members.T]), axis=1)
    masses = np.bincount(frame.members.ravel(), np.repeat(half, 2), len(frame.nodes))
    moved = beam.motions(shapes, frame.nodes)
    size = np.einsum("kni,kni,n->k", moved, moved, masses)
    free = 3 * (len(frame.nodes) - len(frame.held))
    own, theirs = frame.modes(min(3 * len(omegas), free - 1))
    sizes = np.einsum("kni,kni,n->k", theirs, theirs, masses)
    alike = np.einsum("kni,lni,n->kl", theirs, moved, masses) ** 2 / np.outer(sizes, size)
    twins = np.abs(np.subtract.outer(omegas, omegas)) < TWINS * omegas
    alike = alike @ twins
    left = np.ones(len(own), dtype=bool)
    frequencies: dict[str, tuple[float, ...]] = {}
    for k, kind in enumerate(KINDS):
        found = []
        for mode in np.flatnonzero(kinds == k)[:COUNT]:
            best = int(np.argmax(alike[:, mode] * left))
            found.append(float(own[best]) if alike[best, mode] * left[best] > ALIKE else np.nan)
            left[best] = left[best] and not found[-1] > 0.0
        frequencies[kind] = _hertz(np.array(found))
    return SpaceAnswers(tuple(compliance.tolist()), frequencies)


def tip_loads(frame: SpaceFrame) -> Floats:
    """A force up, one to the side and a torque of one about the reference line on the nodes of the tip.

    Shared so that the sum of squares is least: alike in bending, tangentially in torsion; shape (3, n, 3).
    """
    x = frame.nodes[:, 0]
    tip = np.flatnonzero(x > (1.0 - 1e-9) * x.max())
    y, z = frame.nodes[tip, 1:].T
    one, none = np.ones_like(y), np.zeros_like(y)
    # Resultants of forces along y and z, node by node.
    sums = np.stack([np.stack([none, one], axis=1), np.stack([one, none], axis=1), np.stack([-z, y], axis=1)])
    shares = np.linalg.pinv(sums.reshape(3, -1))
    loads = np.zeros((3, len(x), 3))
    loads[:, tip, 1:] = shares.T.reshape(3, -1, 2)
    return loads


def _frame_answers(frame: Callable[[float | None], SpaceFrame], given: float | None, beam: SpaceBeam) -> SpaceAnswers:
    return frame_answers(frame(given), beam)


def _beam_modes(beam: SpaceBeam) -> tuple[Floats, Floats, NDArray[np.int64]]:
    """Angular frequencies, motions of the nodes and kinds, by where most energy is, of enough modes of a beam."""
    masses = beam.masses
    height = -masses[:, 1, 3] / masses[:, 1, 1]
    polar = masses[:, 3, 3] - masses[:, 1, 1] * height**2
    for count in SEARCHED:
        count = min(count, 3 * len(beam.lengths) - 1)
        omegas, shapes = beam.modes(count)
        _, v, w, ph, _, _ = np.moveaxis(shapes, -1, 0)
        mass = masses[:, 1, 1] * beam.lengths
        energies = np.stack([w**2 @ mass, (v - height * ph) ** 2 @ mass, ph**2 @ (polar * beam.lengths)])
        # Stretching has little of each.
        bends = energies.sum(axis=0) > 0.5
        kinds = np.where(bends, energies.argmax(axis=0), -1)
        if all((kinds == k).sum() >= COUNT for k in range(3)):
            break
    return omegas, shapes, kinds


def _hertz(angular: Floats) -> tuple[float, ...]:
    return tuple((angular / (2.0 * np.pi)).tolist())

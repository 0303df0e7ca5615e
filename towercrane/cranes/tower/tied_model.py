"""Tower crane whose jibs hang on tie bars, with its load: its equations of motion, and what a run shows."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.tower.equations.constants import Constants, constants_of
from towercrane.cranes.tower.equations.tied.constants import Tied
from towercrane.cranes.tower.equations.tied.ties import pull_ties, span_of
from towercrane.cranes.tower.model import FlexibleModel
from towercrane.cranes.tower.outputs import tied as shown
from towercrane.cranes.tower.outputs.observed import about
from towercrane.simulation.differences import jacobian
from towercrane.simulation.outcomes import NOT_LEVEL, SLACK_TIE, UNSTABLE
from towercrane.simulation.system import NoEquilibrium

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import NDArray

    from towercrane.cranes.tower.modes.modal_crane import FlexibleCrane
    from towercrane.cranes.tower.modes.tied.head import TiedHead
    from towercrane.cranes.tower.outputs.seen import Seen
    from towercrane.kernels.payload import Structure
    from towercrane.simulation.observed import About, Instant
    from towercrane.simulation.system import System

    Floats = NDArray[np.float64]

MOST_STEPS = 30
"""Of Newton's method for the pretension."""

LEVEL = 0.02
"""Part of the jib's length by which the lower end of a tie may be off level in the crane's own weight."""


def tied_of(crane: FlexibleCrane, gravity: float, stiffness: Floats) -> tuple[Tied, Floats]:
    """Ties as the equations know them, and the coordinates on the head under the crane's own weight alone.

    A tie whose pretension is not stated pulls so that its member is level there. Tensions that are not positive are
    those of ties that could not hold the crane.

    Parameters
    ----------
    crane : FlexibleCrane
    gravity : float
        [m/s^2]
    stiffness : ndarray, shape (n, n)
        Of the coordinates on the head.
    """
    head, sums = _head_of(crane), crane.tied_sums
    upper, lower = head.ends()
    along, across = head.bowing()
    bars, count = head.bars.ties, len(head.bars.ties)
    stated = np.array([np.nan if tie.pretension is None else tie.pretension for tie in bars])
    found = Tied(
        ahead=len(head.bars.jib),
        sags=head.part(5).start,
        fields=sums,
        spans=head.bars.spans, ends=lower - upper, along=along, across=across, lengths=head.lengths,
        reference=np.zeros(count), pretension=np.zeros(count), slack=np.zeros(count),
        stiffness=np.asarray(np.linalg.inv(head.bars.compliance)),
    )  # fmt: skip
    # What weight takes from a tie's sag is what the tension in that sag resists.
    weight = -gravity * sums.momentum[:, 2]
    sagging = weight[head.part(5)]
    level = lower[np.arange(count), :, 2]
    q, tensions = np.zeros(head.count), np.where(np.isnan(stated), 0.0, stated)
    free = np.flatnonzero(np.isnan(stated))
    bent = slice(0, head.part(5).start)
    for _ in range(MOST_STEPS):
        spans = [span_of(found, k, q) for k in range(count)]
        slopes = np.array([span.slopes for span in spans])
        rest = weight - stiffness @ q - tensions @ slopes
        curved = np.array([curvature(found, k, q) for k in range(count)])
        tangent = stiffness + np.einsum("k,kij->ij", tensions, curved)
        size, many = bent.stop, len(free)
        matrix = np.zeros((size + many, size + many))
        matrix[:size, :size] = tangent[bent, bent]
        matrix[:size, size:], matrix[size:, :size] = slopes[free][:, bent].T, level[free][:, bent]
        step = np.linalg.solve(matrix, np.concatenate([rest[bent], -(level @ q)[free]]))
        q[bent] += step[:size]
        tensions[free] += step[size:]
        if np.max(abs(step[size:]), initial=0.0) < 1e-9 * np.max(tensions) and np.max(abs(step[:size])) < 1e-9:
            break
    else:
        tensions = -abs(tensions)
    reference = np.array([span_of(found, k, q).length for k in range(count)])
    return replace(found, reference=reference, pretension=tensions, slack=sagging / tensions), q


def curvature(tied: Tied, k: int, q: Floats) -> Floats:
    """Second derivatives of a tie's length, shape (n, n)."""
    span = span_of(tied, k, q)
    moved = np.array(tied.ends[k])
    moved[:, 0] += tied.along[k] @ q
    moved[:, 2] += tied.across[k] @ q
    slopes, (u, _, w) = np.array(span.slopes), span.direction
    return np.asarray(
        (moved @ moved.T - np.outer(slopes, slopes)) / span.length + u * tied.along[k] + w * tied.across[k]
    )


def _in_kilonewtons(tensions: Floats) -> str:
    return ", ".join(f"{1e-3 * tension:.4g}" for tension in tensions)


def _head_of(crane: FlexibleCrane) -> TiedHead:
    assert crane.tied is not None, "the crane has ties"
    return crane.tied


@dataclass(frozen=True, eq=False)
class TiedModel(FlexibleModel):
    """A tower crane whose jibs hang on tie bars, as a simulation asks for it."""

    @cached_property
    def _at_rest_alone(self) -> tuple[Tied, Floats]:
        carried = slice(self.coordinates - _head_of(self.crane).count, self.coordinates)
        return tied_of(self.crane, self.crane.gravity, np.diag(self.angular_frequencies[carried] ** 2))

    @cached_property
    def constants(self) -> Constants:
        """Constants of the equations."""
        return replace(constants_of(self), tied=self._at_rest_alone[0])

    @cached_property
    def system(self) -> System:
        """The model as the solver sees it."""
        fixed, ties = self.fixed_system, self.counts["tie"]
        return self.on_its_rope(
            replace(
                fixed, guards=(*fixed.guards, *[SLACK_TIE] * ties), floors=np.append(fixed.floors, np.zeros(ties))
            )
        )

    @cached_property
    def small_motions(self) -> list[tuple[Floats, Structure]]:
        """Stiffness and structure as it hangs in its ties without load."""
        held = self.stiffness_when_held
        carried = slice(self.coordinates - len(self._at_rest_alone[1]), self.coordinates)
        tied, q = self._at_rest_alone

        def forces(places: Floats) -> Floats:
            return np.array(np.broadcast_arrays(*pull_ties(tied, list(places)).forces))

        slope, _ = jacobian(forces, q, self.system.scale[carried])
        held[carried, carried] -= 0.5 * (slope + slope.T)
        return [(held, self.at_rest(self.undeformed(inputs), inputs)) for inputs in self.trolley_ends]

    @property
    def outputs(self) -> Callable[[Seen, Instant], Mapping[str, Any]]:
        """See :mod:`towercrane.cranes.tower.outputs.tied`."""
        return shown.outputs

    @cached_property
    def about(self) -> Mapping[str, About]:
        """What the outputs are."""
        bars = _head_of(self.crane).bars
        known = shown.tensions(len(bars.jib), len(bars.counter_jib)).keys()
        here = {name: read for name, read in shown.READ.items() if not shown.tie(name) or name in known}
        return about(self, self.cuts, here)

    def equilibrium(self, inputs: Floats) -> Floats:
        """Coordinates at rest under all weights and the wind; shape (coordinates,).

        Raises
        ------
        NoEquilibrium
            If the ties do not hold the crane's own weight, or it has no stable equilibrium.
        """
        tensions = self._at_rest_alone[0].pretension
        if np.any(tensions <= 0.0):
            pulled = _in_kilonewtons(tensions)
            raise NoEquilibrium(SLACK_TIE, f"under the crane's own weight the ties would pull with {pulled} kN")
        head, q = _head_of(self.crane), self._at_rest_alone[1]
        heights = [float(own @ q) for own in head.ends()[1][np.arange(len(tensions)), :, 2]]
        if max(map(abs, heights)) > LEVEL * self.crane.jib_length:
            listed = ", ".join(f"{height:+.2g}" for height in heights)
            raise NoEquilibrium(
                NOT_LEVEL,
                f"with the stated pretension the ties' ends stand {listed} m off level under the crane's own weight; "
                "state none, or fewer: what the weight asks for is found",
            )
        return super().equilibrium(inputs)

    def gives_way(self, why: str = "") -> NoEquilibrium:
        """What is said of a crane that cannot stand."""
        jib = "a jib or a cat-head buckles that ties press too hard"
        return NoEquilibrium(UNSTABLE, f"{why}{jib}; {self.buckling_message()}")

    def undeformed(self, inputs: Floats) -> Floats:
        """Coordinates of the crane as its drives and ties hold its own weight, its tower straight."""
        origin = super().undeformed(inputs)
        origin[-len(self._at_rest_alone[1]) :] = self._at_rest_alone[1]
        return origin

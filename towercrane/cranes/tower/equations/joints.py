"""Joints of the jib: where the trolley passes from one section to the next.

The slope of a shear-flexible jib steps where its shear strain does, at a change of section and at a body. A trolley
that crosses such a joint is thrown up or down: rates jump, places do not. No force acts along a coordinate or across
the rope in no time, so the momenta dT/dq' go on as they were, and so does the load's velocity across the rope, on an
elastic rope its whole velocity.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.tower.equations.constants import ROPE, SLEWING, TROLLEY
from towercrane.cranes.tower.equations.jib import Section
from towercrane.cranes.tower.equations.structure import slewing_torque, structure
from towercrane.kernels.chain import chain_at_rest
from towercrane.kernels.payload import state_of
from towercrane.kernels.polynomial import polynomial
from towercrane.motions.motion import SAME_INSTANT, Phases, shifted

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.tower.equations.constants import Constants
    from towercrane.cranes.tower.equations.structure import CraneStructure

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Joints:
    """Joints of a crane's jib, as :class:`towercrane.simulation.system.Crossings` has them.

    Parameters
    ----------
    crane : Constants
    """

    crane: Constants

    def cut(self, phases: Phases) -> Phases:
        """The phases cut where the trolley crosses a joint, with its section as one row of inputs more.

        Where the trolley stands on a joint it keeps its section. Phases that are cut already stay as they are.
        """
        if phases.inputs.shape[1] > self.crane.channels:
            return phases
        ends, width = self.crane.sections, phases.inputs.shape[2]
        times, inputs, section = [], [], _section(ends, float(phases.inputs[0, TROLLEY, 0]))
        for begin, until, rows in zip(phases.times[:-1], phases.times[1:], phases.inputs, strict=True):
            span = float(until - begin)
            moments = [0.0, *_crossings(rows[TROLLEY], ends[1:-1], span), span]
            for now, after in pairwise(moments):
                moved = np.array([shifted(row, now) for row in rows]) if now else rows
                place, _, _ = polynomial(moved[TROLLEY], 0.5 * (after - now))
                if not ends[section] <= place <= ends[section + 1]:
                    section = _section(ends, float(place))
                times.append(float(begin) + now)
                inputs.append(np.vstack([moved, self._row(section, width)]))
        after_all = np.vstack([phases.after, self._row(section, width)])
        return Phases(np.array([*times, phases.times[-1]]), np.array(inputs), after_all)

    def crosses(self, phases: Phases) -> bool:
        """Whether the trolley comes to a joint in motion, so that its place alone does not tell its section."""
        cut = self.cut(phases)
        section = np.unique(cut.inputs[:, -1, 1])
        spans = np.diff(cut.times)[:, None] * (0.0, 0.5, 1.0)
        places = [polynomial(row, span)[0] for row, span in zip(cut.inputs[:, TROLLEY], spans, strict=True)]
        found = {float(self.crane.sections[_section(self.crane.sections, place)]) for place in np.ravel(places)}
        return len(section) > 1 or found != set(section.tolist())

    def crossed(self, before: Floats, after: Floats) -> bool:
        """Whether the trolley is on another section in the phase with the inputs ``after``."""
        return bool(before[-1, 0] != after[-1, 0])

    def leap(self, state: Floats, before: Floats, time: float, after: Floats) -> Floats:
        """State right after a joint, from that right before it.

        With dv the jump of the velocity of the rope's upper end D at the rates before, n along the rope and J what
        rates move D, ``(M + m J^T n n^T J) dq' = -J^T (m_c + m n n^T) dv``. The load's velocity across the rope is
        kept. With slings m is what the rope feels of them and the hook, see :mod:`towercrane.kernels.chain`. Each
        drive that is prescribed puts in its impulse times its rate: the trolley's on trolley and load, along the mean
        of its two ways; the hoist's in the rope; the slewing's about the tower's axis.

        Parameters
        ----------
        state : ndarray
        before : ndarray
            Inputs of the phase that ends at the joint, after ``time`` [s].
        after : ndarray
            Inputs of the phase that begins there.
        """
        crane = self.crane
        inner, outer = self._seen(state, before, time), self._seen(state, after, 0.0)
        velocity = np.array(outer.hanging.velocity) - np.array(inner.hanging.velocity)
        # An elastic rope has no impulse to give in no time.
        parts = state_of(state, crane.coordinates, crane.axes)
        hangs = crane.load.now(after[crane.release])
        n = np.array(parts.direction) / np.linalg.norm(parts.direction)
        chain = chain_at_rest(hangs, parts)
        links, share, _ = chain.solved(n)
        # What the rope feels: of a load without slings its mass.
        load = self._carries * chain.masses[0] / (1.0 - share * chain.masses[0])
        jacobian = np.array(outer.hanging.jacobian, dtype=float).reshape(crane.axes, crane.coordinates)
        dragged = crane.trolley_mass * np.eye(crane.axes) + load * np.outer(n, n)
        row = jacobian.T @ n
        mass = outer.hanging.mass_matrix() + load * np.outer(row, row)
        rates = np.linalg.solve(mass, -jacobian.T @ dragged @ velocity) if crane.coordinates else np.empty(0)
        thrown = jacobian @ rates + velocity
        (length, hauling, _), (_, speed, _) = (polynomial(after[row], 0.0) for row in (ROPE, TROLLEY))
        way, along = 0.5 * (np.array(inner.path) + np.array(outer.path))[list(crane.fixed_axes)], load * (n @ thrown)
        pulls, moved = [-along, *chain.tensions(links, -along)], self._carries * thrown
        if links:
            moved = moved - pulls[1] / chain.masses[0] * np.array(chain.directions[0])
        found, half = state.copy(), len(state) // 2
        rope = half + crane.coordinates
        found[half:rope] += rates
        found[rope : rope + crane.axes] -= (moved - n * (n @ moved)) / length
        found[rope + crane.axes : 2 * half] += chain.turning(n, pulls)
        found[-1] += speed * way @ dragged @ thrown + hauling * along
        if crane.slewing == "prescribed":
            column, _ = outer.share.turning
            turned = crane.trolley_mass * np.array(column) @ velocity
            for moved, sign in ((rates, 1.0), (0.0 * rates, -1.0)):
                turned += sign * slewing_torque(
                    outer.share, outer.projected, moved.tolist(), (-along * n * (sign > 0.0)).tolist()
                )
            found[-1] += polynomial(after[SLEWING], 0.0)[1] * turned
        return found

    @property
    def _carries(self) -> float:
        """Whether the rope's upper end takes the load along when it is thrown: 1 or 0."""
        return float(self.crane.load.elasticity is None)

    def _row(self, section: int, width: int) -> Floats:
        crane = self.crane
        cells = crane.shapes.shape[0] // (len(crane.sections) - 1)
        start, end = crane.sections[section : section + 2]
        return np.pad([float(section * cells), start, (end - start) / cells], (0, width - 3))

    def _seen(self, state: Floats, inputs: Floats, time: float) -> CraneStructure:
        drives = [polynomial(channel, time) for channel in inputs[: self.crane.channels].tolist()]
        parts = state_of(state.tolist(), self.crane.coordinates, self.crane.axes)
        return structure(self.crane, parts, drives, Section(*inputs[-1, :3].tolist()))


def _section(ends: Floats, place: float) -> int:
    return int(np.clip(np.searchsorted(ends, place, side="right") - 1, 0, len(ends) - 2))


def _crossings(trolley: Floats, joints: Floats, span: float) -> list[float]:
    """Times within a phase at which a polynomial is at a joint [s], ascending."""
    found: list[Any] = []
    for joint in joints:
        coefficients = np.polynomial.polynomial.polytrim(trolley - joint * (np.arange(len(trolley)) == 0))
        if len(coefficients) > 1:
            roots = np.polynomial.polynomial.polyroots(coefficients)
            real = roots.real[abs(roots.imag) <= 1e-9 * (1.0 + abs(roots.real))]
            found += [root for root in real.tolist() if SAME_INSTANT < root < span - SAME_INSTANT]
    moments = sorted(found)
    return [moment for k, moment in enumerate(moments) if k == 0 or moment > moments[k - 1] + SAME_INSTANT]

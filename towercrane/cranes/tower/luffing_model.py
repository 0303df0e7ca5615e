"""Tower crane whose jib pivots, with its load: its equations of motion in chosen modes, and what a run shows."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.tower.equations.actions.collars import names_of
from towercrane.cranes.tower.equations.constants import ROPE, Constants, constants_of
from towercrane.cranes.tower.equations.luffing import motion as luffing
from towercrane.cranes.tower.equations.luffing.constants import Luffing
from towercrane.cranes.tower.equations.play import contact_stiffness
from towercrane.cranes.tower.model import FlexibleModel
from towercrane.cranes.tower.modes.luffing_crane import luffing_of, products
from towercrane.cranes.tower.outputs.luffing import READ, outputs
from towercrane.cranes.tower.outputs.observed import about
from towercrane.kernels.payload import SLACK, State, Structure
from towercrane.simulation.differences import jacobian
from towercrane.simulation.outcomes import JIB_AT_STOP, JIB_OVER, SLACK_ROPE, TOWER_BUCKLED, UNSTABLE
from towercrane.simulation.system import NoEquilibrium

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import NDArray

    from towercrane.cranes.tower.outputs.seen import Seen
    from towercrane.simulation.observed import About, Instant
    from towercrane.simulation.system import System

    Floats = NDArray[np.float64]


def pivoting(model: FlexibleModel) -> Luffing:
    """What the equations know of a crane's jib that pivots."""
    crane, written = model.crane, model.crane.written
    assert written is not None, "it is made of its parameters"
    own, length = luffing_of(written), crane.jib_length
    shortening, weighted = products(written, crane.lateral, crane.vertical)
    rest, (along, mass) = own.rest_sums(written), own.points_of(written.uniform_jib)
    none = [np.zeros(basis.count) for basis in (crane.lateral, crane.vertical)]
    return Luffing(
        foot=np.array(own.foot),
        frame_head=np.array(own.frame_head),
        winch=np.array(own.winch),
        length=length,
        attachment=own.attachment,
        rope_stiffness=own.rope_stiffness,
        axial_flexibility=length / own.axial_stiffness,
        falls=float(own.falls),
        reference_way=own.hoist_way(length, own.reference_angle),
        highest_angle=own.highest_angle,
        jib=np.array([mass.sum(), mass @ along, mass @ along**2]),
        rest_mass=rest.mass,
        rest_first=np.array([rest.forward, rest.up]),
        rest_inertia=np.array([rest.xx, rest.yy, rest.zz, rest.xz]),
        tip_shapes=np.concatenate([crane.lateral(length), none[1]]),
        tip_slopes=np.concatenate([none[0], crane.vertical(length, 1)]),
        middle=crane.jib_shapes(0.5 * length),
        shortening=shortening,
        weighted=weighted,
        exposure=crane.exposure,
    )


@dataclass(frozen=True, eq=False)
class LuffingModel(FlexibleModel):
    """A tower crane whose jib pivots, as a simulation asks for it."""

    @cached_property
    def constants(self) -> Constants:
        """Constants of the equations."""
        return replace(constants_of(self), luffing=pivoting(self))

    @cached_property
    def system(self) -> System:
        """The model as the solver sees it."""
        fixed = self.fixed_system
        contacts = names_of(self.constants.play)
        floors = np.full(luffing.GUARDS + len(contacts), -np.inf)
        floors[luffing.TENSION] = fixed.floors[luffing.TENSION]
        floors[luffing.HOLDING], floors[[luffing.STOP, luffing.TILT]] = SLACK, 0.0
        recorded = ("corner", "corner", "slewing torque")
        own = replace(
            fixed,
            equations=luffing.motion,
            guards=(SLACK_ROPE, JIB_OVER, JIB_AT_STOP, TOWER_BUCKLED, *recorded, *contacts),
            floors=floors,
            switch=self.corners((luffing.INSIDE, luffing.OUTSIDE), luffing.GUARDS),
        )
        return self.on_its_rope(own)

    @cached_property
    def small_motions(self) -> list[tuple[Floats, Structure]]:
        """Stiffness and structure with the jib at its reference angle and at its stop."""
        own, found = self.crane.luffing, []
        assert own is not None, "the crane's jib pivots"
        for angle in (own.reference_angle, own.highest_angle):
            inputs = np.zeros((len(self.channels), 3))
            inputs[luffing.COMMANDED, 0], inputs[ROPE, 0] = angle, self.crane.jib_length
            there = self.undeformed(inputs)
            slope, _ = jacobian(partial(self.static_forces, inputs=inputs), there, self.system.scale[: len(there)])
            slope -= contact_stiffness(self)
            if self.drive is not None:
                turned = self.parts["slewing"].start
                slope[turned, turned] = -max(self.drive.soft, self.drive.stiff)
            found.append((-0.5 * (slope + slope.T), self.at_rest(there, inputs)))
        return found

    def undeformed(self, inputs: Floats) -> Floats:
        """Coordinates of the undeformed crane as its drives hold it; shape (coordinates,)."""
        origin = super().undeformed(inputs)
        origin[-1] = inputs[luffing.COMMANDED, 0]
        return origin

    def equilibrium(self, inputs: Floats) -> Floats:
        """Coordinates at rest under all weights; shape (coordinates,).

        Raises
        ------
        NoEquilibrium
            If the stiffness is not positive definite, no equilibrium is found, or the luffing rope would push.
        """
        q = super().equilibrium(inputs)
        tension = float(self._resting(q, inputs).held.tension)
        if tension < SLACK:
            message = f"the luffing rope would push by {-tension:.4g} N: the hoist rope pulls the jib back"
            raise NoEquilibrium(JIB_OVER, message)
        return q

    def gives_way(self, why: str = "") -> NoEquilibrium:
        """What is said of a crane that cannot stand."""
        jib = "a jib buckles that is pressed too hard, or swings down where its rope is too soft"
        return NoEquilibrium(UNSTABLE, f"{why}{jib}; {self.buckling_message()}")

    @cached_property
    def _forces_at_rest(self) -> Callable[[Floats, Floats], Floats]:
        return self._written_at_rest(luffing.static_force)

    def at_rest(self, q: Floats, inputs: Floats) -> Structure:
        """The structure at rest at these coordinates, its drives held; of D it has the motion of the hanging load."""
        found = self._resting(q, inputs)
        *across, up = found.hanging.jacobian
        hung = [own - paid for own, paid in zip(up, found.rope.paid, strict=True)]
        return found.hanging._replace(jacobian=[*across, hung])

    def suspended(self, state: Floats, inputs: Floats) -> Structure:
        """The crane without its load in a state, moved by its drives."""
        return luffing.structure(self.constants, *self.as_driven(state, inputs)).hanging

    def paid_out(self, state: Floats, inputs: Floats) -> float:
        """Rate at which the crane's motion pays out rope beside the winch [m/s]."""
        parts, drives = self.as_driven(state, inputs)
        paid = luffing.structure(self.constants, parts, drives).rope.paid
        return float(np.dot(np.array(paid, dtype=float), parts.rates))

    def rope_at_rest(self, q: Floats, inputs: Floats) -> float:
        """Length of the rope below the jib's head [m]."""
        return float(self._resting(q, inputs).rope.length)

    def _resting(self, q: Floats, inputs: Floats) -> luffing.LuffingStructure:
        held = [(value, 0.0, 0.0) for value in inputs[:, 0].tolist()]
        return luffing.structure(self.constants, State(q.tolist(), (), [0.0] * self.coordinates, ()), held)

    @property
    def outputs(self) -> Callable[[Seen, Instant], Mapping[str, Any]]:
        """See :mod:`towercrane.cranes.tower.outputs.luffing`."""
        return outputs

    @cached_property
    def about(self) -> Mapping[str, About]:
        """What the outputs are."""
        return about(self, self.cuts, READ)

"""Tower, jib and counter-jib with trolley and hanging load in their common vertical plane, as one exact structure."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from modal.beams.beam import EndBody
from modal.beams.chain import Foundation
from modal.checks import check_fields, number_in
from modal.structures.members import HELD
from modal.structures.structure import Structure

if TYPE_CHECKING:
    from modal.beams.chain import Chain


@dataclass(frozen=True, slots=True)
class CraneFrame:
    """A tower crane in the vertical plane of its jib.

    Parameters
    ----------
    tower : Chain
        From the foundation to the slewing ring; the body at its end is all that turns but for the jibs below.
        Its gravity says whether weight, trolley and load included, softens it.
    jib : Chain, optional
        From the tower's axis outward; without one it is rigid and part of the body at the tower's end.
    counter_jib : Chain, optional
        From the tower's axis to the other side, likewise.
    trolley_mass, payload_mass : float
        Masses [kg]; without a payload there is no pendulum.
    rope_length : float
        Length from trolley to payload [m].
    gravity : float
        Acceleration of gravity on the payload [m/s^2].

    Raises
    ------
    ValueError
        If a mass is negative, the rope's length or gravity is not positive, a jib has weight along itself, an
        axial load, a foundation, collars or a pendulum, or the tower has a pendulum besides the payload.
    """

    tower: Chain
    jib: Chain | None = None
    counter_jib: Chain | None = None
    trolley_mass: float = 0.0
    payload_mass: float = 0.0
    rope_length: float = 1.0
    gravity: float = 9.81

    def __post_init__(self) -> None:
        check_fields(self, positive=("rope_length", "gravity"), not_negative=("trolley_mass", "payload_mass"))
        for name in ("jib", "counter_jib"):
            chain = getattr(self, name)
            if chain is not None and (
                chain.gravity or chain.axial_load or chain.pendulum or chain.collars
                or chain.foundation != Foundation()
            ):  # fmt: skip
                raise ValueError(f"CraneFrame.{name}: wanted segments and bodies alone")
        if self.tower.pendulum is not None:
            raise ValueError(f"CraneFrame.tower: wanted no pendulum of its own, got {self.tower.pendulum!r}")


def crane_structure(crane: CraneFrame, trolley_position: float) -> Structure:
    """The crane with its trolley at a distance from the tower's axis [m].

    Small motions about the undeformed crane. The tower is rigid along its axis. Its top, with deflection u and
    rotation gamma (positive: the jib's end goes down), carries the jibs: each leaves it at ``w = 0`` and turned by
    gamma, bends vertically, and moves along with u as a whole. Trolley and payload weigh on the jib vertically;
    horizontally the payload is a pendulum hung from u.

    Raises
    ------
    ValueError
        If the trolley is off the jib, or behind the tower where the jib is rigid.
    """
    carried = crane.trolley_mass + crane.payload_mass
    along = crane.trolley_mass
    weights = carried
    for chain in (crane.jib, crane.counter_jib):
        if chain is not None:
            mass = chain.mass + sum(body.mass for body in chain.bodies.values())
            along, weights = along + mass, weights + mass
    tower = replace(crane.tower, axial_load=crane.tower.axial_load + crane.tower.gravity * weights)
    structure = Structure((), shear_theory=tower.shear_theory)
    u, gamma = structure.add_chain(tower, structure.add_foundation(tower.foundation))
    # What moves along with the top but is weighed elsewhere.
    structure.bodies[u, u] += along
    if crane.jib is None:
        number_in("trolley_position", trolley_position, "zero or more", least=0.0)
        structure.bodies[gamma, gamma] += carried * trolley_position**2
    else:
        reach = crane.jib.length
        number_in("trolley_position", trolley_position, f"0 to {reach!r} m", least=0.0, most=reach)
        jib, node = crane.jib.with_node(trolley_position)
        if node > 0 and carried > 0.0:
            there = jib.bodies.get(node, EndBody())
            if there.offset:
                raise ValueError("CraneFrame.jib: the trolley stands on a body that is off the jib's node")
            body = EndBody(there.mass + carried, there.rotary_inertia)
            jib = replace(jib, bodies={**jib.bodies, node: body})
        structure.add_chain(jib, (HELD, gamma), (1.0, -1.0), "jib")
    if crane.counter_jib is not None:
        structure.add_chain(crane.counter_jib, (HELD, gamma), (1.0, 1.0), "counter-jib")
    if crane.payload_mass > 0.0:
        load = structure.add_unknown("m")
        structure.add_pendulum(crane.payload_mass * crane.gravity / crane.rope_length, crane.payload_mass, u, load)
    return structure

"""The crane of a case as an exact structure: tower and jib as chains of segments."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from modal import Beam, Chain, CraneFrame, EndBody, Segment

if TYPE_CHECKING:
    from towercrane.case import Case


def crane_frame(case: Case, *, weight: bool = False) -> CraneFrame:
    """Tower, jib, trolley and load of a radial case in their common vertical plane.

    Parameters
    ----------
    case : Case
    weight : bool
        Whether the weight softens the tower.
    """
    crane = case.radial_crane()
    tower = as_chain(crane.tower)
    top = len(tower.segments)
    counter = EndBody(crane.counter_mass, crane.counter_inertia)
    bodies = {**tower.bodies, top: joined(tower.bodies.get(top, EndBody()), counter)}
    return CraneFrame(
        tower=replace(tower, bodies=bodies, gravity=crane.gravity if weight else 0.0),
        jib=as_chain(crane.jib),
        trolley_mass=crane.trolley_mass,
        payload_mass=case.payload.mass,
        rope_length=case.rope.length,
        gravity=crane.gravity,
    )


def as_chain(beam: Beam | Chain) -> Chain:
    """A uniform beam as a chain of one segment; a chain as it is."""
    if isinstance(beam, Chain):
        return beam
    return Chain((Segment(beam.length, beam.mass_per_length, beam.bending_stiffness),))


def joined(first: EndBody, second: EndBody) -> EndBody:
    """Two bodies on one node as one."""
    mass = first.mass + second.mass
    if mass == 0.0:
        return EndBody(0.0, first.rotary_inertia + second.rotary_inertia)
    offset = (first.mass * first.offset + second.mass * second.offset) / mass
    inertia = sum(body.rotary_inertia + body.mass * (body.offset - offset) ** 2 for body in (first, second))
    return EndBody(mass, inertia, offset)

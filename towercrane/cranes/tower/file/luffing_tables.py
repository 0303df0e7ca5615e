"""Tables of a jib that pivots at its foot, and of the head that it stands on."""

from __future__ import annotations

from math import inf
from typing import Annotated, Any

from pydantic import Field, StrictInt

from towercrane.schema.fields import Angle, Mass, MassOrNone, Position, ShearStiffness, Table

Place = tuple[Position, Position]
"""Forward along the jib and up from the tower's top."""


class Luffing(Table):
    """What makes a jib pivot: its foot, its ropes, and how far it goes.

    The luffing rope holds the jib's head, by ``rope_attachment`` above the chord; its stiffness E A is that of all
    its falls. The hoist rope runs over the jib's head to so many falls.
    """

    pivot: Place
    frame_head: Place
    hoist_winch: Place
    rope_attachment: Position = 0.0
    rope_stiffness: ShearStiffness
    falls: Annotated[StrictInt, Field(ge=1, le=16)] = 1
    tip_mass: MassOrNone = 0.0
    axial_stiffness: ShearStiffness = inf
    lowest_angle: Angle
    highest_angle: Angle


class HeadBody(Table):
    """Point mass on the head: ballast, machinery, A-frame."""

    mass: Mass
    place: Place


class Head(Table):
    """What turns on the tower beside a jib that pivots."""

    bodies: tuple[HeadBody, ...] = ()


def without_trolley(tree: Any) -> Any:
    """A case as written with what a crane whose jib pivots has not, at nothing."""
    if not isinstance(tree, dict) or not isinstance(crane := tree.get("crane"), dict):
        return tree
    if not (isinstance(jib := crane.get("jib"), dict) and "luffing" in jib):
        return tree
    nothing = {
        "trolley": {"mass": 0.0},
        "counter_jib": dict.fromkeys(("length", "mass_per_length", "counterweight"), 0.0),
    }
    motion = tree.get("motion", {})
    if isinstance(motion, dict):
        motion = {"trolley": {"shape": "rest", "start": 0.0}} | motion
    return tree | {"crane": nothing | crane, "motion": motion}

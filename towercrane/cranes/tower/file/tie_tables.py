"""Tables of a cat-head and of the tie bars that hold jib and counter-jib."""

from __future__ import annotations

from towercrane.schema.fields import (
    Length,
    MassPerLength,
    Modulus,
    Reach,
    SecondMoment,
    ShearStiffness,
    Table,
    TensionIfAny,
)


class TowerHead(Table):
    """Cat-head: a column over the tower's top that the tie bars go from."""

    height: Length
    mass_per_length: MassPerLength
    youngs_modulus: Modulus
    second_moment_of_area: SecondMoment
    axial_stiffness: ShearStiffness


class Tie(Table):
    """Tie bar from the cat-head's top to a point over the axis of a jib.

    Its stiffness is E A. The pretension is its tension under the crane's own weight, without trolley and load; where
    it is not stated the jib is level at the tie.
    """

    position: Length
    height: Reach = 0.0
    axial_stiffness: ShearStiffness
    mass_per_length: MassPerLength
    pretension: TensionIfAny = None

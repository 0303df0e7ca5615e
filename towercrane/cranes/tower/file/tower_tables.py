"""Tables of towers: uniform or of segments, with their lattices, their bodies and what they stand on."""

from __future__ import annotations

from math import inf
from typing import Annotated, Literal

from pydantic import Field

from modal.beams.chain import ShearTheory  # noqa: TC001 - pydantic reads annotations when the class is made
from modal.lattices.walls import Lacing  # noqa: TC001
from towercrane.cranes.tower.modes.collars import MOST_COLLARS
from towercrane.schema.fields import (
    Area,
    AreaOrNone,
    Breadth,
    Coupling,
    InertiaOrNone,
    Length,
    LengthIfAny,
    MassOrNone,
    MassPerLength,
    MassPerLengthIfAny,
    ModulusIfAny,
    Position,
    Reach,
    Root,
    RotaryInertiaPerLength,
    RotaryStiffness,
    RotaryStiffnessOrNone,
    SecondMomentIfAny,
    ShearStiffness,
    Stiffness,
    Table,
    TorsionalInertiaIfAny,
    TorsionalStiffnessIfAny,
)

BeamChoice = Literal["stated", "shear-flexible", "euler", "code-equivalent"]
"""Where a tower's beam comes from: its stated second moment of area, or one of three readings of its lattice."""

Taper = Literal["legs", "wedge", "cone"]
"""How a section changes with its breadth, see :data:`towercrane.cranes.tower.file.members.TAPER_POWERS`."""


class Lattice(Table):
    """Members of a laced tower."""

    leg_area: Area
    leg_spacing: Length
    panel_height: Length
    lacing: Lacing
    diagonal_area: Area
    horizontal_area: AreaOrNone = 0.0


class Section(Table):
    """Cross-section of a uniform tower or at the foot of a segment; its beam is stated or comes from a lattice."""

    mass_per_length: MassPerLengthIfAny = None
    youngs_modulus: ModulusIfAny = None
    second_moment_of_area: SecondMomentIfAny = None
    lattice: Lattice | None = None
    shear_stiffness: ShearStiffness = inf
    rotary_inertia_per_length: RotaryInertiaPerLength = 0.0


class TowerSegment(Section):
    """Piece of a tower, described at its foot; without a modulus of its own it has the tower's."""

    length: Length
    mass_per_length: MassPerLength
    top_breadth_ratio: Breadth = 1.0
    taper: Taper = "legs"


class TowerBody(Table):
    """Rigid body at a height of the tower; its centre of mass lies by the offset above that height."""

    height: Reach
    mass: MassOrNone
    rotary_inertia: InertiaOrNone = 0.0
    offset: Position = 0.0


class Collar(Table):
    """What ties the tower to a building at a height, beyond the play that it leaves to each side."""

    height: Length
    stiffness: Stiffness
    rotation_stiffness: RotaryStiffnessOrNone = 0.0
    torsional_stiffness: RotaryStiffnessOrNone = 0.0
    gap: Reach = 0.0


class Tower(Section):
    """Tower: a uniform beam, or segments from the foot up.

    Which keys belong together is for :mod:`towercrane.cranes.tower.file.checks.tower`. Roots that the source of a
    uniform tower prints are shown beside the computed ones. Stated torsion is that of one uniform shaft from the foot
    to the top; without it a lattice gives it piece by piece. It matters to a scene that leaves the plane alone.
    """

    height: LengthIfAny = None
    beam: BeamChoice | None = None
    segments: tuple[TowerSegment, ...] = ()
    bodies: tuple[TowerBody, ...] = ()
    collars: Annotated[tuple[Collar, ...], Field(max_length=MOST_COLLARS)] = ()
    shear_theory: ShearTheory = "haringx"
    torsional_stiffness: TorsionalStiffnessIfAny = None
    torsional_inertia_per_length: TorsionalInertiaIfAny = None
    published_roots: tuple[Root, ...] = ()


class Block(Table):
    """Rigid block at the foot of the tower; its centre of mass lies by the offset above the foot."""

    mass: MassOrNone
    rotary_inertia: InertiaOrNone = 0.0
    offset: Position = 0.0


class Foundation(Table):
    """Springs under the foot of the tower, and the block that they carry; a spring that is not given is rigid."""

    rotation_stiffness: RotaryStiffness = inf
    translation_stiffness: Stiffness = inf
    coupling_stiffness: Coupling = 0.0
    block: Block | None = None

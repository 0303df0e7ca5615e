"""Crane and case files of slewing cranes: one table per kind."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from towercrane.cranes.parts.tables import CaseTable, CraneTable, Drive, Friction, Start
from towercrane.cranes.parts.turbulence.tables import Wind  # noqa: TC001 - pydantic reads annotations
from towercrane.schema.fields import (
    Damping,
    Drag,
    HingeDamping,
    Inertia,
    Length,
    Mass,
    MassMomentOrNone,
    MassOrNone,
    Reach,
    RotaryStiffness,
    Stiffness,
    Table,
)
from towercrane.schema.motions import HoistMotion, JointMotion  # noqa: TC001 - pydantic reads annotations


class Geometry(Table):
    """Lengths of a lumped slewing crane."""

    tower_height: Length
    top_height: Reach
    jib_radius: Length


class BalancedGeometry(Geometry):
    """Lengths, counter-jib included."""

    counterweight_radius: Length


class BasicMass(Table):
    """Masses of the basic model."""

    jib_tip: Mass


class EnhancedMass(Table):
    """Masses of the enhanced model; the counterweight enters by its moment alone."""

    tower_top: MassOrNone
    jib_tip: Mass
    counter_moment: MassMomentOrNone = 0.0


class MultiMass(Table):
    """Masses of the multi-mass model."""

    tower_top: MassOrNone
    jib_tip: Mass
    counterweight: Mass


class BasicInertia(Table):
    """Moment of inertia about the vertical."""

    platform: Inertia


class TowerInertia(BasicInertia):
    """Moments of inertia about the vertical."""

    tower_top: Inertia


class BasicStiffness(Table):
    """Springs at the jib's tip, and the rope's."""

    jib_lateral: Stiffness
    jib_radial: Stiffness
    jib_vertical: Stiffness
    rope: Stiffness


class EnhancedStiffness(Table):
    """Springs of tower and jib."""

    tower_x: Stiffness
    tower_y: Stiffness
    jib_vertical: Stiffness
    tower_torsion: RotaryStiffness
    jib_lateral: RotaryStiffness


class MultiMassStiffness(EnhancedStiffness):
    """Springs of tower, jib and counter-jib."""

    counter_jib_vertical: Stiffness
    counter_jib_lateral: RotaryStiffness


class BasicDamping(Table):
    """Dampers beside the springs."""

    jib_lateral: Damping = 0.0
    jib_radial: Damping = 0.0
    jib_vertical: Damping = 0.0
    rope: Damping = 0.0


class EnhancedDamping(Table):
    """Dampers beside the springs."""

    tower_x: Damping = 0.0
    tower_y: Damping = 0.0
    jib_vertical: Damping = 0.0
    tower_torsion: HingeDamping = 0.0
    jib_lateral: HingeDamping = 0.0


class MultiMassDamping(EnhancedDamping):
    """Dampers beside the springs."""

    counter_jib_vertical: Damping = 0.0
    counter_jib_lateral: HingeDamping = 0.0


class BasicDrag(Table):
    """Air drag of the structure."""

    jib_tip: Drag = 0.0


class EnhancedDrag(BasicDrag):
    """Air drag of the structure."""

    tower_top: Drag = 0.0


class MultiMassDrag(EnhancedDrag):
    """Air drag of the structure."""

    counterweight: Drag = 0.0


class SlewingCrane(CraneTable):
    """What the lumped slewing cranes share."""

    geometry: Geometry
    mass: Table
    inertia: BasicInertia
    stiffness: Table
    damping: Table
    drive: Drive
    friction: Friction = Friction(law="none")
    drag: BasicDrag = Field(default_factory=BasicDrag)


class BasicCrane(SlewingCrane):
    """Basic model: a platform and the jib's tip on springs."""

    kind: Literal["basic"]
    mass: BasicMass
    stiffness: BasicStiffness
    damping: BasicDamping = Field(default_factory=BasicDamping)


class EnhancedCrane(SlewingCrane):
    """Enhanced model: platform, tower top and jib's tip."""

    kind: Literal["enhanced"]
    mass: EnhancedMass
    inertia: TowerInertia
    stiffness: EnhancedStiffness
    damping: EnhancedDamping = Field(default_factory=EnhancedDamping)
    drag: EnhancedDrag = Field(default_factory=EnhancedDrag)


class MultiMassCrane(SlewingCrane):
    """Multi-mass model: platform, tower top, jib's tip and counterweight."""

    kind: Literal["multi-mass"]
    geometry: BalancedGeometry
    mass: MultiMass
    inertia: TowerInertia
    stiffness: MultiMassStiffness
    damping: MultiMassDamping = Field(default_factory=MultiMassDamping)
    drag: MultiMassDrag = Field(default_factory=MultiMassDrag)


class SlewingMotions(Table):
    """What the drives of a slewing crane do; the shaft's angle is referred to the platform."""

    shaft: JointMotion
    hoist: HoistMotion | None = None


class SlewingCase(CaseTable):
    """Case of a lumped slewing crane."""

    crane: SlewingCrane
    motion: SlewingMotions
    wind: Wind | None = None
    start: Start = Field(default_factory=Start)


class MultiMassCase(SlewingCase):
    """Case of the multi-mass model."""

    crane: MultiMassCrane


class BasicCase(SlewingCase):
    """Case of the basic model."""

    crane: BasicCrane


class EnhancedCase(SlewingCase):
    """Case of the enhanced model."""

    crane: EnhancedCrane

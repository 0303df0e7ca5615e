"""Case files of tower cranes, in the plane of the jib and in space."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, StrictBool, StrictInt

from modal.elements.beam_elements import MOST_ELEMENTS
from towercrane.cranes.parts.tables import CaseTable, StartTable
from towercrane.cranes.tower.file.tables import RadialCrane, SpaceCrane  # noqa: TC001 - pydantic reads annotations
from towercrane.cranes.tower.targets import MOTIONS, RADIAL, SPACE
from towercrane.schema.fields import (
    Angle,
    EitherSpeed,
    Length,
    Mass,
    ModeCount,
    Position,
    Ratio,
    SpeedIfAny,
    Table,
    ToleranceIfAny,
)
from towercrane.schema.motions import HoistMotion, JointMotion, TrolleyMotion  # noqa: TC001
from towercrane.schema.targets import Asked, OutputsField, TargetField, Targets


class Motions(Table):
    """What the drives of a crane in radial motion do."""

    trolley: TrolleyMotion
    hoist: HoistMotion | None = None


class SpaceMotions(Motions):
    """What the drives of a tower crane in space do; the head's angle, or that of its drive's shaft."""

    slewing: JointMotion | None = None
    shaft: JointMotion | None = None


class Accuracy(Asked):
    """For a crane in radial motion, without a list all outputs with a target; relative for frequencies."""

    outputs: Annotated[tuple[str, ...], OutputsField(RADIAL)] = ()
    target: Annotated[Targets, TargetField(RADIAL, RADIAL)] | None = None
    frequency: ToleranceIfAny = None


class SpaceAccuracy(Asked):
    """For a crane in space, without a list all motions with a target."""

    outputs: Annotated[tuple[str, ...], OutputsField(SPACE)] = ()
    target: Annotated[Targets, TargetField(SPACE, MOTIONS)] | None = None


class Model(Table):
    """What the model includes."""

    tower_modes: ModeCount = 2
    jib_modes: ModeCount = 3
    weight_softening: StrictBool = False
    tower_damping_ratio: Ratio = 0.0
    jib_damping_ratio: Ratio = 0.0


class Start(StartTable):
    """Initial state of a tower crane; its equilibrium is that in the wind's mean, the angle counts from there."""

    state: Literal["equilibrium", "zero", "zero-no-self-weight"] = "equilibrium"


class ModesRequest(Table):
    """What ``towercrane modes`` shows; without positions, those at both ends of the trolley's way."""

    count: Annotated[StrictInt, Field(ge=1, le=50)] = 4
    trolley_positions: tuple[Position, ...] = ()
    elements: Annotated[StrictInt, Field(ge=2, le=MOST_ELEMENTS)] = 32


MOST_POSITIONS = 1000
"""Places of the trolley in one map: more take minutes and cannot be read."""


class MapRequest(Table):
    """Where the frequency map is taken.

    Without positions of the trolley, ``position_count`` of them equally spaced from the tower's axis to the end of
    the jib; without masses of the load half the case's own, that itself, and its double.
    """

    position_count: Annotated[StrictInt, Field(ge=2, le=MOST_POSITIONS)] = 50
    trolley_positions: tuple[Position, ...] = ()
    payload_masses: tuple[Mass, ...] = ()


class RadialCase(CaseTable):
    """Case of a crane in radial motion."""

    kind: Literal["radial"] = "radial"
    crane: RadialCrane
    motion: Motions
    model: Model = Field(default_factory=Model)
    start: Start = Field(default_factory=Start)
    modes: ModesRequest = Field(default_factory=ModesRequest)
    map: MapRequest = Field(default_factory=MapRequest)
    accuracy: Accuracy = Field(default_factory=Accuracy)


class SpaceModel(Table):
    """Modes that a case in space includes, zero for what is rigid; those of the tower count in both directions."""

    tower_modes: ModeCount = 2
    torsion_modes: ModeCount = 1
    jib_lateral_modes: ModeCount = 2
    jib_vertical_modes: ModeCount = 2
    weight_softening: StrictBool = False
    tower_damping_ratio: Ratio = 0.0
    torsion_damping_ratio: Ratio = 0.0
    jib_lateral_damping_ratio: Ratio = 0.0
    jib_vertical_damping_ratio: Ratio = 0.0


class Wind(Table):
    """Wind on load and structure: steady, or gusts from a CSV file.

    A steady wind blows towards ``direction``, counted like the slewing angle. Gusts are interpolated linearly between
    the file's lines of time [s] and velocity along x, y and z [m/s].
    """

    speed: SpeedIfAny = None
    direction: Angle = 0.0
    upward: EitherSpeed = 0.0
    series: str = ""


class SpaceModesRequest(Table):
    """Where ``towercrane modes`` takes the crane in space, one by one the others at the start of the motions."""

    count: Annotated[StrictInt, Field(ge=1, le=30)] = 8
    trolley_positions: tuple[Position, ...] = ()
    rope_lengths: tuple[Length, ...] = ()
    slewing_angles: tuple[Angle, ...] = ()


class SpaceCase(CaseTable):
    """Case of a tower crane in space."""

    kind: Literal["space"] = "space"
    crane: SpaceCrane
    motion: SpaceMotions
    wind: Wind | None = None
    model: SpaceModel = Field(default_factory=SpaceModel)
    start: Start = Field(default_factory=Start)
    modes: SpaceModesRequest = Field(default_factory=SpaceModesRequest)
    accuracy: SpaceAccuracy = Field(default_factory=SpaceAccuracy)

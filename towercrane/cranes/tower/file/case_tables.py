"""Case files of tower cranes."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, StrictBool, StrictInt, model_validator

from modal.elements.beam_elements import MOST_ELEMENTS
from towercrane.cranes.parts.hoisting.release_table import Released  # noqa: TC001
from towercrane.cranes.parts.tables import CaseTable, SwayStart
from towercrane.cranes.parts.turbulence.tables import Wind  # noqa: TC001 - pydantic reads annotations
from towercrane.cranes.tower.file.luffing_tables import without_trolley
from towercrane.cranes.tower.file.tables import Crane  # noqa: TC001 - pydantic reads annotations
from towercrane.cranes.tower.targets import ALL, ANY_MOTION, FORETOLD
from towercrane.schema.fields import (
    Angle,
    Factor,
    FileName,
    Length,
    Mass,
    ModeCount,
    ModeCountIfAny,
    Position,
    Ratio,
    ReachIfAny,
    Table,
    ToleranceIfAny,
)
from towercrane.schema.motions import HoistMotion, JointMotion, SlewingMotion, TrolleyMotion  # noqa: TC001
from towercrane.schema.targets import Asked, OutputsField, TargetField, Targets


class Motions(Table):
    """What the drives do; the head turns by its angle, or by that of its drive's shaft.

    The angle of a jib that pivots is the one at which it would stand, straight, if its rope did not stretch.
    """

    trolley: TrolleyMotion
    luffing: JointMotion | None = None
    hoist: HoistMotion | None = None
    slewing: SlewingMotion | None = None
    shaft: JointMotion | None = None


class Accuracy(Asked):
    """Errors that are accepted: without a list of all outputs with a target, see `Targets.every`; of frequencies."""

    outputs: Annotated[tuple[str, ...], OutputsField(ALL)] = ()
    target: Annotated[Targets, TargetField(ALL, ANY_MOTION | FORETOLD)] | None = None
    frequency: ToleranceIfAny = None


class Model(Table):
    """Modes that the model includes, zero for what is rigid; those of the tower count in both directions.

    A scene in the jib's plane takes those of the tower and of the jibs up and down. A counter-jib whose stiffness is
    given takes one of a kind by default.
    """

    tower_modes: ModeCount = 2
    torsion_modes: ModeCount = 1
    jib_lateral_modes: ModeCount = 2
    jib_vertical_modes: ModeCount = 3
    counter_jib_lateral_modes: ModeCountIfAny = None
    counter_jib_vertical_modes: ModeCountIfAny = None
    weight_softening: StrictBool = False
    tower_damping_ratio: Ratio = 0.0
    torsion_damping_ratio: Ratio = 0.0
    jib_lateral_damping_ratio: Ratio = 0.0
    jib_vertical_damping_ratio: Ratio = 0.0
    counter_jib_lateral_damping_ratio: Ratio = 0.0
    counter_jib_vertical_damping_ratio: Ratio = 0.0


class Earthquake(Table):
    """Motion of the ground, from a CSV file of its acceleration along x, y and z, linear between the file's lines.

    Of the file only the named axes act, times a factor. Collars move with the ground, unless for each of them, from
    the lowest up, a file of its floor's displacement against the ground along x and y is named.
    """

    file: FileName
    factor: Factor = 1.0
    axes: Annotated[tuple[Literal["x", "y", "z"], ...], Field(min_length=1)] = ("x", "y", "z")
    floors: tuple[FileName, ...] = ()


class Start(SwayStart):
    """Initial state of a tower crane; its equilibrium is that in the wind's mean."""

    state: Literal["equilibrium", "quiet", "zero", "zero-no-self-weight"] = "equilibrium"


class ModesRequest(Table):
    """What ``towercrane modes`` shows.

    ``count`` modes of tower and jib by themselves, and with the trolley at both ends of its way, or at the positions
    named, those of the whole crane in its plane. In space ``crane_count`` modes of the whole crane where the motions
    begin, and over one drive after the other where values are named.
    """

    count: Annotated[StrictInt, Field(ge=1, le=50)] = 4
    crane_count: Annotated[StrictInt, Field(ge=1, le=30)] = 8
    trolley_positions: tuple[Position, ...] = ()
    rope_lengths: tuple[Length, ...] = ()
    slewing_angles: tuple[Angle, ...] = ()
    luffing_angles: tuple[Angle, ...] = ()
    elements: Annotated[StrictInt, Field(ge=2, le=MOST_ELEMENTS)] = 32


MOST_POSITIONS = 1000
"""Places of the trolley in one map: more take minutes and cannot be read."""


class MapRequest(Table):
    """Where the frequency map is taken.

    Without positions of the trolley, ``position_count`` of them equally spaced from the tower's axis to the end of
    the jib, of a jib that pivots angles from the lowest to the highest; without masses of the load half the case's
    own, that itself, and its double.
    """

    position_count: Annotated[StrictInt, Field(ge=2, le=MOST_POSITIONS)] = 50
    trolley_positions: tuple[Position, ...] = ()
    luffing_angles: tuple[Angle, ...] = ()
    payload_masses: tuple[Mass, ...] = ()


class NamedSection(Table):
    """A section of tower or jib whose force and moment are wanted: a height of the one, a position on the other."""

    name: str
    of: Literal["tower", "jib"]
    height: ReachIfAny = None
    position: ReachIfAny = None


class TowerCase(CaseTable):
    """Case of a tower crane."""

    crane: Crane
    motion: Motions
    wind: Wind | None = None
    earthquake: Earthquake | None = None
    model: Model = Field(default_factory=Model)
    start: Start = Field(default_factory=Start)
    modes: ModesRequest = Field(default_factory=ModesRequest)
    map: MapRequest = Field(default_factory=MapRequest)
    accuracy: Accuracy = Field(default_factory=Accuracy)
    sections: tuple[NamedSection, ...] = ()
    release: Released | None = None

    @model_validator(mode="before")
    @classmethod
    def _complete(cls, tree: Any) -> Any:
        return without_trolley(tree)

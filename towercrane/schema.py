"""The keys of a case file and their types; every quantity leaves as an SI float."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, Literal, get_args

from pydantic import BaseModel, ConfigDict, Field, GetCoreSchemaHandler, StrictBool, StrictInt
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from modal.lattice import Lacing  # noqa: TC001 - pydantic reads annotations when the class is made
from towercrane.faults import shown
from towercrane.units import UnitError, to_si, wanted

if TYPE_CHECKING:
    from collections.abc import Iterator


@dataclass(frozen=True)
class Quantity:
    """Annotation of a float field that is written with a unit.

    Parameters
    ----------
    unit : str
        SI unit, a key of :data:`towercrane.units.KINDS`.
    above, least, most : float, optional
        Bounds that no physical or numerical sense survives beyond; ``above`` is itself excluded.
    """

    unit: str
    above: float | None = None
    least: float | None = None
    most: float | None = None

    @property
    def wanted(self) -> str:
        """What belongs here, in words."""
        bounds = [
            f"{word} {bound:g}"
            for word, bound in (("above", self.above), ("from", self.least), ("to", self.most))
            if bound is not None
        ]
        return wanted(self.unit) + (", " + " ".join(bounds) if bounds else "")

    def read(self, value: object) -> float:
        """The checked value in SI."""
        try:
            number = to_si(value, self.unit)
        except UnitError as error:
            raise _refusal(error.wanted, error.got, error.hint) from None
        if (
            (self.above is not None and not number > self.above)
            or (self.least is not None and number < self.least)
            or (self.most is not None and number > self.most)
        ):
            raise _refusal(self.wanted, shown(value), "")
        return number

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)


def _refusal(wanted: str, got: str, hint: str) -> PydanticCustomError:
    return PydanticCustomError("quantity", "{wanted}", {"wanted": wanted, "got": got, "hint": hint})


Length = Annotated[float, Quantity("m", above=0)]
Reach = Annotated[float, Quantity("m", least=0)]
Position = Annotated[float, Quantity("m")]
Area = Annotated[float, Quantity("m^2", above=0)]
AreaOrNone = Annotated[float, Quantity("m^2", least=0)]
SecondMoment = Annotated[float, Quantity("m^4", above=0)]
Modulus = Annotated[float, Quantity("Pa", above=0)]
Mass = Annotated[float, Quantity("kg", above=0)]
MassOrNone = Annotated[float, Quantity("kg", least=0)]
MassPerLength = Annotated[float, Quantity("kg/m", above=0)]
MassPerLengthOrNone = Annotated[float, Quantity("kg/m", least=0)]
Time = Annotated[float, Quantity("s", above=0)]
Wait = Annotated[float, Quantity("s", least=0)]
Speed = Annotated[float, Quantity("m/s", above=0)]
Acceleration = Annotated[float, Quantity("m/s^2", above=0)]
Jerk = Annotated[float, Quantity("m/s^3", above=0)]
Angle = Annotated[float, Quantity("rad")]
HingeDamping = Annotated[float, Quantity("N m s/rad", least=0)]
Ratio = Annotated[float, Quantity("1", least=0)]
Root = Annotated[float, Quantity("1", above=0)]
ModeCount = Annotated[StrictInt, Field(ge=0, le=14)]


class Table(BaseModel):
    """A table of the file: known keys only, unchangeable once read."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class Lattice(Table):
    """Members of a laced tower."""

    leg_area: Area
    leg_spacing: Length
    panel_height: Length
    lacing: Lacing
    diagonal_area: Area
    horizontal_area: AreaOrNone = 0.0


class Jib(Table):
    """Jib as a uniform beam."""

    length: Length
    mass_per_length: MassPerLength
    youngs_modulus: Modulus
    second_moment_of_area: SecondMoment


class Tower(Table):
    """Tower as a uniform beam; roots that its source prints are shown beside the computed ones."""

    height: Length
    mass_per_length: MassPerLength
    youngs_modulus: Modulus
    second_moment_of_area: SecondMoment
    published_roots: tuple[Root, ...] = ()
    lattice: Lattice | None = None


class CounterJib(Table):
    """Counter-jib with the counterweight at its end."""

    length: Reach
    mass_per_length: MassPerLengthOrNone
    counterweight: MassOrNone


class Trolley(Table):
    """Trolley."""

    mass: MassOrNone


class Crane(Table):
    """Crane file."""

    name: str
    source: str = ""
    gravity: Acceleration = 9.81
    tower: Tower
    jib: Jib
    counter_jib: CounterJib
    trolley: Trolley


class Payload(Table):
    """Load on the rope."""

    mass: Mass
    rope_damping: HingeDamping = 0.0
    drag_area: AreaOrNone = 0.0


class Rope(Table):
    """Rope at the start, and what it does where its tension would fall below zero."""

    length: Length
    slack: Literal["stop", "rod"] = "stop"


class Begin(Table):
    """Where a motion begins."""

    start: Position


class Delayed(Table):
    """Wait before a motion begins."""

    delay: Wait = 0.0


class Rest(Delayed):
    """No motion."""

    shape: Literal["rest"]
    duration: Wait = 0.0


class Trapezoid(Delayed):
    """Constant acceleration, speed, deceleration."""

    shape: Literal["trapezoid"]
    end: Position
    speed: Speed
    acceleration: Acceleration


class SCurve(Delayed):
    """Limited jerk."""

    shape: Literal["s-curve"]
    end: Position
    speed: Speed
    acceleration: Acceleration
    jerk: Jerk


Step = Annotated[Trapezoid | SCurve | Rest, Field(discriminator="shape")]


class Sequence(Delayed):
    """Steps, each from where the one before ends."""

    shape: Literal["sequence"]
    steps: Annotated[tuple[Step, ...], Field(min_length=1)]


class Points(Delayed):
    """Smooth motion through the points of a CSV file."""

    shape: Literal["table"]
    file: str


class TrolleyRest(Begin, Rest):
    """Trolley at rest."""


class TrolleyTrapezoid(Begin, Trapezoid):
    """Trolley on a trapezoid."""


class TrolleySCurve(Begin, SCurve):
    """Trolley on an s-curve."""


class TrolleySequence(Begin, Sequence):
    """Trolley in steps."""


AnyMotion = Rest | Trapezoid | SCurve | Sequence | Points
HoistMotion = Annotated[AnyMotion, Field(discriminator="shape")]
TrolleyMotion = Annotated[
    TrolleyRest | TrolleyTrapezoid | TrolleySCurve | TrolleySequence | Points, Field(discriminator="shape")
]


class Motions(Table):
    """What the drives do."""

    trolley: TrolleyMotion
    hoist: HoistMotion | None = None


class Model(Table):
    """What the model includes."""

    tower_modes: ModeCount = 2
    jib_modes: ModeCount = 3
    weight_softening: StrictBool = False
    tower_damping_ratio: Ratio = 0.0
    jib_damping_ratio: Ratio = 0.0


class Start(Table):
    """Initial state."""

    state: Literal["equilibrium", "zero", "zero-no-self-weight"] = "equilibrium"
    swing_angle: Angle = 0.0


class Run(Table):
    """Span and output."""

    duration: Time
    output_step: Time = 0.05


class Solver(Table):
    """Time integration."""

    method: Literal["dop853", "dopri5", "scipy-dop853", "scipy-rk45", "scipy-radau", "scipy-lsoda"] = "dop853"
    rtol: Annotated[float, Quantity("1", least=1e-13, most=0.1)] = 1e-8
    atol: Annotated[float, Quantity("1", above=0)] = 1e-10


class ModesRequest(Table):
    """What ``towercrane modes`` shows; without positions, those at both ends of the trolley's way."""

    count: Annotated[StrictInt, Field(ge=1, le=50)] = 4
    trolley_positions: tuple[Position, ...] = ()
    elements: Annotated[StrictInt, Field(ge=2, le=2000)] = 32


class CaseFile(Table):
    """Case file with its crane in place."""

    title: str = ""
    crane: Crane
    payload: Payload
    rope: Rope
    motion: Motions
    model: Model = Model()
    start: Start = Start()
    run: Run
    solver: Solver = Solver()
    modes: ModesRequest = ModesRequest()
    allow_implausible: tuple[str, ...] = ()


def tables(annotation: Any) -> Iterator[type[Table]]:
    """The tables that a field's annotation admits."""
    if isinstance(annotation, type) and issubclass(annotation, Table):
        yield annotation
    for argument in get_args(annotation):
        yield from tables(argument)

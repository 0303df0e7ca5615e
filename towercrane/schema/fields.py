"""Quantities as pydantic fields, and the tables that cases of every kind share; SI floats leave."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, Literal, get_args

from pydantic import BaseModel, ConfigDict, Field, GetCoreSchemaHandler, StrictInt
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from towercrane.schema.faults import shown
from towercrane.schema.units import UnitError, to_si, wanted

if TYPE_CHECKING:
    from pydantic.fields import FieldInfo


@dataclass(frozen=True)
class Quantity:
    """Annotation of a float field that is written with a unit.

    Parameters
    ----------
    unit : str
        SI unit, a key of :data:`towercrane.schema.units.QUANTITIES`.
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
            raise refusal(error.wanted, error.got, error.hint) from None
        if (
            (self.above is not None and not number > self.above)
            or (self.least is not None and number < self.least)
            or (self.most is not None and number > self.most)
        ):
            raise refusal(self.wanted, shown(value), "")
        return number

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)


@dataclass(frozen=True)
class FrequencyList:
    """Annotation of a field that is "model", a frequency, or a list of frequencies."""

    wanted: str = '"model" or a list of frequencies, such as ["0.106 Hz", "0.155 Hz"]'

    def read(self, value: object) -> str | tuple[float, ...]:
        """The word, or frequencies [Hz]."""
        if value == MODEL:
            return MODEL
        items = value if isinstance(value, list | tuple) else [value]
        if not items:
            raise refusal(self.wanted, "an empty list", "")
        try:
            return tuple(Quantity("Hz", above=0).read(item) for item in items)
        except PydanticCustomError as fault:
            context = fault.context or {}
            raise refusal(self.wanted, context["got"], context["hint"]) from None

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)


def refusal(wanted: str, got: str, hint: str) -> PydanticCustomError:
    """Error of a field that says what belongs there, what came and the likely cause."""
    return PydanticCustomError("quantity", "{wanted}", {"wanted": wanted, "got": got, "hint": hint})


MODEL = "model"
"""Stands for frequencies that the case's own model has."""

Frequencies = Annotated[str | tuple[float, ...], FrequencyList()]
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
Density = Annotated[float, Quantity("kg/m^3", above=0)]
Time = Annotated[float, Quantity("s", above=0)]
Wait = Annotated[float, Quantity("s", least=0)]
Speed = Annotated[float, Quantity("m/s", above=0)]
Acceleration = Annotated[float, Quantity("m/s^2", above=0)]
Jerk = Annotated[float, Quantity("m/s^3", above=0)]
Angle = Annotated[float, Quantity("rad")]
Turning = Annotated[float, Quantity("rad/s", above=0)]
AngularAcceleration = Annotated[float, Quantity("rad/s^2", above=0)]
AngularJerk = Annotated[float, Quantity("rad/s^3", above=0)]
EitherSpeed = Annotated[float, Quantity("m/s")]
EitherTurning = Annotated[float, Quantity("rad/s")]
Inertia = Annotated[float, Quantity("kg m^2", above=0)]
MassMomentOrNone = Annotated[float, Quantity("kg m", least=0)]
Stiffness = Annotated[float, Quantity("N/m", above=0)]
ShearStiffness = Annotated[float, Quantity("N", above=0)]
AxialStiffnessIfAny = Annotated[float | None, Quantity("N", above=0)]
TensionIfAny = Annotated[float | None, Quantity("N", above=0)]
RotaryStiffness = Annotated[float, Quantity("N m/rad", above=0)]
RotaryStiffnessOrNone = Annotated[float, Quantity("N m/rad", least=0)]
Coupling = Annotated[float, Quantity("N")]
Corner = Annotated[float, Quantity("rad", above=0)]
TorqueOrNone = Annotated[float, Quantity("N m", least=0)]
TurningOrNone = Annotated[float, Quantity("rad/s", least=0)]
Damping = Annotated[float, Quantity("N s/m", least=0)]
Drag = Annotated[float, Quantity("N s^2/m^2", least=0)]
HingeDamping = Annotated[float, Quantity("N m s/rad", least=0)]
Ratio = Annotated[float, Quantity("1", least=0)]
Breadth = Annotated[float, Quantity("1", above=0)]
InertiaOrNone = Annotated[float, Quantity("kg m^2", least=0)]
RotaryInertiaPerLength = Annotated[float, Quantity("kg m^2/m", least=0)]
PressedLength = Annotated[float, Quantity("m", least=0)]
Factor = Annotated[float, Quantity("1", above=0)]
FileName = Annotated[str, Field(min_length=1)]
Root = Annotated[float, Quantity("1", above=0)]
ModeCount = Annotated[StrictInt, Field(ge=0, le=14)]
ModeCountIfAny = Annotated[StrictInt | None, Field(ge=0, le=14)]

AngleIfAny = Annotated[float | None, Quantity("rad")]
MassIfAny = Annotated[float | None, Quantity("kg", above=0)]
AreaIfAny = Annotated[float | None, Quantity("m^2", least=0)]
LengthIfAny = Annotated[float | None, Quantity("m", above=0)]
PositionIfAny = Annotated[float | None, Quantity("m")]
ReachIfAny = Annotated[float | None, Quantity("m", least=0)]
MassPerLengthFromNone = Annotated[float | None, Quantity("kg/m", least=0)]
MassPerLengthIfAny = Annotated[float | None, Quantity("kg/m", above=0)]
ModulusIfAny = Annotated[float | None, Quantity("Pa", above=0)]
SecondMomentIfAny = Annotated[float | None, Quantity("m^4", above=0)]
TorsionalStiffnessIfAny = Annotated[float | None, Quantity("N m^2", above=0)]
TorsionalInertiaIfAny = Annotated[float | None, Quantity("kg m^2/m", above=0)]
SpeedIfAny = Annotated[float | None, Quantity("m/s", least=0)]
ToleranceIfAny = Annotated[float | None, Quantity("1", least=1e-9, most=0.1)]


class Table(BaseModel):
    """A table of the file: known keys only, unchangeable once read."""

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)

    @classmethod
    def named(cls) -> dict[str, FieldInfo]:
        """Its fields by their keys, of which some are no names in Python."""
        return {field.alias or name: field for name, field in cls.model_fields.items()}


class Payload(Table):
    """Load on the rope; its drag as an area or as a force per squared speed."""

    mass: Mass
    rope_damping: HingeDamping = 0.0
    drag_area: AreaOrNone = 0.0
    drag: Drag = 0.0


class Rope(Table):
    """Rope at the start; whether it stretches, else what it does where its tension would fall below zero.

    The stiffness is that of all falls together, force per strain; the extra length, per fall, is that between drum
    and falls.
    """

    length: Length
    slack: Literal["stop", "rod"] = "stop"
    stiffness: AxialStiffnessIfAny = None
    axial_stiffness: AxialStiffnessIfAny = None
    falls: Annotated[StrictInt, Field(ge=1, le=100)] = 1
    extra_length: Reach = 0.0
    relaxation_time: Wait = 0.0
    damping_ratio: Ratio = 0.0

    @property
    def stretches(self) -> bool:
        """Whether it is said how it stretches."""
        return bool(self.stiffness or self.axial_stiffness)


class Hook(Table):
    """Hook block at the rope's end."""

    mass: Mass
    drag_area: AreaOrNone = 0.0


class Slings(Table):
    """What the load hangs on below the hook, as one rigid link: a stiffness is refused by name."""

    length: Length
    stiffness: AxialStiffnessIfAny = None


class Run(Table):
    """Span and output."""

    duration: Time
    output_step: Time = 0.05


class Solver(Table):
    """Time integration."""

    method: str = "dop853"
    rtol: Annotated[float, Quantity("1", least=1e-13, most=0.1)] = 1e-8
    atol: Annotated[float, Quantity("1", above=0)] = 1e-10


class Expect(Table):
    """What a run of the case must come to.

    ``energy_gap`` bounds the relative gap of the energy balance; ``error`` the error against runs with a hundredth of
    the tolerances, which only ``towercrane bench --hard`` makes.
    """

    outcome: str = "finished"
    energy_gap: Annotated[float | None, Quantity("1", above=0)] = None
    error: Annotated[float | None, Quantity("1", above=0)] = None


def tables(annotation: Any) -> tuple[type[Table], ...]:
    """The tables that a field's annotation admits."""
    if annotation not in _TABLES:
        own = (annotation,) if isinstance(annotation, type) and issubclass(annotation, Table) else ()
        _TABLES[annotation] = (*own, *(table for argument in get_args(annotation) for table in tables(argument)))
    return _TABLES[annotation]


_TABLES: dict[Any, tuple[type[Table], ...]] = {}
"""Found once: a case is read for every run of a sweep."""


def known_keys(table: type[Table], prefix: str = "") -> list[str]:
    """Every dotted key of a table, without the numbers of list items."""
    found = []
    for name, field in table.named().items():
        found.append(prefix + name)
        for inner in tables(field.annotation):
            found += known_keys(inner, f"{prefix}{name}.")
    return found

"""Tables of case files for the wind."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field, StrictBool, StrictInt

from towercrane.schema.fields import (
    Angle,
    EitherSpeed,
    Factor,
    Length,
    LengthIfAny,
    Quantity,
    SpeedIfAny,
    Table,
    Time,
)

if TYPE_CHECKING:
    from towercrane.cranes.parts.turbulence.profile import Profile
    from towercrane.cranes.parts.wind import WindNodes

TimeIfAny = Annotated[float | None, Quantity("s", above=0)]
WaitIfAny = Annotated[float | None, Quantity("s", least=0)]
RatioIfAny = Annotated[float | None, Quantity("1", above=0)]


class TurbulenceTable(Table):
    """Turbulence of a spectrum and an intensity, by a seed.

    The intensity at the jib's height is stated, or follows from a reference class of IEC 61400-1, or for the spectrum
    of EN 1991-1-4 from the roughness of the ground.
    """

    spectrum: Literal["kaimal", "von-karman", "en-1991-1-4"]
    seed: Annotated[StrictInt, Field(ge=0, le=2**63)]
    intensity: RatioIfAny = None
    reference_class: Literal["A+", "A", "B", "C"] | None = None
    across: StrictBool = True
    across_ratio: RatioIfAny = None
    length_scale: LengthIfAny = None
    coherence_decay: Factor = 12.0
    coherence_length: LengthIfAny = None
    step: Time = 0.1
    duration: TimeIfAny = None
    ramp: WaitIfAny = None


class Wind(Table):
    """Wind on load and structure: steady, gusts from a CSV file, or turbulent about a mean.

    A steady wind blows towards ``direction``, counted like the slewing angle. Gusts are interpolated linearly between
    the file's lines of time [s] and velocity along x, y and z [m/s]. Both are as stated at the reference height where
    a profile is named.
    """

    speed: SpeedIfAny = None
    direction: Angle = 0.0
    upward: EitherSpeed = 0.0
    series: str = ""
    profile: Literal["uniform", "power", "log"] = "uniform"
    reference_height: Length = 10.0
    exponent: Factor = 0.2
    roughness_length: Length = 0.05
    minimum_height: Length = 2.0
    turbulence: TurbulenceTable | None = None

    @property
    def over_height(self) -> Profile:
        """The mean wind over height."""
        from towercrane.cranes.parts.turbulence.profile import Profile

        return Profile(
            self.profile, self.reference_height, self.exponent, self.roughness_length, self.minimum_height
        )  # fmt: skip

    @property
    def differs(self) -> bool:
        """Whether it is not the same everywhere."""
        return self.turbulence is not None or self.profile != "uniform"

    @property
    def nodes(self) -> WindNodes | None:
        """Places on a tower crane that see a wind of their own; None where one wind blows for all."""
        from towercrane.cranes.parts.wind import JIB_NODES, WindNodes

        if not self.differs:
            return None
        return WindNodes(jib=1 if self.turbulence is None else JIB_NODES, profile=self.over_height)

    @property
    def one_way(self) -> bool:
        """Whether it blows along its direction alone."""
        return not self.series and (self.turbulence is None or not self.turbulence.across)

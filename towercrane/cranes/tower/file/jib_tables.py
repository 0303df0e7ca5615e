"""Tables of jibs and counter-jibs: uniform or of segments from the tower's axis outward, with their bodies."""

from __future__ import annotations

from itertools import accumulate
from math import inf

from modal.lattices.jib import Shape, Side  # noqa: TC001 - pydantic reads annotations when the class is made
from modal.lattices.walls import Lacing  # noqa: TC001
from towercrane.cranes.tower.file.luffing_tables import Luffing  # noqa: TC001
from towercrane.cranes.tower.file.tie_tables import Tie  # noqa: TC001
from towercrane.schema.fields import (
    Area,
    AreaIfAny,
    AreaOrNone,
    AxialStiffnessIfAny,
    Density,
    InertiaOrNone,
    Length,
    LengthIfAny,
    MassIfAny,
    MassOrNone,
    MassPerLengthFromNone,
    MassPerLengthIfAny,
    MassPerLengthOrNone,
    ModulusIfAny,
    Reach,
    ReachIfAny,
    RotaryInertiaPerLength,
    SecondMomentIfAny,
    ShearStiffness,
    Table,
)


class JibLattice(Table):
    """Members of a lattice jib, see :class:`modal.lattices.jib.JibLattice`, with the same keys."""

    height: Length
    breadth: Length
    base_chord_area: Area
    opposite_chord_area: Area
    panel_length: Length
    side_diagonal_area: Area
    base_diagonal_area: Area
    side_lacing: Lacing = "zigzag"
    base_lacing: Lacing = "zigzag"
    side_post_area: AreaOrNone = 0.0
    base_post_area: AreaOrNone = 0.0
    shape: Shape = "triangle"
    side: Side = "up"
    end_height: LengthIfAny = None
    opposite_lacing: Lacing | None = None
    opposite_diagonal_area: AreaIfAny = None
    opposite_post_area: AreaIfAny = None
    density: Density = 7850.0
    further_mass_per_length: MassPerLengthOrNone = 0.0


class JibSection(Table):
    """Cross-section of a uniform jib or of a segment; what is lateral is that of bending to the sides."""

    mass_per_length: MassPerLengthIfAny = None
    youngs_modulus: ModulusIfAny = None
    second_moment_of_area: SecondMomentIfAny = None
    lateral_second_moment_of_area: SecondMomentIfAny = None
    lattice: JibLattice | None = None
    shear_stiffness: ShearStiffness = inf
    lateral_shear_stiffness: ShearStiffness = inf
    rotary_inertia_per_length: RotaryInertiaPerLength = 0.0
    lateral_rotary_inertia_per_length: RotaryInertiaPerLength = 0.0
    axial_stiffness: AxialStiffnessIfAny = None

    @property
    def laced(self) -> JibLattice | None:
        """The lattice that gives the beam: beside a stated second moment of area it is a check alone."""
        return self.lattice if self.second_moment_of_area is None else None


class JibSegment(JibSection):
    """Uniform piece of a jib; its mass is given per length or as a whole, its modulus may be the jib's."""

    length: Length
    mass: MassIfAny = None


class JibBody(Table):
    """Rigid body on a jib: a winch, the jib's end, ballast; its rotary inertia counts in both directions."""

    position: Reach
    mass: MassOrNone
    rotary_inertia: InertiaOrNone = 0.0


class Arm(JibSection):
    """Jib or counter-jib, uniform or of segments.

    With ties it hinges at its foot, free up and down, clamped to its sides.

    Which keys belong together is for :mod:`towercrane.cranes.tower.file.checks.jib`.
    """

    length: LengthIfAny = None
    segments: tuple[JibSegment, ...] = ()
    bodies: tuple[JibBody, ...] = ()
    ties: tuple[Tie, ...] = ()

    @property
    def pieces(self) -> tuple[JibSegment, ...]:
        """The segments; a uniform jib has one."""
        if self.segments or not self.length:
            return self.segments
        whole = {name: getattr(self, name) for name in JibSection.model_fields}
        return (JibSegment.model_construct(length=self.length, **whole),)

    @property
    def joints(self) -> tuple[float, ...]:
        """Where its segments meet, by the distance from the tower's axis [m]."""
        return tuple(accumulate(piece.length for piece in self.pieces[:-1]))

    @property
    def reach(self) -> float:
        """Its length [m], of segments their sum: the stated one may miss that by rounding."""
        return sum(piece.length for piece in self.pieces)


class Jib(Arm):
    """Jib; with a table ``luffing`` it pivots at its foot."""

    luffing: Luffing | None = None


class CounterJib(Arm):
    """Counter-jib with the counterweight at its end, and other bodies.

    Without a second moment of area it is rigid. With one it bends where a model has modes of it, and in exact
    frequencies of the crane.
    """

    length: ReachIfAny = None
    mass_per_length: MassPerLengthFromNone = None
    counterweight: MassOrNone = 0.0

    @property
    def weights(self) -> tuple[float, ...]:
        """Where bodies and the counterweight hang, by the distance from the tower's axis [m]."""
        at_end = (self.reach,) if self.counterweight else ()
        return (*(min(body.position, self.reach) for body in self.bodies), *at_end)

    @property
    def bends(self) -> bool:
        """Whether its stiffness is given."""
        pieces = self.pieces
        return bool(pieces) and all(piece.second_moment_of_area or piece.lattice for piece in pieces)

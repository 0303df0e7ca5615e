"""Parameters of a tower crane."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import TYPE_CHECKING

from modal.beams.beam import Beam, EndBody
from modal.checks import check_fields
from towercrane.cranes.tower.modes.collars import SAME_HEIGHT, TowerCollar

if TYPE_CHECKING:
    from modal.beams.chain import Chain
    from modal.beams.shapes import Modes
    from modal.beams.torsion import Shaft
    from modal.structures.chain_modes import ChainModes
    from towercrane.cranes.tower.modes.luffing_jib import LuffingJib
    from towercrane.cranes.tower.modes.tied.bars import TieBars


@dataclass(frozen=True, slots=True)
class TowerCrane:
    """Parameters of a tower crane with a flexible tower and jib.

    Parameters
    ----------
    name : str
    tower : Beam or Chain
        The tower below the slewing part: a uniform clamped Euler beam, or a chain of segments on its foundation with
        bodies of its own. Its length is the tower's height.
    jib : Beam or Chain
        In bending up and down; its length is the jib's radius.
    counter_jib_length : float
        Distance of the counterweight from the tower axis [m].
    counter_jib_mass_per_length : float
        Mass per unit length of the counter-jib [kg/m].
    counterweight : float
        Mass at the end of the counter-jib [kg].
    trolley_mass : float
        Mass of the trolley [kg].
    gravity : float
        Acceleration of gravity [m/s^2].
    jib_lateral : Beam or Chain, optional
        The jib in bending to its sides; needed for such modes alone.
    counter_jib, counter_jib_lateral : Chain, optional
        The counter-jib with its bodies in bending up and down and to its sides, from the tower's axis outward.
        Without them it is rigid. With them its mass and the counterweight are theirs: the numbers above are zero.
    shaft : Shaft, optional
        The tower in torsion; needed for such modes alone.
    roll_inertia : float
        Moment of inertia of the slewing part about the jib's axis [kg m^2].
    luffing : LuffingJib, optional
        Of a jib that pivots and carries no trolley; what depends on its angle is taken at its reference angle.
        Without it the jib is clamped and level.
    tie_bars : TieBars, optional
        Cat-head and ties of a crane whose jib and counter-jib, a chain, hinge at their feet: up and down they turn
        there freely, to their sides they are clamped.
    gapped : tuple of TowerCollar
        Collars with play, which hold the tower's place alone and of which the tower itself knows nothing.

    Raises
    ------
    ValueError
        If a number is negative or not finite, the counter-jib has its mass twice, a member in one direction and in
        the other, or tower and shaft, differ in what they share, or a collar with play has none, is off the tower or
        holds more than its place.
    """

    name: str
    tower: Beam | Chain
    jib: Beam | Chain
    counter_jib_length: float
    counter_jib_mass_per_length: float
    counterweight: float
    trolley_mass: float
    gravity: float = 9.81
    jib_lateral: Beam | Chain | None = None
    shaft: Shaft | None = None
    roll_inertia: float = 0.0
    luffing: LuffingJib | None = None
    counter_jib: Chain | None = None
    counter_jib_lateral: Chain | None = None
    tie_bars: TieBars | None = None
    gapped: tuple[TowerCollar, ...] = ()

    def __post_init__(self) -> None:
        masses = ("counter_jib_mass_per_length", "counterweight", "trolley_mass", "gravity", "roll_inertia")
        check_fields(self, not_negative=("counter_jib_length", *masses))
        if self.shaft is not None and self.shaft.length != self.tower.length:
            wanted, got = self.tower.length, self.shaft.length
            raise ValueError(f"TowerCrane.shaft.length: wanted {wanted!r}, as in the plane, got {got!r}")
        for name in ("jib", "counter_jib"):
            upright, sideways = getattr(self, name), getattr(self, f"{name}_lateral")
            if sideways is not None and (upright is None or _carried(upright) != _carried(sideways)):
                raise ValueError(
                    f"TowerCrane.{name}_lateral: wanted lengths and masses as in the plane, got {sideways!r}"
                )
        if self.counter_jib is not None and (self.counter_jib_mass_per_length or self.counterweight):
            raise ValueError("TowerCrane.counter_jib: wanted its mass in its segments and bodies alone, got it twice")
        if self.tie_bars is not None and (self.luffing is not None or self.counter_jib is None):
            raise ValueError("TowerCrane.tie_bars: wanted a jib that does not pivot and a counter-jib that bends")
        if self.counter_jib is not None and self.counter_jib.length != self.counter_jib_length:
            wanted, got = self.counter_jib.length, self.counter_jib_length
            raise ValueError(f"TowerCrane.counter_jib_length: wanted {wanted!r}, that of its segments, got {got!r}")
        for collar in self.gapped:
            at_place_alone = collar.rotation_stiffness == collar.torsional_stiffness == 0.0
            within = 0.0 < collar.height <= self.tower.length
            if not (within and at_place_alone and 0.0 < collar.gap < inf and 0.0 < collar.stiffness < inf):
                what = f"heights above 0 to {self.tower.length:g} m, a gap and a stiffness, no other stiffness"
                raise ValueError(f"TowerCrane.gapped: wanted {what}, got {collar!r}")

    @property
    def counter_mass(self) -> float:
        """Mass of counter-jib and counterweight [kg]."""
        if self.counter_jib is not None:
            return self.counter_jib.inertia[0]
        return self.counter_jib_mass_per_length * self.counter_jib_length + self.counterweight

    @property
    def counter_inertia(self) -> float:
        """Moment of inertia of counter-jib and counterweight about the tower top [kg m^2]."""
        if self.counter_jib is not None:
            return self.counter_jib.inertia[2] + self.counter_jib.inertia[3]
        length = self.counter_jib_length
        return self.counter_jib_mass_per_length * length**3 / 3 + self.counterweight * length**2

    @property
    def counter_moment(self) -> float:
        """First moment of counter-jib and counterweight about the tower axis, which is negative [kg m]."""
        if self.counter_jib is not None:
            return -self.counter_jib.inertia[1]
        counter = self.counter_jib_mass_per_length * self.counter_jib_length / 2 + self.counterweight
        return -counter * self.counter_jib_length

    @property
    def jib_inertia(self) -> tuple[float, float, float]:
        """Mass of the jib [kg], its first moment [kg m] and its moment of inertia about the tower top [kg m^2]."""
        if isinstance(self.jib, Beam):
            return self.jib.mass, self.jib.mass * self.jib.length / 2, self.jib.mass * self.jib.length**2 / 3
        mass, first, second, rotary = self.jib.inertia
        return mass, first, second + rotary

    @property
    def uniform_jib(self) -> Beam:
        """The jib, if it is uniform.

        Raises
        ------
        ValueError
            If it is a chain.
        """
        if not isinstance(self.jib, Beam):
            raise ValueError("TowerCrane.jib: wanted a uniform beam for a jib that pivots, got a chain")
        return self.jib

    @property
    def joints(self) -> tuple[float, ...]:
        """Places between the ends of the jib at which its sections change or a body sits [m], ascending."""
        members = (self.jib, self.jib_lateral)
        found = {place for member in members if not isinstance(member, Beam | None) for place in member.nodes[1:-1]}
        if self.tie_bars is not None:
            # Under a tie the curvature steps.
            found |= {tie.position for tie in self.tie_bars.jib if tie.position < self.jib.length}
        return tuple(sorted(found))

    @property
    def slewing_mass(self) -> float:
        """Mass m_r of everything that turns, without trolley and load [kg]."""
        if self.luffing is not None:
            return self.luffing.standing_sums(self).mass
        return self.jib_inertia[0] + self.counter_mass + self._tied[0]

    @property
    def slewing_inertia(self) -> float:
        """Moment of inertia J_r of everything that turns about the tower's axis [kg m^2].

        Full integrals; the additional factors 1/2 of Gao et al. (2023), Eq. 8 and 10, are misprints.
        """
        if self.luffing is not None:
            return self.luffing.standing_sums(self).zz
        return self.jib_inertia[2] + self.counter_inertia + self._tied[2]

    @property
    def static_moment(self) -> float:
        """First moment S_r of everything that turns about the tower axis, positive towards the jib [kg m]."""
        if self.luffing is not None:
            return self.luffing.standing_sums(self).forward
        return self.jib_inertia[1] + self.counter_moment + self._tied[1]

    @property
    def _tied(self) -> tuple[float, float, float]:
        """Mass, first moment and moment of inertia of cat-head and ties about the tower's axis."""
        return (0.0, 0.0, 0.0) if self.tie_bars is None else self.tie_bars.inertia()

    @property
    def tower_mass(self) -> float:
        """Mass of the tower and its own bodies [kg]."""
        bodies = () if isinstance(self.tower, Beam) else self.tower.bodies.values()
        return self.tower.mass + sum(body.mass for body in bodies)

    @property
    def tower_moment(self) -> float:
        """First moment of the tower and its own bodies about its foot [kg m]."""
        return as_chain(self.tower).inertia[1]

    @property
    def collars(self) -> tuple[TowerCollar, ...]:
        """What ties the tower to a building, the lowest first, with the springs that hold its shaft there."""
        tower, twisted, found = as_chain(self.tower), () if self.shaft is None else self.shaft.springs, [*self.gapped]
        for node, own in tower.collars.items():
            height = tower.nodes[node]
            torsional = sum(stiffness for at, stiffness in twisted if abs(at - height) <= SAME_HEIGHT * height)
            found.append(TowerCollar(height, own.stiffness, own.rotation_stiffness, torsional))
        return tuple(sorted(found, key=lambda collar: collar.height))

    @property
    def end_body(self) -> EndBody:
        """The slewing part as the tower's end body: what Gao et al. (2023), Eq. 26, calls m_r and J_r."""
        if self.luffing is not None:
            return self.luffing.standing_body(self)
        return EndBody(self.slewing_mass, self.slewing_inertia)

    def tower_modes(self, count: int) -> Modes | ChainModes:
        """Modes of the tower with the slewing part on its end."""
        return modes_of(self.tower, count, self.end_body)

    def tower_shapes(self, count: int) -> Modes | ChainModes:
        """The same, and how the tower bends under each collar with play; none of a rigid tower."""
        if not (self.gapped and count):
            return self.tower_modes(count)
        from towercrane.cranes.tower.modes.gap_shapes import gap_shapes

        return gap_shapes(as_chain(self.tower), count, self.end_body, [collar.height for collar in self.gapped])

    def jib_modes(self, count: int) -> Modes | ChainModes:
        """Modes of the jib, clamped at the tower top and free at its end."""
        return modes_of(self.jib, count)

    def counter_jib_modes(self, count: int) -> Modes | ChainModes | None:
        """The same of the counter-jib with its ballast; None where it is rigid."""
        return modes_of(self.counter_jib, count) if self.counter_jib is not None else None


def modes_of(member: Beam | Chain, count: int, end_body: EndBody = EndBody()) -> Modes | ChainModes:  # noqa: B008
    """Modes of a member clamped at its foot, or on its foundation, with a body at its end."""
    if isinstance(member, Beam):
        from modal.beams.shapes import cantilever_modes

        return cantilever_modes(member, count, end_body)
    from modal.structures.chain_modes import chain_modes

    return chain_modes(member, count, end_body)


def as_chain(beam: Beam | Chain) -> Chain:
    """A uniform beam as a chain of one segment; a chain as it is."""
    if not isinstance(beam, Beam):
        return beam
    from modal.beams.chain import Chain
    from modal.beams.segment import Segment

    return Chain((Segment(beam.length, beam.mass_per_length, beam.bending_stiffness),))


def _carried(member: Beam | Chain) -> tuple[object, ...]:
    """What a member has in common with itself in another direction of bending: lengths and masses."""
    if isinstance(member, Beam):
        return member.length, member.mass_per_length
    segments = tuple((own.length, own.mass_per_length, own.end_ratio, own.mass_power) for own in member.segments)
    return segments, tuple((node, body.mass, body.offset) for node, body in member.bodies.items())

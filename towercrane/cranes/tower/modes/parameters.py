"""Parameters of a tower crane."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from modal.beams.beam import Beam, EndBody
from modal.checks import check_fields

if TYPE_CHECKING:
    from modal.beams.chain import Chain
    from modal.beams.shapes import Modes
    from modal.beams.torsion import Shaft
    from modal.structures.chain_modes import ChainModes
    from towercrane.cranes.tower.modes.luffing_jib import LuffingJib


@dataclass(frozen=True, slots=True)
class TowerCrane:
    """Parameters of a tower crane with a flexible tower and jib and a rigid counter-jib.

    Parameters
    ----------
    name : str
    tower : Beam or Chain
        The tower below the slewing part: a uniform clamped Euler beam, or a chain of segments on its foundation with
        bodies of its own. Its length is the tower's height.
    jib : Beam
        Its length is the jib's radius.
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
    jib_lateral : Beam, optional
        The jib in bending to its sides; needed for such modes alone.
    shaft : Shaft, optional
        The tower in torsion; needed for such modes alone.
    roll_inertia : float
        Moment of inertia of the slewing part about the jib's axis [kg m^2].
    luffing : LuffingJib, optional
        Of a jib that pivots and carries no trolley; what depends on its angle is taken at its reference angle.
        Without it the jib is clamped and level.

    Raises
    ------
    ValueError
        If a number is negative or not finite, or jib and lateral jib, or tower and shaft, differ in what they share.
    """

    name: str
    tower: Beam | Chain
    jib: Beam
    counter_jib_length: float
    counter_jib_mass_per_length: float
    counterweight: float
    trolley_mass: float
    gravity: float = 9.81
    jib_lateral: Beam | None = None
    shaft: Shaft | None = None
    roll_inertia: float = 0.0
    luffing: LuffingJib | None = None

    def __post_init__(self) -> None:
        masses = ("counter_jib_mass_per_length", "counterweight", "trolley_mass", "gravity", "roll_inertia")
        check_fields(self, not_negative=("counter_jib_length", *masses))
        pairs = [("jib_lateral", self.jib_lateral, self.jib, "length"), ("shaft", self.shaft, self.tower, "length")]
        pairs.append(("jib_lateral", self.jib_lateral, self.jib, "mass_per_length"))
        for name, other, member, shared in pairs:
            if other is not None and getattr(other, shared) != getattr(member, shared):
                wanted, got = getattr(member, shared), getattr(other, shared)
                raise ValueError(f"TowerCrane.{name}.{shared}: wanted {wanted!r}, as in the plane, got {got!r}")

    @property
    def counter_mass(self) -> float:
        """Mass of counter-jib and counterweight [kg]."""
        return self.counter_jib_mass_per_length * self.counter_jib_length + self.counterweight

    @property
    def counter_inertia(self) -> float:
        """Moment of inertia of counter-jib and counterweight about the tower top [kg m^2]."""
        length = self.counter_jib_length
        return self.counter_jib_mass_per_length * length**3 / 3 + self.counterweight * length**2

    @property
    def counter_moment(self) -> float:
        """First moment of counter-jib and counterweight about the tower axis, which is negative [kg m]."""
        counter = self.counter_jib_mass_per_length * self.counter_jib_length / 2 + self.counterweight
        return -counter * self.counter_jib_length

    @property
    def slewing_mass(self) -> float:
        """Mass m_r of everything that turns, without trolley and load [kg]."""
        if self.luffing is not None:
            return self.luffing.standing_sums(self).mass
        return self.jib.mass + self.counter_mass

    @property
    def slewing_inertia(self) -> float:
        """Moment of inertia J_r of everything that turns about the tower's axis [kg m^2].

        Full integrals; the additional factors 1/2 of Gao et al. (2023), Eq. 8 and 10, are misprints.
        """
        if self.luffing is not None:
            return self.luffing.standing_sums(self).zz
        return self.jib.mass * self.jib.length**2 / 3 + self.counter_inertia

    @property
    def static_moment(self) -> float:
        """First moment S_r of everything that turns about the tower axis, positive towards the jib [kg m]."""
        if self.luffing is not None:
            return self.luffing.standing_sums(self).forward
        return self.jib.mass * self.jib.length / 2 + self.counter_moment

    @property
    def tower_mass(self) -> float:
        """Mass of the tower and its own bodies [kg]."""
        bodies = () if isinstance(self.tower, Beam) else self.tower.bodies.values()
        return self.tower.mass + sum(body.mass for body in bodies)

    @property
    def end_body(self) -> EndBody:
        """The slewing part as the tower's end body: what Gao et al. (2023), Eq. 26, calls m_r and J_r."""
        if self.luffing is not None:
            return self.luffing.standing_body(self)
        return EndBody(self.slewing_mass, self.slewing_inertia)

    def tower_modes(self, count: int) -> Modes | ChainModes:
        """Modes of the tower with the slewing part on its end."""
        if isinstance(self.tower, Beam):
            from modal.beams.shapes import cantilever_modes

            return cantilever_modes(self.tower, count, self.end_body)
        from modal.structures.chain_modes import chain_modes

        return chain_modes(self.tower, count, self.end_body)

    def jib_modes(self, count: int) -> Modes:
        """Modes of the jib, clamped at the tower top and free at its end."""
        from modal.beams.shapes import cantilever_modes

        return cantilever_modes(self.jib, count)

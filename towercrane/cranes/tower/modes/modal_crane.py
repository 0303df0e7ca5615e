"""What a flexible crane is made of: shapes of its members, sums over the mass they carry, and what the wind meets."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Protocol

import numpy as np

from modal.beams.torsion import torsion_modes
from towercrane.cranes.tower.modes.exposures import exposure_of
from towercrane.cranes.tower.modes.jib_shapes import shapes_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from modal.structures.chain_modes import ChainModes
    from towercrane.cranes.parts.wind import WindAreas, WindNodes
    from towercrane.cranes.tower.modes.collars import TowerCollar
    from towercrane.cranes.tower.modes.exposures import Exposure
    from towercrane.cranes.tower.modes.luffing_jib import LuffingJib
    from towercrane.cranes.tower.modes.mass_sums import Basis, MassSums
    from towercrane.cranes.tower.modes.mode_counts import ModeCounts
    from towercrane.cranes.tower.modes.parameters import TowerCrane
    from towercrane.cranes.tower.modes.tied.head import FieldSums, TiedHead

    Floats = NDArray[np.float64]


class TorsionBasis(Protocol):
    """Shapes of torsion of the tower, such as :class:`modal.beams.torsion.TorsionModes`."""

    @property
    def count(self) -> int:
        """Number of shapes."""

    @property
    def angular_frequencies(self) -> Floats:
        """Square roots of the stiffness of each shape by itself."""

    def __call__(self, position: ArrayLike) -> Floats:
        """Twist, shape (count, *shape of position)."""

    def mass_matrix(self) -> Floats:
        """Products of shapes over the tower's own inertia."""

    def mass_moment(self) -> Floats:
        """Sums of shapes over the tower's own inertia."""

    def with_stiffness(self, factor: float) -> TorsionBasis:
        """As many shapes of a tower so many times as stiff."""


@dataclass(frozen=True, eq=False)
class FlexibleCrane:
    """Tower on the ground, head that slews and tilts with its top, jib with trolley, counter-jib.

    Sums over what turns know four groups of shapes, in this order: of the jib to the left, of the counter-jib to the
    left, of the jib up, of the counter-jib up.

    Parameters
    ----------
    name : str
    tower_height, jib_length : float
        [m]
    tower : Basis
        Bending, the same along x and y.
    torsion : TorsionBasis
    lateral, vertical : Basis
        Bending of the jib to the left and up.
    jib, counter : MassSums
        The jib; counter-jib, counterweight and whatever else is on the head.
    tower_mass : float
        Of the tower and its own bodies [kg].
    trolley_mass : float
        [kg]
    planes : {1, 2}
        Directions in which the tower bends: x, or x and y.
    tower_moment : float
        First moment of the tower's mass and of its own bodies about its foot [kg m].
    collars : tuple of TowerCollar
        What ties the tower to a building, the lowest first; the shapes know the stiffness of those without play.
    exposure : Exposure, optional
        What the wind meets of it.
    gravity : float
        [m/s^2]
    luffing : LuffingJib, optional
        Of a jib that pivots: its shapes are then seen from the chord from foot to head, its sums about the foot.
    counter_lateral, counter_vertical : ChainModes, optional
        Bending of the counter-jib, from its root outward, to the left and up.
    joints : tuple of float
        Places on the jib, between its ends and ascending, at which its slope or curvature may step [m].
    tied : TiedHead, optional
        Cat-head and ties, of jibs that hinge at their feet.
    written : TowerCrane, optional
        The parameters that it is made of; without, it was put together by hand.

    Raises
    ------
    ValueError
        If there are other planes than these.
    """

    name: str
    tower_height: float
    jib_length: float
    tower: Basis
    torsion: TorsionBasis
    lateral: Basis
    vertical: Basis
    jib: MassSums
    counter: MassSums
    tower_mass: float
    trolley_mass: float
    planes: int = 2
    tower_moment: float = 0.0
    collars: tuple[TowerCollar, ...] = ()
    exposure: Exposure | None = None
    gravity: float = 9.81
    luffing: LuffingJib | None = None
    counter_lateral: ChainModes | None = None
    counter_vertical: ChainModes | None = None
    joints: tuple[float, ...] = ()
    tied: TiedHead | None = None
    written: TowerCrane | None = None

    def __post_init__(self) -> None:
        if self.planes not in (1, 2):
            raise ValueError(f"FlexibleCrane.planes: wanted 1 or 2, got {self.planes!r}")

    @cached_property
    def slewing(self) -> MassSums:
        """Sums over all that turns, without trolley and load."""
        return self.jib + self.counter

    @cached_property
    def tied_sums(self) -> FieldSums:
        """Sums over the same and over cat-head and ties, of points that move in any direction."""
        assert self.tied is not None, "the crane has ties"
        return self.tied.sums(self.slewing)

    @property
    def turning_mass(self) -> float:
        """Mass of all that turns, without trolley and load [kg]."""
        return self.slewing.mass if self.tied is None else self.tied_sums.mass

    @cached_property
    def tower_moments(self) -> tuple[Floats, Floats]:
        """Sums over the tower's own mass of its shapes, and with the height as weight; shapes (count,)."""
        return self.tower.mass_moments()

    @cached_property
    def tower_matrices(self) -> tuple[Floats, Floats]:
        """Own mass and stiffness of the tower in its shapes; shapes (count, count)."""
        return self.tower.mass_matrix(), self.tower.stiffness_matrix()

    @cached_property
    def tower_softening(self) -> tuple[Floats, Floats]:
        """What unit force on the tower's top, and its own weight under unit gravity, take from the stiffness."""
        return self.tower.slope_matrix(), self.tower.weight_matrix()

    @cached_property
    def groups(self) -> tuple[int, int, int, int]:
        """How many shapes each group has."""
        bases = self.lateral, self.counter_lateral, self.vertical, self.counter_vertical
        lateral, counter_lateral, vertical, counter_vertical = (0 if own is None else own.count for own in bases)
        return lateral, counter_lateral, vertical, counter_vertical

    @property
    def counter_bends(self) -> bool:
        """Whether there are shapes of the counter-jib."""
        return any(self.groups[1::2])

    @property
    def carrying(self) -> NDArray[np.int64]:
        """Which of the shapes are the jib's, that the trolley runs on."""
        lateral, aside, vertical, _ = self.groups
        return np.concatenate([np.arange(lateral), lateral + aside + np.arange(vertical)])

    def jib_shapes(self, position: ArrayLike, derivative: int = 0) -> Floats:
        """Shapes on the jib, or their derivatives; shape (shapes, *shape of position). Those of the counter-jib are
        zero there."""
        found = np.zeros((sum(self.groups), *np.shape(position)))
        bases = [basis for basis in (self.lateral, self.vertical) if basis.count]
        if bases:
            found[self.carrying] = np.concatenate([basis(position, derivative) for basis in bases])
        return found

    def counter_shapes(self, position: ArrayLike) -> Floats:
        """The same on the counter-jib, by the distance from its root; those of the jib are zero there."""
        found = np.zeros((sum(self.groups), *np.shape(position)))
        lateral, aside, vertical, _ = self.groups
        if self.counter_lateral is not None:
            found[lateral : lateral + aside] = self.counter_lateral(position)
        if self.counter_vertical is not None:
            found[lateral + aside + vertical :] = self.counter_vertical(position)
        return found

    @cached_property
    def tip_shapes(self) -> Floats:
        """Shapes of the jib at its tip, shape (jib modes, 1)."""
        return self.jib_shapes([self.jib_length])

    @cached_property
    def counter_tip_shapes(self) -> Floats:
        """Shapes of the counter-jib at its tip, shape (jib modes,)."""
        bends = self.counter_vertical or self.counter_lateral
        return self.counter_shapes(bends.length if bends is not None else 0.0)

    @property
    def top_slope(self) -> Floats:
        """Rotation of the tower's top with each of its shapes, shape (count,)."""
        return self.tower.rotation(self.tower_height)


def flexible_crane(
    crane: TowerCrane, modes: ModeCounts, areas: WindAreas | None = None, planes: int = 2,
    nodes: WindNodes | None = None, *, moves: bool = False,
) -> FlexibleCrane:  # fmt: skip
    """Crane in so many modes of its members, the tower's with the head on their end.

    Parameters
    ----------
    crane : TowerCrane
    modes : ModeCounts
    areas : WindAreas, optional
    planes : {1, 2}
        Directions in which the tower bends.
    nodes : WindNodes, optional
        Where a wind of its own blows; without, one wind blows for all.
    moves : bool
        Whether the air knows that what turns moves itself.

    Raises
    ------
    ValueError
        If there are modes of a member that the crane does not describe.
    """
    check_described(crane, modes)
    shapes = shapes_of(crane, modes, planes)
    tower = crane.tower_shapes(modes.tower)
    return FlexibleCrane(
        name=crane.name,
        tower_height=crane.tower.length,
        jib_length=crane.jib.length,
        tower=tower,
        torsion=torsion_of(crane, modes.torsion),
        lateral=shapes.lateral,
        vertical=shapes.vertical,
        jib=shapes.jib,
        counter=shapes.counter,
        tower_mass=crane.tower_mass,
        trolley_mass=crane.trolley_mass,
        planes=planes,
        exposure=None if areas is None else exposure_of(shapes, tower, crane.tower.length, areas, nodes, moves),
        tower_moment=crane.tower_moment,
        collars=crane.collars,
        gravity=crane.gravity,
        counter_lateral=shapes.counter_lateral,
        counter_vertical=shapes.counter_vertical,
        joints=crane.joints,
        tied=shapes.tied,
        written=crane,
    )


def check_described(crane: TowerCrane, modes: ModeCounts) -> None:
    """Refuse modes of a member that the crane does not describe.

    Raises
    ------
    ValueError
    """
    described = {
        "shaft": (modes.torsion, "torsion"), "jib_lateral": (modes.lateral, "lateral"),
        "counter_jib_lateral": (modes.counter_lateral, "lateral"),
        "counter_jib": (modes.counter_vertical, "vertical"),
    }  # fmt: skip
    for member, (count, wanted) in described.items():
        if count and getattr(crane, member) is None:
            raise ValueError(f"TowerCrane.{member}: wanted for {count} {wanted} modes, got None")


def torsion_of(crane: TowerCrane, count: int) -> TorsionBasis:
    """Torsion of the tower with what turns on its end."""
    from modal.beams.torsion import Shaft

    # A rigid shaft has no modes, whatever its data.
    shaft = crane.shaft or Shaft(crane.tower.length, 1.0, 1.0)
    return torsion_modes(shaft, count, crane.slewing_inertia)

"""The constants of a flexible crane's equations."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import accumulate
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.parts.friction import BY_RATE
from towercrane.cranes.parts.ground import CHANNELS as GROUND
from towercrane.cranes.tower.equations.matrices import met_by_wind, own_mass, rotary_mass, softening, stiffness
from towercrane.cranes.tower.equations.play import play_of
from towercrane.cranes.tower.modes.mass_sums import Straight
from towercrane.cranes.tower.modes.shape_table import shape_table
from towercrane.kernels.algebra import Row
from towercrane.kernels.straight.leaves import CHANGING

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.slewing.description import Drive
    from towercrane.cranes.tower.equations.coordinates import Coordinates
    from towercrane.cranes.tower.equations.luffing.constants import Luffing
    from towercrane.cranes.tower.equations.play import Play
    from towercrane.cranes.tower.equations.tied.constants import Tied
    from towercrane.kernels.load import Load

    Floats = NDArray[np.float64]
    Table = Floats

TILT_LIMIT = 0.5
"""Tilt of the tower top at which a run ends as buckled [rad]: far beyond what a beam theory of small slopes holds."""

TROLLEY, ROPE, SLEWING = range(3)
"""Motions that drive it; a slewing motion is there unless the head is fixed, the wind's three come last."""

SLIDE_X, SLIDE_Y, TILT_X, TILT_Y, TURN = range(5)
"""Motions of the head: u_x and u_y of the tower's top, tilt vector th_x and th_y, turning."""

Drives = Row
"""Value, rate and acceleration of each of these motions."""

KINDS = (
    "tower_x", "tower_y", "torsion", "slewing",
    "jib_lateral", "counter_jib_lateral", "jib_vertical", "counter_jib_vertical", "luffing",
    "tower_head", "tie", "tie_sideways",
)  # fmt: skip
"""Kinds of coordinates in the order of the state."""


@dataclass(frozen=True, eq=False)
class Constants:
    """What the equations know of a crane; n coordinates.

    Parameters
    ----------
    axes : {2, 3}
        Of space for the load, the vertical last; with 2 the coordinates must leave the crane in its plane.
    channels : int
        Number of the motions that drive it.
    counts : tuple of 12 int
        Coordinates of each kind.
    slewing : {"fixed", "prescribed", "driven", "free"}
    wind : int
        Number of places that see a wind of their own, the load the last; 1: one wind for all; 0: none.
    head_nodes, tower_nodes : tuple of int
        Of what turns, and of parts of the tower, the place whose wind it is.
    ground : int
        Place of the ground's displacement along x among the channels, which those along y and z, then those of floors
        follow; zero where the ground rests.
    release : int
        Place among the channels of the part of the load that has let go; zero where nothing does.
    load : Load
    drive : Drive or None
        Of a head that is driven.
    trolley_mass, gravity, self_gravity : float
        [kg], [m/s^2]; the last, of the structure, is zero where its own weight is left out.
    slewing_mass, static_moment, roll, pitch, yaw : float
        Mass, first moment and moments of inertia of what turns [kg, kg m, kg m^2].
    jib_length, tilt_limit : float
        [m], [rad]
    head_places : ndarray, shape (head nodes,)
        Where they are along the jib [m].
    head_area, head_area_moment : ndarray, shape (head nodes,)
        Drag per squared speed of jib and counter-jib, and its first moment [kg/m, kg].
    plane_cosine, plane_sine : float
        Of the angle from the fixed x axis to the first axis of the coordinates, not zero in a plane alone.
    motions : ndarray, shape (5, n)
        What a coordinate moves the head: SLIDE_X to TURN.
    jib_mass, jib_moment, jib_turning : ndarray, shape (n,)
        int m phi, int m x phi and int rho I theta of the modes of jib and counter-jib, zero elsewhere.
    damping, cap : ndarray, shape (n,)
        Viscous damping; mass added where a frequency is capped.
    head_exposure, tower_exposure : ndarray, shapes (head nodes, n), (tower nodes, n)
        int c phi with the drag c per squared speed.
    tower_mass : ndarray, shape (n,)
        int m phi of the tower's modes with what stands on it and under it, zero elsewhere.
    floor_pull : ndarray, shape (floors, n)
        Force on the tower's modes, along x or y, per displacement of each floor whose collar has no play.
    softening : ndarray, shape (n, n)
        Stiffness that a unit acceleration of the ground, upward, takes from the tower; zero where weight takes none.
    own_mass, stiffness : ndarray, shape (n, n)
        Mass of the tower alone, of the drive, and int m phi_i phi_j of all jib modes, lateral with vertical too.
    rotary_mass : ndarray, shape (n, n)
        int rho I theta_i theta_j of the jib modes of either direction.
    sections : ndarray, shape (s + 1,)
        Ends of the pieces of the jib in which its shapes are smooth [m].
    shapes : ndarray, shape (cells, jib modes, terms)
        Shapes of the jib's modes as polynomials about the middle of cells, as many equal ones in every section.
    luffing : Luffing or None
        Of a jib that pivots.
    tied : Tied or None
        Of jibs on tie bars.
    play : Play or None
        Of collars that leave the tower some way.
    """

    axes: int
    channels: int
    counts: tuple[int, ...]
    slewing: str
    wind: int
    head_nodes: tuple[int, ...]
    tower_nodes: tuple[int, ...]
    ground: int
    release: int
    load: Load
    drive: Drive | None
    trolley_mass: float
    gravity: float
    self_gravity: float
    slewing_mass: float
    static_moment: float
    roll: float
    pitch: float
    yaw: float
    jib_length: float
    tilt_limit: float
    head_places: Floats
    head_area: Floats
    head_area_moment: Floats
    plane_cosine: float
    plane_sine: float
    motions: Floats
    jib_mass: Floats
    jib_moment: Floats
    jib_turning: Floats
    damping: Floats
    head_exposure: Floats
    tower_exposure: Floats
    cap: Floats
    tower_mass: Floats
    floor_pull: Floats
    softening: Floats
    own_mass: Floats
    stiffness: Floats
    rotary_mass: Floats
    sections: Floats
    shapes: Table
    luffing: Luffing | None
    tied: Tied | None
    play: Play | None
    friction_state: float = field(default=BY_RATE, metadata=CHANGING)

    @property
    def coordinates(self) -> int:
        """Number of coordinates."""
        return sum(self.counts)

    def part(self, kind: str) -> range:
        """Coordinates of a kind."""
        ends = [0, *accumulate(self.counts)]
        at = KINDS.index(kind)
        return range(ends[at], ends[at + 1])

    @property
    def lateral(self) -> range:
        """Modes of jib and counter-jib to the left."""
        return range(self.part("jib_lateral").start, self.part("counter_jib_lateral").stop)

    @property
    def vertical(self) -> range:
        """Modes of jib and counter-jib up."""
        return range(self.part("jib_vertical").start, self.part("counter_jib_vertical").stop)

    @property
    def jointed(self) -> bool:
        """Whether the jib has more than one section."""
        return len(self.sections) > 2

    def across(self, mode: int) -> bool:
        """Whether a coordinate is of motion to the left on the head."""
        return mode in self.lateral or mode in self.part("tie_sideways")

    def row_of(self, mode: int) -> int | None:
        """Row of a mode's shape in the table; the counter-jib's have none."""
        lateral, vertical = self.part("jib_lateral"), self.part("jib_vertical")
        if mode in lateral:
            return mode - lateral.start
        return len(lateral) + mode - vertical.start if mode in vertical else None

    @property
    def movers(self) -> int:
        """Number of coordinates that move the head; the modes of jib and counter-jib follow them."""
        return self.lateral.start

    @property
    def straight(self) -> Straight:
        """Mass of what turns, while nothing bends."""
        return Straight(self.slewing_mass, self.static_moment, self.roll, self.pitch, self.yaw)

    @property
    def turns(self) -> bool:
        """Whether the head can turn."""
        return self.slewing != "fixed" or len(self.part("torsion")) > 0

    @property
    def fixed_axes(self) -> tuple[int, ...]:
        """Which of the axes x, y, z a load has."""
        return (0, 1, 2) if self.axes == 3 else (0, 2)


def constants_of(model: Coordinates) -> Constants:
    """Constants of a crane in its chosen coordinates."""
    crane, drive, slewing = model.crane, model.drive, model.crane.slewing
    return Constants(
        axes=model.axes,
        channels=len(model.channels),
        counts=tuple(model.counts.get(kind, 0) for kind in KINDS),
        slewing=str(model.slewing) if drive is None else "free" if drive.free else "driven",
        wind=model.wind,
        ground=model.channels.index(GROUND[0]) if model.ground else 0,
        release=model.channels.index("release") if model.load.release is not None else 0,
        load=model.load,
        drive=drive,
        trolley_mass=crane.trolley_mass,
        gravity=crane.gravity,
        self_gravity=crane.gravity if model.self_weight else 0.0,
        slewing_mass=slewing.mass,
        static_moment=slewing.moment,
        roll=slewing.roll,
        pitch=slewing.pitch,
        yaw=slewing.yaw,
        jib_length=crane.jib_length,
        tilt_limit=TILT_LIMIT,
        plane_cosine=np.cos(model.heading),
        plane_sine=np.sin(model.heading),
        cap=model.added_mass,
        sections=np.array([0.0, *crane.joints, crane.jib_length]),
        shapes=shape_table((crane.lateral, crane.vertical), (0.0, *crane.joints, crane.jib_length)),
        **_of_coordinates(model),
        **met_by_wind(model),
        softening=softening(model),
        **_of_ground(model),
        own_mass=own_mass(model),
        rotary_mass=rotary_mass(model),
        stiffness=stiffness(model),
        luffing=None,
        tied=None,
        play=play_of(model),
    )


def _of_coordinates(model: Coordinates) -> dict[str, Any]:
    """What each coordinate moves, carries and loses."""
    crane, parts, n = model.crane, model.parts, model.coordinates
    motions = np.zeros((TURN + 1, n))
    jib_mass, jib_moment, jib_turning = np.zeros((3, n))
    # One mode list per plane of the tower: both see the same tip and slope.
    for plane, slide, tilt, sense in (("tower_x", SLIDE_X, TILT_Y, 1.0), ("tower_y", SLIDE_Y, TILT_X, -1.0)):
        if model.counts[plane]:
            motions[slide, parts[plane]] = crane.tower(crane.tower_height)
            motions[tilt, parts[plane]] = sense * crane.top_slope
    motions[TURN, parts["torsion"]] = crane.torsion(crane.tower_height)
    motions[TURN, parts["slewing"]] = 1.0
    jib = slice(parts["jib_lateral"].start, parts["counter_jib_vertical"].stop)
    slewing = crane.slewing
    jib_mass[jib], jib_moment[jib], jib_turning[jib] = slewing.first, slewing.second, slewing.turned
    d = model.damping
    kinds = d.tower, d.tower, d.torsion, 0.0, d.lateral, d.counter_lateral, d.vertical, d.counter_vertical
    lost = dict(zip(KINDS, kinds, strict=False))
    ratios = np.concatenate([np.full(count, lost.get(kind, 0.0)) for kind, count in model.counts.items()])
    # Of a mode that a cap slows, of its slowed frequency and greater mass: the ratio is as stated.
    damping = 2.0 * ratios * model.angular_frequencies * np.sqrt(1.0 + model.added_mass)
    return {
        "motions": motions, "damping": damping,
        "jib_mass": jib_mass, "jib_moment": jib_moment, "jib_turning": jib_turning,
    }  # fmt: skip


def _of_ground(model: Coordinates) -> dict[str, Any]:
    """What the ground and floors do to the tower; zeros where they rest."""
    crane, parts, n = model.crane, model.parts, model.coordinates
    tower_mass, floor_pull = np.zeros(n), np.zeros((model.floors, n))
    for plane in ("tower_x", "tower_y"):
        at = parts[plane]
        if not (model.ground and model.counts[plane]):
            continue
        tower_mass[at] = crane.tower_moments[0]
        for row, collar in zip(floor_pull, crane.collars, strict=False):
            row[at] = 0.0 if collar.gap else collar.stiffness * crane.tower(collar.height)
    return {"tower_mass": tower_mass, "floor_pull": floor_pull}

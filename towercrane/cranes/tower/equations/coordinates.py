"""What moves in a flexible crane with its load: its description, its coordinates and the order of its states."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np

from modal.checks import check_fields
from towercrane.cranes.parts.ground import CHANNELS as GROUND
from towercrane.cranes.parts.ground import floor_channels
from towercrane.cranes.parts.wind import wind_channels
from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.cranes.tower.modes.frequency_cap import added_mass

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.slewing.description import Drive
    from towercrane.cranes.tower.modes.modal_crane import FlexibleCrane
    from towercrane.kernels.load import Load

    Floats = NDArray[np.float64]


ANGLES = "slewing", "luffing"
"""Kinds of coordinates that are no modes: of the head where a drive turns it, of a jib that pivots."""

UPRIGHT = "tower_x", "jib_vertical", "counter_jib_vertical", "luffing", "tower_head", "tie"
"""Kinds of coordinates that move in the vertical plane of a jib along x."""

SIDEWAYS = "tower_y", "jib_lateral", "counter_jib_lateral", "tie_sideways"
"""Kinds that move out of it without turning."""

BOWS = {"tie": "tie_sag", "tie_sideways": "tie_bow"}
"""Kinds of coordinates that are the bows of ties [m], down and to the left, and their names."""


@dataclass(frozen=True, eq=False)
class Coordinates:
    """A flexible crane with its load in chosen coordinates.

    Parameters
    ----------
    crane : FlexibleCrane
        With as many modes as are to move; made by :func:`towercrane.cranes.tower.modes.modal_crane.flexible_crane`.
    load : Load
    slewing : {"prescribed", "fixed"} or Drive
        The slewing angle of the head on the tower's top as a motion, fixed, or as a coordinate that a drive with an
        elastic coupling turns.
    heading : float
        Angle from the fixed x axis to a plane that the load swings in [rad]: the jib's, whose coordinates along x are
        then along the jib. Zero for a load in space.
    drive_inertia : float
        Moment of inertia that turns with the slewing angle and does not tilt [kg m^2]; with a drive only.
    damping : ModalDamping
    weight_softening : bool
        Include the geometric stiffness of the weight above each section of the tower.
    self_weight : bool
        Whether the structure has weight; without it only trolley and load do.
    rope_as_rod : bool
        Let the rope push, as most published models do. Without it a slack rope ends the run.
    wind : int
        Number of places that see a wind of their own, prescribed by motions of its components: one for all; or none.
    ground : bool
        Whether the ground moves, prescribed by motions of its three displacements.
    floors : int
        Number of floors, the lowest first, whose own motion against the ground moves the collars that tie the tower
        to them; all of them, or none: then collars move with the ground.
    axes : {2, 3}
        2 for a load that swings in the plane of a jib at rest, 3 in space.
    cap : float
        Highest frequency [Hz] of a mode by itself: every mode after a member's second that is faster keeps its
        stiffness and is made so slow by mass added to its own coordinate (selective mass scaling). The static
        flexibility stays exact and energy is conserved; what vibrates near the cap or beyond it is not.

    Raises
    ------
    ValueError
        If the cap is not positive, a crane that leaves the plane is asked to stay in it, a load in space is given a
        heading, there are floors without a collar or a ground that moves, the ground moves under a jib that pivots,
        the slewing is of no known kind, the drive's friction is set-valued, or there is inertia of a drive without a
        drive.
    """

    crane: FlexibleCrane
    load: Load
    slewing: Literal["prescribed", "fixed"] | Drive = "prescribed"
    drive_inertia: float = 0.0
    heading: float = 0.0
    damping: ModalDamping = field(default_factory=ModalDamping)
    weight_softening: bool = False
    self_weight: bool = True
    rope_as_rod: bool = False
    wind: int = 0
    ground: bool = False
    floors: int = 0
    axes: Literal[2, 3] = 3
    cap: float = np.inf

    def __post_init__(self) -> None:
        check_fields(self, not_negative=("drive_inertia",))
        if not isinstance(self.cap, int | float) or not self.cap > 0.0:
            raise ValueError(f"FlexibleModel.cap: wanted a positive frequency [Hz], got {self.cap!r}")
        crane = self.crane
        leaves = crane.planes > 1 or crane.torsion.count or any(crane.groups[:2]) or self.slewing != "fixed"
        if self.axes == 2 and leaves:
            raise ValueError("FlexibleModel.axes: wanted 3 for a crane that moves out of its plane, got 2")
        if self.axes == 3 and self.heading != 0.0:
            raise ValueError(f"FlexibleModel.heading: wanted 0 for a load in space, got {self.heading!r}")
        if isinstance(self.slewing, str) and self.slewing not in ("prescribed", "fixed"):
            raise ValueError(f"FlexibleModel.slewing: wanted 'prescribed', 'fixed' or a Drive, got {self.slewing!r}")
        if self.ground and crane.luffing is not None:
            raise ValueError("FlexibleModel.ground: wanted False for a jib that pivots, got True")
        if self.floors not in (0, len(crane.collars)) or (self.floors and not self.ground):
            wanted = f"0, or {len(crane.collars)} for a ground that moves, one for each collar"
            raise ValueError(f"FlexibleModel.floors: wanted {wanted}, got {self.floors!r}")
        if self.weight_softening and self.load.release is not None:
            raise ValueError("FlexibleModel.weight_softening: wanted False for a load that lets go, got True")
        if self.drive is None and self.drive_inertia:
            raise ValueError(f"FlexibleModel.drive_inertia: wanted 0 without a drive, got {self.drive_inertia!r}")
        if self.drive is not None and self.drive.friction == "stick-slip" and not self.drive.free:
            raise ValueError(
                "FlexibleModel.slewing: wanted friction 'none' or 'tanh', got 'stick-slip', which is of a brake "
                "without a coupling"
            )
        if self.drive is not None and self.drive.free and crane.luffing is not None:
            raise ValueError(
                "FlexibleModel.slewing: wanted a motion or a drive with a coupling for a jib that pivots"
            )

    @property
    def drive(self) -> Drive | None:
        """The drive that turns the head, if its angle is a coordinate."""
        return None if isinstance(self.slewing, str) else self.slewing

    @cached_property
    def channels(self) -> tuple[str, ...]:
        """Motions, as there are: trolley [m] or luffing [rad], rope [m], slewing or shaft of its drive [rad], part of
        what lets go of the load that is gone, ground and floors [m], wind [m/s]."""
        turning: tuple[str, ...] = ("slewing",) if self.drive is None or self.drive.free else ("shaft",)
        if self.slewing == "fixed":
            turning = ()
        placing = "trolley" if self.crane.luffing is None else "luffing"
        going = ("release",) if self.load.release is not None else ()
        shaken = (*GROUND, *floor_channels(self.floors)) if self.ground else ()
        return (placing, "rope", *turning, *going, *shaken, *self.value_channels)

    @property
    def value_channels(self) -> tuple[str, ...]:
        """Channels that act by their value alone, of which a crane at rest knows the mean: the wind's components."""
        return wind_channels(self.wind)

    @property
    def channel_units(self) -> tuple[str, ...]:
        """Units of the channels."""
        units = dict.fromkeys(("luffing", "slewing", "shaft"), "rad") | dict.fromkeys(self.value_channels, "m/s")
        units["release"] = "1"
        return tuple(units.get(channel, "m") for channel in self.channels)

    @cached_property
    def counts(self) -> dict[str, int]:
        """Number of coordinates of each kind, in the order of the state."""
        crane = self.crane
        lateral, counter_lateral, vertical, counter_vertical = crane.groups
        modes = {
            "tower_x": crane.tower.count,
            "tower_y": crane.tower.count if crane.planes > 1 else 0,
            "torsion": crane.torsion.count,
            "slewing": int(self.drive is not None),
            "jib_lateral": lateral,
            "counter_jib_lateral": counter_lateral,
            "jib_vertical": vertical,
            "counter_jib_vertical": counter_vertical,
        }
        if crane.tied is not None:
            modes |= dict(zip(("tower_head", "tie", "tie_sideways"), crane.tied.counts[4:], strict=True))
        return modes if crane.luffing is None else {**modes, "luffing": 1}

    @cached_property
    def parts(self) -> dict[str, slice]:
        """Where the coordinates of each kind are in the state."""
        ends = np.cumsum([0, *self.counts.values()])
        return {kind: slice(int(a), int(b)) for kind, a, b in zip(self.counts, ends[:-1], ends[1:], strict=True)}

    @property
    def state_names(self) -> dict[str, str]:
        """Name and unit of every coordinate."""
        names: dict[str, str] = {}
        for kind, count in self.counts.items():
            if kind in ANGLES:
                names |= dict.fromkeys([f"{kind}_angle"][:count], "rad")
            elif kind in BOWS:
                names |= {f"{BOWS[kind]}_{i + 1}": "m" for i in range(count)}
            else:
                names |= {f"{kind}_mode_{i + 1}": "kg^0.5 m" for i in range(count)}
        return names

    @cached_property
    def coordinates(self) -> int:
        """Number of structural coordinates."""
        return sum(self.counts.values())

    @property
    def size(self) -> int:
        """Number of states: coordinates and directions of rope and slings with their rates, and the work done."""
        return 2 * (self.coordinates + self.axes * len(self.load.bodies)) + 1

    @cached_property
    def angular_frequencies(self) -> Floats:
        """Of each coordinate's mode by itself [rad/s], zero for an angle; shape (coordinates,)."""
        crane, counts = self.crane, self.counts
        tower = np.asarray(crane.tower.angular_frequencies)
        bases = crane.lateral, crane.counter_lateral, crane.vertical, crane.counter_vertical
        return np.concatenate([
            tower,
            tower[: counts["tower_y"]],
            crane.torsion.angular_frequencies,
            np.zeros(counts["slewing"]),
            *(basis.angular_frequencies for basis in bases if basis is not None),
            np.zeros(counts.get("luffing", 0)),
            *(() if crane.tied is None else (crane.tied.column.angular_frequencies, crane.tied.bows)),
        ])  # fmt: skip

    @cached_property
    def added_mass(self) -> Floats:
        """Mass that the cap adds to each coordinate, whose own is 1; shape (coordinates,)."""
        order = np.concatenate([np.arange(count) for count in self.counts.values()])
        return added_mass(self.angular_frequencies, order, self.cap)

"""Where a flexible crane is at an instant and how it moves.

Vectors are along the axes of the coordinates, which in a plane are not the fixed ones: `Kinematics.from_plane`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.tower.equations.actions.ground import Ground, ground_of
from towercrane.cranes.tower.equations.actions.wind import winds_of
from towercrane.cranes.tower.equations.body import Carried, carried
from towercrane.cranes.tower.equations.constants import ROPE, SLEWING, TURN
from towercrane.cranes.tower.equations.head import Head, head_of
from towercrane.cranes.tower.equations.jib import Path, Section, Trolley, path_of, trolley_of
from towercrane.cranes.tower.equations.motion import GUARDS
from towercrane.kernels.algebra import Row, Vector, dot
from towercrane.kernels.choices import choose
from towercrane.kernels.load import Momentary
from towercrane.kernels.payload import State, state_of

if TYPE_CHECKING:
    from towercrane.cranes.tower.outputs.seen import Seen
    from towercrane.kernels.load import Load
    from towercrane.simulation.observed import Instant

Pair = tuple[Any, Any]


@dataclass(frozen=True, eq=False)
class Kinematics:
    """A state as positions and velocities: numbers, arrays with an entry for each of many instants, or operands.

    Parameters
    ----------
    seen : Seen
    instant : Instant
        Of which slopes, and guards but those of joints, do not matter here.
    """

    seen: Seen
    instant: Instant

    def parts(self, values: Any) -> State:
        """Parts of a state or of its slopes."""
        return state_of(values, self.seen.crane.coordinates, self.seen.crane.axes)

    @cached_property
    def state(self) -> State:
        """Parts of the state."""
        return self.parts(self.instant.state)

    @cached_property
    def head(self) -> Head:
        """Orientation and motion of the head."""
        return head_of(self.seen.crane, self.state, self.instant.drives)[0]

    @cached_property
    def trolley(self) -> Trolley:
        """The trolley along the jib; at a joint the guards know on which section."""
        crane, known = self.seen.crane, self.instant.guards[GUARDS : GUARDS + 3]
        return trolley_of(crane, self.instant.drives, Section(*known) if crane.jointed and len(known) else None)

    @cached_property
    def paths(self) -> tuple[Path, Path]:
        """Bending of the jib at the trolley, to the left and up."""
        crane = self.seen.crane
        left, up = (path_of(crane, modes, self.trolley, self.state) for modes in (crane.lateral, crane.vertical))
        return left, up

    def carry(self, head: Head) -> Carried:
        """Motion of the trolley on the jib of a head that moves so, in its axes."""
        return carried(head, self.trolley, *self.paths)

    @cached_property
    def end(self) -> Carried:
        """That of the trolley, in the head's axes."""
        return self.carry(self.head)

    def top(self, values: Row) -> list[Any]:
        """What coordinates, or derivatives of them, are of the tower's top: u_x, u_y, th_x, th_y, and the turn."""
        crane = self.seen.crane
        return [dot(row[: crane.movers], values[: crane.movers]) for row in crane.motions]

    @cached_property
    def placed(self) -> list[Any]:
        """Those of the coordinates."""
        return self.top(self.state.coordinates)

    @cached_property
    def twist(self) -> Any:
        """Twist of the tower's top [rad]."""
        at = self.seen.crane.part("torsion")
        return dot([self.seen.crane.motions[TURN][i] for i in at], [self.state.coordinates[i] for i in at])

    @cached_property
    def slewing(self) -> Pair:
        """Slewing angle of the head on the tower's top and its rate; a head that is fixed stands at its heading."""
        crane = self.seen.crane
        if crane.slewing in ("driven", "free"):
            (at,) = crane.part("slewing")
            return self.state.coordinates[at], self.state.rates[at]
        if crane.slewing == "prescribed":
            angle, rate, _ = self.instant.drives[SLEWING]
            return angle, rate
        return self.seen.heading, 0.0

    @cached_property
    def turned(self) -> Pair:
        """Cosine and sine of the angle from the axes of the coordinates to the jib's root."""
        crane = self.seen.crane
        if not crane.turns:
            return 1.0, 0.0
        turn = self.placed[TURN]
        if crane.slewing == "prescribed":
            turn = turn + self.slewing[0]
        return np.cos(turn), np.sin(turn)

    def by_jib(self, x: Any, y: Any) -> Pair:
        """Horizontal components along the jib's root and to its left."""
        c, s = self.turned
        return x * c + y * s, y * c - x * s

    def from_plane(self, x: Any, y: Any) -> Pair:
        """Horizontal components along the fixed axes, of those along the axes of the coordinates."""
        c, s = self.seen.crane.plane_cosine, self.seen.crane.plane_sine
        return x * c - y * s, y * c + x * s

    def of_jib(self, values: Row) -> tuple[Row, Row]:
        """Coordinates of the jib, or derivatives of them, to the left and up."""
        middle = self.seen.crane.vertical.start
        return values[self.seen.crane.movers : middle], values[middle : self.seen.crane.vertical.stop]

    def deflection(self, shapes: Row, values: Row) -> Pair:
        """Sums of the jib's shapes with coordinates or their derivatives, to the left and up."""
        left, up = self.of_jib(values)
        return dot(left, shapes[: len(left)]), dot(up, shapes[len(left) :])

    @cached_property
    def trolley_in_space(self) -> tuple[Vector, Vector]:
        """Position of the trolley from the undeformed tower top, and its velocity."""
        u_x, u_y, *_ = self.placed
        x, y, z = self.head.to_fixed(self.end.place)
        return (u_x + x, u_y + y, z), self.head.to_fixed(self.end.velocity)

    @cached_property
    def rope(self) -> Vector:
        """Direction of the rope; of one that stretches, the vector along it."""
        return self._from_upper_end(self.state.direction, 0)

    @cached_property
    def rope_reach(self) -> Any:
        """Length of that vector."""
        return np.sqrt(dot(self.rope, self.rope))

    @cached_property
    def stretch(self) -> Any:
        """How much further that is than the rope is long; nothing where nothing hangs."""
        found = self.rope_reach - self.below[0]
        return choose(self.load.hangs, found, 0.0) if isinstance(self.load, Momentary) else found

    @cached_property
    def swing(self) -> Vector:
        """Its rate."""
        return self._from_upper_end(self.state.swing, 1)

    @cached_property
    def load(self) -> Load | Momentary:
        """The load as it is then."""
        crane = self.seen.crane
        return crane.load.now(self.instant.drives[crane.release])

    def _from_upper_end(self, own: Row, order: int) -> Vector:
        x, y, z = in_space(own)
        if self.seen.crane.load.elasticity is None:
            return x, y, z
        u, v, w = self.trolley_in_space[order]
        return x - u, y - v, z - w

    @cached_property
    def below(self) -> Pair:
        """Length of the rope to the load and its rate."""
        length, hauling, _ = self.instant.drives[ROPE]
        return length, hauling

    @cached_property
    def hung(self) -> list[tuple[Any, tuple[Vector, Vector]]]:
        """Mass of each body that hangs, from above, its position from the undeformed tower top, and its velocity."""
        load, moving = self.load, self.on_rope
        found = [(load.bodies[0].mass, moving)]
        for sling, own, (direction, swing) in zip(load.slings, load.bodies[1:], self.state.links(), strict=True):
            place, velocity = (
                tuple(at + sling.length * n for at, n in zip(above, in_space(link), strict=True))
                for above, link in zip(moving, (direction, swing), strict=True)
            )
            moving = place, velocity
            found.append((own.mass, moving))
        return found

    @cached_property
    def load_in_space(self) -> tuple[Vector, Vector]:
        """Position of the load from the undeformed tower top, and its velocity."""
        return self.hung[-1][1]

    @cached_property
    def sling(self) -> Vector:
        """Direction of the sling that carries the load."""
        return in_space(self.state.links()[-1][0])

    @cached_property
    def on_rope(self) -> tuple[Vector, Vector]:
        """Position of what hangs on the rope from the undeformed tower top, and its velocity."""
        if self.seen.crane.load.elasticity is not None:
            return in_space(self.state.direction), in_space(self.state.swing)
        (place, velocity), (length, hauling) = self.trolley_in_space, self.below
        x, y, z = (own + length * n for own, n in zip(place, self.rope, strict=True))
        u, v, w = (own + hauling * n + length * p for own, n, p in zip(velocity, self.rope, self.swing, strict=True))
        return (x, y, z), (u, v, w)

    @cached_property
    def ground(self) -> Ground:
        """Motion of the ground."""
        return ground_of(self.seen.crane, self.instant.drives)

    @cached_property
    def winds(self) -> list[Vector]:
        """Velocity of the air at each place that sees a wind of its own, the load's the last."""
        return winds_of(self.seen.crane, self.instant.drives)


def in_space(vector: Row) -> Vector:
    """A vector in space, of one in space or in the vertical plane."""
    return vector[0], vector[1] if len(vector) == 3 else 0.0, vector[-1]

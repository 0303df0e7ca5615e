"""What holds a flexible crane: the ground under its tower's foot, and collars that tie the tower to a building.

The ground takes what the acceleration of every mass, the weights and the wind leave over, less what the collars take.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from towercrane.cranes.parts.base import Reaction, added
from towercrane.cranes.tower.equations.actions.collars import meet
from towercrane.cranes.tower.equations.actions.ground import floors_of
from towercrane.cranes.tower.modes.collars import MOST_COLLARS
from towercrane.kernels.algebra import Vector, cross, dot, form
from towercrane.simulation.observed import About

if TYPE_CHECKING:
    from collections.abc import Callable

    from towercrane.cranes.tower.outputs.cut_sums import TowerCut
    from towercrane.cranes.tower.outputs.kinematics import Kinematics
    from towercrane.cranes.tower.outputs.sections import Sections


class Tied(NamedTuple):
    """What a collar takes, along the axes of the coordinates: where it is, force, moment."""

    place: Vector
    force: Vector
    moment: Vector


@dataclass(frozen=True, eq=False)
class Support:
    """What the crane does to what holds it.

    Parameters
    ----------
    at : Kinematics
        With the slopes and guards of its instant.
    sections : Sections
        Of the same instant.
    """

    at: Kinematics
    sections: Sections

    @cached_property
    def tied(self) -> list[Tied]:
        """What each collar takes, the lowest first."""
        crane, seen, q = self.at.seen.crane, self.at.seen, self.at.state.coordinates
        q_x, q_y, q_c = ([q[i] for i in crane.part(kind)] for kind in ("tower_x", "tower_y", "torsion"))
        floors: list[Any] = floors_of(crane, self.at.instant.drives) or [(0.0, 0.0)] * len(seen.collar_heights)
        numbers = () if crane.play is None else crane.play.numbers
        met = dict(zip(numbers, meet(crane, q, self.at.instant.drives), strict=True))
        found = []
        for k, (height, floor) in enumerate(zip(seen.collar_heights, floors, strict=True)):
            stiffness, rotating, twisting = seen.collar_springs[k]
            x, y = (dot(seen.collar_bends[k], own) for own in (q_x, q_y))
            force = stiffness * (x - floor[0]), stiffness * (y - floor[1]), 0.0
            if k in met:
                force = *met[k].force, 0.0
            turned_x, turned_y = -dot(seen.collar_turns[k], q_y), dot(seen.collar_turns[k], q_x)
            moment = rotating * turned_x, rotating * turned_y, twisting * dot(seen.collar_twists[k], q_c)
            found.append(Tied((x, y, height), force, moment))
        return found

    def collar(self, number: int) -> Reaction:
        """What the crane does to a collar, counted from 0 and the lowest."""
        _, force, moment = self.tied[number]
        return self._fixed(force, moment)

    @cached_property
    def base(self) -> Reaction:
        """What the crane does to the ground, the moment about the place of its undeformed foot."""
        force, upright, leaning = self._foot
        return self._fixed(force, added(upright, leaning))

    @cached_property
    def upright(self) -> Reaction:
        """The same of a tower that bears its loads where it stands undeformed."""
        force, upright, _ = self._foot
        return self._fixed(force, upright)

    @cached_property
    def _foot(self) -> tuple[Vector, Vector, Vector]:
        return self.loads(self.at.seen.foot)

    def section(self, cut: TowerCut) -> Reaction:
        """What is above a section of the tower does to it, the moment about where the deflected tower has it."""
        force, upright, leaning = self.loads(cut)
        crane, q = self.at.seen.crane, self.at.state.coordinates
        x, y = (dot(cut.bends, [q[i] for i in crane.part(kind)]) for kind in ("tower_x", "tower_y"))
        moment = less(added(upright, leaning), cross((x, y, cut.height), force))
        return self._fixed(force, moment)

    def loads(self, cut: TowerCut) -> tuple[Vector, Vector, Vector]:
        """Force on a section by what is above, its moment about the foot, what the tower's deflection adds to it.

        They are along the axes of the coordinates.
        """
        at, seen, crane, top = self.at, self.at.seen, self.at.seen.crane, self.sections.tower_top
        head, qdd = self.sections.head, self.sections.accelerations
        force, moment = head.to_fixed(top.force), head.to_fixed(top.moment)
        u_x, u_y, *_ = at.placed
        moment = added(moment, cross((0.0, 0.0, seen.tower_height), force))
        count, bent = len(crane.part("tower_x")), crane.part("torsion").start
        (q_x, q_y), (a_x, a_y) = ((values[:count], values[count:bent]) for values in (at.state.coordinates, qdd))
        shaken_x, shaken_y, shaken_z = at.ground.acceleration
        falls = crane.self_gravity + shaken_z

        # Along an axis that the tower does not bend to there are no coordinates. Its mass moves sideways alone.
        s_x, s_y = dot(q_x, cut.zeroth), dot(q_y, cut.zeroth)
        inertia = (
            -dot(a_x, cut.zeroth) - cut.mass * shaken_x,
            -dot(a_y, cut.zeroth) - cut.mass * shaken_y,
            -cut.mass * falls,
        )
        tipping = (
            dot(a_y, cut.first) + cut.moment * shaken_y,
            -dot(a_x, cut.first) - cut.moment * shaken_x,
            -dot(qdd[bent : bent + len(cut.torsion)], cut.torsion),
        )
        turn = s_y * shaken_x - s_x * shaken_y
        if len(q_y):
            turn = turn - form(q_x, cut.products, a_y) + form(q_y, cut.products, a_x)
        leaning = added(cross((u_x, u_y, 0.0), force), (-falls * s_y, falls * s_x, turn))
        force, moment = added(force, inertia), added(moment, tipping)
        for part in cut.exposed:
            wind = at.winds[part.node]
            speed = np.sqrt(dot(wind, wind))
            press = tuple(speed * own for own in wind)
            force = added(force, tuple(part.area * own for own in press))
            moment = added(moment, cross((0.0, 0.0, part.moment), press))
            leaning = added(leaning, cross((dot(q_x, part.swept), dot(q_y, part.swept), 0.0), press))
        for (x, y, z), held, couple in self.tied[cut.collars :]:
            # The collars take their part.
            force, moment = less(force, held), less(less(moment, couple), cross((0.0, 0.0, z), held))
            leaning = less(leaning, cross((x, y, 0.0), held))
        return force, moment, leaning

    def _fixed(self, force: Vector, moment: Vector) -> Reaction:
        """Along the fixed axes, of what is along the axes of the coordinates."""
        along, about = (self.at.from_plane(*vector[:2]) for vector in (force, moment))
        return Reaction((*along, force[2]), (*about, moment[2]))


def collar_outputs() -> dict[str, tuple[Callable[[Any], Any], About]]:
    """Those of collars, the lowest the first."""
    parts = {
        "force_x": ("force", 0, "N", "force of the tower on collar {} along x"),
        "force_y": ("force", 1, "N", "force of the tower on collar {} along y"),
        "moment_x": ("moment", 0, "N m", "moment of the tower on collar {} about x"),
        "moment_y": ("moment", 1, "N m", "moment of the tower on collar {} about y"),
        "torque": ("moment", 2, "N m", "moment of the tower on collar {} about the vertical"),
    }

    def read(number: int, load: str, axis: int) -> Callable[[Any], Any]:
        return lambda at: getattr(at.support.collar(number), load)[axis]

    return {
        f"collar_{k + 1}_{name}": (read(k, load, axis), About(units, said.format(k + 1)))
        for k in range(MOST_COLLARS)
        for name, (load, axis, units, said) in parts.items()
    }


def less(one: Vector, other: Vector) -> Vector:
    """Difference of two vectors."""
    return one[0] - other[0], one[1] - other[1], one[2] - other[2]

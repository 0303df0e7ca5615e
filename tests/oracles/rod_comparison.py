"""Flexible crane and exact rods in the same manoeuvre: where trolley, load and tower top differ, and why.

``PYTHONPATH=tests python -m oracles.rod_comparison`` prints the largest differences over 45 s of a manoeuvre.
"""

import dataclasses
from functools import cached_property

import numpy as np
from numpy.polynomial.legendre import leggauss
from oracles import exact_rods
from samples import space_crane as space

from towercrane.cranes.tower.modes.mass_sums import rigid_sums
from towercrane.motions.motion import phases
from towercrane.motions.profiles import speed_trapezoid, table, trapezoid
from towercrane.simulation.integrate import integrate

LOAD = 1500.0
ROLL = 620.0
"""Of the jib about its axis [kg m^2], a radius of gyration of 0.3 m: the rods need some, so both cranes have it."""

BRISK = {
    "slewing": speed_trapezoid(0.0, 0.08, 3.0, 4.0),
    "trolley": trapezoid(36.0, 42.0, 0.8, 0.4),
    "rope": trapezoid(15.0, 12.0, 0.4, 0.2),
}
"""Ten seconds in which everything moves."""


def stiffer(factor):
    """The crane in space with all its stiffness multiplied."""
    crane = space.CRANE
    members = {
        name: dataclasses.replace(beam, youngs_modulus=factor * beam.youngs_modulus)
        for name, beam in (("tower", crane.tower), ("jib", crane.jib), ("jib_lateral", crane.jib_lateral))
    }
    shaft = dataclasses.replace(crane.shaft, torsional_stiffness=factor * crane.shaft.torsional_stiffness)
    return dataclasses.replace(crane, **members, shaft=shaft, roll_inertia=ROLL)


def shortening(crane, motion, reach):
    """By how much the bent jib draws in what is ``reach`` (times,) along it: the integral of slope^2 / 2."""
    total = np.zeros_like(reach)
    for point, weight in zip(*leggauss(16), strict=True):
        shapes = crane.jib_shapes(0.5 * reach * (1.0 + point), 1)
        left, up = motion.deflection(shapes, motion.state.coordinates)
        total += 0.25 * weight * reach * (left**2 + up**2)
    return total


@dataclasses.dataclass(frozen=True)
class Comparison:
    """The crane with its stiffness multiplied, as exact rods and in modes, from equilibrium at heading 0."""

    factor: float
    motions: dict
    duration: float

    @cached_property
    def crane(self):
        return stiffer(self.factor)

    @cached_property
    def exact(self):
        """Times, and places of tower top, trolley and load."""
        return exact_rods.course(exact_rods.crane_rods(self.crane, LOAD), self.motions, self.duration)

    def scene(self, **options):
        return space.model(3, 2, 6, 6, LOAD, crane=self.crane, **options)

    def course(self, motions, change=None, **options):
        """Motion of the flexible crane; ``change`` adds to the sums over the mass of what is rigid on the head."""
        scene = self.scene(**options)
        if change is not None:
            crane = dataclasses.replace(scene.crane, counter=scene.crane.counter + change)
            scene = dataclasses.replace(scene, crane=crane)
        cut = phases(tuple(motions[c] for c in scene.channels), self.duration)
        run = integrate(scene.system, cut, space.start(scene, motions), self.exact[0], rtol=1e-9, atol=1e-11)
        assert run.outcome == "finished"
        return space.kinematics(scene, motions, run.times, run.states)

    @cached_property
    def plain(self):
        return self.course(self.motions)

    @property
    def softened(self):
        """With the tower softened by the weight on it."""
        return self.course(self.motions, weight_softening=True)

    def drawn_in(self, jib=False, **options):
        """With the trolley where the shortening of the jib takes it; with the jib's mass so, as it is on average."""
        motion, change, bent, (times, _) = self.plain, None, self.scene().crane, self.exact
        way = table(times, motion.trolley.x - shortening(bent, motion, motion.trolley.x))
        if jib:
            points, weights = leggauss(12)
            reach = 0.5 * self.crane.jib.length * (1.0 + points)
            inwards = [shortening(bent, motion, np.full(len(times), x)).mean() for x in reach] * weights
            moved = 0.5 * self.crane.jib.mass * inwards
            change = rigid_sums(0.0, -moved.sum(), -2.0 * float(moved @ reach), 12)
        return self.course(self.motions | {"trolley": way}, change, **options)

    def gaps(self, motion):
        """Flexible crane less rods: of tower top, trolley, load; radial, lateral, vertical; (3, times, 3).

        As seen from a jib that points where it is commanded to.
        """
        u_x, u_y, *_ = motion.top(motion.state.coordinates)
        places = (u_x, u_y, 0.0 * u_x), motion.trolley_in_space[0], motion.load_in_space[0]
        gaps = np.moveaxis(places, 1, -1) - self.exact[1]
        heading = self.motions["slewing"](self.exact[0])
        c, s = np.cos(heading), np.sin(heading)
        x, y, z = np.moveaxis(gaps, -1, 0)
        return np.stack([c * x + s * y, c * y - s * x, z], axis=-1)


def print_table():
    print("| Largest difference, radial / lateral / vertical [mm] | trolley | load | tower top |")
    for factor in (1.0, 4.0):
        pair = Comparison(factor, space.manoeuvre(), 45.0)
        ways = {
            "as it is": pair.plain,
            "weight softening": pair.softened,
            "trolley drawn in": pair.drawn_in(),
            "trolley and jib drawn in": pair.drawn_in(jib=True),
        }
        for way, motion in ways.items():
            largest = 1e3 * abs(pair.gaps(motion)).max(axis=1)
            cells = [" / ".join(f"{value:.1f}" for value in largest[i]) for i in (1, 2, 0)]
            print(f"| stiffness x {factor:g}, {way} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    print_table()

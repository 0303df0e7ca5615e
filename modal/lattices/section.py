"""Section of a lattice as a beam: chords at points, walls between them, one law of stiffness and mass."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import hypot
from typing import TYPE_CHECKING, Literal

import numpy as np

from modal.checks import check_fields, check_positive

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from modal.lattices.walls import Chord, Wall

    Floats = NDArray[np.float64]

Plane = Literal["vertical", "lateral"]

AXIAL, SHEAR_Y, SHEAR_Z, TWIST, CURVATURE_Y, CURVATURE_Z = range(6)
"""Strains of a section, in this order: u', v' - tz, w' + ty, ph', ty', tz'."""

LEFT_OVER = 1e-9
"""Relative; what couples less than this is rounding."""


@dataclass(frozen=True, eq=False)
class LatticeSection:
    """Section of a lattice: what strains it, and what it weighs.

    Displacements of a point of it are ``u = u0 + z ty - y tz, v = v0 - z ph, w = w0 + y ph``, from those of the
    reference line. A section of three chords cannot warp, and the law is complete; one of more warps freely, and what
    it costs to hold that, at a foot, is left out.

    Parameters
    ----------
    chords : tuple of Chord
    walls : tuple of Wall
    youngs_modulus : float
        [Pa]
    density : float
        Of the members [kg/m^3].

    Raises
    ------
    ValueError
        If a wall is between chords that do not exist or coincide, or the walls leave the section without stiffness.
    """

    chords: tuple[Chord, ...]
    walls: tuple[Wall, ...]
    youngs_modulus: float
    density: float

    def __post_init__(self) -> None:
        check_fields(self, positive=("youngs_modulus",), not_negative=("density",))
        for wall in self.walls:
            ends = {wall.first, wall.second}
            if len(ends) < 2 or not ends <= set(range(len(self.chords))):
                raise ValueError(
                    f"LatticeSection.walls: wanted two of chords 0 to {len(self.chords) - 1}, got {wall!r}"
                )
            check_positive("LatticeSection.walls: distance of the chords", self.depth(wall))

    def depth(self, wall: Wall) -> float:
        """Distance of the chords of a wall [m]."""
        first, second = self.chords[wall.first], self.chords[wall.second]
        return hypot(second.y - first.y, second.z - first.z)

    @cached_property
    def flexibility(self) -> Floats:
        """The six strains by axial force, shear forces, torque and moments, symmetric, shape (6, 6).

        Chords lie along their slopes. Parallel diagonals are strained by the chords' mean strain as by
        ``panel / depth`` times it of shear. Crossed ones are worth a chord at the middle of their wall. What steps of
        zigzags cost counts in torsion; in bending the ends of a lattice decide what it is.
        """
        smooth, stepped = self._inverse(self._smooth_walls), self._inverse(self._smooth_walls + self._steps)
        return smooth - _of_twist(smooth) + _of_twist(stepped)

    def _inverse(self, walls: Floats) -> Floats:
        """Strains by forces with shear strains of the walls by their forces."""
        found, rows = np.zeros((6, 6)), np.zeros((len(self.walls), 6))
        for chord in self.chords:
            strain = chord.strain()
            found += self.youngs_modulus * chord.area / chord.stretch**3 * np.outer(strain, strain)
        for row, wall in zip(rows, self.walls, strict=True):
            first, second, depth = self.chords[wall.first], self.chords[wall.second], self.depth(wall)
            t_y, t_z = (second.y - first.y) / depth, (second.z - first.z) / depth
            mean = 0.5 * (first.strain() + second.strain())
            row[[SHEAR_Y, SHEAR_Z, TWIST]] = t_y, t_z, first.y * t_z - first.z * t_y
            if wall.lacing == "N":
                row += wall.panel / depth * mean
            found += self.youngs_modulus * wall.chord_area(depth) * np.outer(mean, mean)
        shear = np.linalg.inv(walls)
        if len(self.chords) > 3:
            # Chords slide along each other, out of plane, until that strains the walls least.
            warping = self._warping
            shear -= shear @ warping @ np.linalg.solve(warping.T @ shear @ warping, warping.T @ shear)
        found += rows.T @ shear @ rows
        size = np.sqrt(np.diag(found))
        scaled = found / np.outer(size, size)
        if not np.linalg.eigvalsh(scaled)[0] > LEFT_OVER:
            raise ValueError("LatticeSection.walls: wanted walls that hold the chords, got too few")
        return np.asarray(np.linalg.inv(scaled) / np.outer(size, size))

    @property
    def _warping(self) -> Floats:
        """Shear strains of the walls where chords slide out of any plane, shape (walls, chords - 3)."""
        planes = np.array([(1.0, chord.y, chord.z) for chord in self.chords])
        moved = np.linalg.svd(planes)[0][:, 3:]
        ends = [moved[wall.second] - moved[wall.first] for wall in self.walls]
        return np.asarray(np.array(ends) / np.array([self.depth(wall) for wall in self.walls])[:, np.newaxis])

    @property
    def _smooth_walls(self) -> Floats:
        """Shear strains of the walls by their shear forces [1/N], as if chord forces changed evenly."""
        depths = [self.depth(wall) for wall in self.walls]
        return np.diag(
            [
                wall.shear_flexibility(depth, self.youngs_modulus)
                for wall, depth in zip(self.walls, depths, strict=True)
            ]
        )

    @property
    def _steps(self) -> Floats:
        """What steps of the chord forces add to them, symmetric, shape (walls, walls).

        Where a zigzag meets a chord its force steps, by what the whole of two diagonals brings, and is constant up to
        the next node. The energy of the steps beyond that of the straight line between is one of shear: it is found
        over two panels of the longest zigzag, whose far end is free. Steps of two walls on a chord may cancel.
        """
        found = np.zeros((len(self.walls), len(self.walls)))
        zigzags = [(k, wall) for k, wall in enumerate(self.walls) if wall.lacing == "zigzag"]
        if not zigzags:
            return found
        panels = [wall.panel for _, wall in zigzags]
        span, step = 2.0 * max(panels), min(panels)
        middles = step * (np.arange(round(span / step)) + 0.5)
        for c, chord in enumerate(self.chords):
            lines, steps = np.zeros(len(self.walls)), np.zeros((len(self.walls), middles.size))
            for k, wall in zigzags:
                if c in (wall.first, wall.second):
                    lines[k] = (1.0 if c == wall.first else -1.0) / self.depth(wall)
                    # Nodes at all even panels of the zigzag or at all odd; that at the free end has one diagonal.
                    beyond = (span - middles) / (2.0 * wall.panel)
                    count = np.floor(beyond) + 0.5 if c == wall.first else np.round(beyond)
                    steps[k] = lines[k] * 2.0 * wall.panel * count
            more = steps @ steps.T / middles.size - np.outer(lines, lines) * span**2 / 3.0
            found += more / (self.youngs_modulus * chord.area)
        return found

    @property
    def masses(self) -> tuple[Floats, Floats]:
        """Points (y, z) of the section [m] and their masses per length [kg/m], shapes (n, 2) and (n,).

        Lacing has a sixth of its mass at either chord and four at mid wall, which keeps its moments.
        """
        places = [(chord.y, chord.z) for chord in self.chords]
        points = list(places)
        masses = [self.density * chord.area * chord.stretch + chord.further_mass for chord in self.chords]
        for wall in self.walls:
            mass = self.density * wall.volume(self.depth(wall))
            for c in (wall.first, wall.second):
                masses[c] += mass / 6.0
            points.append(tuple(np.mean([places[wall.first], places[wall.second]], axis=0)))
            masses.append(4.0 * mass / 6.0)
        return np.array(points), np.array(masses)

    @property
    def mass_matrix(self) -> Floats:
        """Mass per length for the motions of a section, u, v, w, ph, ty, tz, symmetric, shape (6, 6)."""
        found = np.zeros((6, 6))
        for (y, z), mass in zip(*self.masses, strict=True):
            moved = np.array([[1, 0, 0, 0, z, -y], [0, 1, 0, -z, 0, 0], [0, 0, 1, y, 0, 0]], dtype=float)
            found += mass * moved.T @ moved
        return found

    @property
    def mass_per_length(self) -> float:
        """Mass per length [kg/m]."""
        return float(self.masses[1].sum())

    @property
    def mass_centre(self) -> float:
        """Height of the centre of mass above the reference line, z_m [m]."""
        points, masses = self.masses
        return float(masses @ points[:, 1] / masses.sum()) if masses.any() else 0.0

    @property
    def rotary_inertias(self) -> tuple[float, float, float]:
        """Moments of inertia per length about the centre of mass [kg m]: in bending up, to the side, and polar."""
        points, masses = self.masses
        vertical = float(masses @ (points[:, 1] - self.mass_centre) ** 2)
        lateral = float(masses @ points[:, 0] ** 2)
        return vertical, lateral, vertical + lateral

    @property
    def torsional_stiffness(self) -> float:
        """Torque per twist per length, GJ [N m^2]."""
        return 1.0 / float(self.flexibility[TWIST, TWIST])

    @property
    def shear_centre(self) -> float:
        """Height above the reference line at which a lateral force does not twist, e [m]."""
        flexibility = self.flexibility
        return float(flexibility[SHEAR_Y, TWIST] / flexibility[TWIST, TWIST])

    @property
    def axial_stiffness(self) -> float:
        """Axial force per strain without bending, EA [N]."""
        flexibility = self.flexibility
        bending = flexibility[4:, AXIAL] @ np.linalg.solve(flexibility[4:, 4:], flexibility[4:, AXIAL])
        return 1.0 / float(flexibility[AXIAL, AXIAL] - bending)

    def bending(self, plane: Plane) -> tuple[float, float, float]:
        """Bending stiffness [N m^2], shear stiffness [N] and what couples the two [1/m], in a plane.

        With the slope th, the shear strain gam = w' - th, the moment M and the force V = -M' the coupling g has
        ``M = EI (th' - g gam)`` and ``S gam = V + g M``. Chords whose distance h changes carry ``V = -M h'/h``
        without the walls, g = h'/h; parallel diagonals are strained by the chords. Lateral forces go through the
        shear centre.
        """
        flexibility = self.flexibility
        if plane == "vertical":
            # ty is minus the slope.
            strains, signs = [SHEAR_Z, CURVATURE_Y], np.array([1.0, -1.0])
        else:
            strains, signs = [SHEAR_Y, CURVATURE_Z], np.ones(2)
            flexibility = flexibility - _of_twist(flexibility)
        (shear, both), (_, turn) = (flexibility[np.ix_(strains, strains)] * np.outer(signs, signs)).tolist()
        coupling = both / shear
        if both**2 < LEFT_OVER**2 * shear * turn:
            coupling = 0.0
        return 1.0 / (turn - coupling * both), 1.0 / shear, coupling


def _of_twist(flexibility: Floats) -> Floats:
    """Part of a flexibility that goes with twist; what is left is that of a section that does not twist."""
    twist = flexibility[:, TWIST]
    return np.asarray(np.outer(twist, twist) / twist[TWIST])

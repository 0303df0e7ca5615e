"""Lattice of a jib: members of three or four chords as sections, as pieces and as segments of a chain."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import ceil, log, sqrt
from typing import Literal, get_args

from modal.beams.segment import Segment
from modal.checks import check_fields, check_positive, number_in
from modal.lattices.lattice_taper import STEP, tapered
from modal.lattices.section import LEFT_OVER, LatticeSection, Plane
from modal.lattices.walls import Chord, Lacing, Wall

Shape = Literal["triangle", "rectangle"]
Side = Literal["up", "down"]


@dataclass(frozen=True, slots=True)
class BeamPiece:
    """Uniform piece of a lattice as a beam; heights count from the rail, the middle line of the two base chords.

    Parameters
    ----------
    length : float
        Length [m].
    mass_per_length : float
        [kg/m]
    bending_vertical, bending_lateral : float
        Bending stiffnesses for deflections up and to the side [N m^2].
    shear_vertical, shear_lateral : float
        Shear stiffnesses [N].
    coupling_vertical, coupling_lateral : float
        Of bending and shear [1/m], see `LatticeSection.bending`; of a tapering height h, h'/h.
    torsional_stiffness : float
        GJ [N m^2].
    shear_centre, mass_centre : float
        Heights of shear centre and centre of mass above the rail, e and z_m [m].
    rotary_vertical, rotary_lateral, polar_inertia : float
        Moments of inertia per length about the centre of mass [kg m]: in bending up and to the side, and in torsion.
    axial_stiffness : float
        EA [N].
    """

    length: float
    mass_per_length: float
    bending_vertical: float
    bending_lateral: float
    shear_vertical: float
    shear_lateral: float
    coupling_vertical: float
    coupling_lateral: float
    torsional_stiffness: float
    shear_centre: float
    mass_centre: float
    rotary_vertical: float
    rotary_lateral: float
    polar_inertia: float
    axial_stiffness: float


@dataclass(frozen=True, slots=True)
class JibLattice:
    """Members of a lattice jib between two stations: two base chords side by side and one or two opposite.

    Parameters
    ----------
    height : float
        Distance of the opposite chords from the plane of the base chords, at the near end [m].
    breadth : float
        Distance of the base chords [m]; the trolley runs on their middle line.
    base_chord_area, opposite_chord_area : float
        Cross-sectional area of one chord [m^2].
    panel_length : float
        Distance between nodes of a base chord [m]. A zigzag side of a triangle has its other node at mid panel; all
        other diagonals span a panel.
    side_diagonal_area, base_diagonal_area : float
        Cross-sectional areas of one diagonal of a side wall and of the wall between the base chords [m^2].
    youngs_modulus : float
        [Pa]
    side_lacing, base_lacing : {"zigzag", "X", "N"}
        See `modal.lattices.walls.Wall`. Parallel diagonals of the sides lead outward away from the base, those of
        the base and opposite walls to the left.
    side_post_area, base_post_area : float
        Cross-sectional areas of one post [m^2]; 0: there are none.
    shape : {"triangle", "rectangle"}
        One opposite chord in the middle, or two as far apart as the base chords.
    side : {"up", "down"}
        Where the opposite chords are.
    end_height : float, optional
        Height at the far end [m]; without one, that of the near end.
    opposite_lacing, opposite_diagonal_area, opposite_post_area : optional
        Of the wall between two opposite chords; as the base's without them.
    density : float
        Density of the members [kg/m^3].
    further_mass_per_length : float
        Mass that the base chords bear besides: rails, walkways [kg/m].

    Raises
    ------
    ValueError
        If a value is out of range, or N lacing comes without posts.

    Notes
    -----
    Parallel diagonals of the base or opposite walls make a jib that bends down bend to the side as well: a section
    and a beam in space have that, segments in one plane have not (equilateral, all walls of parallel diagonals, 12 m:
    2 % of the first frequency up, 5 % aside). A rectangle twists as its section says where diaphragms keep its shape.
    """

    height: float
    breadth: float
    base_chord_area: float
    opposite_chord_area: float
    panel_length: float
    side_diagonal_area: float
    base_diagonal_area: float
    youngs_modulus: float
    side_lacing: Lacing = "zigzag"
    base_lacing: Lacing = "zigzag"
    side_post_area: float = 0.0
    base_post_area: float = 0.0
    shape: Shape = "triangle"
    side: Side = "up"
    end_height: float | None = None
    opposite_lacing: Lacing | None = None
    opposite_diagonal_area: float | None = None
    opposite_post_area: float | None = None
    density: float = 7850.0
    further_mass_per_length: float = 0.0

    def __post_init__(self) -> None:
        check_fields(
            self,
            positive=(
                "height", "breadth", "base_chord_area", "opposite_chord_area", "panel_length", "side_diagonal_area",
                "base_diagonal_area", "youngs_modulus",
            ),
            not_negative=("side_post_area", "base_post_area", "density", "further_mass_per_length"),
        )  # fmt: skip
        for name, allowed in (
            ("shape", Shape), ("side", Side), ("side_lacing", Lacing), ("base_lacing", Lacing),
            ("opposite_lacing", Lacing),
        ):  # fmt: skip
            value = getattr(self, name)
            if value not in get_args(allowed) and not (name == "opposite_lacing" and value is None):
                raise ValueError(f"JibLattice.{name}: wanted one of {get_args(allowed)}, got {value!r}")
        for name in ("end_height", "opposite_diagonal_area"):
            if getattr(self, name) is not None:
                check_positive(f"JibLattice.{name}", getattr(self, name))
        if self.opposite_post_area is not None:
            number_in("JibLattice.opposite_post_area", self.opposite_post_area, "zero or more", least=0.0)
        if self.shape == "triangle" and self.side_lacing == "zigzag" and self.side_post_area > 0.0:
            raise ValueError(
                "JibLattice.side_post_area: wanted 0 for zigzag sides of a triangle, whose nodes face no other, got "
                f"{self.side_post_area!r}"
            )
        for wall, (lacing, _, posts) in self._lacings.items():
            if lacing == "N" and posts == 0.0:
                raise ValueError(f"JibLattice.{wall}_post_area: N lacing carries shear through its posts, got 0")

    @property
    def far_height(self) -> float:
        """Height at the far end [m]."""
        return self.height if self.end_height is None else self.end_height

    @property
    def _lacings(self) -> dict[str, tuple[Lacing, float, float]]:
        """Lacing, areas of diagonals and of posts of the walls there are, by their names."""
        found = {
            "side": (self.side_lacing, self.side_diagonal_area, self.side_post_area),
            "base": (self.base_lacing, self.base_diagonal_area, self.base_post_area),
        }
        if self.shape == "rectangle":
            lacing, diagonal, posts = self.opposite_lacing, self.opposite_diagonal_area, self.opposite_post_area
            found["opposite"] = (
                lacing or self.base_lacing,
                diagonal if diagonal is not None else self.base_diagonal_area,
                posts if posts is not None else self.base_post_area,
            )
        return found

    @property
    def walls(self) -> tuple[Wall, ...]:
        """Walls between chords as `section` numbers them: right and left base chord, then those opposite.

        Zigzags of a rectangle meet at every chord in the same nodes.
        """
        lacings, p = self._lacings, self.panel_length

        def wall(name: str, first: int, second: int, panel: float = p) -> Wall:
            lacing, *areas = lacings[name]
            return Wall(first, second, lacing, panel, *areas)

        if self.shape == "triangle":
            panel = 0.5 * p if self.side_lacing == "zigzag" else p
            return wall("base", 0, 1), wall("side", 0, 2, panel), wall("side", 1, 2, panel)
        left = (2, 1) if self.side_lacing == "zigzag" else (1, 2)
        across = (2, 3) if lacings["opposite"][0] == "zigzag" else (3, 2)
        return wall("base", 0, 1), wall("side", 0, 3), wall("side", *left), wall("opposite", *across)

    def at(self, part: float, length: float) -> LatticeSection:
        """The section at a part of a length [m] over which the lattice reaches."""
        change = self.far_height - self.height
        return self.section(self.height + part * change, change / length)

    def section(self, height: float, slope: float = 0.0) -> LatticeSection:
        """The section where it has a height [m] that changes by a slope [1]."""
        sign, half = (1.0 if self.side == "up" else -1.0), 0.5 * self.breadth
        base, area = self.base_chord_area, self.opposite_chord_area
        chords = [Chord(y, 0.0, base, further_mass=0.5 * self.further_mass_per_length) for y in (-half, half)]
        places = (0.0,) if self.shape == "triangle" else (half, -half)
        chords += [Chord(y, sign * height, area, slope_z=sign * slope) for y in places]
        return LatticeSection(tuple(chords), self.walls, self.youngs_modulus, self.density)

    def pieces(self, length: float, mass_per_length: float | None = None) -> tuple[BeamPiece, ...]:
        """The lattice over a length [m] as uniform beams, from its near end: one, or several where it tapers.

        Where the height changes, each piece has the section at its middle, and its height changes by 10 % at most. A
        stated mass per length [kg/m] takes the place of the members' own, spread over the section as theirs.

        Raises
        ------
        ValueError
            If the length or the mass is not a positive finite number.
        """
        slope, found = self._slope(length), []
        for (near, far), part in self._parts(length):
            section = self.section(0.5 * (near + far), slope)
            mass = section.mass_per_length
            if mass_per_length is not None:
                mass = check_positive("mass_per_length", mass_per_length)
            vertical, lateral = section.bending("vertical"), section.bending("lateral")
            rotary = [mass / section.mass_per_length * inertia for inertia in section.rotary_inertias]
            found.append(
                BeamPiece(
                    length=part,
                    mass_per_length=mass,
                    bending_vertical=vertical[0],
                    bending_lateral=lateral[0],
                    shear_vertical=vertical[1],
                    shear_lateral=lateral[1],
                    coupling_vertical=vertical[2],
                    coupling_lateral=lateral[2],
                    torsional_stiffness=section.torsional_stiffness,
                    shear_centre=section.shear_centre,
                    mass_centre=section.mass_centre,
                    rotary_vertical=rotary[0],
                    rotary_lateral=rotary[1],
                    polar_inertia=rotary[2],
                    axial_stiffness=section.axial_stiffness,
                )
            )
        return tuple(found)

    def segments(self, length: float, plane: Plane, mass_per_length: float | None = None) -> tuple[Segment, ...]:
        """The lattice over a length [m] as segments of a `modal.beams.chain.Chain`, bending up or to the side.

        Along a segment of changing height the properties go with powers of the height, exact at its ends; up, its
        chords are inclined.

        Raises
        ------
        ValueError
            If the length or the mass is not a positive finite number.
        """
        slope, found = self._slope(length), []
        for (near, far), part in self._parts(length):
            first, last = (self._segment(height, slope, plane, mass_per_length) for height in (near, far))
            found.append(tapered(first, last, part, far / near, inclined=plane == "vertical"))
        return tuple(found)

    def _segment(self, height: float, slope: float, plane: Plane, mass_per_length: float | None) -> Segment:
        """Segment of unit length with the section where the lattice has a height [m]."""
        section = self.section(height, slope)
        bending, shear, coupling = section.bending(plane)
        if plane == "vertical":
            # What inclined chords couple, the segment has of its taper.
            coupling -= slope / height
        if abs(coupling) * sqrt(bending / shear) < LEFT_OVER:
            coupling = 0.0
        mass = section.mass_per_length if mass_per_length is None else mass_per_length
        rotary = section.rotary_inertias[plane == "lateral"] * mass / section.mass_per_length
        return Segment(1.0, mass, bending, shear, rotary, coupling=coupling)

    def _slope(self, length: float) -> float:
        return (self.far_height - self.height) / check_positive("length", length)

    def _parts(self, length: float) -> list[tuple[tuple[float, float], float]]:
        """Heights at the ends and lengths of parts of a length, along each of which the height changes little [m]."""
        near, far = self.height, self.far_height
        count = max(1, ceil(abs(log(far / near)) / STEP))
        heights = [near * (far / near) ** (k / count) for k in range(count + 1)]
        return [
            (ends, length / count if near == far else length * (ends[1] - ends[0]) / (far - near))
            for ends in pairwise(heights)
        ]

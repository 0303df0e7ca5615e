"""Members of tower crane files as beams, chains, lattices and bodies."""

from __future__ import annotations

from dataclasses import replace
from math import inf
from typing import TYPE_CHECKING, Any, Literal

from modal import Beam, Chain, Collar, ColumnTruss, EndBody, Foundation, LacedColumn, Segment
from modal.lattices.jib import JibLattice
from modal.lattices.lattice_taper import column_segments
from towercrane.cranes.tower.modes.luffing_jib import HeadBody, LuffingJib
from towercrane.cranes.tower.modes.parameters import TowerCrane
from towercrane.cranes.tower.modes.tied.bars import CatHead, Tie, TieBars

if TYPE_CHECKING:
    from towercrane.cranes.tower.file.case_tables import TowerCase
    from towercrane.cranes.tower.file.jib_tables import Arm, JibSegment
    from towercrane.cranes.tower.file.jib_tables import JibLattice as JibMembers
    from towercrane.cranes.tower.file.tables import Crane
    from towercrane.cranes.tower.file.tower_tables import BeamChoice, Lattice, Section, Tower, TowerSegment

TAPER_POWERS = {"legs": (0.0, 2.0, 0.0), "wedge": (1.0, 3.0, 1.0), "cone": (2.0, 4.0, 2.0)}
"""Powers of the breadth that mass, bending and shear stiffness go with where these are stated: four legs that draw
together and so carry a part of the shear, whose lacing is taken to stay as stiff; a plate whose depth tapers; a solid
section that tapers both ways."""


def tower_of(crane: Crane) -> Beam | Chain:
    """The tower of a checked crane file, without the slewing part and without weight.

    A uniform tower on rigid ground without shear strain, rotary inertia, bodies and collars is a `Beam`, which has
    closed forms; any other, and one that is written as segments, is a `Chain`.
    """
    tower = crane.tower
    if (uniform := uniform_of(crane)) is not None:
        modulus = tower.youngs_modulus
        assert modulus is not None, "the file is checked to give one"
        return Beam(uniform.length, uniform.mass_per_length, modulus, uniform.bending_stiffness / modulus)
    segments = tuple(segment for piece in tower_pieces(tower) for segment in _segments(tower, piece))
    chain = Chain(segments, foundation=foundation_of(crane), shear_theory=tower.shear_theory)
    block = crane.foundation.block
    bodies = [(body.height, body) for body in tower.bodies] + ([(0.0, block)] if block is not None else [])
    # The sum of the segments may fall short of the stated height by rounding.
    for height, body in bodies:
        chain, node = chain.with_node(min(height, chain.length))
        more = EndBody(body.mass, body.rotary_inertia, body.offset)
        chain = replace(chain, bodies={**chain.bodies, node: joined(chain.bodies.get(node, EndBody()), more)})
    for collar in tower.collars:
        chain, node = chain.with_node(min(collar.height, chain.length))
        if collar.gap:
            # It is no part of a tower that stands free within its play.
            continue
        springs = Collar(collar.stiffness, collar.rotation_stiffness)
        chain = replace(chain, collars={**chain.collars, node: springs})
    return chain


def foundation_of(crane: Crane) -> Foundation:
    """Springs under the foot of the tower."""
    ground = crane.foundation
    return Foundation(ground.rotation_stiffness, ground.translation_stiffness, ground.coupling_stiffness)


def uniform_of(crane: Crane) -> Segment | None:
    """The one segment of a tower that is a `Beam`, see `tower_of`; None for a `Chain`."""
    tower = crane.tower
    ground = foundation_of(crane) != Foundation() or crane.foundation.block is not None
    if tower.segments or tower.bodies or tower.collars or ground:
        return None
    first = _segments(tower, tower_pieces(tower)[0])[0]
    return first if first.shear_stiffness == inf and first.rotary_inertia == 0.0 else None


def beam_choice(tower: Tower, section: Section) -> BeamChoice:
    """Where the beam of a section comes from.

    A stated second moment of area holds, unless the key ``beam`` of a uniform tower asks for its lattice instead.
    """
    if section.second_moment_of_area is None:
        return tower.beam or "shear-flexible"
    return "stated" if tower.segments else tower.beam or "stated"


def laced_column(lattice: Lattice, youngs_modulus: float) -> LacedColumn:
    """Members of a crane file as a laced column."""
    return LacedColumn(**dict(lattice), youngs_modulus=youngs_modulus)


def _segments(tower: Tower, piece: TowerSegment) -> tuple[Segment, ...]:
    """A piece of the tower as segments, its beam stated or that of its lattice."""
    modulus, choice = piece.youngs_modulus or tower.youngs_modulus, beam_choice(tower, piece)
    assert modulus is not None, "the file is checked to give one"
    if piece.lattice is None or choice == "stated":
        assert piece.second_moment_of_area is not None, "the file is checked to give one"
        stiffness, shear = modulus * piece.second_moment_of_area, piece.shear_stiffness
        taper = (piece.top_breadth_ratio, *TAPER_POWERS[piece.taper])
        leaning = piece.taper == "legs" and piece.top_breadth_ratio != 1.0
        rotary = piece.rotary_inertia_per_length
        return (Segment(piece.length, piece.mass_per_length, stiffness, shear, rotary, *taper, leaning),)
    column = laced_column(piece.lattice, modulus)
    laced = column_segments(column, piece.length, piece.top_breadth_ratio, piece.mass_per_length, choice)
    if not piece.rotary_inertia_per_length:
        return laced
    # Stated at the foot; it goes with the bending stiffness.
    per_stiffness = piece.rotary_inertia_per_length / laced[0].bending_stiffness
    return tuple(replace(one, rotary_inertia=per_stiffness * one.bending_stiffness) for one in laced)


def tower_truss(crane: Crane) -> ColumnTruss | None:
    """The lattices of a tower, one on the other, as a truss of whole panels; None where a piece has none.

    Bodies, foundation and the slewing part are left out.

    Raises
    ------
    ValueError
        If a truss is a mechanism, or legs do not stand on those below.
    """
    tower = crane.tower
    found: ColumnTruss | None = None
    for piece in reversed(tower_pieces(tower)):
        modulus = piece.youngs_modulus or tower.youngs_modulus
        if piece.lattice is None or modulus is None:
            return None
        column = laced_column(piece.lattice, modulus)
        height = max(1, round(piece.length / column.panel_height)) * column.panel_height
        found = ColumnTruss(column, height, piece.mass_per_length, piece.top_breadth_ratio, found)
    return found


def tower_pieces(tower: Tower) -> tuple[TowerSegment, ...]:
    """The segments of a tower; a uniform one has one."""
    from towercrane.cranes.tower.file.tower_tables import Section, TowerSegment

    if tower.segments:
        return tower.segments
    whole = {name: getattr(tower, name) for name in Section.model_fields}
    return (TowerSegment.model_construct(length=tower.height, **whole),)


def with_end_body(tower: Chain, body: EndBody) -> Chain:
    """The tower with one body more on its end."""
    top = len(tower.segments)
    return replace(tower, bodies={**tower.bodies, top: joined(tower.bodies.get(top, EndBody()), body)})


def joined(first: EndBody, second: EndBody) -> EndBody:
    """Two bodies on one node as one."""
    mass = first.mass + second.mass
    if mass == 0.0:
        return EndBody(0.0, first.rotary_inertia + second.rotary_inertia)
    offset = (first.mass * first.offset + second.mass * second.offset) / mass
    inertia = sum(body.rotary_inertia + body.mass * (body.offset - offset) ** 2 for body in (first, second))
    return EndBody(mass, inertia, offset)


Plane = Literal["vertical", "lateral"]


def jib_of(crane: Crane, plane: Plane = "vertical") -> Beam | Chain | None:
    """The jib of a checked crane file in bending up and down or to its sides; None where the file does not say."""
    jib = crane.jib
    (first, *more), prefix = jib.pieces, "lateral_" if plane == "lateral" else ""
    inertia: float | None = getattr(first, f"{prefix}second_moment_of_area")
    # Both planes are beams, or both are chains.
    rigid = first.shear_stiffness == first.lateral_shear_stiffness == inf
    light = first.rotary_inertia_per_length == first.lateral_rotary_inertia_per_length == 0.0
    if not more and not jib.bodies and first.laced is None and rigid and light:
        modulus, mass = first.youngs_modulus or jib.youngs_modulus, first.mass_per_length
        assert modulus is not None, "the file is checked to give one"
        return None if inertia is None else Beam(first.length, spread(first) or mass or 0.0, modulus, inertia)
    return _jib_chain(jib, plane)


def counter_jib_of(crane: Crane, plane: Plane = "vertical") -> Chain | None:
    """The counter-jib with its bodies and the counterweight; None where it is rigid, or not described in a plane."""
    jib = crane.counter_jib
    chain = _jib_chain(jib, plane) if jib.bends else None
    if chain is None or not jib.counterweight:
        return chain
    end = len(chain.segments)
    weight = joined(chain.bodies.get(end, EndBody()), EndBody(jib.counterweight))
    return replace(chain, bodies={**chain.bodies, end: weight})


def jib_lattice(lattice: JibMembers, youngs_modulus: float) -> JibLattice:
    """Members of a crane file as a jib's lattice."""
    return JibLattice(**dict(lattice), youngs_modulus=youngs_modulus)


def _jib_chain(jib: Arm, plane: Plane) -> Chain | None:
    segments: list[Segment] = []
    for piece in jib.pieces:
        modulus = piece.youngs_modulus or jib.youngs_modulus
        assert modulus is not None, "the file is checked to give one"
        if piece.laced is not None:
            lattice = jib_lattice(piece.laced, modulus)
            segments += lattice.segments(piece.length, plane, spread(piece))
            continue
        prefix = "lateral_" if plane == "lateral" else ""
        inertia, shear, rotary = (
            getattr(piece, f"{prefix}{name}")
            for name in ("second_moment_of_area", "shear_stiffness", "rotary_inertia_per_length")
        )
        if inertia is None:
            return None
        mass = spread(piece)
        assert mass is not None, "the file is checked to give one"
        segments.append(Segment(piece.length, mass, modulus * inertia, shear, rotary))
    chain = Chain(tuple(segments))
    for body in jib.bodies:
        chain, node = chain.with_node(min(body.position, chain.length))
        more = joined(chain.bodies.get(node, EndBody()), EndBody(body.mass, body.rotary_inertia))
        chain = replace(chain, bodies={**chain.bodies, node: more})
    return chain


def spread(piece: JibSegment) -> float | None:
    """Mass per length of a piece [kg/m], stated or from its whole mass."""
    return piece.mass_per_length if piece.mass is None else piece.mass / piece.length


def crane_on(tower: Beam | Chain, crane: Crane, **aside: Any) -> TowerCrane:
    """The crane of a file, in the plane of its jib, on a tower that may differ from the file's.

    Keyword arguments are what a :class:`towercrane.cranes.tower.modes.parameters.TowerCrane` has out of that plane.
    """
    jib, counter, rigid = jib_of(crane), counter_jib_of(crane), crane.counter_jib
    assert jib is not None, "the file is checked to give its stiffness"
    return TowerCrane(
        name=crane.name,
        tower=tower,
        jib=jib,
        counter_jib_length=counter.length if counter is not None else rigid.reach,
        counter_jib_mass_per_length=0.0 if counter is not None else rigid.mass_per_length or 0.0,
        counterweight=0.0 if counter is not None else rigid.counterweight,
        counter_jib=counter,
        trolley_mass=crane.trolley.mass,
        gravity=crane.gravity,
        **aside,
    )


def lattice_of(crane: Crane) -> LacedColumn | None:
    """The members of a uniform tower; None where the file has none."""
    tower = crane.tower
    if tower.lattice is None or tower.youngs_modulus is None:
        return None
    return laced_column(tower.lattice, tower.youngs_modulus)


def tie_bars_of(crane: Crane) -> TieBars | None:
    """Cat-head and ties of a checked crane file; None where it has none."""
    head = crane.tower_head
    if head is None:
        return None
    column = CatHead(
        head.height, head.mass_per_length, head.youngs_modulus * head.second_moment_of_area, head.axial_stiffness
    )
    jib, back = crane.jib, crane.counter_jib
    return TieBars(column, _ties(jib), _ties(back), _axial(jib), _axial(back))


def _ties(jib: Arm) -> tuple[Tie, ...]:
    return tuple(Tie(**dict(tie)) for tie in sorted(jib.ties, key=lambda tie: tie.position))


def _axial(jib: Arm) -> tuple[tuple[float, float], ...]:
    """Where each section ends [m] and its E A [N]."""
    pieces = zip((*jib.joints, jib.reach), jib.pieces, strict=True)
    return tuple((end, piece.axial_stiffness or 0.0) for end, piece in pieces)


def luffing_of(tables: TowerCase) -> LuffingJib | None:
    """The jib of a checked case if it pivots."""
    own, motion = tables.crane.jib.luffing, tables.motion.luffing
    if own is None:
        return None
    return LuffingJib(
        foot=own.pivot,
        frame_head=own.frame_head,
        winch=own.hoist_winch,
        attachment=own.rope_attachment,
        rope_stiffness=own.rope_stiffness,
        falls=own.falls,
        reference_angle=float(getattr(motion, "start", 0.0)),
        highest_angle=own.highest_angle,
        tip_mass=own.tip_mass,
        axial_stiffness=own.axial_stiffness,
        bodies=tuple(HeadBody(body.mass, body.place) for body in tables.crane.head.bodies),
    )

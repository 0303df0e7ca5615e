"""Named sections of tower and jib, and sums over all that is beyond each: mass, inertia, what the wind meets."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from modal.structures.part_shapes import gauss
from towercrane.cranes.parts.wind import drag
from towercrane.cranes.tower.modes.exposures import TowerExposure
from towercrane.cranes.tower.modes.mass_sums import MassSums, point_sums
from towercrane.cranes.tower.modes.parameters import as_chain
from towercrane.cranes.tower.modes.tied.head import sums_of_points

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from towercrane.cranes.parts.wind import WindAreas, WindNodes
    from towercrane.cranes.tower.modes.modal_crane import FlexibleCrane
    from towercrane.cranes.tower.modes.parameters import TowerCrane
    from towercrane.cranes.tower.modes.tied.head import FieldSums, TiedHead

    Floats = NDArray[np.float64]

PANELS = 6
"""Parts of each piece of a member, over which shapes of any number of modes are summed to rounding."""


class Section(NamedTuple):
    """Where force and moment are wanted: a height of the tower, or a distance along the jib [m].

    It is from the tower's axis, of a jib that pivots from its foot.
    """

    name: str
    of: Literal["tower", "jib"]
    place: float


@dataclass(frozen=True, eq=False)
class TowerCut:
    """What is above a section of the tower.

    Parameters
    ----------
    name : str
    height : float
        [m]
    bends : ndarray, shape (modes,)
        The tower's shapes there.
    mass, moment : float
        Mass of the tower and its bodies, and its first moment about the foot [kg, kg m].
    zeroth, first : ndarray, shape (modes,)
        Sums over it of the shapes, and of what tips it about the foot.
    products : ndarray, shape (modes, modes)
        Of two shapes.
    torsion : ndarray, shape (torsion modes,)
        Sums over its inertia of the shapes of torsion.
    collars : int
        Of the crane's collars the first that is above.
    exposed : tuple of TowerExposure
    """

    name: str
    height: float
    bends: Floats
    mass: float
    moment: float
    zeroth: Floats
    first: Floats
    products: Floats
    torsion: Floats
    collars: int
    exposed: tuple[TowerExposure, ...]


@dataclass(frozen=True, eq=False)
class TieCut:
    """A tie whose lower end is beyond a section of the jib.

    Parameters
    ----------
    number : int
        Among the ties, from 0.
    place : ndarray, shape (3,)
        Of its lower end on the straight jib, in the head's axes [m].
    moves : ndarray, shape (n, 3)
        What each coordinate of what is on the head moves that end.
    share : FieldSums
        Sums over its mass, weighted from none at the upper end to all at the lower one, which bears so much of it.
    """

    number: int
    place: Floats
    moves: Floats
    share: FieldSums


@dataclass(frozen=True, eq=False)
class JibCut:
    """What is beyond a section of the jib, without trolley and load.

    Parameters
    ----------
    name : str
    position : float
        From the tower's axis [m].
    shapes : ndarray, shape (shapes,)
        All shapes of what turns, there.
    beyond : MassSums
    exposed : tuple of MassSums
        The same of the drag per squared speed, for each place of what turns whose wind is known.
    ties : tuple of TieCut
        Those that hold what is beyond.
    """

    name: str
    position: float
    shapes: Floats
    beyond: MassSums
    exposed: tuple[MassSums, ...]
    ties: tuple[TieCut, ...]


class Cuts(NamedTuple):
    """Sections as they were asked for, and what is beyond them."""

    asked: tuple[Section, ...] = ()
    tower: tuple[TowerCut, ...] = ()
    jib: tuple[JibCut, ...] = ()


NONE = Cuts()


def cuts_of(
    crane: FlexibleCrane,
    written: TowerCrane,
    asked: Sequence[Section],
    areas: WindAreas | None,
    nodes: WindNodes | None,
) -> Cuts:
    """What is beyond sections of a crane.

    Parameters
    ----------
    crane : FlexibleCrane
    written : TowerCrane
        That it is made of.
    asked : sequence of Section
    areas, nodes
        As in :func:`towercrane.cranes.tower.modes.modal_crane.flexible_crane`.

    Raises
    ------
    ValueError
        If a section is off its member.
    """
    for own in asked:
        length = crane.tower_height if own.of == "tower" else crane.jib_length
        if not 0.0 <= own.place <= length:
            raise ValueError(f"section {own.name}: wanted a place from 0 to {length:g} m, got {own.place:g}")
    return Cuts(
        tuple(asked),
        tuple(tower_cut(crane, written, own.name, own.place, areas, nodes) for own in asked if own.of == "tower"),
        tuple(_jib_cut(crane, written, own, areas, nodes) for own in asked if own.of == "jib"),
    )


def tower_cut(
    crane: FlexibleCrane, written: TowerCrane, name: str, height: float, areas: WindAreas | None,
    nodes: WindNodes | None,
) -> TowerCut:  # fmt: skip
    """What is above a height of the tower [m]."""
    chain, tower = as_chain(written.tower), crane.tower
    z, dz = _spread(chain.nodes, height)
    m, shapes = chain.section(z, "mass_per_length") * dz, tower(z)
    rotary = tower.rotation(z) @ (chain.section(z, "rotary_inertia") * dz)
    mass, moment, zeroth = float(m.sum()), float(m @ z), shapes @ m
    first, products = shapes @ (m * z) + rotary, (shapes * m) @ shapes.T
    for node, body in chain.bodies.items():
        at = float(chain.nodes[node])
        if at < height:
            continue
        turned = tower.rotation([at])[:, 0]
        moved, arm = tower([at])[:, 0] + body.offset * turned, at + body.offset
        mass, moment, zeroth = mass + body.mass, moment + body.mass * arm, zeroth + body.mass * moved
        first = first + body.mass * arm * moved + body.rotary_inertia * turned
        products = products + body.mass * np.outer(moved, moved)
    torsion = np.zeros(crane.torsion.count)
    if written.shaft is not None and crane.torsion.count:
        knots, (inertias, _) = written.shaft.nodes, written.shaft.pieces
        z, dz = _spread(knots, height)
        torsion = crane.torsion(z) @ (inertias[np.searchsorted(knots[1:-1], z, side="right")] * dz)
    return TowerCut(
        name, height, tower([height])[:, 0], mass, moment, zeroth, first, products, torsion,
        sum(collar.height <= height for collar in crane.collars), _blown(crane, height, areas, nodes),
    )  # fmt: skip


def _blown(
    crane: FlexibleCrane, height: float, areas: WindAreas | None, nodes: WindNodes | None
) -> tuple[TowerExposure, ...]:
    """What of the tower above a height the wind meets."""
    if areas is None:
        return ()
    parts, top, per_length = [], crane.tower_height, drag(areas.tower)
    count = 1 if nodes is None else nodes.tower
    for node in range(count):
        low, high = max(node * top / count, height), (node + 1) * top / count
        if low >= high:
            continue
        z, dz = _spread((low, high), low)
        pressed = per_length * dz
        if nodes is not None:
            pressed = pressed * (nodes.profile.share(z) / nodes.profile.share((node + 0.5) * top / count)) ** 2
        parts.append(TowerExposure(node, float(pressed.sum()), float(pressed @ z), crane.tower(z) @ pressed))
    return tuple(parts)


def _jib_cut(
    crane: FlexibleCrane, written: TowerCrane, asked: Section, areas: WindAreas | None, nodes: WindNodes | None
) -> JibCut:
    """What is beyond a place on the jib."""
    upright = as_chain(written.jib)
    sideways = None if written.jib_lateral is None else as_chain(written.jib_lateral)
    x, dx = _spread(upright.nodes, asked.place)
    m = upright.section(x, "mass_per_length") * dx
    heavy = [
        (float(upright.nodes[k]), own.mass) for k, own in upright.bodies.items() if upright.nodes[k] >= asked.place
    ]
    if crane.luffing is not None:
        heavy.append((crane.jib_length, crane.luffing.tip_mass))
    places, masses = np.append(x, [at for at, _ in heavy]), np.append(m, [mass for _, mass in heavy])
    beyond = _sums(crane, places, masses)
    # Sections and bodies turn by themselves beside that.
    turned, own = np.zeros(len(beyond.first)), [0.0, 0.0]
    lateral, vertical = crane.lateral.count, crane.vertical.count
    for k, (chain, basis, mine) in enumerate(
        (
            (upright, crane.vertical, crane.carrying[lateral : lateral + vertical]),
            (sideways, crane.lateral, crane.carrying[:lateral]),
        )
    ):
        if chain is None:
            continue
        inertia = chain.section(x, "rotary_inertia") * dx
        bodies = [(float(chain.nodes[node]), body.rotary_inertia) for node, body in chain.bodies.items()]
        at = np.append(x, [place for place, _ in bodies if place >= asked.place])
        inertia = np.append(inertia, [rotary for place, rotary in bodies if place >= asked.place])
        if inertia.any():
            own[k], turned[mine] = float(inertia.sum()), basis.rotation(at) @ inertia
    pitch, yaw = own
    own_pitch, own_yaw = beyond.pitch + pitch, beyond.yaw + yaw
    sums = replace(beyond, roll=pitch + yaw, pitch=own_pitch, yaw=own_yaw, turned=turned)
    exposed: tuple[MassSums, ...] = ()
    if areas is not None:
        swept, hats = drag(areas.jib) * dx, [np.ones_like(x)]
        if nodes is not None and nodes.head > 1:
            known = nodes.along_jib(written.jib.length, written.counter_jib_length)
            hats = [np.interp(x, known, own) for own in np.eye(len(known))]
        exposed = tuple(_sums(crane, x, swept * hat) for hat in hats)
    ties = () if crane.tied is None else _ties_beyond(crane.tied, asked.place)
    return JibCut(asked.name, asked.place, crane.jib_shapes([asked.place])[:, 0], sums, exposed, ties)


def _ties_beyond(tied: TiedHead, place: float) -> tuple[TieCut, ...]:
    """Ties that hold the jib beyond a place."""
    part, weights = gauss()
    found = []
    for k, (side, tie) in enumerate(zip(tied.bars.sides, tied.bars.ties, strict=True)):
        if side < 0.0 or tie.position < place:
            continue
        places, fields = tied.points(k, part)
        share = sums_of_points(places, fields, tied.masses[k] * weights * part)
        found.append(TieCut(k, np.array([tie.position, 0.0, tie.height]), tied.ends()[1][k], share))
    return tuple(found)


def _sums(crane: FlexibleCrane, x: Floats, m: Floats) -> MassSums:
    """Sums over points of mass on the jib."""
    return point_sums(x, m, crane.lateral, crane.vertical).among(crane.carrying, sum(crane.groups))


def _spread(nodes: Sequence[float] | Floats, begin: float) -> tuple[Floats, Floats]:
    """Gauss points and weights between nodes, from a place on."""
    inside = np.asarray(nodes, dtype=float)
    ends = np.append([begin], inside[inside > begin])
    if len(ends) < 2:
        return np.zeros(0), np.zeros(0)
    fine = np.append(np.concatenate([np.linspace(a, b, PANELS + 1)[:-1] for a, b in pairwise(ends)]), ends[-1])
    points, weights = gauss()
    return (fine[:-1, None] + np.diff(fine)[:, None] * points).ravel(), (np.diff(fine)[:, None] * weights).ravel()

"""A tower crane with a jib that pivots, in modes of its members."""

from __future__ import annotations

from typing import TYPE_CHECKING

from modal.beams.beam import EndBody
from towercrane.cranes.tower.modes.chord_shapes import ChordShapes
from towercrane.cranes.tower.modes.exposures import exposure_of
from towercrane.cranes.tower.modes.jib_shapes import JibShapes
from towercrane.cranes.tower.modes.mass_sums import point_sums, rigid_sums
from towercrane.cranes.tower.modes.modal_crane import FlexibleCrane, check_described, torsion_of
from towercrane.cranes.tower.modes.parameters import modes_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from towercrane.cranes.parts.wind import WindAreas, WindNodes
    from towercrane.cranes.tower.modes.luffing_jib import LuffingJib
    from towercrane.cranes.tower.modes.mass_sums import Basis
    from towercrane.cranes.tower.modes.mode_counts import ModeCounts
    from towercrane.cranes.tower.modes.parameters import TowerCrane

    Floats = NDArray[np.float64]


def luffing_of(crane: TowerCrane) -> LuffingJib:
    """What a crane has of a jib that pivots."""
    assert crane.luffing is not None, "the crane's jib pivots"
    return crane.luffing


def products(crane: TowerCrane, lateral: Basis, vertical: Basis) -> tuple[Floats, Floats]:
    """Sums of slopes of either direction over the jib's length, and with the mass beyond; shapes (n, n)."""
    from scipy.linalg import block_diag

    slopes = block_diag(lateral.slope_matrix(), vertical.slope_matrix())
    beyond = block_diag(lateral.weight_matrix(), vertical.weight_matrix()) + luffing_of(crane).tip_mass * slopes
    return slopes, beyond


def luffing_crane(
    crane: TowerCrane, modes: ModeCounts, planes: int, areas: WindAreas | None = None, nodes: WindNodes | None = None
) -> FlexibleCrane:
    """Crane in so many modes of its members.

    To its sides the jib bends as clamped at its foot and free at its head, up and down as held at both.

    Parameters
    ----------
    crane : TowerCrane
    modes : ModeCounts
    planes : {1, 2}
        Directions in which the tower bends.
    areas, nodes
        As in :func:`towercrane.cranes.tower.modes.modal_crane.flexible_crane`.

    Raises
    ------
    ValueError
        If there are modes of a member that the crane does not describe.
    """
    check_described(crane, modes)
    own = luffing_of(crane)
    jib, lateral_jib = crane.uniform_jib, crane.jib_lateral
    lateral = modes_of(lateral_jib or jib, modes.lateral, EndBody(own.tip_mass))
    vertical = ChordShapes(jib, modes.vertical)
    rest, tower = own.rest_sums(crane), crane.tower_shapes(modes.tower)
    sums = point_sums(*own.points_of(jib), lateral, vertical)
    counter = rigid_sums(rest.mass, rest.forward, rest.yy, modes.lateral + modes.vertical)
    shapes = JibShapes(crane, lateral, vertical, None, None, sums, counter)
    return FlexibleCrane(
        name=crane.name,
        tower_height=crane.tower.length,
        jib_length=crane.jib.length,
        tower=tower,
        torsion=torsion_of(crane, modes.torsion),
        lateral=lateral,
        vertical=vertical,
        jib=sums,
        counter=counter,
        tower_mass=crane.tower_mass,
        trolley_mass=0.0,
        planes=planes,
        tower_moment=crane.tower_moment,
        collars=crane.collars,
        gravity=crane.gravity,
        luffing=own,
        exposure=None if areas is None else exposure_of(shapes, tower, crane.tower.length, areas, nodes),
        written=crane,
    )

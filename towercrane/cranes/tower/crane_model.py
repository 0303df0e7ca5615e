"""A tower crane with its load in a number of modes of each kind, in the jib's plane or in space."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.tower.model import FlexibleModel
from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.cranes.tower.modes.modal_crane import flexible_crane
from towercrane.cranes.tower.outputs.cut_sums import cuts_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from towercrane.cranes.parts.wind import WindAreas, WindNodes
    from towercrane.cranes.slewing.description import Drive
    from towercrane.cranes.tower.modes.mode_counts import ModeCounts
    from towercrane.cranes.tower.modes.parameters import TowerCrane
    from towercrane.cranes.tower.outputs.cut_sums import Section
    from towercrane.kernels.load import Load


MODE_KINDS = {
    "tower_modes": "bending of the tower",
    "torsion_modes": "torsion of the tower",
    "jib_lateral_modes": "bending of the jib to its sides",
    "jib_vertical_modes": "bending of the jib up and down",
    "counter_jib_lateral_modes": "bending of the counter-jib to its sides",
    "counter_jib_vertical_modes": "bending of the counter-jib up and down",
}
"""Kinds of modes, by the key that counts them, in the order of
:class:`towercrane.cranes.tower.modes.mode_counts.ModeCounts`."""

PLANE_MODES = ("tower_modes", "jib_vertical_modes", "counter_jib_vertical_modes")
"""Kinds that move in the jib's vertical plane."""


def moving(planar: bool) -> tuple[str, ...]:
    """Kinds of modes that move in a scene: in the jib's plane, or in space."""
    return PLANE_MODES if planar else tuple(MODE_KINDS)


def described(crane: TowerCrane) -> tuple[str, ...]:
    """Kinds of modes for which a crane has data."""
    missing = {
        "torsion_modes": crane.shaft is None,
        "jib_lateral_modes": crane.jib_lateral is None,
        "counter_jib_lateral_modes": crane.counter_jib_lateral is None,
        "counter_jib_vertical_modes": crane.counter_jib is None,
    }
    return tuple(kind for kind in MODE_KINDS if not missing.get(kind, False))


def tower_crane_model(
    crane: TowerCrane,
    load: Load,
    modes: ModeCounts,
    *,
    planar: bool = False,
    heading: float = 0.0,
    drive: Drive | None = None,
    drive_inertia: float = 0.0,
    areas: WindAreas | None = None,
    nodes: WindNodes | None = None,
    ground: bool = False,
    floors: int = 0,
    damping: ModalDamping | None = None,
    weight_softening: bool = False,
    self_weight: bool = True,
    rope_as_rod: bool = False,
    cap: float = np.inf,
    sections: Sequence[Section] = (),
) -> FlexibleModel:
    """Equations of motion of a tower crane.

    Parameters
    ----------
    crane : TowerCrane
        With its shaft and its jib's lateral beam where it has them.
    load : Load
    modes : ModeCounts
        In the plane those of torsion and of the jib to its sides stand still, and are left out.
    planar : bool
        Whether all stays in the jib's vertical plane; then the head does not turn.
    heading : float
        Angle from the fixed x axis at which a head that does not turn stands [rad].
    drive : Drive, optional
        What turns the head in place of the motion "slewing".
    drive_inertia : float
        [kg m^2]
    areas : WindAreas, optional
        What the wind meets; without it there is none.
    nodes : WindNodes, optional
        Where a wind of its own blows; without, one wind blows for all.
    ground, floors, damping, weight_softening, self_weight, rope_as_rod, cap
        As in :class:`towercrane.cranes.tower.model.FlexibleModel`.
    sections : sequence of Section
        Where force and moment are wanted.
    """
    if planar:
        modes, drive, drive_inertia = replace(modes, torsion=0, lateral=0, counter_lateral=0), None, 0.0
    planes = 1 if planar else 2
    kind = FlexibleModel
    # Most cranes have neither: what only these need is loaded with them.
    if crane.luffing is not None:
        from towercrane.cranes.tower.luffing_model import LuffingModel
        from towercrane.cranes.tower.modes.luffing_crane import luffing_crane

        kind, chosen = LuffingModel, luffing_crane(crane, modes, planes, areas, nodes)
    else:
        free = drive is not None and drive.free
        chosen = flexible_crane(crane, modes, areas, planes, nodes, moves=free)
    if crane.tie_bars is not None:
        from towercrane.cranes.tower.tied_model import TiedModel

        kind = TiedModel
    return kind(
        chosen,
        load,
        slewing="fixed" if planar else drive or "prescribed",
        drive_inertia=drive_inertia,
        heading=heading if planar else 0.0,
        damping=damping or ModalDamping(),
        weight_softening=weight_softening,
        self_weight=self_weight,
        rope_as_rod=rope_as_rod,
        wind=0 if areas is None else 1 if nodes is None else nodes.count,
        ground=ground,
        floors=floors,
        axes=2 if planar else 3,
        cap=cap,
        cuts=cuts_of(chosen, crane, sections, areas, nodes),
    )

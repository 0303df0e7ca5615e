"""The crane of the tests, without a case file: QTZ5613 of Gao et al. (2023), Table 2."""

from dataclasses import replace

from modal.beams.beam import Beam
from towercrane.accuracy.setting import Setting
from towercrane.cranes.tower.crane_model import tower_crane_model
from towercrane.cranes.tower.model import FlexibleModel
from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.cranes.tower.modes.mode_counts import ModeCounts
from towercrane.cranes.tower.modes.parameters import TowerCrane
from towercrane.kernels.load import Load
from towercrane.motions.motion import rest
from towercrane.motions.profiles import trapezoid

CRANE = TowerCrane(
    name="QTZ5613",
    tower=Beam(23.8, 350.0, 206e9, 0.014),
    jib=Beam(55.6, 123.8, 206e9, 0.0035),
    counter_jib_length=12.3,
    counter_jib_mass_per_length=159.3,
    counterweight=15130.0,
    trolley_mass=350.0,
)

CONDITIONS = {1: (0.4, 400.0, 18.0), 2: (0.8, 400.0, 18.0), 3: (0.8, 800.0, 18.0), 4: (0.8, 800.0, 10.0)}
"""Trolley speed [m/s], load [kg], rope [m]; loads of 1 and 2 are assumed."""


def in_plane(
    crane: TowerCrane,
    load: Load,
    tower: int = 2,
    jib: int = 3,
    *,
    damping: tuple[float, float] = (0.0, 0.0),
    axes: int = 2,
    **options,
) -> FlexibleModel:
    """A crane in the plane of its jib, with so many modes of tower and jib and damping of them.

    With three axes its load may leave the plane.
    """
    modes = ModeCounts(tower=tower, torsion=0, lateral=0, vertical=jib)
    ratios = ModalDamping(tower=damping[0], vertical=damping[1])
    return replace(tower_crane_model(crane, load, modes, planar=True, damping=ratios, **options), axes=axes)


def model(tower: int = 2, jib: int = 3, load: float = 800.0, **options) -> FlexibleModel:
    return in_plane(CRANE, Load(load), tower, jib, **options)


def plane_setting(tower: int = 0, jib: int = 0, **options) -> Setting:
    """So many modes of tower and jib in the plane of the jib."""
    return Setting(tower_modes=tower, jib_vertical_modes=jib, planar=True, **options)


def motions(speed: float = 0.8, rope: float = 18.0) -> dict:
    return {"trolley": trapezoid(5.0, 41.0, speed, 0.1), "rope": rest(rope)}


def standing(trolley: float, rope: float) -> dict:
    return {"trolley": rest(trolley), "rope": rest(rope)}

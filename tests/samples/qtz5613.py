"""The crane of the tests, without a case file: QTZ5613 of Gao et al. (2023), Table 2."""

from modal.beams.beam import Beam
from towercrane.cranes.tower.modes.parameters import TowerCrane
from towercrane.cranes.tower.planar import RadialModel
from towercrane.kernels.payload import Load
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


def model(tower_modes: int = 2, jib_modes: int = 3, load: float = 800.0, **options) -> RadialModel:
    return RadialModel(CRANE, Load(load), tower_modes, jib_modes, **options)


def motions(speed: float = 0.8, rope: float = 18.0) -> dict:
    return {"trolley": trapezoid(5.0, 41.0, speed, 0.1), "rope": rest(rope)}


def standing(trolley: float, rope: float) -> dict:
    return {"trolley": rest(trolley), "rope": rest(rope)}

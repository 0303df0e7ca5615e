"""A crane with a jib that pivots: the data set of the tests, its values assumed."""

import dataclasses
from math import radians

from modal.beams.beam import Beam
from modal.beams.torsion import Shaft
from towercrane.cranes.tower.luffing_model import LuffingModel
from towercrane.cranes.tower.modes.luffing_crane import luffing_crane
from towercrane.cranes.tower.modes.luffing_jib import HeadBody, LuffingJib
from towercrane.cranes.tower.modes.mode_counts import ModeCounts
from towercrane.cranes.tower.modes.parameters import TowerCrane
from towercrane.kernels.load import Load

PIVOTING = LuffingJib(
    foot=(1.5, 1.2),
    frame_head=(-3.0, 11.0),
    winch=(-2.5, 1.8),
    attachment=0.9,
    rope_stiffness=2.4e8,
    falls=2,
    reference_angle=radians(45.0),
    highest_angle=radians(88.0),
    tip_mass=700.0,
    bodies=(HeadBody(30e3, (-7.5, 1.0)), HeadBody(6e3, (-4.0, 1.2)), HeadBody(9e3, (-1.5, 4.0))),
)
AXIAL = 2.5e9

CRANE = TowerCrane(
    name="LJ",
    tower=Beam(40.0, 600.0, 200e9, 0.03),
    jib=Beam(50.0, 150.0, 200e9, 0.0035),
    counter_jib_length=0.0,
    counter_jib_mass_per_length=0.0,
    counterweight=0.0,
    trolley_mass=0.0,
    jib_lateral=Beam(50.0, 150.0, 200e9, 0.0030),
    shaft=Shaft(40.0, 700.0, 2.5e8),
    luffing=PIVOTING,
)


def crane(**changes):
    """The crane with another jib on its hinge."""
    return dataclasses.replace(CRANE, luffing=dataclasses.replace(PIVOTING, **changes))


def model(tower=0, torsion=0, lateral=2, vertical=2, load=5000.0, planes=2, crane=CRANE, areas=None, **options):
    modes = ModeCounts(tower, torsion, lateral, vertical)
    hung = load if isinstance(load, Load) else Load(load)
    return LuffingModel(luffing_crane(crane, modes, planes, areas), hung, **options)

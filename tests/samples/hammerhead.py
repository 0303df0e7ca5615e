"""A hammerhead crane on tie bars: the data set of the tests, its values assumed."""

import dataclasses

from modal import Beam, Chain, EndBody, Segment, Shaft
from towercrane.cranes.tower.modes.modal_crane import flexible_crane
from towercrane.cranes.tower.modes.mode_counts import ModeCounts
from towercrane.cranes.tower.modes.parameters import TowerCrane
from towercrane.cranes.tower.modes.tied.bars import CatHead, Tie, TieBars
from towercrane.cranes.tower.tied_model import TiedModel
from towercrane.kernels.load import Load

HEAD = CatHead(height=8.5, mass_per_length=220.0, bending_stiffness=1.6e9, axial_stiffness=2e9)
JIB_TIES = (Tie(18.0, 1.2, 5.8e8, 23.0), Tie(44.0, 1.2, 5.8e8, 23.0))
BACK_TIE = (Tie(12.5, 0.6, 1.2e9, 46.0),)
BARS = TieBars(HEAD, JIB_TIES, BACK_TIE, ((40.0, 1.7e9), (60.0, 1.1e9)), ((14.0, 1.5e9),))

JIB = Chain((Segment(40.0, 130.0, 6e8, 6e7), Segment(20.0, 100.0, 4e8, 5e7)))
SIDEWAYS = Chain((Segment(40.0, 130.0, 8e8, 5e7), Segment(20.0, 100.0, 5e8, 4e7)))
COUNTER = Chain((Segment(13.2, 200.0, 3e8, 8e7), Segment(0.8, 200.0, 3e8, 8e7)), bodies={1: EndBody(12e3)})

CRANE = TowerCrane(
    name="HH",
    tower=Beam(45.0, 600.0, 200e9, 0.03),
    jib=JIB,
    counter_jib_length=14.0,
    counter_jib_mass_per_length=0.0,
    counterweight=0.0,
    trolley_mass=400.0,
    jib_lateral=SIDEWAYS,
    shaft=Shaft(45.0, 700.0, 2.5e8),
    counter_jib=COUNTER,
    counter_jib_lateral=COUNTER,
    tie_bars=BARS,
)


def crane(**changes):
    """The crane with other ties."""
    return dataclasses.replace(CRANE, tie_bars=dataclasses.replace(BARS, **changes))


def model(tower=0, torsion=0, lateral=2, vertical=1, aside=0, back=1, load=3000.0, planes=2, crane=CRANE, **options):
    modes = ModeCounts(tower, torsion, lateral, vertical, aside, back)
    hung = load if isinstance(load, Load) else Load(load)
    return TiedModel(flexible_crane(crane, modes, planes=planes), hung, **options)


def bare(**changes):
    """The crane with other numbers of its own."""
    return dataclasses.replace(CRANE, **changes)

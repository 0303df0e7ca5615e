"""The crane of the tests in space: QTZ5613 with data for its sides that no source prints."""

import dataclasses

import numpy as np
from samples import qtz5613

from modal.beams.beam import Beam
from modal.beams.torsion import Shaft
from towercrane.cranes.tower.model import FlexibleModel
from towercrane.cranes.tower.modes.modal_crane import flexible_crane
from towercrane.cranes.tower.modes.mode_counts import ModeCounts
from towercrane.cranes.tower.outputs.kinematics import Kinematics
from towercrane.kernels.load import Load
from towercrane.motions.motion import rest, sequence
from towercrane.motions.profiles import speed_trapezoid, trapezoid
from towercrane.simulation.observed import Instant

CRANE = dataclasses.replace(
    qtz5613.CRANE,
    jib_lateral=Beam(55.6, 123.8, 206e9, 0.0020),
    shaft=Shaft(23.8, 400.0, 1.7e8),
)


def model(
    tower=2,
    torsion=1,
    lateral=3,
    vertical=3,
    load=1500.0,
    areas=None,
    nodes=None,
    planes=2,
    crane=CRANE,
    counter=(0, 0),
    **options,
):
    modes = ModeCounts(tower, torsion, lateral, vertical, *counter)
    hung = load if isinstance(load, Load) else Load(load)
    return FlexibleModel(flexible_crane(crane, modes, areas, planes, nodes), hung, **options)


def manoeuvre(heading: float = np.pi / 2) -> dict:
    """Slew 90 degrees, trolley out, load up: 0.6 rpm in ramps of 5 s, 0.8 m/s, 0.4 m/s."""
    speed = 0.6 * 2 * np.pi / 60
    return {
        "slewing": speed_trapezoid(0.0, speed, 5.0, heading / speed - 5.0),
        "trolley": trapezoid(10.0, 40.0, 0.8, 0.2),
        "rope": sequence(rest(20.0, 5.0), trapezoid(20.0, 12.0, 0.4, 0.2)),
    }


def standing(trolley: float, rope: float, heading: float = 0.0) -> dict:
    return {"trolley": rest(trolley), "rope": rest(rope), "slewing": rest(heading)}


def start(scene: FlexibleModel, motions: dict, **options) -> np.ndarray:
    from towercrane.motions.motion import phases
    from towercrane.simulation.starts.begin import begin

    return begin(scene, phases(tuple(motions[c] for c in scene.channels), 1.0).inputs[0], **options)


def kinematics(scene: FlexibleModel, motions: dict, times: np.ndarray, states: np.ndarray) -> Kinematics:
    """Positions and velocities in states of a run, arrays with an entry for each of the times."""
    drives = [[motions[channel](times, derivative) for derivative in range(3)] for channel in scene.channels]
    return Kinematics(scene.seen, Instant(states.T, (), (), drives))

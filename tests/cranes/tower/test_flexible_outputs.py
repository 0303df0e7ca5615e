"""What a flexible crane shows, of rows as they stand and of states on the way."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples import space_crane as space
from samples.qtz5613 import in_plane
from samples.space_crane import kinematics, manoeuvre

from towercrane.cranes.parts.wind import WindAreas, gusts
from towercrane.cranes.slewing.description import Drive
from towercrane.cranes.tower.equations.motion import motion
from towercrane.cranes.tower.outputs.energy import kinetic_energy
from towercrane.kernels.load import Load
from towercrane.kernels.straight.leaves import numbers_of, table_of
from towercrane.kernels.straight.written import written
from towercrane.motions.motion import phases
from towercrane.simulation.integrate import evaluate
from towercrane.simulation.observed import Looked, scalars

AREAS = WindAreas(tower=2.5, jib=1.0, counter_jib=1.2, counterweight=10.0)
LOSSY = Load(1500.0, rope_damping=800.0, drag_area=8.0)
DRIVE = Drive("slewing", 4e6, 2e7, 0.01, 4e5, "tanh", 5e4, 0.005)
WINDY = {"areas": AREAS, "wind": True}
SCENES = {
    "prescribed": space.model(2, 1, 2, 3, load=LOSSY, **WINDY),
    "driven": space.model(1, 1, 1, 1, load=LOSSY, slewing=DRIVE, drive_inertia=1e6),
    "turned plane": space.model(2, 0, 0, 3, load=LOSSY, **WINDY, planes=1, slewing="fixed", axes=2, heading=2.2),
    "plane": in_plane(space.CRANE, Load(800.0), 2, 3),
}
AT = 7.3


def states_of(scene):
    """Motions, phases, and random states at one time."""
    rng = np.random.default_rng(4)
    motions = manoeuvre() | gusts(1.0, [12.0, 5.0, 2.0] + 3.0 * rng.normal(size=(40, 3)))
    motions["shaft"] = motions["slewing"]
    cut = phases(tuple(motions[channel] for channel in scene.channels), 46.0)
    sizes = np.append(scene.system.scale[:-1], 1.0)
    return motions, cut, space.start(scene, motions) + 0.05 * sizes * rng.normal(size=(5, scene.size))


@pytest.mark.parametrize("name", SCENES)
def test_outputs_recorded_on_the_way_are_those_of_rows(name):
    scene = SCENES[name]
    motions, cut, states = states_of(scene)
    times = np.full(len(states), AT)
    seen = scene.observe(motions, times, states, *evaluate(scene.system, cut, times, states))
    phase = int(np.searchsorted(cut.times, AT)) - 1
    inputs = cut.inputs[phase]
    names = scalars(scene)
    looked, numbers = Looked(motion, scene.outputs, names, len(scene.channels)), numbers_of(scene.seen)
    code = written(looked, scene.seen, [numbers], scene.size, inputs.shape)
    given = {
        "t": {(): AT - cut.times[phase]}, "y": states.T, "inputs": inputs, "tables": table_of(scene.seen),
        "numbers": code.numbers(numbers),
    }  # fmt: skip
    found = code.program.values(given)
    assert code.counts == (len(names), len(scene.system.guards))
    for index, name in enumerate(names):
        row = seen[name].values
        assert_allclose(found["dy", index] + 0.0 * row, row, rtol=0.0, atol=1e-13 * abs(row).max())


@pytest.mark.parametrize("name", SCENES)
def test_kinetic_energy_is_that_of_the_equations_mass_and_what_drives_move(name):
    # Of a crane whose drives stand still it is the form of the mass matrix, with the load's own swing beside it.
    scene = SCENES[name]
    _, _, states = states_of(scene)
    motions = space.standing(25.0, 12.0, 0.7)
    motions |= {"shaft": motions["slewing"], **gusts(1.0, np.zeros((2, 3)))}
    at = kinematics(scene, motions, np.zeros(len(states)), states)
    inputs = np.array([[float(motions[channel](0.0)), 0.0, 0.0] for channel in scene.channels])
    n, axes = scene.coordinates, scene.axes
    for state, energy in zip(states, kinetic_energy(at), strict=True):
        rates, swing = state[n + axes : 2 * n + axes], state[2 * n + axes : -1]
        structure = scene.at_rest(state[:n], inputs)
        velocity = np.array(structure.jacobian) @ rates + 12.0 * swing
        expected = 0.5 * rates @ structure.mass_matrix() @ rates + 0.5 * scene.load.mass * velocity @ velocity
        assert energy == pytest.approx(expected, rel=1e-12)

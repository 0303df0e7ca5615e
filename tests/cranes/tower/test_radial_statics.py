"""The flexible crane in radial motion at rest: equilibrium, buckling and natural frequencies."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.qtz5613 import CRANE, model, standing

from modal import crane_structure, finite_element_structure_frequencies
from tests.samples.qtz5613 import in_plane
from towercrane.cranes.tower.equations.small_motions import plane_modes
from towercrane.cranes.tower.file.build import frame_of
from towercrane.kernels.load import Load
from towercrane.simulation.simulate import simulate
from towercrane.simulation.starts.start import Start
from towercrane.simulation.system import NoEquilibrium

# --- equilibrium ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("softening", [False, True])
def test_start_from_equilibrium_stays_there(softening):
    result = simulate(model(2, 3, weight_softening=softening), standing(41.0, 18.0), 60.0)
    assert np.ptp(result["tower_tip_displacement"].values) < 1e-10
    assert abs(result["sway_radial"]).max() < 1e-10
    # The step control keeps the coordinates; the tension shows their rounding multiplied by high frequencies.
    assert_allclose(result["hoist_rope_force"], 800 * 9.81, rtol=2e-5)


def test_rigid_jib_equilibrium_is_the_moment_on_a_cantilever():
    # Tip moment on a clamped-free column, small tilt: u = M L^2 / 2 E I. Many modes are needed for a static moment.
    column = model(14, 0)
    q = column.equilibrium(np.array([[41.0, 0.0, 0.0], [18.0, 0.0, 0.0]]))
    moment = 9.81 * (CRANE.static_moment + 41.0 * 1150.0)
    expected = moment * 23.8**2 / (2 * CRANE.tower.bending_stiffness)
    assert_allclose(q @ column.constants.motions[0], expected, rtol=2e-3)


def test_buckling_load_is_that_of_the_loaded_column():
    # P_cr = (pi / 2)^2 E I / L^2 for a load that outweighs the column: the message quotes the ratio.
    import re

    heavy = in_plane(CRANE, Load(4e6), 6, 0, weight_softening=True)
    with pytest.raises(NoEquilibrium) as caught:
        heavy.equilibrium(np.array([[20.0, 0.0, 0.0], [18.0, 0.0, 0.0]]))
    ratio = float(re.search(r"carry ([\d.]+) times", str(caught.value))[1])
    weight = 9.81 * (4e6 + 350 + CRANE.slewing_mass + 0.3 * CRANE.tower.mass)
    assert_allclose(ratio, (np.pi / 2) ** 2 * CRANE.tower.bending_stiffness / 23.8**2 / weight, rtol=0.01)


def test_buckling_tower_is_named_with_its_load_factor():
    import dataclasses

    weak = dataclasses.replace(CRANE.tower, second_moment_of_area=0.014 / 400)
    slender = in_plane(dataclasses.replace(CRANE, tower=weak), Load(800.0), 2, 2, weight_softening=True)
    inputs = np.array([[20.0, 0.0, 0.0], [18.0, 0.0, 0.0]])
    with pytest.raises(NoEquilibrium, match=r"would carry 0\.\d+ times the weight"):
        slender.equilibrium(inputs)
    with pytest.raises(NoEquilibrium, match="would carry"):
        plane_modes(slender, 20.0, 18.0)
    result = simulate(slender, standing(20.0, 18.0), 10.0)
    assert (result.attrs["outcome"], result.attrs["end_time"]) == ("tower buckled", 0.0)
    falling = simulate(slender, standing(20.0, 18.0), 100.0, start=Start("zero"))
    assert falling.attrs["outcome"] in ("tower buckled", "slack rope")
    assert 0.0 < falling.attrs["end_time"] < 100.0


# --- frequencies ---------------------------------------------------------------------------------------


def frame(trolley: float):
    structure = crane_structure(frame_of(CRANE, 800.0, 18.0), trolley)
    return finite_element_structure_frequencies(structure, 3, elements=40)


@pytest.mark.parametrize("trolley", [5.0, 23.0, 41.0, 55.0])
def test_linear_model_against_the_finite_element_frame(trolley):
    reference = frame(trolley)

    def errors(tower_modes, jib_vertical_modes):
        return plane_modes(model(tower_modes, jib_vertical_modes), trolley, 18.0)[0][:3] / reference - 1

    both = np.array([errors(n, n) for n in (1, 2, 3, 4)])
    assert np.max(abs(both[1, 1:])) < 3e-4
    assert np.max(abs(both[1:, 0])) < 5e-8
    assert np.all(both[:, 1:] > -1e-7)  # a Ritz model is too stiff, never too soft
    # One mode more, of tower or of jib, never makes it worse.
    jib = np.array([errors(4, n) for n in (1, 2, 3, 4, 5, 6)])
    tower = np.array([errors(n, 6) for n in (1, 2, 3, 4)])
    for sweep in (jib, tower):
        assert np.all(np.diff(sweep[:, 1:], axis=0) < 1e-9)
    assert np.all(jib[-1, 1:] < 0.05 * jib[1, 1:] + 2e-6)


@pytest.mark.parametrize(("trolley", "hz"), [(5.0, (0.3465, 0.7974)), (41.0, (0.3106, 0.7890))])
def test_softened_frequencies_against_exact_dynamic_stiffness(trolley, hz):
    # Figures of an exact dynamic stiffness of tower and jib with the weight as axial load, to four digits.
    found = plane_modes(model(8, 8, weight_softening=True), trolley, 18.0)[0][1:3] / (2 * np.pi)
    assert_allclose(found, hz, atol=1.1e-4)


def test_swing_is_found_among_the_modes_by_its_energy():
    frequencies, swing = plane_modes(model(2, 3), 41.0, 18.0)
    assert swing == 0
    frequencies, swing = plane_modes(model(2, 3), 41.0, 0.65)
    assert swing == 1
    assert_allclose(frequencies[swing], np.sqrt(9.81 / 0.65), rtol=0.02)


def test_tower_frequency_falls_as_the_trolley_travels():
    for jib_vertical_modes in (0, 3):
        found = [plane_modes(model(2, jib_vertical_modes), x, 18.0)[0][1] for x in np.linspace(5, 41, 10)]
        assert np.all(np.diff(found) < 0)


def test_linear_frequencies_of_the_rigid_jib():
    assert_allclose(plane_modes(model(8, 0), 5.0, 18.0)[0][1:4] / 2 / np.pi, [0.4757, 1.8356, 18.574], rtol=2e-4)


def test_small_swing_has_the_linear_frequency():
    result = simulate(
        model(2, 3, self_weight=False),
        standing(20.0, 18.0),
        200.0,
        start=Start(along=1e-4),
        output_step=0.01,
        rtol=1e-11,
    )
    angle, time = result["sway_radial"].values, result.time.values
    angle = angle - angle.mean()
    up = np.flatnonzero((angle[:-1] < 0) & (angle[1:] >= 0))
    crossings = time[up] - angle[up] * 0.01 / (angle[up + 1] - angle[up])
    measured = 2 * np.pi * (len(crossings) - 1) / (crossings[-1] - crossings[0])
    # The weight of trolley and load bends the crane: a second-order effect of 1e-4 on the pendulum.
    assert_allclose(measured, plane_modes(model(2, 3), 20.0, 18.0)[0][0], rtol=3e-4)

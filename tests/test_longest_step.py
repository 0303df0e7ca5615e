"""The longest step that feeds no vibration: what a pair's reach is, what vibrates fastest, what a run gains by it."""

import warnings

import numpy as np
import pytest
import qtz5613
import space_crane
from scipy.linalg import eigh

from towercrane.cranes.small_motions import fastest_vibration, linear_matrices
from towercrane.motion import smooth_ramps
from towercrane.simulate import simulate
from towercrane.tableaus import DOP853, DOPRI5, REACH_USED


def growth(tableau, z):
    """Factor of one step of y' = i w y with z = w h, from the stages themselves."""
    slopes = np.zeros(tableau.stages + 1, dtype=complex)
    for stage in range(tableau.stages + 1):
        slopes[stage] = 1.0 + 1j * z * (tableau.a[stage, :stage] @ slopes[:stage])
    return abs(slopes[-1])


def test_no_step_within_its_reach_makes_a_vibration_grow_and_longer_ones_do():
    within = np.linspace(0.01, DOP853.reach, 2000)
    assert max(growth(DOP853, z) for z in within) <= 1.0 + 1e-14
    assert growth(DOP853, DOP853.reach + 0.02) > 1.0
    assert growth(DOP853, REACH_USED * DOP853.reach) < 0.8


def test_a_pair_that_feeds_all_vibrations_has_no_reach():
    assert growth(DOPRI5, 1.0) > 1.0
    assert np.isinf(DOPRI5.longest_step(lambda: 3.0))
    assert np.isinf(DOP853.longest_step(None))
    assert np.isinf(DOP853.longest_step(lambda: 0.0))
    assert DOP853.longest_step(lambda: 3.0) == pytest.approx(REACH_USED * DOP853.reach / 3.0)


@pytest.mark.parametrize(
    "scene",
    [
        qtz5613.model(2, 3).scene,
        qtz5613.model(2, 3, load=20_000.0).scene,
        qtz5613.model(0, 2).scene,
        space_crane.model(),
        space_crane.model(tower=1, torsion=0, lateral=1, vertical=1),
    ],
)
def test_nothing_vibrates_faster_than_the_unloaded_crane_with_its_trolley_at_the_tower(scene):
    fastest = fastest_vibration(scene)
    found = []
    for trolley in np.linspace(0.0, scene.crane.jib_length, 9):
        drives = np.zeros(len(scene.channels))
        drives[:2] = trolley, 7.0
        mass, stiffness = linear_matrices(scene, drives)
        found.append(np.sqrt(eigh(stiffness, mass, eigvals_only=True)[-1]))
    assert max(found) < 1.02 * fastest
    # And it is no idle bound: with little on the rope the crane comes near it.
    assert max(found) > (0.98 if scene.load.mass < 2000.0 else 0.8) * fastest


def test_a_crane_without_coordinates_of_its_own_bounds_no_step():
    assert fastest_vibration(qtz5613.model(0, 0).scene) == 0.0


def test_no_burst_of_the_fastest_mode_at_any_loose_tolerance():
    """Steps at the edge of stability feed the fastest mode until the error estimate sees it: once in fifty runs by a
    thousand times the median error, in others by ten."""
    ramps = {**qtz5613.motions(), "trolley": smooth_ramps(41.0, -0.6, 2.5, 40.0)}
    crane = qtz5613.model(2, 3)
    exact = simulate(crane, ramps, 80.0, rtol=1e-10, atol=1e-12)["tower_tip_displacement"].values
    errors, rejected = [], []
    for k in range(40):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            rtol = 10.0 ** (-2.0 - 0.05 * k)
            run = simulate(crane, ramps, 80.0, rtol=rtol, atol=1e-2 * rtol)
        errors.append(abs(run["tower_tip_displacement"].values - exact).max() / abs(exact).max())
        rejected.append(run.attrs["steps_rejected"])
    assert max(errors) < 1e-6
    assert max(errors) < 3.0 * min(errors)
    assert max(rejected) <= 3

"""The longest step that feeds no vibration: what a pair's reach is, what vibrates fastest, what a run gains by it."""

import dataclasses
import warnings

import numpy as np
import pytest
from samples import lab_crane, qtz5613, space_crane
from scipy.linalg import eigh

from modal import Chain, EndBody, Foundation, Segment
from towercrane.cranes.slewing.description import Drive
from towercrane.cranes.tower.equations.small_motions import linear_matrices
from towercrane.kernels.load import Load
from towercrane.linear.linearise import linearise
from towercrane.motions.motion import rest
from towercrane.motions.profiles import smooth_ramps, trapezoid
from towercrane.simulation.methods.runge_kutta import REACH_USED
from towercrane.simulation.methods.tableaus import DOP853, DOPRI5
from towercrane.simulation.simulate import simulate


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
        qtz5613.model(2, 3),
        qtz5613.model(2, 3, load=20_000.0),
        qtz5613.model(0, 2),
        space_crane.model(),
        space_crane.model(tower=1, torsion=0, lateral=1, vertical=1),
    ],
)
def test_nothing_vibrates_faster_than_the_unloaded_crane_with_its_trolley_at_the_tower(scene):
    fastest = scene.fastest
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
    assert qtz5613.model(0, 0).fastest == 0.0


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


def fastest_of(model, motions) -> float:
    """Highest angular frequency of the linear model, drives held: from differences of the right-hand side."""
    return max(e.value.imag for e in linearise(model, motions, outputs=[]).eigenvalues())


STIFF = {"drive_soft_stiffness": 3e5, "drive_stiff_stiffness": 3e5}


@pytest.mark.parametrize("kind", lab_crane.PARAMETERS)
@pytest.mark.parametrize("changes", [{}, STIFF], ids=["drive", "stiff drive"])
def test_nothing_of_a_slewing_crane_vibrates_faster_than_it_says(kind, changes):
    model = lab_crane.lossless(kind, **{"drive_soft_stiffness": 750.0} | changes)
    found = fastest_of(model, {"shaft": rest(0.0), "rope": rest(2.0)})
    assert found < 1.01 * model.fastest_on(2.0) < 1.6 * found


@pytest.mark.parametrize("stiffness", [1e6, 1e9])
def test_the_drive_of_a_crane_in_space_is_among_what_vibrates(stiffness):
    drive = Drive("slewing", 0.01 * stiffness, stiffness, 1e-9, 0.0, "none")
    model = space_crane.model(tower=1, torsion=1, lateral=1, vertical=1, slewing=drive)
    found = fastest_of(model, {"trolley": rest(3.0), "rope": rest(15.0), "shaft": rest(0.4)})
    assert found < 1.02 * model.fastest < 1.1 * found


def test_a_foundation_is_among_what_vibrates():
    # A light block on a stiff spring shakes faster than the tower on it.
    block = {0: EndBody(mass=200.0, rotary_inertia=500.0)}
    tower = Chain((Segment(23.8, 350.0, 206e9 * 0.014),), block, foundation=Foundation(5e9, 4e9))
    model = qtz5613.in_plane(dataclasses.replace(qtz5613.CRANE, tower=tower), Load(800.0), 6, 3)
    found = fastest_of(model, qtz5613.standing(3.0, 18.0))
    assert found < 1.02 * model.fastest < 1.1 * found


def test_another_load_has_the_longest_step_of_a_model_made_anew():
    for softened in (False, True):
        light, heavy = (qtz5613.model(2, 3, load=load, weight_softening=softened) for load in (800.0, 200_000.0))
        found = light.with_load(Load(200_000.0)).system.fastest()
        assert found == heavy.system.fastest()
        assert (found == light.system.fastest()) != softened


def test_a_drive_stiffer_than_the_crane_does_not_ring_at_loose_tolerances():
    drive = Drive("slewing", 1e9, 1e9, 0.001, 0.0, "none")
    model = space_crane.model(tower=1, torsion=1, lateral=1, vertical=1, slewing=drive)
    motions = {"trolley": rest(30.0), "rope": rest(15.0), "shaft": trapezoid(0.0, 0.1, 0.06, 0.06)}
    runs = {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for rtol in (1e-3, 1e-10):
            runs[rtol] = simulate(model, motions, 4.0, rtol=rtol, atol=1e-2 * rtol)["slewing_torque"].values
    assert abs(runs[1e-3] - runs[1e-10]).max() < 5e-3 * abs(runs[1e-10]).max()


@pytest.mark.parametrize(("kind", "error"), [("basic", 0.1), ("enhanced", 3e-3), ("multi-mass", 5e-3)])
def test_no_mode_of_a_slewing_crane_rings_at_loose_tolerances(kind, error):
    runs = {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for rtol in (1e-3, 1e-10):
            run = simulate(lab_crane.crane(kind), lab_crane.motions(), 10.0, rtol=rtol, atol=1e-2 * rtol)
            runs[rtol] = run["hoist_rope_force"].values
    assert abs(runs[1e-3] - runs[1e-10]).max() < error * np.ptp(runs[1e-10])

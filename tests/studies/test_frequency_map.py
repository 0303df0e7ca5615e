"""The frequency map: its numbers are the structure's, its branches have names, a tower that buckles is named."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.plane_crane import FRAME, HEIGHT, REACH, TOWER

from modal import Chain, EndBody, Segment, crane_structure
from towercrane.studies.frequency_map import branch_names, buckling_factor, doubtful_steps, frequency_map

POSITIONS = np.linspace(0.0, REACH, 9)
PAYLOADS = (200.0, 800.0, 3200.0)


@pytest.fixture(scope="module")
def data():
    return frequency_map(FRAME, POSITIONS, PAYLOADS, modes=5)


def test_frequencies_are_those_of_the_structure(data):
    for i, mass in enumerate(PAYLOADS):
        for j, position in enumerate(POSITIONS):
            exact = crane_structure(replace(FRAME, payload_mass=mass), position).angular_frequencies(5)
            assert_allclose(np.sort(data.frequency.values[i, j]), exact / (2.0 * np.pi), rtol=1e-11)


def test_load_slows_every_branch_but_the_swing_and_only_away_from_the_tower(data):
    # Rayleigh: more mass lowers no mode but by the rope's pull, a thousandth here.
    change = np.diff(data.frequency.values[:, :, 1:], axis=0) / data.frequency.values[:-1, :, 1:]
    assert change.max() < 1e-3
    assert np.abs(change[:, 0]).max() < 1e-3
    assert change[:, -1].min() < -0.1


def test_branches_are_named_after_what_holds_their_energy(data):
    names = data.branch.values.tolist()
    assert names[0] == "load swing"
    assert len(set(names)) == 5
    assert {"first jib bending", "first tower bending"} <= set(names)
    assert_allclose(data.energy_share.sum("member"), 1.0, rtol=1e-12)
    shares = np.zeros((1, 1, 4, 6))
    shares[0, 0, [0, 1, 2, 3], [1, 0, 1, 5]] = 1.0
    named = branch_names(np.array([[[3.0, 2.0, 1.0, 0.1]]]), shares)
    assert named == ["second jib bending", "first tower bending", "first jib bending", "load swing"]


def test_jib_that_the_tower_does_not_feel_crosses_the_tower_straight_through():
    # The trolley's mass slows the jib past a tower that is all but rigid in rotation: so heavy a body turns no more.
    tower = replace(TOWER, bodies={1: EndBody(17000.0, 1e13)})
    frame = replace(FRAME, tower=tower, jib=Chain((Segment(REACH, 120.0, 1.6e10),)), rope_length=100.0)
    places = np.linspace(1.0, REACH, 12)
    found = frequency_map(frame, places, [4000.0], modes=4)
    ranks = np.argsort(np.argsort(found.frequency.values[0], axis=1), axis=1)
    assert (np.ptp(ranks, axis=0) > 0).sum() == 2
    jib = int(np.flatnonzero(found.branch.values == "first jib bending")[0])
    other = int(np.flatnonzero((np.ptp(ranks, axis=0) > 0) & (np.arange(4) != jib))[0])
    assert np.ptp(found.frequency.values[0, :, jib]) > 0.3
    assert np.ptp(found.frequency.values[0, :, other]) < 0.01
    assert doubtful_steps(found) == []


def test_buckling_factor_of_a_column_under_its_head():
    # Of a light tower the load alone counts: Euler's column, clamped and free.
    light = replace(FRAME, tower=Chain((Segment(HEIGHT, 1e-3, 2.9e9),)), jib=Chain((Segment(REACH, 1e-3, 7e8),)))
    carried = (light.trolley_mass + light.payload_mass) * 9.81
    assert_allclose(buckling_factor(light), np.pi**2 * 2.9e9 / (4.0 * HEIGHT**2) / carried, rtol=1e-4)
    assert_allclose(buckling_factor(light, 33.0), buckling_factor(light), rtol=1e-12)


@pytest.mark.parametrize("gravity", [0.0, 9.81])
def test_payload_that_buckles_the_tower_is_named_and_the_others_are_kept(gravity):
    slender = replace(FRAME, tower=replace(TOWER, segments=(Segment(HEIGHT, 350.0, 9e7),), gravity=gravity))
    found = frequency_map(slender, [0.0, 25.0], [500.0, 30000.0], modes=3)
    assert found.attrs["outcome"] == "tower buckled"
    assert found.outcome.values.tolist() == ["finished", "tower buckled"]
    assert found.buckling_factor[0] > 1.0 > found.buckling_factor[1]
    assert np.isfinite(found.frequency[0]).all()
    assert np.isnan(found.frequency[1]).all()
    none = frequency_map(slender, [25.0], [30000.0, 40000.0], modes=2)
    assert none.outcome.values.tolist() == ["tower buckled"] * 2
    assert none.branch.values.tolist() == ["mode 1", "mode 2"]


def test_lost_branch_is_reported(data):
    assert doubtful_steps(data) == []
    lost = data.copy(deep=True)
    lost.shape_agreement[1, 3, 2] = 0.4
    assert doubtful_steps(lost) == [(800.0, float(POSITIONS[3]), 3)]


def test_progress_reaches_its_end():
    seen = []
    frequency_map(FRAME, [0.0, REACH], [500.0, 800.0], modes=1, progress=seen.append)
    assert seen[-1] == 1.0
    assert 0.0 <= min(seen) <= max(seen) <= 1.0


@pytest.mark.parametrize(
    ("positions", "payloads", "modes", "message"),
    [
        ([], [800.0], 3, "positions: wanted one or more ascending finite numbers"),
        ([5.0, 5.0], [800.0], 3, "positions: wanted one or more ascending"),
        ([5.0, np.nan], [800.0], 3, "positions: wanted one or more ascending"),
        ([-1.0, 5.0], [800.0], 3, "positions: wanted 0 to 50 m, got -1 to 5"),
        ([5.0, 50.1], [800.0], 3, "positions: wanted 0 to 50 m, got 5 to 50.1"),
        ([5.0], [800.0, 400.0], 3, "payloads: wanted one or more ascending"),
        ([5.0], [0.0, 400.0], 3, "payloads: wanted masses above 0 kg, got 0 to 400"),
        ([5.0], [800.0], 0, "modes: wanted one or more, got 0"),
    ],
)
def test_bad_arguments_are_named(positions, payloads, modes, message):
    with pytest.raises(ValueError, match=message):
        frequency_map(FRAME, positions, payloads, modes=modes)

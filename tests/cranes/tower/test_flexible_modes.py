"""Small motions of the flexible crane: against finite elements, known figures, and in any heading."""

import dataclasses

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles import space_frame
from samples import flat_top_crane as flat_top
from samples import space_crane as space

from modal import crane_structure
from towercrane.cranes.tower.crane_model import tower_crane_model
from towercrane.cranes.tower.equations.small_motions import MOTION_KINDS, linear_matrices, natural_modes, plane_modes
from towercrane.cranes.tower.modes.mode_counts import ModeCounts
from towercrane.cranes.tower.modes.parameters import TowerCrane
from towercrane.kernels.load import Load
from towercrane.linear.linearise import linearise
from towercrane.motions.motion import rest
from towercrane.simulation.system import NoEquilibrium

STATES = [(0.0, 10.0, 20.0), (0.7, 25.0, 15.0), (1.3, 40.0, 12.0), (-2.0, 40.0, 20.0), (2.6, 50.0, 15.0)]
"""Heading [rad], trolley and rope [m]."""


def structural(scene, heading, trolley):
    """Frequencies without gravity: the load moves with the trolley vertically and not at all horizontally."""
    inputs = np.array([[trolley, 0, 0], [10.0, 0, 0], [heading, 0, 0]])
    n, at_rest = scene.coordinates, scene.at_rest(np.zeros(scene.coordinates), inputs)
    up = at_rest.jacobian[2]
    mass = at_rest.mass_matrix() + scene.load.mass * np.outer(up, up)
    _, stiffness = linear_matrices(scene, inputs[:, 0])
    return 1.0 / np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(stiffness[:n, :n], mass)).real)[::-1])


@pytest.mark.parametrize("state", STATES)
def test_frequencies_against_beam_elements_in_space(state):
    heading, trolley, _ = state
    reference = space_frame.frequencies(space.CRANE, heading, trolley, 1500.0, 8)
    few = structural(space.model(2, 1, 3, 3), heading, trolley)[:8] / reference - 1
    many = structural(space.model(3, 2, 6, 6), heading, trolley)[:8] / reference - 1
    assert np.max(abs(few)) < 6e-3
    assert np.max(abs(few[:4])) < 2e-4
    assert np.max(abs(many)) < 2e-4
    # A Ritz model is too stiff, never too soft.
    assert min(few.min(), many.min()) > -1e-6


def test_frequencies_at_equilibrium_are_known():
    found = natural_modes(space.model(3, 2, 6, 6), 40.0, 12.0)
    hz = [mode.frequency_hz for mode in found[:7]]
    assert_allclose(hz[:3], [0.10204, 0.14379, 0.17704], atol=1.5e-5)
    assert_allclose(hz[3:], [0.2977, 0.536, 0.802, 1.376], rtol=1e-3)
    kinds = [mode.kind for mode in found[:7]]
    assert kinds == ["torsion", "radial sway", "lateral sway", "radial", "lateral", "radial", "lateral"]
    for mode in found:
        assert set(mode.shares) == set(MOTION_KINDS)
        assert sum(mode.shares.values()) == pytest.approx(1.0, abs=1e-12)
        across = mode.shares["lateral"] + mode.shares["torsion"] + mode.shares["lateral sway"]
        assert min(across, 1.0 - across) < 1e-9


@pytest.mark.parametrize(
    ("trolley", "rope", "pair"),
    [(10, 20, (0.1094, 0.1319)), (25, 15, (0.1100, 0.1499)), (40, 20, (0.0927, 0.1511)), (50, 15, (0.0915, 0.1729))],
)
def test_lateral_pair_lies_on_both_sides_of_the_pendulum(trolley, rope, pair):
    modes = natural_modes(space.model(2, 1, 3, 3), float(trolley), float(rope))
    sideways = [m for m in modes if m.shares["torsion"] + m.shares["lateral sway"] > 0.5][:2]
    assert_allclose([m.frequency_hz for m in sideways], pair, atol=1.2e-4)
    radial = next(m for m in modes if m.kind == "radial sway")
    assert_allclose(radial.angular_frequency, np.sqrt(9.81 / rope), rtol=2e-3)


def test_heading_changes_neither_frequencies_nor_kinds():
    scene = space.model(2, 1, 2, 2)
    straight, turned = natural_modes(scene, 30.0, 15.0), natural_modes(scene, 30.0, 15.0, 2.2)
    assert_allclose([m.frequency_hz for m in turned], [m.frequency_hz for m in straight], rtol=1e-8)
    for a, b in zip(straight, turned, strict=True):
        assert a.kind == b.kind
        assert_allclose(list(a.shares.values()), list(b.shares.values()), atol=1e-6)


def test_modes_are_those_of_the_linear_model():
    scene = space.model(1, 1, 2, 2, weight_softening=True)
    drives = {"trolley": rest(30.0), "rope": rest(15.0), "slewing": rest(0.9)}
    expected = linearise(scene, drives, outputs=["slewing_torque"]).frequencies
    found = [mode.frequency_hz for mode in natural_modes(scene, 30.0, 15.0, 0.9)]
    assert_allclose(found, expected, rtol=1e-7)


def test_buckling_in_space_is_named():
    weak = dataclasses.replace(space.CRANE.tower, second_moment_of_area=0.014 / 400)
    scene = space.model(2, 1, 1, 1, crane=dataclasses.replace(space.CRANE, tower=weak), weight_softening=True)
    with pytest.raises(NoEquilibrium, match=r"would carry 0\.\d+ times the weight"):
        natural_modes(scene, 30.0, 15.0)
    with pytest.raises(ValueError, match="wanted 3, a load in space, got 2"):
        natural_modes(space.model(1, 0, 0, 1, planes=1, slewing="fixed", axes=2), 30.0, 15.0)


@pytest.mark.parametrize(("modes", "errors"), [(1, (1.1e-4, 1.2e-3)), (2, (1.7e-5, 4e-4)), (10, (2.6e-6, 3e-5))])
def test_modes_of_a_jib_of_segments_tend_to_the_exact_crane(modes, errors):
    written = TowerCrane(
        "flat-top", flat_top.TOWER, flat_top.JIB, 15.0, 0.0, 0.0, 420.0, counter_jib=flat_top.COUNTER_JIB
    )
    counts = ModeCounts(10, 0, 0, modes, 0, 4)
    found, _ = plane_modes(tower_crane_model(written, Load(2000.0), counts, planar=True), 40.0, 20.0)
    exact = crane_structure(flat_top.FRAME, 40.0).angular_frequencies(3)
    gaps = found[1:3] / exact[1:3] - 1.0
    # Modes left out stiffen; ten of the tower leave less than these.
    assert np.all(gaps > 0.35 * np.array(errors))
    assert np.all(gaps < errors)

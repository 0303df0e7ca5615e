"""Capped modes: the same static flexibility, the same slow vibration, energy kept."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from samples.qtz5613 import in_plane, model, motions

from towercrane import load_case
from towercrane.cranes.tower.equations.small_motions import plane_modes
from towercrane.cranes.tower.file.build import crane_of
from towercrane.cranes.tower.modes.frequency_cap import added_mass
from towercrane.cranes.tower.modes.parameters import as_chain
from towercrane.linear.linearise import linearise
from towercrane.motions.motion import rest
from towercrane.simulation.simulate import simulate
from towercrane.simulation.starts.start import Start

CAP = 8.0


def test_added_mass_slows_a_mode_to_the_cap_and_spares_the_first_two():
    omega = 2.0 * np.pi * np.array([9.0, 12.0, 16.0, 4.0])
    added = added_mass(omega, np.array([0, 1, 2, 3]), CAP)
    np.testing.assert_allclose(omega / np.sqrt(1.0 + added) / (2.0 * np.pi), [9.0, 12.0, 8.0, 4.0])


def test_static_flexibility_is_that_of_all_modes():
    inputs = np.zeros((2, 3))
    inputs[:, 0] = 41.0, 18.0
    plain, capped = (model(4, 8, cap=cap).equilibrium(inputs) for cap in (np.inf, CAP))
    np.testing.assert_allclose(capped, plain, rtol=1e-9)
    assert model(2, 2).equilibrium(inputs)[0] != pytest.approx(plain[0], rel=1e-9)


def test_frequencies_below_the_cap_stay():
    plain, capped = (plane_modes(model(4, 8, cap=cap), 41.0, 18.0)[0] / (2.0 * np.pi) for cap in (np.inf, CAP))
    slow = plain < CAP / 2.5
    change = abs(capped[slow] / plain[slow] - 1.0)
    assert slow.sum() == 5
    assert 1e-6 < change.max() < 3e-4
    assert plain.max() > 60.0
    assert CAP < capped.max() < 1.2 * CAP


def test_a_capped_run_follows_the_uncapped_one():
    runs = {cap: simulate(model(4, 6, cap=cap), motions(), 60.0, rtol=1e-7) for cap in (np.inf, CAP)}
    for name, low, high in (("tower_tip_displacement", 1e-9, 1e-6), ("jib_tip_deflection", 1e-8, 1e-5)):
        one, other = (run[name].values for run in runs.values())
        assert low < abs(one - other).max() / abs(one).max() < high
    assert runs[CAP].attrs["evaluations"] < 0.3 * runs[np.inf].attrs["evaluations"]
    assert (runs[np.inf].attrs["frequency_cap"], runs[CAP].attrs["frequency_cap"]) == (0.0, CAP)


@pytest.mark.parametrize("tower", ["beam", "chain"])
def test_a_capped_crane_keeps_its_energy(tower):
    crane = crane_of(load_case("qtz5613/condition-3").checked)
    if tower == "chain":
        crane = replace(crane, tower=as_chain(crane.tower))
    capped = in_plane(crane, model().load, 4, 6, cap=CAP, rope_as_rod=True)
    run = simulate(capped, motions(), 60.0, start=Start("zero"), rtol=1e-10, atol=1e-12)
    energy, work = run["total_energy"].values, run["input_work"].values
    assert run.attrs["outcome"] == "finished"
    assert abs(energy - energy[0] - work).max() < 1e-8 * np.ptp(energy)


@pytest.mark.parametrize("cap", [np.inf, CAP])
def test_every_mode_is_damped_as_stated_whether_a_cap_slows_it_or_not(cap):
    # Little on the jib and rope: the modes are those of the members.
    tower, jib = 0.02, 0.03
    crane = model(4, 6, load=1e-6, cap=cap, damping=(tower, jib))
    mass = 1.0 + crane.added_mass
    ratios = crane.constants.damping / (2.0 * np.sqrt(mass) * crane.angular_frequencies)
    np.testing.assert_allclose(ratios, np.repeat([tower, jib], [4, 6]), rtol=1e-14)
    # And so the solver has it: of the fastest, most of whose energy is one mode's, by its eigenvalue.
    linear = linearise(crane, {"trolley": rest(0.0), "rope": rest(10.0)}, outputs=[])
    fastest = max(linear.eigenvalues(), key=lambda e: e.frequency)
    assert min(tower, jib) < fastest.damping_ratio < 1.3 * max(tower, jib)


def test_bad_cap():
    with pytest.raises(ValueError, match=r"cap: wanted a positive frequency \[Hz\], got -1"):
        model(cap=-1.0)

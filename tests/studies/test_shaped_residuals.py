"""What shaped motions of the crane in space leave of the load's sway, against known figures."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples import space_crane as space

from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.cranes.tower.sway_frequencies import PendulumFrequencies, SwayFrequencies
from towercrane.motions.motion import rest
from towercrane.motions.plans import Move, Plan, Shaping, shaped_motions
from towercrane.motions.shaping import boxes, ei, minimum_jerk, zv, zvd
from towercrane.studies.rest_study import attempt, resting_place

DAMPED = ModalDamping(0.01, 0.01, 0.01, 0.01)
SLEWING = {"trolley": rest(30.0), "rope": rest(15.0), "slewing": space.manoeuvre()["slewing"]}


@pytest.fixture(scope="module")
def scene():
    return space.model(2, 1, 3, 3, damping=DAMPED)


def shaped(motions, design, frequencies, hoist=False):
    """Motions with every ramp of trolley and slewing, or of all drives, shaped."""
    plain = () if hoist else ("rope",)
    plans = {
        c: Plan((Move(m, None if c in plain or not m.duration else Shaping(design)),)) for c, m in motions.items()
    }
    return shaped_motions(plans, frequencies)


def test_slewing_alone_leaves_what_other_programs_found(scene):
    # Load 1500 kg at 30 m on 15 m of rope, 90 degrees: figures [m, kN m] of an independent program with more modes.
    sway, pendulum = SwayFrequencies(scene), PendulumFrequencies(9.81)
    trials = {
        "commanded": (attempt(scene, SLEWING), 5.923, 397.0),
        "pendulum": (attempt(scene, shaped(SLEWING, zv, pendulum)), 1.655, 200.0),
        "zv": (attempt(scene, shaped(SLEWING, zv, sway)), 0.075, 105.0),
        "zvd": (attempt(scene, shaped(SLEWING, zvd, sway)), 0.010, 71.0),
        "ei": (attempt(scene, shaped(SLEWING, ei, sway)), 0.057, 68.0),
        "boxes": (attempt(scene, shaped(SLEWING, boxes, sway)), 0.040, 87.0),
        "minimum jerk": (attempt(scene, SLEWING | {"slewing": minimum_jerk(0, np.pi / 2, 47.6)}), 0.118, 55.0),
    }
    for name, (trial, residual, torque) in trials.items():
        assert trial.outcome == "finished"
        assert_allclose(trial.residual, residual, atol=0.004 if residual > 0.02 else 6e-4, rtol=0, err_msg=name)
        assert_allclose(1e-3 * trial.torque, torque, atol=0.6, rtol=0.025, err_msg=name)


def test_slewing_shaped_stays_calm_with_another_rope_and_another_tower(scene):
    motions = shaped(SLEWING, zvd, SwayFrequencies(scene))
    assert_allclose([attempt(scene, motions, f).residual for f in (0.8, 1.2)], [0.006, 0.030], atol=1.2e-3)
    assert_allclose(attempt(scene, motions, torsion=0.7).residual, 0.05, atol=6e-3)
    assert_allclose(attempt(scene, motions, torsion=0.85).residual, 0.02, atol=6e-3)
    zero_vibration = shaped(SLEWING, zv, SwayFrequencies(scene))
    assert_allclose(
        [attempt(scene, zero_vibration, torsion=f).residual for f in (0.7, 0.85)], [0.59, 0.27], atol=0.02
    )


def test_slewing_trolley_and_hoist_together(scene):
    known = dict(zip((0.8, 1.0, 1.2), (2.822, 4.006, 4.916), strict=True))
    for rope, residual in known.items():
        assert_allclose(attempt(scene, space.manoeuvre(), rope).residual, residual, atol=1e-3)
    sway = SwayFrequencies(scene)
    assert_allclose(attempt(scene, shaped(space.manoeuvre(), zvd, sway)).residual, 0.022, atol=1e-3)
    assert_allclose(attempt(scene, shaped(space.manoeuvre(), ei, sway)).residual, 0.042, atol=2e-3)
    # A pendulum's frequency, even at each ramp, leaves twenty times as much.
    assert attempt(scene, shaped(space.manoeuvre(), zvd, PendulumFrequencies(9.81))).residual > 0.4
    # To shape the hoist as well is no gain: its speed, not its ramps, stirs the load.
    assert attempt(scene, shaped(space.manoeuvre(), zvd, sway, hoist=True)).residual > 0.024


def test_a_tower_of_other_torsional_stiffness_is_the_scaled_one():
    stiffer = replace(space.CRANE, shaft=replace(space.CRANE.shaft, torsional_stiffness=1.3 * 1.7e8))
    built, plain = space.model(1, 2, 1, 1, crane=stiffer), space.model(1, 2, 1, 1)
    scaled = replace(plain, crane=replace(plain.crane, torsion=plain.crane.torsion.with_stiffness(1.3)))
    assert_allclose(SwayFrequencies(scaled)("slewing", 30, 15), SwayFrequencies(built)("slewing", 30, 15), rtol=1e-9)
    assert scaled.crane.torsion.count == 2


def test_resting_place_is_where_a_damped_run_ends():
    crane = space.model(1, 1, 1, 1, damping=ModalDamping(0.3, 0.3, 0.3, 0.3))
    place = resting_place(crane, SLEWING)
    # Nearly across: 30 m along y, less what jib and tower give under the weights.
    assert_allclose(place, [0.0, 30.0], atol=1.5)
    assert abs(place[0]) < 1e-9
    held = {c: rest(m.end) for c, m in SLEWING.items()}
    assert attempt(crane, held).residual < 1e-9

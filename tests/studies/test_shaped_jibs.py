"""What shaped motions leave of the load's sway under a jib that luffs, and under one on ties."""

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples import hammerhead, luffing_crane
from samples.program import towercrane

from towercrane.cranes.tower.equations.small_motions import natural_modes
from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.cranes.tower.sway_frequencies import PendulumFrequencies, SwayFrequencies
from towercrane.motions.motion import rest
from towercrane.motions.plans import Move, Plan, Shaping, shaped_motions
from towercrane.motions.profiles import trapezoid
from towercrane.motions.shaping import zv, zvd
from towercrane.studies.rest_study import attempt

DAMPED = ModalDamping(0.01, 0.01, 0.01, 0.01, 0.01, 0.01)
LUFF = {"luffing": trapezoid(*np.radians([35.0, 60.0, 1.0, 0.5])), "rope": rest(25.0)}
TRAVEL = {"trolley": trapezoid(12.0, 34.5, 1.0, 0.25), "rope": rest(20.0)}


def shaped(motions, design, frequencies):
    plans = {c: Plan((Move(m, Shaping(design) if m.duration else None),)) for c, m in motions.items()}
    return shaped_motions(plans, frequencies)


@pytest.fixture(scope="module")
def luffing():
    crane = luffing_crane.crane(reference_angle=np.radians(35.0))
    options = {"slewing": "fixed", "axes": 2, "planes": 1, "damping": DAMPED}
    return luffing_crane.model(1, 0, 0, 1, load=3000.0, crane=crane, **options)


def test_a_luffing_move_that_is_shaped_for_the_rope_as_it_hangs_leaves_the_load_calm(luffing):
    """Frequencies of a rigid crane with the rope as it hangs below its head nearly do."""
    pendulum = PendulumFrequencies(9.81, luffing.crane)
    plain, rigid, exact, twice = (
        attempt(luffing, motions).residual
        for motions in (
            LUFF,
            shaped(LUFF, zv, pendulum),
            shaped(LUFF, zv, SwayFrequencies(luffing)),
            shaped(LUFF, zvd, SwayFrequencies(luffing)),
        )
    )
    assert plain > 1.5
    assert rigid < 0.06 * plain
    assert exact < 0.05 * plain
    assert twice < 0.01 * plain
    assert attempt(luffing, LUFF).force == pytest.approx(3e5, rel=0.2)


def test_the_rope_below_a_straight_head_is_what_the_equations_have(luffing):
    """Against the model of a crane that hardly gives."""
    own = luffing_crane.crane(reference_angle=np.radians(35.0), rope_stiffness=1e13)
    stiff = luffing_crane.model(0, 0, 0, 0, load=3000.0, crane=own)
    for angle in np.radians([35.0, 50.0, 70.0]):
        (expected,) = PendulumFrequencies(9.81, stiff.crane)("luffing", angle, 25.0)
        modes = natural_modes(stiff, angle, 25.0)
        found = max(modes, key=lambda mode: mode.shares["radial sway"]).frequency_hz
        assert found == pytest.approx(expected, rel=1e-4)
    inputs = np.array([[np.radians(70.0), 0.0, 0.0], [25.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    below = own.luffing.below(50.0, np.radians(70.0), 25.0)
    assert_allclose(stiff.rope_at_rest(stiff.equilibrium(inputs), inputs), below, rtol=1e-4)


def test_a_trolley_on_a_jib_on_ties_is_shaped_as_on_any_other():
    model = hammerhead.model(1, 0, 0, 0, back=0, planes=1, axes=2, slewing="fixed", damping=DAMPED)
    left = [attempt(model, motions).residual for motions in (TRAVEL, shaped(TRAVEL, zvd, SwayFrequencies(model)))]
    assert left[0] > 0.2
    assert left[1] < 0.03 * left[0]


def test_the_command_proposes_luffing_moves(tmp_path):
    changes = (
        "motion.luffing.hold=11 s", "motion.luffing.speed=1 deg/s", "motion.slewing.speed=0 rad/s",
        "motion.hoist.end=30 m", "model.tower_modes=0", "model.jib_vertical_modes=0", "model.torsion_modes=0",
        "model.jib_lateral_modes=0",
    )  # fmt: skip
    options = [part for change in changes for part in ("--set", change)]
    done = towercrane("shape", "luffing/manoeuvre", *options, "--out", tmp_path)
    assert done.returncode == 0, done.stderr
    assert "luffing rope force" in done.stdout
    assert "luffing excites" in done.stdout
    assert {path.name for path in tmp_path.iterdir()} == {
        "shape.json", "drive-luffing.csv", "residuals.png", "profiles.png",
    }  # fmt: skip
    report = json.loads((tmp_path / "shape.json").read_text("utf-8"))
    found = {row["name"]: row for row in report["candidates"]}
    assert found["zvd"]["residual_m"] < 0.05 * found["commanded"]["residual_m"]
    assert 2e5 < found["zvd"]["peak_luffing_rope_force_N"] < 6e5
    assert "position [rad]" in (tmp_path / "drive-luffing.csv").read_text("utf-8")

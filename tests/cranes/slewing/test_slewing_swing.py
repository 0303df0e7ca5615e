"""Slewing cranes' loads that swing far, long and on ever shorter ropes: within tolerance, or a named outcome."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.balance import imbalance
from samples.lab_crane import PARAMETERS, crane, lossless, motions, run
from scipy.special import ellipj, ellipk

from towercrane.cranes.slewing import equations
from towercrane.cranes.slewing.description import Drive, Link, LumpedCrane, Point
from towercrane.cranes.slewing.model import LumpedModel
from towercrane.kernels.load import Load
from towercrane.motions.motion import phases, rest
from towercrane.motions.profiles import trapezoid
from towercrane.simulation.starts.begin import begin
from towercrane.simulation.starts.start import Start

STILL = {"shaft": rest(0.0), "rope": rest(2.0)}


def at_rest(model: LumpedModel, rope: float = 2.0) -> np.ndarray:
    return model.start(phases((rest(0.0), rest(rope)), 1.0).inputs[0])


# --- the load over the horizontal ----------------------------------------------------------------------


def pushed(model: LumpedModel, outward: float, ahead: float = 0.3) -> np.ndarray:
    """Start at rest but for the load's speed [m/s]."""
    state, first = at_rest(model), (model.size - 1) // 2 + model.rope
    state[first : first + 2] = np.array([outward, ahead]) / (1.0 if model.carried.elasticity else 2.0)
    return state


@pytest.mark.parametrize("kind", PARAMETERS)
@pytest.mark.parametrize("speed", [6.5, 8.0, 10.5, 15.0])
def test_load_passes_over_the_horizontal(kind, speed):
    model = replace(lossless(kind), rope_as_rod=True)
    trajectory, outputs, _ = run(model, STILL, 10.0, pushed(model, speed), step=0.01, rtol=1e-9)
    assert trajectory.outcome == "finished"
    assert trajectory.evaluations < 120_000
    assert np.max(abs(outputs["sway_radial"])) > np.pi / 2
    energy = outputs["total_energy"]
    assert np.max(abs(energy - energy[0])) < 1e-6 * (0.5 * 50.5 * speed**2)
    n = model.rope
    if model.carried.elasticity is None:
        assert_allclose(np.linalg.norm(trajectory.states[:, n : n + 3], axis=1), 1.0, atol=1e-8)


@pytest.mark.parametrize("kind", ["multi-mass", "enhanced"])
@pytest.mark.parametrize("speed", [8.0, 10.5, 15.0])
def test_rope_goes_slack_above_the_horizontal(kind, speed):
    # The jib springs up as the load rises: the rope goes slack at speeds that would carry a load around a fixed tip.
    model = lossless(kind)
    ends = []
    for rtol in (1e-4, 1e-6, 1e-9):
        trajectory, outputs, _ = run(model, STILL, 10.0, pushed(model, speed), rtol=rtol)
        assert trajectory.outcome == "slack rope"
        _, guards = model.system.slope(0.0, trajectory.end_state, phases((rest(0.0), rest(2.0)), 1.0).inputs[0])
        assert abs(guards[equations.TENSION]) < 1e-4
        assert np.all(outputs["hoist_rope_force"] > 0.0)
        ends.append(trajectory.end_time)
    assert_allclose(ends, ends[-1], atol=1e-4)


# --- long and far --------------------------------------------------------------------------------------


def arm_alone(inertia: float, stiffness: float) -> LumpedModel:
    """The shortest crane: an arm on a coupling, and the load."""
    return LumpedModel(
        LumpedCrane(
            name="arm",
            coordinates=("platform_angle",),
            points={"tip": Point(14.0, (Link("platform_angle", {"": 2.0}),), {"": 2.2})},
            springs=(),
            drive=Drive("platform_angle", stiffness, stiffness, 0.25, 0.0, "none"),
            inertias={"platform_angle": inertia},
            suspension="tip",
            jib_angle="platform_angle",
            linear_outputs={},
        ),
        Load(50.5),
    )


def test_one_hour_of_free_swing_is_the_exact_pendulum():
    # In the jib's own plane nothing moves but the load: 60 degrees, some 1190 periods.
    model, amplitude = arm_alone(95.0, 750.0), np.radians(60)
    start = begin(model, phases((rest(0.0), rest(2.0)), 1.0).inputs[0], Start("equilibrium", along=amplitude))
    trajectory, outputs, _ = run(model, STILL, 3600.0, start, step=1.0, rtol=1e-11)
    assert trajectory.outcome == "finished"
    k, omega = np.sin(amplitude / 2), np.sqrt(9.81 / 2.0)
    sn, *_ = ellipj(ellipk(k**2) - omega * trajectory.times, k**2)
    assert_allclose(outputs["sway_radial"], 2 * np.arcsin(k * sn), atol=1e-6)
    assert np.all(outputs["platform_angle"] == 0.0)


def test_one_hour_of_free_swing_in_space_keeps_its_energy():
    model = arm_alone(95.0, 20.0)
    start = begin(model, phases((rest(0.0), rest(2.0)), 1.0).inputs[0], Start("equilibrium", along=0.8))
    start[model.size // 2 + 2] = 0.7
    trajectory, outputs, _ = run(model, STILL, 3600.0, start, step=1.0, rtol=1e-10)
    assert trajectory.outcome == "finished"
    energy = outputs["total_energy"]
    swing = 50.5 * 9.81 * 2.0 * (1 - np.cos(0.8))
    assert np.max(abs(energy - energy[0])) < 1e-6 * swing
    assert np.max(abs(np.linalg.norm(trajectory.states[:, 1:4], axis=1) - 1)) < 1e-7


def test_one_hour_with_a_loose_tolerance():
    trajectory, outputs, _ = run(crane("enhanced"), motions(), 3600.0, step=1.0, rtol=1e-4)
    assert trajectory.outcome == "finished"
    assert imbalance(outputs) < 1e-3
    late = trajectory.times > 3000
    # Drag in the square of the speed lets a small swing last: its amplitude falls as one over time.
    assert 1.0 < np.degrees(np.max(abs(outputs["sway_radial"][late]))) < 3.0
    assert np.max(abs(outputs["hoist_rope_force"][late] - 50.5 * 9.81)) < 2.0


@pytest.mark.parametrize("kind", PARAMETERS)
def test_rope_hauled_from_twenty_metres_to_one(kind):
    hauled = {"shaft": motions()["shaft"], "rope": trapezoid(20.0, 1.0, 0.8, 0.5)}
    runs = [run(crane(kind), hauled, 30.0, rtol=rtol) for rtol in (1e-6, 1e-10)]
    for trajectory, outputs, _ in runs:
        assert trajectory.outcome == "finished"
        assert np.max(abs(outputs["sway_radial"] - runs[-1][1]["sway_radial"])) < 3e-4
    assert imbalance(runs[-1][1]) < 3e-10
    assert_allclose(runs[-1][1]["rope_length"][[0, -1]], [20.0, 1.0], rtol=1e-12)


def test_small_swing_grows_as_the_rope_is_hauled_slowly():
    # Adiabatic invariant of the pendulum: energy over frequency, so the angle grows with length^(-3/4).
    model = arm_alone(95.0, 750.0)
    drive = {"shaft": rest(0.0), "rope": trapezoid(20.0, 1.0, 0.02, 0.001)}
    start = begin(model, phases((rest(0.0), rest(20.0)), 1.0).inputs[0], Start("equilibrium", along=1e-3))
    trajectory, outputs, _ = run(model, drive, 1000.0, start, step=0.1)
    assert trajectory.outcome == "finished"
    angle = abs(outputs["sway_radial"])
    before, after = angle[trajectory.times < 9.0].max(), angle[trajectory.times > 985.0].max()
    assert_allclose(after / before, 20.0**0.75, rtol=0.02)

"""Linear models about the steady rotation of whole cranes."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples import lab_crane, space_crane
from scipy.linalg import expm

from towercrane import load_case
from towercrane.linear.chart import Chart
from towercrane.linear.linearise import linearise
from towercrane.motions.motion import Motion, phases, rest
from towercrane.simulation.integrate import integrate
from towercrane.simulation.starts.begin import begin
from towercrane.simulation.starts.steady import Frame, _small_motions
from towercrane.studies.linear_report import linear_model, linear_report

SPAN = 4.0


def turn(rate):
    return Motion(np.array([0.0, SPAN]), np.array([[0.4, rate]]), rate)


STANDING = {"trolley": rest(31.0), "rope": rest(9.0)}
SCENES = {
    "slewing": lambda: (space_crane.model(1, 1, 1, 1), {**STANDING, "slewing": turn(0.0733)}),
    "platform_angle": lambda: (lab_crane.crane("multi-mass"), {"shaft": turn(0.6), "rope": rest(2.0)}),
}  # fmt: skip


@pytest.mark.parametrize("angle", SCENES)
def test_small_motions_are_those_of_the_turning_frame(angle):
    model, motions = SCENES[angle]()
    linear = linearise(model, motions, turning=angle, outputs=[])
    spin = float(next(motions[name](0.0, 1) for name in ("slewing", "shaft") if name in motions))
    assert linear.at_equilibrium
    assert linear.point.spin == spin
    inputs = phases(tuple(motions[channel] for channel in model.channels), SPAN).inputs[0]
    assert_allclose(linear.point.full_state, begin(model, inputs), rtol=0, atol=1e-12)
    other = np.linalg.eigvals(_small_motions(model, linear.point.full_state, Frame.of(model, inputs)))
    found = np.linalg.eigvals(linear.a)
    # The drives' integrators are in the one alone.
    rings, others = (values[values.imag > 1e-3] for values in (found, other))
    order, orders = (np.argsort(values.imag) for values in (rings, others))
    assert_allclose(rings[order], others[orders], rtol=1e-7, atol=1e-7)


def test_a_push_moves_the_turning_crane_as_its_linear_model_says():
    model, motions = SCENES["slewing"]()
    linear = linearise(model, motions, turning="slewing", inputs="motion", outputs=[])
    cut = phases(tuple(motions[channel] for channel in model.channels), SPAN)
    inputs = cut.inputs[0]
    drives = (inputs / [1.0, 1.0, 0.5])[:, :3].T
    chart = Chart.about(model, linear.point.full_state, drives, "slewing")
    push = np.random.default_rng(3).normal(size=len(chart.at)) * np.where(chart.scale > 1.0, chart.scale, 1.0)
    later = drives.copy()
    later[0, model.turning.channel] += drives[1, model.turning.channel] * SPAN
    gaps = []
    for size in (1e-3, 5e-4):
        start = chart.full(chart.at + size * push, drives)
        end = integrate(model.system, cut, start, np.array([SPAN]), rtol=1e-12, atol=1e-14).end_state
        found = Chart.about(model, end, later, "slewing")
        sways = chart.bases[0].T @ found.direction
        n = model.coordinates
        places = np.concatenate([found.at[:n], sways]) - chart.at[: n + 2]
        wanted = (expm(SPAN * linear.a) @ (size * push))[: n + 2]
        gaps.append(np.max(abs(places - wanted)) / np.max(abs(wanted)))
    assert gaps[0] < 5e-3
    assert 1.8 < gaps[0] / gaps[1] < 2.2


FEW = [f"model.{kind}=1" for kind in ("tower_modes", "jib_lateral_modes", "jib_vertical_modes")]
STANDS = ["motion.trolley={shape='rest', start='30 m'}", "motion.hoist={shape='rest'}", "run.duration=30 s"]
TURNS = "motion.slewing={shape='speed-trapezoid', speed='0.6 rpm', ramp='5 s', hold='20 s'}"


@pytest.mark.parametrize(
    ("at", "changes", "said"),
    [
        (12.0, [], "the steady rotation at 0.6 rpm"),
        (12.0, ["wind.speed=8 m/s"], "the equilibrium in the mean wind"),
    ],
)
def test_the_report_says_what_it_is_about(at, changes, said):
    case = load_case("qtz5613/slewing", [*FEW, *STANDS, TURNS, *changes])
    report = linear_report(case, at, linear_model(case, at))
    assert report["about"] == said
    assert report["equilibrium"]

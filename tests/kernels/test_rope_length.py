"""The rope keeps its length and the load its energy, however wide it swings: against elliptic functions."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.pendulums import Pendulum
from samples import qtz5613

from towercrane.cases.case import load_case
from towercrane.cases.models import model_of, motions_of
from towercrane.motions.motion import phases, rest
from towercrane.simulation.directions import longest_turn, restore, restore_rows
from towercrane.simulation.integrate import integrate
from towercrane.simulation.lanes.many import integrate_many
from towercrane.simulation.lanes.run import LaneRun
from towercrane.simulation.methods.registry import METHODS
from towercrane.simulation.simulate import simulate
from towercrane.simulation.starts.begin import begin
from towercrane.simulation.starts.start import Start

GRAVITY = qtz5613.CRANE.gravity
SPAN = 1800.0
TIMES = np.linspace(0.0, SPAN, 601)

PENDULUMS = [
    Pendulum(5.0, 0.1),
    Pendulum(60.0, 0.5, 0.6),
    Pendulum(1.0, 1.0),
    Pendulum(20.0, 1.15, 1.0),
    Pendulum(5.0, 1.5),
    Pendulum(10.0, 1.5, 0.5),
    Pendulum(30.0, 2.0),
    Pendulum(10.0, 2.5, 1.2),
    Pendulum(2.0, 2.8),
    Pendulum(5.0, 3.0),
]


def swing(pendulum, times=TIMES, **options):
    """States of a load that swings under a rigid crane, in space, over time."""
    model = replace(qtz5613.model(0, 0, rope_as_rod=True), axes=3)
    start = np.zeros(model.size)
    start[:3] = np.sin(pendulum.angle), 0.0, -np.cos(pendulum.angle)
    start[4] = pendulum.turning * np.sqrt(GRAVITY / pendulum.length) * np.sin(pendulum.angle)
    cut = phases((rest(20.0), rest(pendulum.length)), times[-1])
    run = integrate(model.system, cut, start, times, **options)
    assert run.outcome == "finished"
    return run.states[:, :3], run.states[:, 3:6]


def off_its_length(directions, states):
    """Largest error of a length of one, and of a right angle relative to the rate."""
    worst = 0.0
    for first, rate, count in directions:
        n, p = states[..., first : first + count], states[..., rate : rate + count]
        speed = np.linalg.norm(p, axis=-1).max()
        worst = max(worst, abs(np.linalg.norm(n, axis=-1) - 1.0).max(), abs((n * p).sum(-1)).max() / max(speed, 1e-3))
    return worst


def test_the_reference_solves_the_equations_of_the_pendulum():
    for pendulum in (Pendulum(3.0, 2.0), Pendulum(3.0, 2.0, 0.7)):
        h = 1e-3
        n = pendulum.direction(GRAVITY, 7.0 + h * np.arange(-3.0, 4.0))
        second = (np.array([2, -27, 270, -490, 270, -27, 2]) / 180) @ n / h**2
        pull = GRAVITY / pendulum.length * np.array([0.0, 0.0, -1.0])
        across = np.eye(3) - np.outer(n[3], n[3])
        assert_allclose(across @ (second - pull), 0.0, atol=3e-8)


@pytest.mark.parametrize("pendulum", PENDULUMS, ids=str)
def test_half_an_hour_of_swing_follows_elliptic_functions_within_a_hundred_thousandth(pendulum):
    # Near the top a pendulum's period hangs on its energy: an error of 1e-6 there is 0.01 rad in 400 periods.
    exact = pendulum.direction(GRAVITY, TIMES)
    errors = {}
    for rtol in (1e-8, 1e-10):
        n, p = swing(pendulum, rtol=rtol, atol=1e-2 * rtol)
        assert abs(np.linalg.norm(n, axis=1) - 1.0).max() < 1e-15
        errors[rtol] = abs(n - exact).max()
        energy = 0.5 * pendulum.length / GRAVITY * (p**2).sum(axis=1) + n[:, 2]
        assert abs(energy - energy[0]).max() < rtol
    assert errors[1e-8] < 1e-5
    assert 5e-3 < errors[1e-10] / errors[1e-8] < 3e-2


@pytest.mark.parametrize("method", [name for name, method in METHODS.items() if method.compiled])
def test_a_bound_on_the_turn_leaves_loads_that_sway_little_and_flexible_cranes_their_steps(method, monkeypatch):
    crane, cut, short = qtz5613.model(1, 1), phases(tuple(qtz5613.motions().values()), 5.0), np.linspace(0.0, 5.0, 7)

    def swings():
        rocked = integrate(crane.system, cut, crane.start(cut.inputs[0], "zero"), short, method=method)
        return [rocked.states, *(swing(Pendulum(5.0, angle), short, method=method)[0] for angle in (0.0, 1e-4, 0.5))]

    bounded = swings()
    monkeypatch.setitem(METHODS, method, replace(METHODS[method], turn=np.inf))
    *same, wide = [np.array_equal(*pair) for pair in zip(bounded, swings(), strict=True)]
    assert all(same)
    assert not wide


def test_a_step_turns_a_circling_load_by_the_angle_and_one_that_speeds_up_by_less():
    directions, k = np.array([[0, 3, 3]]), np.zeros((3, 7))
    # Round a circle at 2 rad/s the acceleration is 4.
    k[0, 3:6], k[2, 3:6] = (4.0, 0.0, 0.0), (0.0, 2.4, 3.2)
    assert_allclose(longest_turn(k, 2, directions, 0.3), 0.15, rtol=1e-14)
    # It has doubled and is expected to do so once more, but never to do more than that.
    for before in (2.0, 0.0):
        k[0, 3:6] = before, 0.0, 0.0
        assert_allclose(longest_turn(k, 2, directions, 0.3), 0.15 / np.sqrt(2.0), rtol=1e-14)
    assert longest_turn(0.0 * k, 2, directions, 0.3) > 1e70
    assert longest_turn(k, 2, directions[:0], 0.3) > 1e70


@pytest.mark.parametrize("method", METHODS)
def test_every_method_keeps_the_rope_s_length_between_its_steps_too(method):
    pendulum, times = Pendulum(5.0, 1.5, 0.3), np.linspace(0.0, 40.0, 1711)
    exact = pendulum.direction(GRAVITY, times)
    for rtol in (1e-4, 1e-7):
        n, p = swing(pendulum, times, method=method, rtol=rtol, atol=1e-2 * rtol)
        assert off_its_length([(0, 3, 3)], np.hstack([n, p])) < 1e-14
        assert abs(n - exact).max() < 300 * rtol


@pytest.mark.parametrize(
    "name",
    [
        "slewing/enhanced/example-1",
        "slewing/multi-mass/example-1",
        "jib-crane/plan",
        "overhead-crane/travel",
        "qtz5613/manoeuvre",
        "qtz5613/condition-3",
    ],
)
def test_every_crane_s_ropes_are_directions(name):
    case = load_case(name)
    model = model_of(case)
    cut = phases(tuple(motions_of(case)[channel] for channel in model.channels), 3.0)
    start = begin(model, cut.inputs[0], Start("equilibrium", along=0.4))
    run = integrate(model.system, cut, start, np.linspace(0.0, 3.0, 50), rtol=1e-4, atol=1e-6)
    assert len(model.system.directions) == 1
    assert off_its_length(model.system.directions, run.states) < 1e-14
    assert off_its_length(model.system.directions, run.end_state) < 1e-14
    # Only the direction's own slope knows its length and what of its rate is along it.
    system, inputs = model.system, cut.inputs[0]
    (first, rate, count), state = system.directions[0], run.end_state.copy()
    state[first : first + count] *= 1.1
    state[rate : rate + count] += 0.2 * state[first : first + count]
    rough = system.slope(0.0, state, inputs)[0]
    restored = state.copy()
    restore(restored, rough[None], 0, system.directions)
    smooth = system.slope(0.0, restored, inputs)[0]
    assert_allclose(rough, smooth, rtol=1e-9, atol=1e-9 * abs(smooth).max())
    restore_rows(state, system.directions)
    assert_allclose(state, restored, rtol=1e-14)


def test_the_drawn_rope_has_its_length_and_the_energy_stays():
    crane = qtz5613.model(0, 0, rope_as_rod=True)
    run = simulate(crane, qtz5613.standing(20.0, 5.0), 300.0, output_step=0.17, start=Start(along=1.5))
    load = run["payload_position"].values - [20.0, 0.0, 0.0]
    assert_allclose(np.linalg.norm(load, axis=1), 5.0, rtol=0.0, atol=1e-12)
    assert run.hoist_rope_force.min() > 0.0
    energy = run["total_energy"].values
    assert np.ptp(energy) < 1e-6 * crane.load.mass * GRAVITY * 5.0


@pytest.mark.parametrize("modes", [(0, 0), (1, 1)], ids=str)
def test_a_wide_swing_in_lanes_has_the_bits_of_a_single_run(modes):
    crane = qtz5613.model(*modes, rope_as_rod=True)
    cut = phases((rest(20.0), rest(5.0)), 60.0)
    grid, loose = np.linspace(0.0, 60.0, 61), {"rtol": 1e-5, "atol": 1e-7}
    angles = (1.5, 2.5, 1.2)
    found = integrate_many([LaneRun(crane, cut, Start("zero", angle)) for angle in angles], grid, threads=1, **loose)
    for angle, state, evaluations in zip(angles, found.end_states, found.evaluations, strict=True):
        single = integrate(crane.system, cut, begin(crane, cut.inputs[0], Start("zero", along=angle)), grid, **loose)
        assert np.array_equal(state, single.end_state)
        assert evaluations == single.evaluations
        assert off_its_length(crane.system.directions, state) < 1e-14


def test_a_system_without_directions_is_left_alone():
    crane = qtz5613.model(0, 0, rope_as_rod=True)
    plain = replace(crane.system, directions=np.empty((0, 3), dtype=np.int64))
    state = np.array([0.5, -2.0, 1.0, 1.0, 0.0])
    assert restore_rows(state, plain.directions) == 0.0
    assert_allclose(state, [0.5, -2.0, 1.0, 1.0, 0.0], rtol=0.0)

"""Ropes that stretch, go slack and are caught, on every kind of crane: against limits and a second formulation."""

from bisect import bisect_right
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.cartesian_crane import CartesianCrane
from samples import jib_cranes, lab_crane, luffing_crane, overhead_crane, qtz5613, space_crane
from samples.lab_crane import BASIC

from towercrane.cranes.jib.model import PlannedJibCrane
from towercrane.cranes.overhead.model import OverheadModel
from towercrane.kernels.elastic_rope import SLACK_MODE, TAUT, Elasticity
from towercrane.kernels.hanging import hang_load
from towercrane.kernels.load import Load
from towercrane.kernels.payload import Rope, State, Structure
from towercrane.motions.motion import phases, rest, sequence
from towercrane.motions.profiles import trapezoid
from towercrane.simulation.integrate import evaluate, integrate
from towercrane.simulation.simulate import record

# --- the kernel ----------------------------------------------------------------------------------------


def drawn(rng: np.random.Generator, axes: int, n: int) -> tuple[Structure, State, Rope, float]:
    """A structure that no crane has, its load on a rope that does not stretch."""
    root = rng.normal(size=(n, n))
    mass = root @ root.T + n * np.eye(n)
    jacobian = rng.normal(size=(axes, n))
    rates, n_load = rng.normal(size=n), rng.normal(size=axes)
    n_load /= np.linalg.norm(n_load)
    p = rng.normal(size=axes)
    p -= (p @ n_load) * n_load
    crane = Structure(
        [mass[i, : i + 1] for i in range(n)], rng.normal(size=n), rng.normal(size=axes), jacobian @ rates,
        rng.normal(size=axes), jacobian, rng.normal(size=axes), rng.normal(size=axes),
    )  # fmt: skip
    rope = Rope(*rng.uniform(1.0, 3.0, size=1), *rng.normal(size=2), (0.3 * rng.normal(size=n)).tolist())
    return crane, State(rng.normal(size=n), n_load, rates, p), rope, rng.uniform(0.5, 2.0)


@pytest.mark.parametrize("axes", [2, 3])
def test_pulled_alike_crane_and_load_accelerate_alike_whether_the_rope_stretches_or_not(axes):
    rng = np.random.default_rng(axes)
    for n in (0, 1, 4):
        for _ in range(10):
            crane, state, rope, mass = drawn(rng, axes, n)
            load = Load(mass, 0.7, 0.4)
            rigid = hang_load(crane, state, rope, load, 9.81)
            # The same places and velocities, and a strain that gives the same force.
            strain, whole = 0.01 * np.sign(rigid.tension), rope.length / (1.0 + 0.01 * np.sign(rigid.tension)) + 3.0
            unstretched = rope.length - strain * whole
            winding = rope.rate + np.dot(rope.paid, state.rates)
            place = crane.place + rope.length * state.direction
            velocity = crane.velocity + winding * state.direction + rope.length * state.swing
            elastic = Elasticity(rigid.tension / strain, whole - unstretched, 0.0, TAUT)
            found = hang_load(
                crane, State(state.coordinates, place, state.rates, velocity), rope._replace(length=unstretched),
                replace(load, elasticity=elastic), 9.81,
            )  # fmt: skip
            assert_allclose(found.tension, rigid.tension, rtol=1e-12)
            assert_allclose(found.accelerations, rigid.accelerations, rtol=1e-11, atol=1e-11)
            paying = rope.acceleration + np.dot(rope.paid, rigid.accelerations)
            expected = (
                np.array(rigid.suspension) - crane.ground + paying * state.direction
                + 2.0 * winding * state.swing + rope.length * np.array(rigid.turning)
            )  # fmt: skip
            assert_allclose(found.turning, expected, rtol=1e-10, atol=1e-10)
            assert_allclose([found.pull(k) for k in range(axes)], [rigid.pull(k) for k in range(axes)], rtol=1e-10)


def test_a_slack_rope_does_nothing_wherever_the_load_is():
    rng = np.random.default_rng(1)
    crane, state, rope, mass = drawn(rng, 3, 3)
    load = Load(mass, 0.7, 0.0, Elasticity(1e5, 1.0, 0.01, SLACK_MODE))
    alone = np.linalg.solve(crane.mass_matrix(), crane.force)
    for away in (0.0, 1e-9, 0.3, 0.9, 1.0, 2.0):
        place = crane.place + away * rope.length * state.direction
        found = hang_load(crane, State(state.coordinates, place, state.rates, state.swing), rope, load, 9.81)
        assert found.tension == 0.0
        assert list(map(float, found.hinge)) == [0.0] * 3
        assert_allclose(found.accelerations, alone, rtol=1e-12)
        assert_allclose(found.turning, [*-crane.ground[:2], -9.81 - crane.ground[2]], rtol=1e-14)


# --- a rope alone --------------------------------------------------------------------------------------


@pytest.mark.parametrize(("damping_ratio", "rounded"), [(0.02, 0.94), (0.05, 0.86), (0.7, 0.21)])
def test_a_load_that_a_fixed_rope_catches_is_thrown_back(damping_ratio, rounded):
    crane = replace(jib_cranes.HEAVY, gravity=1e-12)
    stiffness, length, mass = 14e6, 18.0, 1500.0
    frequency = np.sqrt(stiffness / (length + 32.5) / mass)
    load = Load(mass, elasticity=Elasticity(stiffness, 32.5, 2.0 * damping_ratio / frequency))
    model = PlannedJibCrane(crane, load)
    cut = phases((*[rest(0.5)] * 3, rest(length)), 3.0)
    start = model.start(cut.inputs[0])
    start[2] += 0.5
    start[5] = -1.0
    run = integrate(model.system, cut, start, np.array([3.0]), rtol=1e-11, atol=1e-13)
    assert len(run.switch_times) == 2
    exact = np.exp(-2.0 * damping_ratio * np.arccos(damping_ratio) / np.sqrt(1.0 - damping_ratio**2))
    assert run.end_state[5] == pytest.approx(exact, rel=1e-8)
    assert exact == pytest.approx(rounded, abs=5e-3)
    assert run.switch_times[0] == pytest.approx(0.5, rel=1e-9)


# --- flexible cranes -----------------------------------------------------------------------------------

EA, EXTRA = 14e6, 32.5


def on_elastic(model, factor: float = 1.0, damping_ratio: float = 0.03, length: float = 18.0):
    """The model with 1500 kg on a rope of so many times its stiffness."""
    frequency = np.sqrt(factor * EA / (length + EXTRA) / 1500.0)
    rope = Elasticity(factor * EA, EXTRA, 2.0 * damping_ratio / frequency)
    return replace(model, load=Load(1500.0, elasticity=rope))


def test_the_stiffer_a_rope_the_nearer_its_load_to_that_of_one_that_does_not_stretch():
    rigid = qtz5613.model(1, 1, load=1500.0)
    motions = {"trolley": trapezoid(20.0, 26.0, 0.8, 0.4), "rope": trapezoid(18.0, 14.0, 0.5, 0.5)}
    places = [
        record(model, motions, 6.0, output_step=0.5, rtol=1e-9, atol=1e-11)["payload_position"].values
        for model in (rigid, *(on_elastic(rigid, factor) for factor in (10.0, 100.0)))
    ]
    errors = [abs(place - places[0]).max() for place in places[1:]]
    assert 2e-3 < errors[0] < 2e-2
    assert 7.0 < errors[0] / errors[1] < 13.0


@pytest.mark.parametrize(
    ("factor", "damping_ratio", "heights", "peak"),
    [
        (1.0, 0.03, [-0.430, -0.800, -0.885, -0.588], 3.39),
        (10.0, 0.03, None, 8.2),
        (100.0, 0.7, [-0.3577, -0.6572, -0.7123, -0.6288], None),
    ],
)
def test_a_load_dropped_into_its_rope(factor, damping_ratio, heights, peak):
    model = on_elastic(qtz5613.model(2, 3, load=1500.0), factor, damping_ratio)
    motions = {"trolley": rest(30.0), "rope": rest(18.0)}
    cut = phases((motions["trolley"], motions["rope"]), 4.0)
    bare = replace(model, load=Load(1e-6))
    start = np.zeros(model.size)
    start[:5] = bare.equilibrium(cut.inputs[0])
    start[5:7] = np.array(model.suspended(start, cut.inputs[0]).place) - [0.0, 18.0 - 0.25]
    times = np.linspace(0.0, 4.0, 4001)
    run = integrate(model.system, cut, start, times, rtol=1e-10, atol=1e-12)
    outputs = model.observe(motions, times, run.states, *evaluate(model.system, cut, times, run.states))
    if heights is not None:
        risen = np.interp([0.5, 1.0, 2.0, 4.0], times, run.states[:, 6] - start[6])
        assert_allclose(risen, heights, atol=6e-4 if heights[0] == -0.430 else 6e-5)
    force = outputs["hoist_rope_force"].values
    if peak is not None:
        assert force.max() / (1500.0 * 9.81) == pytest.approx(peak, rel=6e-3)
    assert force.min() == 0.0
    energy, work = outputs["total_energy"].values, outputs["input_work"].values
    assert abs(energy - energy[0] - work).max() < 1e-9 * np.ptp(energy)


CRANES = {
    "plane": (lambda load: qtz5613.in_plane(qtz5613.CRANE, load, 1, 1), {"trolley": rest(20.0)}, 18.0),
    "space": (
        lambda load: replace(space_crane.model(tower=1, torsion=1, lateral=1, vertical=1), load=load),
        {"trolley": trapezoid(20.0, 21.0, 0.8, 2.0), "slewing": trapezoid(0.0, 0.3, 0.2, 0.5)},
        18.0,
    ),
    "luffing": (
        lambda load: replace(luffing_crane.model(), load=load),
        {"luffing": trapezoid(0.8, 0.82, 0.01, 0.01), "slewing": trapezoid(0.0, 0.3, 0.2, 0.5)},
        20.0,
    ),
    "overhead": (
        lambda load: OverheadModel(overhead_crane.SMALL, load),
        {"bridge": trapezoid(10.0, 12.0, 0.8, 1.0), "trolley": rest(8.0)},
        5.0,
    ),
}


@pytest.mark.parametrize("kind", CRANES)
def test_slack_and_caught_again_and_again_the_balance_of_energy_holds(kind):
    build, motions, length = CRANES[kind]
    # A heavier load would throw the jib that pivots over backwards.
    mass = 30.0 if kind == "luffing" else 500.0
    model = build(Load(mass, rope_damping=20.0, drag_area=1.0, elasticity=Elasticity(3e6, 10.0, 0.003)))
    rope = sequence(rest(length, 0.2), trapezoid(length, length - 1.0, 2.0, 20.0))
    run = record(model, {**motions, "rope": rope}, 4.0, rtol=1e-11, atol=1e-13)
    assert run.attrs["outcome"] == "finished"
    assert run.switches is not None
    forces = run.switches["hoist_rope_force"].values
    # Slack and taut in turn; a damped rope is caught with a jerk.
    assert len(forces) > 4
    assert np.all(forces[::2] == 0.0)
    assert np.all(forces[1::2] > 0.0)
    assert run["rope_stretch"].values.min() < -1e-3
    energy, work = run["total_energy"].values, run["input_work"].values
    assert abs(energy - energy[0] - work).max() < 1e-9 * max(np.ptp(energy), np.ptp(work))


@pytest.mark.parametrize("kind", CRANES)
def test_at_rest_on_a_stretched_rope_nothing_moves(kind):
    build, motions, length = CRANES[kind]
    model = build(Load(500.0, elasticity=Elasticity(3e6, 10.0, 0.003)))
    inputs = np.zeros((len(model.channels), 3))
    for row, channel in enumerate(model.channels):
        inputs[row, 0] = length if channel == "rope" else float(motions[channel](0.0))
    slope, guards = model.system.slope(0.0, model.start(inputs), inputs)
    assert abs(slope).max() < 1e-6
    assert guards[0] == pytest.approx(500.0 * 9.81, rel=1e-8)


# --- slack and caught twenty times, a second way -------------------------------------------------------


def drive_of(cut, row):
    """Value and rate of a drive over time, of its polynomials."""
    times, rows = cut.times.tolist(), cut.inputs[:, row].tolist()

    def drive(t):
        phase = min(max(bisect_right(times, t) - 1, 0), len(rows) - 1)
        (a, b, c), t = rows[phase], t - times[phase]
        return a + t * (b + t * c), b + 2.0 * t * c

    return drive


def test_a_second_formulation_slackens_and_catches_alike():
    model = lab_crane.crane("basic", friction_law="none")
    hoist = sequence(rest(2.0, 0.2), trapezoid(2.0, 1.7, 1.2, 40.0))
    shaft = trapezoid(0.0, 2.0, 0.738, 0.738 / 0.2)
    cut = phases((shaft, hoist), 1.5)
    start, ends = model.start(cut.inputs[0]), np.array([0.6, 1.0, 1.5])
    run = integrate(model.system, cut, start, ends, rtol=1e-12, atol=1e-14)
    rope = model.crane.rope
    drives = [drive_of(cut, row) for row in (1, 0)]
    oracle = CartesianCrane(BASIC, rope.stiffness, rope.relaxation_time, 50.5, 0.08, *drives)
    q, jib = start[:4], np.array([2.0, 0.0, 2.2])
    tip = jib + q[[2, 1, 0]]
    other = np.concatenate([tip, np.zeros(3), [q[3]], start[4:7], np.zeros(3), [0.0]])
    switched, states = oracle.run(other, ends, cut.times[1:-1].tolist(), 1e-10)
    assert len(run.switch_times) == len(switched) >= 20
    assert_allclose(run.switch_times, switched, rtol=0, atol=1e-7)
    assert_allclose(run.states[:, 4:7], states[:, 7:10], rtol=0, atol=1e-7)

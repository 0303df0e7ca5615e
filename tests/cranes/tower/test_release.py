"""A load that lets go, all or in part: how far the crane swings back, what leaves the balance of energy."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples import qtz5613, space_crane

from towercrane.cases.case import load_case
from towercrane.cranes.parts.hoisting.letting_go import letting_go
from towercrane.cranes.parts.wind import WindAreas
from towercrane.cranes.tower.equations.small_motions import linear_matrices, plane_matrices, unloaded_frequencies
from towercrane.cranes.tower.model import FlexibleModel
from towercrane.kernels.elastic_rope import Elasticity
from towercrane.kernels.load import Load, Release
from towercrane.linear.linearise import linearise
from towercrane.motions.motion import Phases, phases, rest
from towercrane.motions.profiles import speed_trapezoid, trapezoid
from towercrane.runs.extremes import extremes_of, highest, phases_between
from towercrane.runs.run import record_case
from towercrane.simulation.integrate import integrate
from towercrane.simulation.lanes.many import integrate_many
from towercrane.simulation.lanes.run import LaneRun
from towercrane.simulation.outcomes import SLACK_ROPE
from towercrane.simulation.run import Run
from towercrane.simulation.simulate import record

STEEL = Elasticity(14e6, 32.5, 3e-3)
"""A rope of 7 MN in two falls."""

TIGHT = {"rtol": 1e-10, "atol": 1e-12}


def let_go(
    place: float, mass: float, gone: float, modes: tuple[int, int] = (2, 3), damping: float = 0.0,
    rope: Elasticity | None = STEEL, time: float = 1.0, duration: float = 13.0, **options,
) -> Run:  # fmt: skip
    """A run of QTZ5613 at rest whose load lets go of some mass."""
    load = Load(mass, elasticity=rope, release=Release(gone))
    crane = qtz5613.in_plane(qtz5613.CRANE, load, *modes, damping=(damping, damping))
    motions = {"trolley": rest(place), "rope": rest(18.0), "release": letting_go(time)}
    return record(crane, motions, duration, **{**TIGHT, **options})


def at_rest(model: FlexibleModel, place: float, gone: float) -> tuple[np.ndarray, dict]:
    """State at rest with so much gone, and its outputs."""
    inputs = np.zeros((len(model.channels), 3))
    inputs[:, 0] = [{"trolley": place, "rope": 18.0, "release": gone}[name] for name in model.channels]
    state = model.start(inputs)
    return state, observed(model, state, np.zeros(model.coordinates), inputs)


def observed(model: FlexibleModel, state: np.ndarray, accelerations: np.ndarray, inputs: np.ndarray) -> dict:
    """Outputs in a state with accelerations of the structure that are given."""
    slopes, guards = model.system.slope(0.0, state, inputs)
    first = len(state) // 2
    slopes[first : first + model.coordinates] = accelerations
    motions = {name: rest(value) for name, value in zip(model.channels, inputs[:, 0], strict=True)}
    found = model.observe(motions, np.zeros(1), state[None], slopes[None], guards[None])
    return {name: own.values[0] for name, own in found.items()}


def upright(values) -> np.ndarray:
    """Moment on the base in the jib's plane of a tower that bears its loads where it stands undeformed [N m]."""
    return np.sign(values["base_moment_y"]) * values["overturning_moment_first_order"]


SWUNG = [
    ((40.0, 1500.0, 1500.0), 2.72, 2.06),
    ((40.0, 1500.0, 750.0), 2.63, 2.05),
    ((15.0, 3000.0, 3000.0), 2.70, 2.01),
    ((25.0, 1500.0, 1500.0), 2.66, 2.03),
    ((40.0, 1500.0, 1500.0, (2, 3), 0.01), 2.47, 1.91),
    ((40.0, 1500.0, 1500.0, (2, 3), 0.02), 2.42, 1.87),
    ((40.0, 1500.0, 1500.0, (2, 3), 0.04), 2.34, 1.82),
]
"""Place, mass, what goes of it, modes and damping; 1 + beta of base and jib root by a second program, two digits."""


@pytest.mark.parametrize(("scene", "base", "root"), SWUNG)
def test_base_and_jib_root_swing_back_as_far_as_a_second_program_has_it(scene, base, root):
    run = let_go(*scene)
    found, (_, after) = extremes_of(run), at_rest(run.model, scene[0], 1.0)
    for wanted, values, resting in (
        (base, upright(found.values), upright(after)),
        (root, found.values["jib_root_moment"], after["jib_root_moment"]),
    ):
        least = highest(found.times, values, -1.0).value
        # Two digits, and 1e-3 of it between two programs.
        assert abs((values[0] - least) / (values[0] - resting) - wanted) < 0.0055 + 2e-3 * wanted
    energy, work = (run[name].values for name in ("total_energy", "input_work"))
    assert abs(energy - energy[0] - work).max() < 1e-9 * abs(work).max()


def test_moments_after_it_are_the_sum_of_modes_in_closed_form():
    run, place = let_go(40.0, 1500.0, 1500.0), 40.0
    model, n = run.model, run.model.coordinates
    (loaded, before), (bare, after) = (at_rest(model, place, gone) for gone in (0.0, 1.0))
    inputs = np.zeros((len(model.channels), 3))
    inputs[:, 0] = place, 18.0, 1.0
    lever = np.array([upright(observed(model, bare, unit, inputs)) - upright(after) for unit in np.eye(n)])
    mass, stiffness = (matrix[:n, :n] for matrix in linear_matrices(model, inputs[:, 0], about=bare[:n]))
    squares, shapes = np.linalg.eig(np.linalg.solve(mass, stiffness))
    amplitudes = np.linalg.solve(shapes, (loaded - bare)[:n])
    parts = -(lever @ shapes) * squares * amplitudes
    fall = upright(before) - upright(after)
    # At once all of the moment that the load was is there: the parts add up to it, their sizes to more.
    assert_allclose(parts.sum(), fall, rtol=3e-3)
    assert_allclose(1.0 + abs(parts).sum() / fall, 2.75, atol=0.01)
    elapsed = np.linspace(0.0, 12.0, 24_001)
    moments = upright(after) + np.cos(np.outer(elapsed, np.sqrt(squares))) @ parts
    assert_allclose((upright(before) - moments.min()) / fall, 2.7217, atol=4e-3)
    found = extremes_of(run)
    least = highest(found.times, upright(found.values), -1.0).value
    assert_allclose((upright(before) - least) / fall, (upright(before) - moments.min()) / fall, atol=5e-3)
    shown = upright({name: run[name].values for name in ("base_moment_y", "overturning_moment_first_order")})
    soon = (run.times >= 1.0) & (run.times < 3.0)
    assert abs(shown[soon] - np.interp(run.times[soon] - 1.0, elapsed, moments)).max() < 0.02 * fall


def test_on_a_rigid_crane_a_rope_without_losses_swings_to_the_load_less_twice_what_goes():
    rope = Elasticity(14e6, 32.5)
    for gone in (150.0, 400.0, 700.0):
        run = let_go(30.0, 1500.0, gone, (0, 0), rope=rope, duration=3.0)
        least = extremes_of(run).lowest["hoist_rope_force"].value
        assert_allclose(least / (1500.0 * 9.81), 1.0 - gone / 1500.0 * 2.0, atol=2e-6)


def test_a_rope_slackens_where_more_than_half_goes_which_ends_the_run_only_if_it_does_not_stretch():
    # The crane's own inertia holds the rope's end; it takes a heavy load to throw that up.
    assert let_go(40.0, 1500.0, 1450.0, (1, 1), rope=None, duration=3.0).attrs["outcome"] == "finished"
    rigid = let_go(55.0, 6000.0, 5900.0, (1, 1), rope=None, duration=3.0)
    assert rigid.attrs["outcome"] == SLACK_ROPE
    assert 1.0 < rigid.attrs["end_time"] < 2.5
    elastic = let_go(40.0, 1500.0, 900.0, (1, 1), duration=3.0)
    assert elastic.attrs["outcome"] == "finished"
    assert elastic.switches is not None
    assert extremes_of(elastic).lowest["hoist_rope_force"].value == 0.0
    energy, work = (elastic[name].values for name in ("total_energy", "input_work"))
    assert abs(energy - energy[0] - work).max() < 1e-9 * abs(work).max()


def test_tension_goes_on_as_it_was_if_the_rope_stretches_and_jumps_if_it_does_not():
    jumps = {}
    for rope in (STEEL, None):
        found = extremes_of(let_go(40.0, 1500.0, 600.0, rope=rope, duration=2.0))
        first = int(np.searchsorted(found.times, 1.0))
        assert found.times[first] == 1.0
        assert 1e-9 < 1.0 - found.times[first - 1] < 3e-9
        jumps[rope] = np.diff(found.values["hoist_rope_force"][first - 1 : first + 1])[0]
        base = found.values["base_force_z"][first - 1 : first + 1]
        # Places and velocities go on, and with them what a free crane hangs on; the weight is not yet missed.
        assert rope is None or abs(np.diff(base)[0]) < 1e-3
    assert abs(jumps[STEEL]) < 1e-3
    assert -600.0 * 9.81 < jumps[None] < -1000.0


AREAS = WindAreas(tower=0.5, jib=0.3, counter_jib=0.3, counterweight=2.0)


def in_space(rope: Elasticity | None, gone: float, drag: float) -> FlexibleModel:
    load = Load(1500.0, 300.0, 4.0, rope, release=Release(gone, drag))
    return space_crane.model(1, 1, 1, 1, load, areas=AREAS, wind=1)


def driven(time: float, duration: float = 0.0) -> dict:
    """Slewing, trolley and hoist while the load lets go in a wind."""
    wind = dict(zip(("wind_x", "wind_y", "wind_z"), map(rest, (6.0, 3.0, 0.0)), strict=True))
    return {
        "trolley": trapezoid(20.0, 26.0, 1.0, 0.5), "rope": trapezoid(15.0, 13.0, 0.8, 0.8),
        "slewing": speed_trapezoid(0.0, 0.06, 2.0, 4.0), "release": letting_go(time, duration), **wind,
    }  # fmt: skip


def cut_of(model: FlexibleModel, motions: dict, end: float) -> Phases:
    return phases(tuple(motions[name] for name in model.channels), end)


@pytest.mark.parametrize("rope", [STEEL, None])
def test_in_space_the_crane_goes_on_as_one_whose_load_was_lighter_from_there_on(rope):
    time, end, gone, drag = 2.35, 5.0, 600.0, 1.2
    model, motions = in_space(rope, gone, drag), driven(time)
    run = record(model, motions, end, output_step=0.25, **TIGHT)
    energy, work = (run[name].values for name in ("total_energy", "input_work"))
    assert abs(energy - energy[0] - work).max() < 1e-9 * 1500.0 * 9.81 * 15.0
    # To the instant with the load whole, and on from there with what is left.
    whole, left = (
        model.with_load(Load(mass, 300.0, area, rope, release=Release(1e-9 * mass)))
        for mass, area in ((1500.0, 4.0), (900.0, 2.8))
    )
    cut = cut_of(model, {**motions, "release": rest(0.0)}, end)
    first = integrate(whole.system, phases_between(cut, 0.0, time), run.states[0], np.array([time]), **TIGHT)
    rows = run.times[run.times > time]
    then = integrate(left.system, phases_between(cut, time, end), first.end_state, rows - time, **TIGHT)
    assert_allclose(run.states[run.times > time][:, :-1], then.states[:, :-1], atol=1e-7)
    # What left the balance is the energy that the mass had.
    place, velocity = (first.end_state[model.rope + k * (len(run.states[0]) // 2) :][:3] for k in (0, 1))
    if rope is not None:
        lost = gone * (0.5 * velocity @ velocity + 9.81 * place[2])
        assert_allclose(run.states[-1, -1], then.states[-1, -1] - lost, atol=1e-4)
    # Beside each other, to the last bit.
    lanes = [LaneRun(in_space(rope, own, drag), cut_of(model, motions, end)) for own in (gone, 900.0)]
    assert (integrate_many(lanes, run.times, threads=1, **TIGHT).end_states[0] == run.attrs["end_state"]).all()


@pytest.mark.parametrize("rope", [STEEL, None])
def test_mass_that_goes_by_and_by_takes_its_energy_along(rope):
    run = record(in_space(rope, 900.0, 2.4), driven(1.0, 2.0), 5.0, output_step=0.25, **TIGHT)
    energy, work = (run[name].values for name in ("total_energy", "input_work"))
    assert abs(energy - energy[0] - work).max() < 1e-9 * 1500.0 * 9.81 * 15.0
    assert abs(work[-1]) > 1e4


@pytest.mark.parametrize("rope", [STEEL, None])
def test_nothing_hangs_once_all_has_gone(rope):
    model = in_space(rope, 1500.0, 4.0)
    run = record(model, driven(2.35), 5.0, output_step=0.25, **TIGHT)
    assert run.attrs["outcome"] == "finished"
    assert (run["hoist_rope_force"].values[run.times > 2.35] == 0.0).all()
    energy, work = (run[name].values for name in ("total_energy", "input_work"))
    assert abs(energy - energy[0] - work).max() < 1e-9 * 1500.0 * 9.81 * 15.0
    if rope is not None:
        # What has gone falls.
        last, at = run["payload_position"].values[:, 2], run.times
        bends = np.diff(last[at > 2.4], 2) / 0.25**2
        assert_allclose(bends, -9.81, atol=1e-6)


@pytest.mark.parametrize("name", ["luffing/manoeuvre", "hammerhead/manoeuvre"])
def test_a_jib_that_pivots_and_one_on_ties_keep_the_balance_too(name):
    few = [f"model.{kind}_modes=1" for kind in ("tower", "jib_lateral", "jib_vertical")]
    tight = ["solver.rtol=1e-9", "solver.atol=1e-11", "run.duration=5 s"]
    run = record_case(load_case(name, [*few, *tight, "release.time=4.2 s", "release.fraction=0.4"]))
    assert run.attrs["outcome"] == "finished"
    energy, work = (run[key].values for key in ("total_energy", "input_work"))
    assert abs(work[-1]) > 1e5
    assert abs(energy - energy[0] - work).max() < 1e-9 * abs(work).max()


def test_linear_models_and_frequencies_are_of_what_hangs_then():
    load = Load(1500.0, elasticity=STEEL, release=Release(600.0))
    model = qtz5613.in_plane(qtz5613.CRANE, load, 1, 1)
    light = qtz5613.in_plane(qtz5613.CRANE, Load(900.0, elasticity=STEEL), 1, 1)
    motions = {"trolley": rest(40.0), "rope": rest(18.0), "release": letting_go(1.0)}
    values = linearise(model, motions, time=2.0, outputs=[])
    others = linearise(light, motions, time=2.0, outputs=[])
    assert_allclose(values.a, others.a, rtol=0.0, atol=0.0)
    assert values.states == others.states
    bare = qtz5613.in_plane(qtz5613.CRANE, Load(1500.0, elasticity=STEEL, release=Release(1500.0)), 1, 1)
    with pytest.raises(ValueError, match="one at which a load hangs, got 2 s"):
        linearise(bare, motions, time=2.0)
    tiny = qtz5613.in_plane(qtz5613.CRANE, Load(1e-6), 1, 1)
    mass, stiffness = (matrix[:2, :2] for matrix in plane_matrices(tiny, 40.0, 18.0))
    wanted = np.sort(np.sqrt(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real))
    assert_allclose(unloaded_frequencies(bare, 40.0, 18.0), wanted, rtol=1e-8)


def test_more_than_there_is_cannot_go_and_a_softened_tower_knows_one_load():
    with pytest.raises(ValueError, match=r"Load\.release: wanted no more than mass and drag area"):
        Load(1500.0, release=Release(1501.0))
    with pytest.raises(ValueError, match=r"Release\.mass"):
        Release(0.0)
    with pytest.raises(ValueError, match="weight_softening: wanted False for a load that lets go"):
        qtz5613.model(load=1500.0, weight_softening=True).with_load(Load(1500.0, release=Release(1.0)))

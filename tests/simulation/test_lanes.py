"""Runs in lanes beside single runs: the same bits, whatever shares the lanes with them."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.qtz5613 import CRANE, in_plane, model, motions

from modal import Chain, Foundation, Segment
from modal.compiler.lanes import LANES
from towercrane.cranes.parts.ground import earthquake
from towercrane.kernels.load import Load
from towercrane.motions.motion import phases, rest, sequence
from towercrane.motions.profiles import s_curve, trapezoid
from towercrane.simulation.lanes.many import integrate_many
from towercrane.simulation.lanes.run import LaneRun
from towercrane.simulation.observed import scalars
from towercrane.simulation.simulate import rows_of, simulate
from towercrane.simulation.starts.start import Start

DURATION = 12.0
ROWS = rows_of(DURATION, 0.05)
LOOSE = {"rtol": 1e-5, "atol": 1e-7}


def lane_run(crane, drives, *start):
    return LaneRun(crane, phases(tuple(drives[name] for name in crane.channels), DURATION), Start(*start))


def in_lanes(scenes, **options):
    """Scenes are model, motions and, if need be, state and swing angle at the start."""
    return integrate_many([lane_run(*scene) for scene in scenes], ROWS, **{**LOOSE, "threads": 1, **options})


def alone(crane, drives, *start, **options):
    return simulate(crane, drives, DURATION, start=Start(*start), **{**LOOSE, **options})


def assert_same(found, scenes, **options):
    for number, scene in enumerate(scenes):
        single = alone(*scene, **options)
        assert found.outcomes[number] == single.attrs["outcome"]
        assert found.end_times[number] == single.attrs["end_time"]
        assert found.evaluations[number] == single.attrs["evaluations"]
        assert found.accepted[number] == single.attrs["steps_accepted"]
        assert found.rejected[number] == single.attrs["steps_rejected"]
        assert np.array_equal(found.end_states[number], single.attrs["end_state"])
        for output, name in zip(found.extremes[number], scalars(scene[0]), strict=True):
            values, times = single[name].values, single["time"].values
            size = max(np.max(abs(values)), 1e-300)
            assert_allclose(output[[0, 2]], [values.max(), values.min()], rtol=0, atol=1e-12 * size)
            # Extremes may be met twice; at the time told the value is the extreme.
            for value, time in (output[:2], output[2:]):
                row = int(np.argmin(abs(times - time)))
                assert times[row] == time
                assert_allclose(values[row], value, rtol=0, atol=1e-12 * size)


def loads_and_ropes(count, *modes, **options):
    random = np.random.default_rng(7)
    return [
        (model(*modes, load=random.uniform(100, 2000), **options), motions(rope=random.uniform(4, 23)))
        for _ in range(count)
    ]


@pytest.mark.parametrize("modes", [(0, 0), (0, 1), (1, 0), (2, 3), (4, 4)])
def test_lanes_give_the_bits_of_single_runs(modes):
    scenes = loads_and_ropes(3, *modes)
    assert_same(in_lanes(scenes), scenes)


@pytest.mark.parametrize(
    "options",
    [
        {"damping": (0.01, 0.02)},
        {"weight_softening": True},
        {"self_weight": False},
        {"rope_as_rod": True},
    ],
    ids=lambda options: next(iter(options)),
)
def test_what_the_model_includes_is_the_same_in_lanes(options):
    scenes = loads_and_ropes(3, 2, 3, **options)
    assert_same(in_lanes(scenes), scenes)


def test_a_ground_that_moves_is_the_same_in_lanes():
    records = np.random.default_rng(3).normal(size=(3, 21, 3))
    scenes = [
        (crane, drives | earthquake(np.linspace(0.0, 5.0, 21), record, 2.0 * DURATION))
        for (crane, drives), record in zip(loads_and_ropes(3, 2, 1, ground=True), records, strict=True)
    ]
    assert_same(in_lanes(scenes), scenes)


def test_more_runs_than_lanes_refill_them():
    scenes = loads_and_ropes(2 * LANES + 3, 1, 1)
    assert_same(in_lanes(scenes), scenes)


def test_runs_of_different_motions_losses_and_starts_share_lanes():
    hauled = sequence(rest(12, 2), trapezoid(12, 7, 0.6, 0.2))
    waits = sequence(rest(20, 3), s_curve(20, 30, 1.0, 0.3, 0.2))
    lossy = in_plane(CRANE, Load(600.0, rope_damping=400.0, drag_area=3.0), 2, 3)
    scenes = [
        (lossy, {"trolley": waits, "rope": hauled}),
        (model(load=500.0), {"trolley": waits, "rope": rest(9)}),
        (model(load=900.0), {"trolley": rest(10), "rope": hauled}, "zero"),
        (model(load=900.0), motions(speed=0.4), "equilibrium", 0.7),
    ]
    assert_same(in_lanes(scenes), scenes)
    # Tight steps are as many as the noise of a crane at rest lets them be: the bits have to be the same for that.
    assert_same(in_lanes(scenes, rtol=1e-9, atol=1e-11), scenes, rtol=1e-9, atol=1e-11)


def test_every_way_a_run_ends_is_told_for_that_run_alone():
    scenes = [
        (model(), motions()),
        (model(), {"trolley": rest(20), "rope": rest(18)}, "equilibrium", 2.0),  # slack at the start
        (model(), {"trolley": rest(20), "rope": rest(18)}, "equilibrium", 1.5),  # stays taut
        (model(), {"trolley": trapezoid(50, 58, 2.0, 0.5), "rope": rest(10)}),  # runs off the jib
        (model(), {"trolley": trapezoid(5, 3, 2.0, 0.5), "rope": trapezoid(18, 10, 4.0, 40.0)}),
        (model(load=1e7, weight_softening=True), motions()),  # no equilibrium
        (model(), {"trolley": rest(20), "rope": sequence(rest(10, 1), trapezoid(10, 18, 6.0, 12.0))}),  # free fall
    ]
    found = in_lanes(scenes)
    assert set(found.outcomes) == {"finished", "slack rope", "trolley off the jib", "tower buckled"}
    assert found.outcomes[-1] == "slack rope"
    assert 0.99 < found.end_times[-1] < 2.0
    assert_same(found, scenes)


def test_towers_of_all_kinds_share_lanes_and_lean_as_far_as_they_like():
    weak = replace(CRANE, tower=replace(CRANE.tower, youngs_modulus=1e9))
    weaker = replace(CRANE, tower=replace(CRANE.tower, youngs_modulus=0.5e9))
    segments = Segment(10.0, 350.0, 3e9), Segment(13.8, 300.0, 2e9)
    stepped = replace(CRANE, tower=Chain(segments, foundation=Foundation(rotation_stiffness=5e9)))
    scenes = [
        (in_plane(crane, Load(3000.0), 2, 3, rope_as_rod=True), motions(rope=9.0), "zero")
        for crane in (weak, CRANE, weaker, stepped)
    ]
    found = in_lanes(scenes)
    assert found.outcomes == ["finished", "finished", "tower buckled", "finished"]
    # Beyond 0.15 rad the head's turning is found another way, in that lane only.
    assert alone(*scenes[0])["tower_tip_tilt"].max() > 0.4
    assert_same(found, scenes)


def test_the_other_pair_runs_in_lanes_too():
    scenes = loads_and_ropes(3, 1, 1)
    assert_same(in_lanes(scenes, method="dopri5"), scenes, method="dopri5")


def test_series_are_those_of_single_runs():
    scenes = [*loads_and_ropes(2, 2, 3), (model(), {"trolley": trapezoid(50, 58, 2.0, 0.5), "rope": rest(10)})]
    found = in_lanes(scenes, series=True)
    for scene, series in zip(scenes, found.series, strict=True):
        single = alone(*scene)
        rows = np.count_nonzero(np.isin(ROWS, single["time"].values))
        assert np.all(np.isnan(series[rows:]))
        for column, name in zip(series[:rows].T, scalars(scene[0]), strict=True):
            values = single[name].values
            assert_allclose(column, values[:rows], rtol=0, atol=1e-12 * np.max(abs(values)))


def test_threads_change_no_bit():
    scenes = loads_and_ropes(3 * LANES + 1, 1, 2)
    one, three = in_lanes(scenes), in_lanes(scenes, threads=3)
    assert np.array_equal(one.end_states, three.end_states)
    assert np.array_equal(one.extremes, three.extremes)
    assert one.outcomes == three.outcomes


def test_ctrl_c_keeps_what_has_ended():
    # The first batch ends at once, the second takes many looks at the keyboard.
    short = [(model(4, 4), {"trolley": trapezoid(55.599, 58, 2.0, 0.5), "rope": rest(10)})] * LANES
    long = loads_and_ropes(LANES, 4, 4)

    def stop(done):
        if done >= LANES:
            raise KeyboardInterrupt

    found = in_lanes([*short, *long], rtol=1e-13, atol=1e-15, method="dopri5", progress=stop)
    assert found.outcomes == ["trolley off the jib"] * LANES + ["interrupted"] * LANES
    assert np.all(np.isfinite(found.extremes[:LANES]))
    assert np.all(np.isnan(found.extremes[LANES:]))


@pytest.mark.parametrize(
    ("options", "words"),
    [({"method": "scipy-radau"}, "method: wanted"), ({"threads": 0}, "threads: wanted one or more, got 0")],
)
def test_wrong_arguments_are_named(options, words):
    with pytest.raises(ValueError, match=words):
        in_lanes(loads_and_ropes(1, 1, 1), **options)


def test_runs_that_cannot_share_lanes_are_refused():
    with pytest.raises(ValueError, match="same numbers and shapes of modes"):
        in_lanes([(model(1, 1), motions()), (model(1, 2), motions())])
    with pytest.raises(ValueError, match="runs: wanted one or more, got none"):
        in_lanes([])

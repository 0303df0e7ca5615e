"""What the solvers cannot work with is one message that names the argument; phases need no rows."""

import numpy as np
import pytest
from oracles.exact_systems import driven, oscillator
from samples import qtz5613

from towercrane.cases.case import load_case
from towercrane.motions.motion import phases
from towercrane.runs.run import record_case
from towercrane.simulation.integrate import evaluate, integrate
from towercrane.simulation.lanes.many import integrate_many
from towercrane.simulation.lanes.run import LaneRun
from towercrane.simulation.methods.registry import METHODS
from towercrane.simulation.simulate import record, simulate


@pytest.mark.parametrize("name", ["rtol", "atol"])
@pytest.mark.parametrize("value", [-1.0, 0, 1e-30, np.nan, np.inf, 2.0, "1e-8", None])
def test_a_tolerance_out_of_range_is_named(name, value):
    exact, wanted = oscillator(), rf"^{name}: wanted a number from 1e-\d+ to 1, got {value!r}$"
    cut = phases((exact.motion,), 1.0)
    with pytest.raises(ValueError, match=wanted):
        integrate(exact.system, cut, np.zeros(2), np.zeros(1), **{name: value})
    model, drives = qtz5613.model(1, 1), qtz5613.motions()
    with pytest.raises(ValueError, match=wanted):
        simulate(model, drives, 1.0, **{name: value})
    run = LaneRun(model, phases((drives["trolley"], drives["rope"]), 1.0))
    with pytest.raises(ValueError, match=wanted):
        integrate_many([run], np.zeros(1), **{name: value})


@pytest.mark.parametrize(
    ("options", "wanted"),
    [
        ({"duration": 0.0}, "^duration: wanted a positive finite number, got 0.0"),
        ({"duration": np.nan}, "^duration: .*got nan"),
        ({"duration": "1 s"}, "^duration: .*got '1 s'"),
        ({"output_step": 0.0}, "^output_step: wanted a positive finite number, got 0.0"),
        ({"output_step": -0.1}, "^output_step: .*got -0.1"),
        ({"output_step": 2.0}, "^output_step, duration: .*got 2.0"),
        ({"output_step": np.nan}, "^output_step: .*got nan"),
        ({"method": "euler"}, "^method: wanted .*got 'euler'"),
    ],
)
def test_another_argument_out_of_range_is_named(options, wanted):
    duration = options.pop("duration", 1.0)
    with pytest.raises(ValueError, match=wanted):
        record(qtz5613.model(1, 1), qtz5613.motions(), duration, **options)


def test_starts_and_times_of_the_wrong_shape_are_named():
    exact = oscillator()
    cut = phases((exact.motion,), 1.0)
    for start in (np.zeros(3), np.zeros((1, 2)), np.zeros((2, 2))):
        with pytest.raises(ValueError, match=r"^start: wanted 2 states in one row, got the shape \("):
            integrate(exact.system, cut, start, np.zeros(1))
    for times in (np.array([1.0, 0.5]), np.array([0.0, np.nan]), np.zeros((2, 1))):
        with pytest.raises(ValueError, match=r"^sample_times: wanted finite, increasing times in one row, got"):
            integrate(exact.system, cut, np.zeros(2), times)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("times", [[], [0.0], [60.0], [0.0, 60.0], [31.0]])
def test_phases_need_no_rows(method, times):
    exact, times = driven(), np.array(times)
    cut = phases((exact.motion,), exact.duration)
    assert len(cut.inputs) > 2
    run = integrate(exact.system, cut, np.zeros(2), times, method=method, rtol=1e-7, atol=1e-9)
    assert run.outcome == "finished"
    assert np.array_equal(run.times, times)
    assert np.all(abs(run.states - exact.solution(times)) < 2e-5)
    slopes, guards = evaluate(exact.system, cut, times, run.states)
    assert (slopes.shape, guards.shape) == ((len(times), 2), (len(times), 0))


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        ("hard/speed-jump", ["run.duration=8 s"]),
        ("qtz5613/condition-3", ["run.output_step=20 s", "run.duration=20 s"]),
        ("qtz5613/condition-3", ["run.output_step=5 s", "run.duration=21 s"]),
    ],
)
def test_few_rows_are_the_same_by_every_method(name, changes):
    found = []
    for method in ("dop853", "scipy-dop853"):
        case = load_case(name, [*changes, f"solver.method={method}"])
        result = record_case(case)
        assert result.attrs["outcome"] == "finished"
        found.append(result["payload_position"].values)
    assert np.allclose(*found, rtol=0.0, atol=1e-5)


def test_lanes_need_no_rows_in_a_phase():
    model, drives = qtz5613.model(1, 1), qtz5613.motions()
    cut = phases((drives["trolley"], drives["rope"]), 20.0)
    ends = [
        integrate_many([LaneRun(model, cut)], np.array(times), rtol=1e-5, atol=1e-7, threads=1).end_states
        for times in ([], [20.0], [0.0, 20.0], np.linspace(0.0, 20.0, 100))
    ]
    assert all(np.array_equal(end, ends[0]) for end in ends)

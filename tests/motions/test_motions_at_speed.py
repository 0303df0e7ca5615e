"""Motions that begin at speed, and that end at speed and go on."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from towercrane import load_case
from towercrane.cases.models import model_of
from towercrane.motions.motion import phases, rest, sequence
from towercrane.motions.profiles import smooth_ramps, speed_trapezoid, table
from towercrane.motions.superposition import total
from towercrane.runs.run import record_case
from towercrane.schema.faults import CaseError

SPEEDS = [
    speed_trapezoid(2.0, 0.8, 3.0, 4.0, 0.2, -0.5),
    smooth_ramps(2.0, 0.8, 3.0, 4.0, 0.2, -0.5),
    speed_trapezoid(2.0, 0.8, 3.0, 0.0, 0.2, -0.5),
    table([0.0, 3.0, 7.0, 10.0], [2.0, 3.0, 6.0, 6.2], 0.2, -0.5),
]


@pytest.mark.parametrize("motion", SPEEDS)
def test_speed_is_continuous_from_its_first_value_to_the_one_it_goes_on_at(motion):
    assert_allclose([motion(0.0), motion(0.0, 1)], [2.0, 0.2], rtol=1e-14)
    end = motion.duration
    assert_allclose([motion(end + 7.0), motion(end + 7.0, 1)], [motion.end - 3.5, -0.5], rtol=1e-14)
    assert motion(end + 7.0, 2) == 0.0
    for order in (0, 1):
        before, after = (motion(motion.switch_times + step, order) for step in (-1e-7, 1e-7))
        assert_allclose(after[1:], before[1:], atol=1e-6)
    times = np.linspace(0.0, end + 2.0, 200_001)
    assert_allclose(np.trapezoid(motion(times, 1), times), motion(times[-1]) - 2.0, rtol=1e-8)
    assert motion.range(until=end + 20.0)[0] == pytest.approx(motion.end - 10.0)
    assert motion.range(1)[0] <= -0.5
    assert motion.stop == np.inf
    assert rest(1.0, 3.0).stop == 3.0


def test_ramps_between_speeds_have_their_closed_way():
    for motion in SPEEDS[:2]:
        assert_allclose(motion.end, 2.0 + 3.0 * 0.5 * (0.2 + 0.8) + 4.0 * 0.8 + 3.0 * 0.5 * (0.8 - 0.5), rtol=1e-14)
    # Steady from the first instant on.
    steady = speed_trapezoid(1.0, 0.3, 2.0, 5.0, 0.3, 0.3)
    times = np.linspace(0.0, 30.0, 31)
    assert_allclose(steady(times), 1.0 + 0.3 * times, rtol=1e-14)


def test_what_goes_on_does_so_in_phases_sequences_and_sums():
    going = speed_trapezoid(2.0, 0.8, 1.0, 1.0, 0.0, 0.4)
    cut = phases((going, rest(5.0, 4.0)), 12.0)
    assert_allclose(cut.after[0, :2], [going(12.0), 0.4])
    piece = cut.inputs[-1, 0]
    assert_allclose([piece[0], piece[1]], [going(cut.times[-2]), 0.4])
    followed = sequence(rest(2.0, 3.0), going)
    assert_allclose(followed(20.0), going(17.0), rtol=1e-14)
    summed = total([going, going], [0.0, 5.0], [1.0, 2.0])
    assert_allclose(summed(30.0), going(30.0) + 2.0 * going(25.0), rtol=1e-14)


def test_motions_from_rest_to_rest_have_the_bits_they_had():
    old = speed_trapezoid(1.0, 0.7, 3.1, 2.3)
    assert_allclose(
        old.coefficients, [[1.0, 0.0, 0.7 / 6.2], [2.085, 0.7, 0.0], [3.695, 0.7, -0.7 / 6.2]], rtol=1e-15
    )
    assert old.end_rate == 0.0
    assert old.stop == old.duration


TURN = "shape='speed-trapezoid', speed='0.7 rpm', ramp='2 s', hold='1 s'"
SPEEDING = "shape='speed-trapezoid', speed='0.5 m/s', ramp='2 s', hold='1 s'"


@pytest.mark.parametrize(
    ("name", "changes", "words"),
    [
        (
            "qtz5613/slewing",
            ["motion.slewing={" + TURN + ", start_speed='0.7 rpm', delay='2 s'}"],
            ["motion.slewing", "speed at which the one before ends", "a delay is at rest"],
        ),
        (
            "qtz5613/condition-3",
            ["motion.trolley={start='5 m', shape='sequence', steps=[{" + SPEEDING + ", end_speed='0.4 m/s'},"
             "{shape='rest'}]}"],
            ["motion.trolley", "here 0.4 m/s", "one that begins at 0 m/s"],
        ),
        (
            "qtz5613/condition-3",
            ["motion.trolley={start='5 m', " + SPEEDING + ", start_speed='12 m/s'}"],
            ["motion.trolley.start_speed", "m/min"],
        ),
        (
            "qtz5613/condition-3",
            ["motion.trolley={start='5 m', " + SPEEDING + ", start_sped='0.5 m/s'}"],
            ['closest known key: "start_speed"'],
        ),
        (
            "qtz5613/slewing",
            ["motion.slewing.start_speed=0.05 rad/s"],
            ["motion.slewing.start_speed", 'a key of shape = "speed-trapezoid" or "smooth"'],
        ),
        (
            "qtz5613/slewing",
            ["motion.slewing={" + TURN + ", start_speed='0.7 m/s'}"],
            ["motion.slewing.start_speed", "rad/s"],
        ),
        (
            "qtz5613/condition-3",
            ["motion.trolley={start='5 m', " + SPEEDING + ", end_speed='0.5 m/s'}", "run.duration=120 s"],
            ["motion.trolley", "positions on the jib", "a motion from 5 to"],
        ),
        (
            "qtz5613/gusts-working",
            ["motion.slewing={" + TURN + ", start_speed='0.7 rpm'}"],
            ["start.state", '"zero"', "in a wind nothing turns steadily"],
        ),
    ],
)  # fmt: skip
def test_speeds_that_cannot_be_are_told_in_one_message(name, changes, words):
    with pytest.raises(CaseError) as caught:
        load_case(name, changes)
    assert len(caught.value.faults) == 1, caught.value
    for word in words:
        assert word in str(caught.value)


def test_a_run_that_ends_at_speed_is_no_fault_and_its_load_travels_along():
    few = ["model.tower_modes=1", "model.jib_vertical_modes=1", "run.duration=10 s"]
    motion = "motion.trolley={start='5 m', " + SPEEDING + ", start_speed='0.5 m/s', end_speed='0.5 m/s'}"
    run = record_case(load_case("qtz5613/condition-3", [*few, motion]))
    assert run.attrs["outcome"] == "finished"
    assert_allclose(run["trolley_position"].values[-1], 10.0, rtol=1e-12)
    # On a jib that hardly yields there the load neither stays behind nor swings.
    assert abs(run["sway_radial"].values).max() < 2e-3
    assert abs(run["payload_position"].values[-1, 0] - 10.0) < 0.1


def test_a_turn_that_begins_at_speed_leaves_the_plane():
    going = "shape='speed-trapezoid', speed='0 rpm', start_speed='0.1 rpm', ramp='2 s', hold='1 s'"
    assert model_of(load_case("qtz5613/slewing", ["motion.slewing={" + going + "}"])).axes == 3


def test_shapes_that_leave_the_load_at_rest_are_from_rest_to_rest():
    motion = "motion.trolley={start='5 m', " + SPEEDING + ", start_speed='0.5 m/s'}"
    case = load_case("qtz5613/condition-3", [motion, "run.duration=5 s"])
    assert [name for name, plan in case.plans.items() if plan.at_speed] == ["trolley"]

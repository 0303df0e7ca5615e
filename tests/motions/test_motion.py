"""Motions: limits kept, ways travelled exactly, switch points where they belong."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.polynomial.polynomial import polyder, polyval
from numpy.testing import assert_allclose

from towercrane.motions.motion import SAME_INSTANT, Motion, phases, rest, sequence
from towercrane.motions.profiles import SHORTEST_WAY, s_curve, smooth_ramps, table, trapezoid
from towercrane.motions.superposition import total

positive = st.floats(0.01, 10.0)
place = st.floats(-50.0, 50.0)


def sampled(motion: Motion) -> np.ndarray:
    inside = np.linspace(0.0, motion.duration, 501)
    return np.unique(np.r_[inside, motion.switch_times])


@given(place, place, positive, positive)
def test_trapezoid_travels_exactly_within_its_limits(start, end, speed, acceleration):
    motion = trapezoid(start, end, speed, acceleration)
    t = sampled(motion)
    assert_allclose([motion(0.0), motion.end], [start, end], atol=1e-11)
    assert np.max(abs(motion(t, 1))) <= speed * (1 + 1e-12)
    assert np.max(abs(motion(t, 2))) <= acceleration * (1 + 1e-12)
    way = abs(end - start)
    if way < SHORTEST_WAY:
        assert motion.duration == 0.0
        return
    shortest = (
        way / speed + speed / acceleration if way > speed**2 / acceleration else 2 * np.sqrt(way / acceleration)
    )
    assert_allclose(motion.duration, shortest, atol=4e-9, rtol=1e-12)


@given(place, place, positive, positive, positive)
def test_s_curve_travels_exactly_within_its_limits(start, end, speed, acceleration, jerk):
    motion = s_curve(start, end, speed, acceleration, jerk)
    t = sampled(motion)
    assert_allclose([motion(0.0), motion.end], [start, end], atol=1e-10)
    assert np.max(abs(motion(t, 1))) <= speed * (1 + 1e-9)
    assert np.max(abs(motion(t, 2))) <= acceleration * (1 + 1e-9)
    assert np.max(abs(motion(t, 3))) <= jerk * (1 + 1e-9)
    # At rest at both ends, whichever limits were reached.
    last = motion.coefficients[-1]
    span = motion.switch_times[-1] - motion.switch_times[-2]
    assert abs(np.polyval(np.polyder(last[::-1]), span)) < 1e-7


@given(place, place, positive, positive)
def test_s_curve_with_endless_jerk_is_the_trapezoid(start, end, speed, acceleration):
    ramp, curve = trapezoid(start, end, speed, acceleration), s_curve(start, end, speed, acceleration, 1e9)
    t = np.linspace(0.0, ramp.duration + 1.0, 50)
    assert_allclose(curve(t), ramp(t), atol=1e-6)


# No hold that begins and ends at the same instant.
@given(place, st.floats(-5.0, 5.0).filter(lambda v: abs(v) > 1e-3), positive, st.just(0.0) | st.floats(1e-6, 20.0))
def test_smooth_ramps_travel_exactly_without_jumps_up_to_jerk(start, speed, ramp, hold):
    motion = smooth_ramps(start, speed, ramp, hold)
    t = sampled(motion)
    assert_allclose([motion(0.0), motion.end], [start, start + speed * (ramp + hold)], atol=1e-9)
    assert np.max(abs(motion(t, 1))) <= abs(speed) * (1 + 1e-9)
    assert_allclose(np.max(np.abs(motion.range(2))), 15 / 8 * abs(speed) / ramp, rtol=1e-9)
    for derivative in range(4):
        scale = abs(speed) / ramp ** (derivative - 1) * 100
        # One piece's end is the next one's beginning; the last piece ends at rest.
        ends = [
            polyval(span, polyder(piece, derivative))
            for piece, span in zip(motion.coefficients, np.diff(motion.switch_times), strict=True)
        ]
        begins = [*(motion(motion.switch_times[1:-1], derivative)), motion.end if derivative == 0 else 0.0]
        assert_allclose(ends, begins, atol=1e-9 * max(scale, 1.0), rtol=1e-9)


def test_smooth_ramps_follow_the_quintic_step():
    motion = smooth_ramps(20.0, -0.2, 4.0, 36.0)
    assert_allclose(motion.switch_times, [0, 4, 40, 44])
    x = np.linspace(0, 1, 9)
    assert_allclose(motion(4 * x, 1), -0.2 * (10 * x**3 - 15 * x**4 + 6 * x**5), atol=1e-15)
    assert_allclose(motion(40 + 4 * x[:-1], 1), -0.2 * (1 - 10 * x**3 + 15 * x**4 - 6 * x**5)[:-1], atol=1e-14)


def test_conditions_of_the_source_reach_speed_at_4_and_8_seconds():
    assert_allclose(trapezoid(5, 41, 0.4, 0.1).switch_times, [0, 4, 90, 94])
    assert_allclose(trapezoid(5, 41, 0.8, 0.1).switch_times, [0, 8, 45, 53])


def test_value_and_rate_are_continuous_and_derivatives_match():
    motion = sequence(rest(3.0, 2.0), s_curve(3, 9, 1.0, 0.5, 0.4), rest(9.0, 1.0), trapezoid(9, 1, 2, 1))
    for t in motion.switch_times:
        assert_allclose(motion(t - 1e-7), motion(t + 1e-7), atol=5e-7)
        assert_allclose(motion(t - 1e-7, 1), motion(t + 1e-7, 1), atol=5e-7)
    middle = 0.5 * (motion.switch_times[:-1] + motion.switch_times[1:])
    for order in (0, 1, 2):
        slope = (motion(middle + 1e-5, order) - motion(middle - 1e-5, order)) / 2e-5
        assert_allclose(motion(middle, order + 1), slope, atol=1e-5)


def test_before_and_after_it_rests():
    motion = trapezoid(5, 41, 0.8, 0.1)
    assert_allclose(motion([-3.0, 99.0]), [5.0, 41.0])
    assert_allclose(motion([-3.0, 99.0, motion.duration], 1), 0.0)
    assert_allclose(motion(0.0, 2), 0.1)
    assert motion(np.zeros((2, 3))).shape == (2, 3)


def test_range_finds_the_turning_points_between_samples():
    assert_allclose(table([0, 1, 2], [0, 1, 0]).range(), (0, 1))
    low, high = table([0, 1, 2, 3], [0, 1, 1, 0]).range()
    t = np.linspace(0, 3, 100_001)
    assert_allclose([low, high], [0.0, table([0, 1, 2, 3], [0, 1, 1, 0])(t).max()], atol=1e-9)


def test_table_passes_its_points_and_starts_and_ends_at_rest():
    motion = table([0, 10, 25, 40], [5, 9, 30, 41])
    assert_allclose(motion([0, 10, 25, 40]), [5, 9, 30, 41])
    assert_allclose(motion([0.0, 40.0], 1), 0.0, atol=1e-12)
    assert_allclose(motion(10 - 1e-9, 2), motion(10 + 1e-9, 2), atol=1e-6)


@given(st.lists(st.tuples(st.floats(0.01, 30.0), place), min_size=1, max_size=12), place)
def test_a_table_stays_between_neighbouring_points(rows, first):
    times = np.concatenate([[0.0], np.cumsum([step for step, _ in rows])])
    values = np.array([first, *(value for _, value in rows)])
    motion = table(times, values)
    for start, stop, ends in zip(times[:-1], times[1:], pairwise(values), strict=True):
        inside = motion(np.linspace(start, stop, 40)[1:-1])
        assert inside.min() >= min(ends) - 1e-9
        assert inside.max() <= max(ends) + 1e-9


def test_a_table_of_a_smooth_way_has_its_acceleration():
    # Up and back, the highest point a third of a step from a sample; second order in the step.
    errors = []
    for step in (0.2, 0.1):
        t = np.arange(0.0, 40.0 + step / 2, step)
        phase = 2.0 * np.pi * t / (40.0 + 2.0 * step / 3.0)
        motion = table(t, 5.0 * (1.0 - np.cos(phase)) ** 2)
        true = 10.0 * (phase[1] / step) ** 2 * (np.cos(phase) - np.cos(2.0 * phase))
        # Away from the end, where the table stops and the way does not quite.
        inner = slice(3, -25)
        errors.append(np.max(abs(motion(t, 2) - true)[inner]))
    assert errors[0] < 4e-3
    assert 3.0 < errors[0] / errors[1] < 5.0


def test_range_of_numbers_whose_squares_are_none():
    # A parabola that turns at 0.5, and a motion that goes on.
    large = Motion(np.array([0.0, 1.0]), 1e200 * np.array([[0.0, 1.0, -1.0]]))
    assert_allclose(large.range(), (0.0, 0.25e200), rtol=1e-12)
    goes_on = replace(large, end_rate=-1e308)
    assert goes_on.range(until=3.0) == (-np.inf, pytest.approx(0.25e200))
    assert float(goes_on(0.0)) == 0.0


def test_range_of_a_derivative_of_every_degree():
    rng = np.random.default_rng(2)
    for width in range(1, 8):
        motion = Motion(np.array([0.0, 1.5, 4.0]), rng.normal(size=(2, width)))
        for derivative in range(3):
            times = np.concatenate([np.linspace(0.0, 1.5 - 1e-8, 40_001), np.linspace(1.5, 4.0 - 1e-8, 40_001)])
            seen = motion(times, derivative)
            low, high = motion.range(derivative)
            size = 1.0 + abs(seen).max()
            assert_allclose([low, high], [min(seen.min(), low), max(seen.max(), high)], atol=1e-12)
            resting = [motion.coefficients[0, 0], motion.end] if derivative == 0 else [0.0]
            assert_allclose([low, high], [min(*seen, *resting), max(*seen, *resting)], atol=1e-6 * size)


def test_phases_cut_at_the_union_and_merge_rounding():
    trolley = sequence(rest(0.0, 0.1 + 0.2), trapezoid(0, 3, 1, 1))
    rope = sequence(rest(9.0, 0.3), trapezoid(9, 7, 1, 1))
    cut = phases((trolley, rope), 4.0)
    assert_allclose(cut.times, [0, 0.3, 1.3, 2.3, 3.3, 4.0])
    assert cut.inputs.shape == (5, 2, 3)
    for phase, (start, stop) in enumerate(zip(cut.times[:-1], cut.times[1:], strict=True)):
        for local in (0.1 * (stop - start), 0.9 * (stop - start)):
            for channel, motion in enumerate((trolley, rope)):
                value = np.polyval(cut.inputs[phase, channel, ::-1], local)
                assert_allclose(value, motion(start + local), atol=1e-9)


SPANS = st.lists(st.one_of(st.floats(1e-10, 3e-9), st.floats(0.01, 2.0)), min_size=1, max_size=8)
"""Spans of pieces, some of which last hardly an instant."""


@st.composite
def jerky(draw) -> Motion:
    """Motion without jumps of value or rate, whose switches may follow each other within an instant."""
    spans = draw(SPANS)
    value, rate, pieces = draw(place), 0.0, []
    for span in spans:
        acceleration, jerk = draw(st.floats(-2.0, 2.0)), draw(st.floats(-3.0, 3.0))
        pieces.append([value, rate, acceleration / 2, jerk / 6])
        value, rate = (float(polyval(span, polyder(pieces[-1], k))) for k in (0, 1))
    return Motion(np.concatenate([[0.0], np.cumsum(spans)]), np.array(pieces))


def away_from(switches: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Those of the times that are no instant beside a switch."""
    gaps = abs(times[:, None] - switches).min(axis=1)
    return times[gaps > 2.0 * SAME_INSTANT]


def exact(motion: Motion, time: float, derivative: int) -> float:
    """Value of the piece that holds, the motion at rest once its pieces are over."""
    if time >= motion.duration:
        return motion.end if derivative == 0 else 0.0
    piece = int(np.searchsorted(motion.switch_times, time, side="right")) - 1
    return float(polyval(time - motion.switch_times[piece], polyder(motion.coefficients[piece], derivative)))


def assert_same_everywhere(motions, duration: float, value) -> None:
    """``value(time, channel, derivative)`` is that of the motions, but for an instant beside their switches."""
    switches = np.concatenate([m.switch_times for m in motions])
    times = away_from(np.append(switches, 0.0), np.linspace(0.0, duration, 14)[:-1])
    for time in times:
        for channel, motion in enumerate(motions):
            for derivative in (0, 1, 2):
                wanted = exact(motion, time, derivative)
                assert_allclose(value(time, channel, derivative), wanted, rtol=1e-10, atol=1e-10)


@settings(deadline=None, max_examples=40)
@given(st.lists(jerky(), min_size=1, max_size=3), st.floats(0.5, 10.0))
def test_phases_are_the_motions_everywhere(motions, duration):
    cut = phases(tuple(motions), duration)
    assert (cut.times[0], cut.times[-1]) == (0.0, duration)
    assert np.all(np.diff(cut.times) > 0.0)

    def value(time, channel, derivative):
        phase = int(np.searchsorted(cut.times, time, side="right")) - 1
        return polyval(time - cut.times[phase], polyder(cut.inputs[phase, channel], derivative))

    assert_same_everywhere(motions, duration, value)
    if len(away_from(np.concatenate([m.switch_times for m in motions]), np.array([duration]))):
        for channel, motion in enumerate(motions):
            for derivative in (0, 1, 2):
                found = polyder(cut.after[channel], derivative)[0]
                assert_allclose(found, exact(motion, duration, derivative), rtol=1e-10, atol=1e-10)


@settings(deadline=None, max_examples=40)
@given(st.lists(st.tuples(jerky(), st.floats(0.0, 3.0), st.floats(-2.0, 2.0)), min_size=1, max_size=3))
def test_a_sum_of_motions_is_their_sum_everywhere(parts):
    motions, delays, weights = zip(*parts, strict=True)
    found = total(motions, delays, weights)

    def summed(time, derivative):
        rests = [m.coefficients[0, 0] if derivative == 0 else 0.0 for m in motions]
        now = [
            exact(m, time - d, derivative) if time >= d else r for m, d, r in zip(motions, delays, rests, strict=True)
        ]
        return float(np.dot(weights, now))

    switches = np.concatenate(
        [found.switch_times, *(m.switch_times + d for m, d in zip(motions, delays, strict=True))]
    )
    for time in away_from(switches, np.linspace(0.0, found.duration + 1.0, 14)):
        for derivative in (0, 1, 2):
            assert_allclose(found(time, derivative), summed(time, derivative), rtol=1e-9, atol=1e-8)


def test_a_curve_of_hardly_limited_jerk_brakes_as_the_trapezoid_does():
    curve, ramp = s_curve(0.0, 1.0, 10.0, 1.0, 1.25e9), trapezoid(0.0, 1.0, 10.0, 1.0)
    cut = phases((curve,), 3.0)
    for time in (0.3, 0.9, 1.1, 1.7, 2.5):
        phase = int(np.searchsorted(cut.times, time, side="right")) - 1
        local = time - cut.times[phase]
        for derivative in (0, 1, 2):
            found = polyval(local, polyder(cut.inputs[phase, 0], derivative))
            assert_allclose(found, ramp(time, derivative), rtol=0, atol=1e-8)


def test_phases_stop_at_the_duration():
    assert_allclose(phases((trapezoid(5, 41, 0.8, 0.1),), 20.0).times, [0, 8, 20])
    assert_allclose(phases((rest(1.0),), 20.0).times, [0, 20])


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: trapezoid(0, 1, 0.0, 1.0), "speed: wanted a positive finite number, got 0.0"),
        (lambda: s_curve(0, 1, 1.0, 1.0, -2.0), "jerk: wanted a positive finite number"),
        (lambda: sequence(rest(1.0, 1.0), rest(2.0)), "motion 2 begins at 2, the one before ends at 1"),
        (lambda: sequence(), "at least one motion"),
        (lambda: table([0, 2, 1], [0, 1, 2]), "start at 0 and increase"),
        (lambda: table([0.0], [1.0]), "two or more"),
        (lambda: rest(0.0, -1.0), "duration: wanted a finite number, zero or more"),
        (lambda: Motion(np.array([0.0, 1.0]), np.array([[np.nan]])), "finite numbers"),
    ],
)
def test_nonsense_is_refused(make, message):
    with pytest.raises(ValueError, match=message):
        make()

"""Shapers: exact residuals, exact ways, limits kept."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from oracles.oscillator import residual

from towercrane.motions.motion import SAME_INSTANT, rest, sequence
from towercrane.motions.profiles import s_curve, smooth_ramps, trapezoid
from towercrane.motions.ramps import ramps, shape_ramps
from towercrane.motions.shaping import DESIGNS, Shaper, boxes, ei, minimum_jerk, zv, zvd

frequency = st.floats(0.05, 0.5)
limit = st.floats(0.05, 2.0)
design = st.sampled_from(sorted(DESIGNS))
RUN = trapezoid(5.0, 41.0, 0.8, 0.2)


# --- residuals -----------------------------------------------------------------------------------------


@given(frequency, st.floats(0.2, 3.0))
def test_residuals_are_the_closed_formulas(f, ratio):
    phase = np.pi * ratio
    assert_allclose(zv([f]).residual(ratio * f), abs(np.cos(phase / 2)), atol=1e-14)
    assert_allclose(zvd([f]).residual(ratio * f), np.cos(phase / 2) ** 2, atol=1e-14)
    assert_allclose(ei([f]).residual(ratio * f), abs(0.525 * np.cos(phase) + 0.475), atol=1e-14)
    assert_allclose(boxes([f]).residual(ratio * f), abs(np.sinc(ratio)), atol=1e-14)


@pytest.mark.parametrize("name", DESIGNS)
@pytest.mark.parametrize("shaped", [[0.1061], [0.1061, 0.1546]])
def test_residual_of_a_shaped_motion_is_the_shapers_times_the_motions(name, shaped):
    shaper = DESIGNS[name](shaped, 0.0)
    motion = shaper(RUN)
    for f in (0.031, 0.09, 0.1061, 0.13, 0.1546, 0.4):
        assert_allclose(residual(motion, f), shaper.residual(f) * residual(RUN, f), rtol=0, atol=2e-14)


@given(frequency, st.floats(0.0, 0.3))
def test_zero_vibration_leaves_nothing_with_damping_too(f, damping):
    for shaper in (zv([f], damping), zvd([f], damping)):
        assert shaper.residual(f, damping) < 1e-12
        assert residual(shaper(RUN), f, damping) < 1e-12
    expected = zv([f], damping).residual(1.1 * f, damping) * residual(RUN, 1.1 * f, damping)
    assert_allclose(residual(zv([f], damping)(RUN), 1.1 * f, damping), expected, atol=1e-12)


def test_residual_with_damping_counts_the_averages_too():
    shaper = zv([0.11], 0.05).then(boxes([0.2]))
    for f in (0.08, 0.15):
        expected = shaper.residual(f, 0.05) * residual(RUN, f, 0.05)
        assert_allclose(residual(shaper(RUN), f, 0.05), expected, atol=1e-14)


def test_derivative_is_zero_for_zvd_alone():
    h = 1e-4
    assert zvd([0.1]).residual(0.1 * (1 + h)) < 1.01 * (np.pi * h / 2) ** 2
    assert zv([0.1]).residual(0.1 * (1 + h)) > 0.99 * np.pi * h / 2
    assert zvd([0.1], 0.1).residual(0.1 * (1 + h), 0.1) < 1e-7


@given(st.floats(0.01, 0.3))
def test_extra_insensitive_leaves_what_is_tolerated_between_two_zeros(tolerated):
    shaper = ei([0.1], tolerated=tolerated)
    assert_allclose(shaper.residual(0.1), tolerated, rtol=1e-12)
    zero = np.arccos(-(1 - tolerated) / (1 + tolerated)) / np.pi
    assert_allclose(shaper.residual([0.1 * zero, 0.1 * (2 - zero)]), 0.0, atol=1e-13)
    within = shaper.residual(0.1 * np.linspace(zero, 2 - zero, 101))
    assert within.max() <= tolerated * (1 + 1e-12)
    assert shaper.residual(0.1 * (zero - 0.1)) > 0.0


@given(st.lists(frequency, min_size=2, max_size=3), design)
@settings(max_examples=30)
def test_several_modes_multiply(several, name):
    shaper, single = DESIGNS[name](several, 0.0), [DESIGNS[name]([f], 0.0) for f in several]
    probe = np.linspace(0.04, 0.6, 40)
    assert_allclose(shaper.residual(probe), np.prod([s.residual(probe) for s in single], axis=0), atol=1e-13)
    assert_allclose(shaper.duration, sum(s.duration for s in single))
    assert_allclose(shaper.mean_delay, sum(s.mean_delay for s in single))
    if name != "ei":
        assert shaper.residual(several).max() < 1e-12


def test_impulses_of_known_size_and_time():
    assert zv([0.25]) == Shaper((0.0, 2.0), (0.5, 0.5))
    assert zvd([0.25]) == Shaper((0.0, 2.0, 4.0), (0.25, 0.5, 0.25))
    assert_allclose(ei([0.25]).amplitudes, (0.2625, 0.475, 0.2625), rtol=1e-15)
    assert boxes([0.25, 0.5]).widths == (4.0, 2.0)
    # The same mode twice: instants that coincide are one impulse.
    assert zv([0.25, 0.25]) == zvd([0.25])
    damped = zv([0.25], 0.1)
    k = np.exp(-np.pi * 0.1 / np.sqrt(0.99))
    assert_allclose(damped.amplitudes, (1 / (1 + k), k / (1 + k)), rtol=1e-14)
    assert_allclose(damped.delays[1], 2.0 / np.sqrt(0.99), rtol=1e-14)


# --- motions -------------------------------------------------------------------------------------------


@given(st.floats(-50, 50), st.floats(-50, 50), limit, limit, st.lists(frequency, min_size=1, max_size=2), design)
def test_shaped_motions_travel_exactly_within_the_limits(start, end, speed, acceleration, several, name):
    plain, shaper = trapezoid(start, end, speed, acceleration), DESIGNS[name](several, 0.0)
    motion = shaper(plain)
    assert_allclose([motion(0.0), motion.end], [start, end], atol=1e-11)
    if plain.duration == 0.0:
        return
    assert_allclose(motion.duration, plain.duration + shaper.duration, atol=1e-8)
    for order in (1, 2):
        for mine, bound, sign in zip(motion.range(order), plain.range(order), (-1, 1), strict=True):
            assert sign * mine <= sign * bound + 1e-10
    low, high = sorted((start, end))
    assert low - 1e-10 <= motion.range()[0]
    assert motion.range()[1] <= high + 1e-10
    assert np.all(np.diff(motion.switch_times) > SAME_INSTANT)


@given(st.floats(-50, 50), limit, limit, st.tuples(frequency, frequency), st.tuples(design, design))
def test_ramps_of_their_own_frequencies_travel_exactly_within_the_limits(end, speed, acceleration, own, names):
    plain = trapezoid(0.0, end, speed, acceleration)
    shapers = [DESIGNS[name]([f], 0.0) for name, f in zip(names, own, strict=True)][: len(ramps(plain))]
    motion, ends = shape_ramps(plain, shapers)
    assert_allclose(motion.end, end, atol=1e-11)
    for order in (1, 2):
        bound = max(abs(b) for b in plain.range(order))
        assert max(abs(b) for b in motion.range(order)) <= bound + 1e-10
    if shapers:
        assert_allclose(max(ends), motion.duration, atol=1e-8)


def test_each_ramp_is_calm_at_its_own_frequency():
    way = trapezoid(0.0, 60.0, 0.8, 0.2)
    motion, ends = shape_ramps(way, [zvd([0.11]), zv([0.14])])
    # Cut where the speed is steady: the start's part and the stop's part.
    turn = 40.0
    assert motion(turn, 1) == pytest.approx(0.8, abs=1e-12)
    first = motion.switch_times[:-1] < turn
    for own, other, mine in ((0.11, 0.14, first), (0.14, 0.11, ~first)):
        part = type(motion)(motion.switch_times, np.where(mine[:, None], motion.coefficients, 0.0))
        assert residual(part, own) < 1e-13
        assert residual(part, other) > 0.05
    # The commanded stop ends at 79 s; it moves by the difference of the mean delays.
    assert_allclose(ends, [4.0 + 2 * 0.5 / 0.11, 79.0 + 0.5 / 0.11 - 0.25 / 0.14 + 0.5 / 0.14], rtol=1e-12)


def test_one_shaper_for_all_ramps_is_the_convolution():
    for plain in (RUN, s_curve(0, 20, 0.8, 0.3, 0.2), smooth_ramps(3.0, -0.4, 5.0, 7.0), trapezoid(0, 1, 9, 0.2)):
        for shaper in (zvd([0.11, 0.17]), boxes([0.11, 0.17])):
            whole, (parts, _) = shaper(plain), shape_ramps(plain, [shaper] * len(ramps(plain)))
            t = np.linspace(0.0, whole.duration, 301)
            for order in (0, 1):
                assert_allclose(parts(t, order), whole(t, order), atol=1e-12)


def test_waits_before_and_after_a_motion_stay():
    plain = sequence(rest(2.0, 3.0), trapezoid(2.0, 9.0, 0.5, 0.1), rest(9.0, 4.0))
    motion, _ = shape_ramps(plain, [zv([0.1])] * 2)
    assert_allclose(motion.duration, plain.duration + 5.0)
    assert motion(3.0) == pytest.approx(2.0)
    assert shape_ramps(rest(2.0, 3.0), [])[0].duration == 3.0
    assert zv([0.1])(rest(2.0)).duration == 0.0


def test_a_slower_start_than_stop_waits_for_it():
    # The stop's shaper delays more than the whole cruise lasts: nothing begins before the first ramp did.
    plain = sequence(rest(0.0, 1.0), trapezoid(0.0, 1.0, 0.5, 0.5))
    motion, ends = shape_ramps(plain, [zv([0.5]), zvd([0.05])])
    assert motion.end == pytest.approx(1.0, abs=1e-13)
    assert abs(motion(0.999)) < 1e-13
    assert ends[1] == pytest.approx(1.0 + 1.0 + 20.0)


def test_minimum_jerk_is_known():
    motion = minimum_jerk(2.0, 12.0, 8.0)
    assert_allclose([motion(0.0), motion(4.0), motion.end], [2.0, 7.0, 12.0], atol=1e-13)
    assert_allclose(motion.range(1), (0.0, 1.875 * 10 / 8), rtol=1e-12)
    assert_allclose(motion.range(2)[1], 10 / np.sqrt(3) * 10 / 64, rtol=1e-12)
    assert_allclose(motion([0.0, 7.9999999], 2), 0.0, atol=1e-6)
    assert minimum_jerk(2.0, 2.0, 8.0).duration == 8.0


def test_bad_shapers_are_refused():
    with pytest.raises(ValueError, match="frequencies: wanted one or more positive numbers in Hz, got "):
        zv([])
    with pytest.raises(ValueError, match=r"frequencies: wanted .* got \[0.1, -2\]"):
        boxes([0.1, -2])
    with pytest.raises(ValueError, match="damping_ratio: wanted a fraction of critical"):
        zvd([0.1], 1.0)
    with pytest.raises(ValueError, match=r"ei: damping_ratio wants 0, got 0\.1"):
        ei([0.1], 0.1)
    with pytest.raises(ValueError, match="boxes: damping_ratio wants 0"):
        boxes([0.1], 0.1)
    with pytest.raises(ValueError, match="ei: tolerated wants"):
        ei([0.1], tolerated=1.0)
    with pytest.raises(ValueError, match="wanted a shaper for each of 2 ramps, got 1"):
        shape_ramps(RUN, [zv([0.1])])
    with pytest.raises(ValueError, match="minimum_jerk: duration: wanted a positive finite number, got 0"):
        minimum_jerk(0.0, 1.0, 0)
    for delays, amplitudes, widths in (((1.0,), (1.0,), ()), ((0.0, 2.0), (0.5, 0.6), ()), ((0.0,), (1.0,), (0.0,))):
        with pytest.raises(ValueError, match=r"Shaper\."):
            Shaper(delays, amplitudes, widths)

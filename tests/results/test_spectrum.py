"""Peaks and periods of signals whose frequencies are known."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from towercrane.results.spectrum import _stands_out, amplitude_spectrum, spectrum_peaks, swing_period

TIMES = np.arange(2401) * 0.05


def test_two_sines_on_a_drift():
    signal = 3 * np.sin(2 * np.pi * 0.3118 * TIMES) + 0.5 * np.cos(2 * np.pi * 0.7945 * TIMES) + 0.2 * TIMES
    assert_allclose(spectrum_peaks(TIMES, signal), [0.3118, 0.7945], atol=2e-4)
    frequencies, amplitudes = amplitude_spectrum(TIMES, signal)
    assert_allclose(amplitudes.max(), 3.0, rtol=5e-3)
    assert_allclose(frequencies[np.argmax(amplitudes)], 0.3118, atol=1e-3)


def test_a_peak_between_two_bins_is_at_worst_a_quarter_of_a_percent_low():
    lines = np.linspace(0.5, 0.5 + 1.0 / TIMES[-1], 129)
    heights = [amplitude_spectrum(TIMES, 2.0 * np.sin(2 * np.pi * f * TIMES))[1].max() for f in lines]
    # Hann's lobe falls by (pi^2 / 6 - 1) x^2 at x bins from its middle, here up to half of an eighth.
    assert_allclose(1.0 - min(heights) / 2.0, (np.pi**2 / 6 - 1) / 16**2, rtol=0.08)


def test_two_near_lines_are_told_apart():
    signal = np.sin(2 * np.pi * 0.45 * TIMES) + 0.6 * np.sin(2 * np.pi * 0.49 * TIMES)
    assert_allclose(spectrum_peaks(TIMES, signal), [0.45, 0.49], atol=1e-3)


def test_weak_peaks_and_side_lobes_are_left_out():
    signal = np.sin(2 * np.pi * 0.45 * TIMES) + 0.01 * np.sin(2 * np.pi * 2.0 * TIMES)
    assert len(spectrum_peaks(TIMES, signal)) == 1


def test_too_short_a_signal_has_no_peaks():
    assert spectrum_peaks(TIMES[:5], TIMES[:5]) == []
    assert spectrum_peaks(TIMES, np.zeros_like(TIMES)) == []


def test_period_of_a_swing_off_centre():
    angle = 0.02 * np.sin(2 * np.pi * TIMES / 8.514 + 1.0) + 0.001
    assert_allclose(swing_period(TIMES, angle), 8.514, rtol=1e-4)
    assert swing_period(TIMES[:20], angle[:20]) is None
    assert swing_period(TIMES, np.zeros_like(TIMES)) is None
    assert swing_period(TIMES, 1e-9 * angle) is None
    two = np.sin(2 * np.pi * TIMES / 8.5) + 0.9 * np.sin(2 * np.pi * TIMES / 1.6)
    assert swing_period(TIMES, two) is None


def test_a_swing_of_fewer_than_eight_samples_has_no_period():
    samples = np.array([7.96, 8.04])
    found = [swing_period(TIMES, 0.02 * np.sin(2 * np.pi * TIMES / (0.05 * n) + 1.0)) for n in samples]
    assert found == [None, pytest.approx(0.05 * 8.04, rel=2e-3)]


def test_a_last_row_off_the_grid_does_not_shift_the_peaks():
    times = np.append(TIMES, TIMES[-1] + 0.013)
    assert_allclose(spectrum_peaks(times, np.sin(2 * np.pi * 0.5 * times)), [0.5], atol=1e-4)


def test_a_shoulder_on_a_flank_is_no_peak():
    # The dip before the higher neighbour has to reach two thirds of the peak.
    assert not _stands_out(np.array([0.0, 10.0, 8.0, 9.0, 2.0, 0.0]), 3)
    assert _stands_out(np.array([0.0, 10.0, 5.0, 9.0, 2.0, 0.0]), 3)
    assert _stands_out(np.array([0.0, 10.0, 8.0, 9.0, 2.0, 0.0]), 1)

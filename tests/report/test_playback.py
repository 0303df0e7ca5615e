"""Moments that a film shows."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from towercrane.report.film.playback import MOST_FRAMES, Playback, fitting_speed


def test_frames_are_even_and_end_where_the_span_does():
    assert_allclose(Playback(2.0, 4.0, 5.0, 20.0).times, np.linspace(2.0, 4.0, 9), rtol=1e-15)
    # 0.05 s does not divide the span: the end has a frame of its own.
    assert_allclose(Playback(0.0, 0.12, 1.0, 20.0).times, [0.0, 0.05, 0.1, 0.12], rtol=1e-15)
    assert len(Playback(0.0, 120.0, 1.0, 50.0).times) == MOST_FRAMES + 1
    times = Playback(0.0, 12.3, 0.7, 30.0).times
    assert times[-1] == 12.3
    assert np.diff(times).max() <= 0.7 / 30.0 * (1 + 1e-12)


@pytest.mark.parametrize(("span", "speed"), [(1.0, 1.0), (30.0, 1.0), (30.1, 2.0), (120.0, 5.0), (3600.0, 200.0)])
def test_unasked_a_film_lasts_half_a_minute_at_most(span, speed):
    assert fitting_speed(span) == speed
    assert len(Playback(0.0, span, speed).times) <= 601


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"start": -1.0}, "Playback.start: wanted zero or more seconds, got -1 s"),
        ({"start": float("nan")}, "Playback.start"),
        ({"start": 10.0}, "Playback.end: wanted more than 10 s, the start, got 10 s"),
        ({"end": float("inf")}, "Playback.end"),
        ({"speed": 0.0}, "Playback.speed: wanted 0.001 to 1000 times real time, got 0"),
        ({"speed": float("nan")}, "Playback.speed"),
        ({"frames_per_second": 0.0}, "Playback.frames_per_second: wanted 1 to 100, got 0"),
        ({"frames_per_second": float("inf")}, "Playback.frames_per_second"),
        ({"speed": 0.01}, "at most 6000 frames, got 0.01, at which they take 20000"),
    ],
)
def test_absurd_playback_is_refused(wrong, said):
    with pytest.raises(ValueError, match=said.replace(".", r"\.")):
        Playback(**{"start": 0.0, "end": 10.0, **wrong})

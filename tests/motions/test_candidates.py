"""Motions that a study of shaping puts beside each other."""

import pytest

from towercrane.cranes.tower.sway_frequencies import PendulumFrequencies
from towercrane.motions.motion import rest
from towercrane.motions.plans import Move, Plan
from towercrane.motions.profiles import trapezoid
from towercrane.studies.candidates import candidates


def test_each_drive_of_least_jerk_takes_as_long_as_its_zvd():
    """Trolley and head start and stop at different times; the hoist stays as it is."""
    plans = {
        "trolley": Plan((Move(trapezoid(10.0, 25.0, 0.8, 0.1)), Move(trapezoid(25.0, 22.0, 0.5, 0.2)))),
        "rope": Plan((Move(rest(12.0, 60.0)),)),
        "slewing": Plan((Move(trapezoid(0.0, 1.0, 0.06, 0.01)),)),
    }
    found = {c.name: c for c in candidates(plans, PendulumFrequencies(9.81), PendulumFrequencies(9.81))}
    for channel in ("trolley", "slewing"):
        smooth, zvd, plain = (found[name].motions[channel] for name in ("minimum-jerk", "zvd", "commanded"))
        assert smooth.duration == pytest.approx(zvd.duration, rel=1e-12)
        assert smooth.duration > plain.duration + 5.0
        assert smooth.end == pytest.approx(plain.end)
        assert float(smooth(0.0)) == float(plain(0.0))
    assert found["minimum-jerk"].motions["trolley"].duration != found["minimum-jerk"].motions["slewing"].duration
    smooth = found["minimum-jerk"].motions["slewing"]
    middle = 0.5 * smooth.duration
    assert float(smooth(middle, 1)) == pytest.approx(1.875 / smooth.duration)

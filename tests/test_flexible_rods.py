"""The flexible crane in space beside geometrically exact rods: equal but for second-order terms, which are named."""

import numpy as np
import pytest
from rod_comparison import BRISK, Comparison, shortening
from space_crane import standing

TOP, TROLLEY, LOAD = range(3)
RADIAL, LATERAL, VERTICAL = range(3)


@pytest.fixture(scope="module")
def as_it_is():
    return Comparison(1.0, BRISK, 12.0)


@pytest.fixture(scope="module")
def stiff():
    return Comparison(4.0, BRISK, 12.0)


def largest(pair, motion):
    """Differences of tower top, trolley and load, radial, lateral and vertical [mm]."""
    return 1e3 * abs(pair.gaps(motion)).max(axis=1)


def test_at_rest_shortening_and_weight_explain_the_difference():
    found = {}
    for factor in (1.0, 4.0):
        pair = Comparison(factor, standing(40.0, 12.0), 0.25)
        drawn_in = standing(40.0 - float(shortening(pair.plain)[0]), 12.0)
        both = pair.course(drawn_in, weight_softening=True)
        found[factor] = [1e3 * pair.gaps(motion)[:, 0] for motion in (pair.plain, both)]
    plain, explained = found[1.0]
    assert plain[TROLLEY, RADIAL] == pytest.approx(46.85, abs=0.1)
    assert plain[TOP, RADIAL] == pytest.approx(-1.20, abs=0.02)
    # The jib's shortening has gone, and what the tower leans more under its weight. What is left vertically is the
    # rods' own stretch.
    assert np.all(abs(explained) < [[0.25, 1e-6, 0.25], [0.15, 1e-6, 0.3], [0.15, 1e-6, 0.3]])
    assert plain[TROLLEY, RADIAL] / found[4.0][0][TROLLEY, RADIAL] == pytest.approx(16.0, abs=0.2)


def test_manoeuvre_is_that_of_the_rods_but_for_second_order_terms(as_it_is, stiff):
    soft, hard = largest(as_it_is, as_it_is.plain), largest(stiff, stiff.plain)
    assert np.all(hard < [[0.15, 0.05, 0.05], [4.2, 1.0, 0.65], [4.4, 1.1, 0.8]])
    np.testing.assert_allclose(soft[TROLLEY], [73.6, 33.3, 17.2], rtol=0.02)
    np.testing.assert_allclose(soft[LOAD], [62.0, 56.4, 19.6], rtol=0.02)
    # Second order: a sixteenth. The lateral ones are of phase, which fewer swings make smaller still.
    ratio = soft / hard
    assert 15.0 < ratio[TROLLEY, RADIAL] < 21.0
    assert 13.0 < ratio[LOAD, RADIAL] < 18.0
    assert 12.0 < ratio[TOP, RADIAL] < 20.0
    assert np.all(ratio[1:, LATERAL:] > 24.0)
    # Of a motion a thousand times as large.
    heading, (_, places) = BRISK["slewing"](stiff.exact[0]), stiff.exact
    sway = places[LOAD] - places[TROLLEY]
    across = sway[:, 1] * np.cos(heading) - sway[:, 0] * np.sin(heading)
    assert np.ptp(across) > 2.0


def test_shortening_of_the_jib_explains_the_radial_difference(as_it_is, stiff):
    fed = largest(as_it_is, as_it_is.drawn_in)
    assert 2.5 < fed[TROLLEY, RADIAL] < 4.5
    assert fed[LOAD, RADIAL] < 12.0
    assert fed[TROLLEY, LATERAL] < 15.0
    assert 0.1 < largest(stiff, stiff.drawn_in)[TROLLEY, RADIAL] < 0.2


def test_weight_explains_the_towers_difference(stiff):
    softened = largest(stiff, stiff.softened)
    plain = largest(stiff, stiff.plain)
    assert plain[TOP, RADIAL] > 2.2 * softened[TOP, RADIAL]
    assert plain[TOP, LATERAL] > 2.5 * softened[TOP, LATERAL]

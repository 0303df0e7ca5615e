"""The flexible crane in space beside geometrically exact rods: equal but for second-order terms, which are named."""

import numpy as np
import pytest
from oracles import exact_rods
from oracles.rod_comparison import BRISK, Comparison, stiffer
from samples import space_crane as space
from samples.space_crane import standing

from towercrane.cranes.tower.equations.small_motions import natural_modes

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
        both = pair.drawn_in(weight_softening=True)
        found[factor] = [1e3 * pair.gaps(motion)[:, 0] for motion in (pair.plain, both)]
    plain, explained = found[1.0]
    assert plain[TROLLEY, RADIAL] == pytest.approx(46.85, abs=0.1)
    assert plain[TOP, RADIAL] == pytest.approx(-1.20, abs=0.02)
    # What the jib is drawn in, and what the tower leans more under its weight, have gone. What is left vertically
    # is the rods' own stretch.
    assert np.all(abs(explained) < [[0.25, 1e-6, 0.25], [0.15, 1e-6, 0.3], [0.15, 1e-6, 0.3]])
    assert plain[TROLLEY, RADIAL] / found[4.0][0][TROLLEY, RADIAL] == pytest.approx(16.0, abs=0.2)


def test_small_motions_about_equilibrium_have_the_rods_frequencies():
    misses = []
    for factor in (1.0, 4.0, 16.0):
        rods, inputs = exact_rods.crane_rods(stiffer(factor), 1500.0), np.array([40.0, 12.0, 0.0, 0.0, 0.0])
        squares = -np.linalg.eigvals(rods.gradient(exact_rods.at_rest(rods, inputs), inputs, 1e-4)).real
        # The first six are turns of trolley and load, which are points.
        exact = np.sqrt(np.sort(squares)[6:14]) / (2.0 * np.pi)
        modes = natural_modes(space.model(3, 2, 6, 6, 1500.0, crane=stiffer(factor)), 40.0, 12.0)
        misses.append(np.array([mode.frequency_hz for mode in modes[:8]]) / exact - 1.0)
    soft, stiff, rigid = misses
    # Sways, torsion and the jib's first modes; a sagging jib's tip also moves along it, which modes of bending lack.
    assert np.all(abs(soft[:4]) < [1e-3, 1e-4, 3e-4, 8e-4])
    assert np.all(abs(soft[[4, 6, 7]]) < [5e-3, 5e-3, 1.1e-2])
    assert soft[5] == pytest.approx(0.025, abs=0.001)
    # In proportion to the sag, which four times the stiffness makes a quarter.
    np.testing.assert_allclose(soft[5] / stiff[5], 3.9, atol=0.2)
    np.testing.assert_allclose(stiff[5] / rigid[5], 3.8, atol=0.2)
    assert np.all(abs(rigid) < [3e-5, 3e-5, 3e-5, 3e-4, 4e-4, 2e-3, 7e-4, 4e-4])


def test_manoeuvre_is_that_of_the_rods_but_for_second_order_terms(as_it_is, stiff):
    soft, hard = largest(as_it_is, as_it_is.plain), largest(stiff, stiff.plain)
    assert np.all(hard < [[0.15, 0.05, 0.05], [4.2, 1.0, 0.65], [4.4, 1.1, 0.8]])
    np.testing.assert_allclose(soft[TROLLEY], [73.6, 33.3, 17.2], rtol=0.01)
    np.testing.assert_allclose(soft[LOAD], [62.0, 56.4, 19.6], rtol=0.01)
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


def test_shortening_of_the_jib_explains_the_difference(as_it_is, stiff):
    fed = largest(as_it_is, as_it_is.drawn_in())
    assert fed[TROLLEY, RADIAL] == pytest.approx(3.6, abs=0.3)
    assert fed[LOAD, RADIAL] == pytest.approx(10.1, abs=0.5)
    np.testing.assert_allclose(fed[1:, LATERAL], [13.7, 23.6], rtol=0.03)
    # A jib that is drawn in is also easier to turn.
    eased = largest(as_it_is, as_it_is.drawn_in(jib=True))
    np.testing.assert_allclose(eased[1:, LATERAL], [7.2, 12.1], rtol=0.05)
    assert eased[LOAD, RADIAL] < 7.0
    hard = largest(stiff, stiff.drawn_in(jib=True))
    assert np.all(hard[1:] < [[0.2, 0.45, 0.75], [0.35, 0.5, 0.85]])


def test_weight_explains_the_towers_difference(stiff):
    softened = largest(stiff, stiff.softened)
    plain = largest(stiff, stiff.plain)
    assert plain[TOP, RADIAL] > 2.2 * softened[TOP, RADIAL]
    assert plain[TOP, LATERAL] > 2.5 * softened[TOP, LATERAL]

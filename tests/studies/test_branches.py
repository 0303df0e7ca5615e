"""Branches on systems whose answer is known: two or three oscillators, uncoupled or coupled."""

from dataclasses import dataclass

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from towercrane.studies.branches import CLEAR, FINEST, follow


@dataclass(frozen=True)
class Oscillators:
    frequencies: np.ndarray
    shapes: np.ndarray


def crossing(coupling: float, tangle: float = 0.0):
    """Squared frequencies 2 + t and 2 - t with unit masses, coupled; a third far above."""

    def solve(t: float) -> Oscillators:
        values, vectors = np.linalg.eigh([[2.0 + t, coupling, 0.0], [coupling, 2.0 - t, 0.0], [0.0, 0.0, 9.0]])
        shapes = vectors.T
        if t == 0.0:
            # Of a double frequency a solver may give any mixture.
            c, s = np.cos(tangle), np.sin(tangle)
            shapes = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) @ shapes
        signs = np.where(np.arange(3) % 2, 1.0, -1.0)
        return Oscillators(np.sqrt(values), signs[:, None] * shapes)

    return solve


def along(solve, places, kept=3):
    found = follow(solve, places, kept)
    return np.array([s.frequencies[r] for s, r in zip(found.spectra, found.ranks, strict=True)]), found


# Odd: a place on the crossing itself; even: none.
@pytest.mark.parametrize("number", [6, 7, 40, 41])
@pytest.mark.parametrize("tangle", [0.0, 0.3, np.pi / 4])
def test_uncoupled_oscillators_cross_straight_through(number, tangle):
    places = np.linspace(-1.0, 1.0, number)
    frequencies, found = along(crossing(0.0, tangle), places)
    assert_allclose(frequencies[:, 0], np.sqrt(2.0 + places), rtol=1e-14)
    assert_allclose(frequencies[:, 1], np.sqrt(2.0 - places), rtol=1e-14)
    assert_allclose(frequencies[:, 2], 3.0, rtol=1e-14)
    assert_allclose(found.agreement, 1.0, atol=1e-12)
    assert found.solved <= number + FINEST + 1


@pytest.mark.parametrize("number", [6, 7, 40, 41])
@pytest.mark.parametrize("coupling", [0.3, 0.03, 0.003])
def test_veering_keeps_the_order(number, coupling):
    places = np.linspace(-1.0, 1.0, number)
    frequencies, found = along(crossing(coupling), places)
    gap = np.hypot(places, coupling)
    assert_allclose(frequencies[:, 0], np.sqrt(2.0 - gap), rtol=1e-14)
    assert_allclose(frequencies[:, 1], np.sqrt(2.0 + gap), rtol=1e-14)
    assert CLEAR <= found.agreement.min() < 1.0


def test_veering_narrower_than_the_finest_step_counts_as_crossing():
    # No halving of these steps meets the crossing at zero itself.
    places = np.linspace(-1.0, 0.9, 6)
    finest = (places[1] - places[0]) / 2**FINEST
    narrow, _ = along(crossing(0.02 * finest), places)
    assert_allclose(narrow[:, 0], np.sqrt(2.0 + places), rtol=1e-6)
    wide, _ = along(crossing(5.0 * finest), places)
    assert (wide[:, 0] < wide[:, 1]).all()


def test_kept_branch_crosses_one_that_is_not_kept():
    places = np.linspace(-1.0, 0.9, 20)
    frequencies, _ = along(crossing(0.0), places, kept=1)
    assert_allclose(frequencies[:, 0], np.sqrt(2.0 + places), rtol=1e-14)


def test_order_at_the_first_place_is_carried_on():
    places = np.linspace(0.1, 1.0, 5)
    found = follow(crossing(0.0), places, 3, np.array([2, 0, 1]))
    assert_array_equal(found.ranks, np.tile([2, 0, 1], (5, 1)))


def test_one_place_is_a_path_and_none_is_not():
    assert_array_equal(follow(crossing(0.1), [0.2], 2).ranks, [[0, 1, 2]])
    with pytest.raises(ValueError, match="places: wanted at least one, got none"):
        follow(crossing(0.1), [], 2)
    for kept in (0, 4):
        with pytest.raises(ValueError, match=f"kept: wanted 1 to 3 modes, got {kept}"):
            follow(crossing(0.1), [0.0], kept)

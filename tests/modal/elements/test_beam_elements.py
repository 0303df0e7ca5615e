"""Hermite elements against the exact roots: constant, order, round-off floor."""

from __future__ import annotations

import numpy as np
import pytest

from modal import Beam, EndBody, cantilever_modes, finite_element_frequencies
from modal.elements.beam_elements import round_off_floor

INF = float("inf")
BEAM = Beam(23.8, 350.0, 206e9, 0.014)
FREE, QTZ5613 = (0.0, 0.0, 0.0), (2.877872, 2.009291, 0.0)


def errors(ratios, count, elements, **options):
    """Signed relative errors of the lowest frequencies."""
    a, j, h = ratios
    body = EndBody(a * BEAM.mass, j * BEAM.mass * BEAM.length**2, h * BEAM.length)
    exact = cantilever_modes(BEAM, count, body).angular_frequencies
    return finite_element_frequencies(BEAM, count, body, elements=elements, **options) / exact - 1.0


@pytest.mark.parametrize(
    ("ratios", "elements", "expected"),
    [
        (FREE, 8, [2.083e-6, 7.996e-5, 6.082e-4, 2.240e-3]),
        (FREE, 32, [8.18e-9, 3.210e-7, 2.512e-6, 9.622e-6]),
        (QTZ5613, 4, [2.002e-8, 1.381e-6, 1.328e-3, 9.214e-3]),
        (QTZ5613, 16, [8.1e-11, 5.39e-9, 5.315e-6, 4.013e-5]),
    ],
)
def test_errors_are_those_of_the_element(ratios, elements, expected):
    """Discretisation errors from above, to the digits given."""
    np.testing.assert_allclose(errors(ratios, 4, elements), expected, rtol=3e-2, atol=2e-12)


@pytest.mark.parametrize(
    "ratios",
    [FREE, QTZ5613, (2.0, 0.5, -0.4), (1e8, 1e8, 0.0), (INF, 2.0, 0.3), (0.3, INF, 0.3)],
)
def test_lowest_modes_within_a_millionth_of_the_roots(ratios):
    # Below zero only by rounding: elements are too stiff, never too soft.
    error = errors(ratios, 2, 40)
    assert (error > -1e-10).all()
    assert (error < 1e-6).all()


@pytest.mark.parametrize("ratios", [(INF, 0.0, 0.0), (INF, INF, 0.0), (0.0, INF, 0.0)])
def test_held_ends(ratios):
    assert errors(ratios, 1, 32)[0] == pytest.approx(errors(ratios, 1, 16)[0] / 16, rel=0.01)
    assert 0.0 < errors(ratios, 1, 32)[0] < 4e-7


@pytest.mark.parametrize("ratios", [FREE, QTZ5613])
def test_fourth_order(ratios):
    error = np.array([errors(ratios, 4, n)[2:] for n in (8, 16, 32)])
    order = np.log2(error[:-1] / error[1:])
    assert ((order > 3.8) & (order < 4.1)).all(), order


def test_more_elements_than_the_floor_allows_make_it_worse():
    # Rounding is erratic: the worst of a few meshes of about the same size is what the floor speaks of.
    few = abs(errors(FREE, 1, 64)[0])
    many = max(abs(errors(FREE, 1, n, allow_round_off=True)[0]) for n in (480, 490, 500, 510, 512))
    assert few < 2e-9
    assert many > 50 * few
    assert 0.02 * round_off_floor(512) < many < 2 * round_off_floor(512)
    assert abs(errors(QTZ5613, 1, 128)[0]) < 2 * round_off_floor(128)


def test_refuses_more_elements_than_the_floor_allows():
    with pytest.raises(ValueError, match=r"elements: wanted at most 256, got 257: .* 1e-07"):
        finite_element_frequencies(BEAM, 1, elements=257)
    assert finite_element_frequencies(BEAM, 1, elements=256).shape == (1,)


def test_results_repeat_bit_for_bit():
    once, again = (finite_element_frequencies(BEAM, 6, EndBody(1e4, 1e5)) for _ in range(2))
    assert (once == again).all()


@pytest.mark.parametrize(
    ("count", "elements", "name"), [(-1, 8, "count"), (8, 4, "count"), (1, 0, "elements"), (9, 4, "count")]
)
def test_refuses_what_makes_no_sense(count, elements, name):
    with pytest.raises(ValueError, match=name):
        finite_element_frequencies(BEAM, count, elements=elements)


def test_none_wanted_none_given():
    assert finite_element_frequencies(BEAM, 0).shape == (0,)

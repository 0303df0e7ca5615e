"""Characteristic roots against 50-digit arithmetic, limits, and a count that must not miss or repeat one."""

from __future__ import annotations

from itertools import pairwise, product

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from modal.beams.roots import characteristic_roots, count_roots_below

INF = float("inf")
EPS = float(np.finfo(float).eps)
QTZ5613 = (2.877872, 2.009291)


def end_determinant(x, a, j, h):
    """Determinant of the end conditions to 50 digits, from the shapes and not from the closed form."""
    # Its terms cancel by a factor of exp(x).
    with mpmath.workdps(80 + int(x / 2)):
        x, h = mpmath.mpf(x), mpmath.mpf(h)
        c, s, ch, sh = mpmath.cos(x), mpmath.sin(x), mpmath.cosh(x), mpmath.sinh(x)
        columns = (
            ((ch - c) / x**2, (sh + s) / x, ch + c, x * (sh - s)),
            ((sh - s) / x**3, (ch - c) / x**2, (sh + s) / x, ch + c),
        )
        rows = []
        for d0, d1, d2, d3 in columns:
            force = d0 + h * d1 if a == INF else d3 + mpmath.mpf(a) * x**4 * (d0 + h * d1)
            moment = d1 if j == INF else d2 + h * d3 - mpmath.mpf(j) * x**4 * d1
            rows.append((force, moment))
        return rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0]


def has_root_within(x, relative, a, j, h):
    """Whether the 50-digit determinant changes sign within a relative distance of x."""
    with mpmath.workdps(50):
        below, above = mpmath.mpf(x) * (1 - mpmath.mpf(relative)), mpmath.mpf(x) * (1 + mpmath.mpf(relative))
        return end_determinant(below, a, j, h) * end_determinant(above, a, j, h) < 0


RATIOS = (0.0, 1e-8, 0.03, 1.0, 50.0, 1e8, INF)


@pytest.mark.parametrize("offset", [0.0, 0.3, -0.7])
@pytest.mark.parametrize(("mass_ratio", "inertia_ratio"), list(product(RATIOS, RATIOS)))
def test_every_root_of_every_extreme_is_one_of_50_digit_arithmetic(mass_ratio, inertia_ratio, offset):
    roots = characteristic_roots(mass_ratio, inertia_ratio, 8, offset_ratio=offset)
    assert (np.diff(roots) > 1e-6 * roots[1:]).all()
    for k, root in enumerate(roots, start=1):
        assert has_root_within(root, 2e-15, mass_ratio, inertia_ratio, offset), (k, root)
        below, above = (
            count_roots_below(root * factor, mass_ratio, inertia_ratio, offset_ratio=offset)
            for factor in (1 - 1e-12, 1 + 1e-12)
        )
        assert (below, above) == (k - 1, k)


def sign_changes(a, j, h, end, step):
    """Number of roots below an end, by the sign of the 50-digit determinant on a fine grid."""
    with mpmath.workdps(50):
        grid = [step * (k + mpmath.mpf("0.5")) for k in range(int(end / step))]
        signs = [end_determinant(x, a, j, h) > 0 for x in grid]
    return sum(one != other for one, other in pairwise(signs))


@pytest.mark.parametrize(
    ("a", "j", "h"), [(*QTZ5613, 0.0), (0.0, 0.0, 0.0), (50.0, 50.0, 0.0), (0.2, 3.0, -0.4), (INF, 0.5, 0.2)]
)
def test_count_is_the_number_of_sign_changes(a, j, h):
    assert count_roots_below(15.0, a, j, offset_ratio=h) == sign_changes(a, j, h, 15.0, 0.01)


def test_four_roots_of_the_published_crane_and_its_misprint():
    roots = characteristic_roots(*QTZ5613, 4)
    np.testing.assert_allclose(roots, [0.7691, 1.5121, 4.7997, 7.8964], rtol=0, atol=5e-5)
    printed = np.array([0.765, 1.508, 4.780, 7.896])
    distance = np.abs(roots - printed)
    assert (distance[[0, 1, 3]] < 0.005).all()
    # No body near the published one has a third root of 4.780: a discrepancy of the source.
    assert distance[2] > 0.015
    for mass, inertia in product((0.96, 1.04), (0.96, 1.04)):
        assert abs(characteristic_roots(mass * QTZ5613[0], inertia * QTZ5613[1], 3)[2] - 4.780) > 0.015


def limit_roots(function, starts):
    with mpmath.workdps(30):
        return [float(mpmath.findroot(function, start)) for start in starts]


@pytest.mark.parametrize(
    ("mass_ratio", "inertia_ratio", "function", "starts"),
    [
        (0.0, 0.0, lambda x: mpmath.cos(x) + mpmath.sech(x), (1.875, 4.694, 7.855, 10.996)),
        (INF, 0.0, lambda x: mpmath.tan(x) - mpmath.tanh(x), (3.9266, 7.0686, 10.2102, 13.3518)),
        (0.0, INF, lambda x: mpmath.tan(x) + mpmath.tanh(x), (2.3650, 5.4978, 8.6394, 11.7810)),
        (INF, INF, lambda x: mpmath.cos(x) - mpmath.sech(x), (4.7300, 7.8532, 10.9956, 14.1372)),
    ],
    ids=["free", "pinned", "sliding", "clamped"],
)
def test_limits_of_the_end(mass_ratio, inertia_ratio, function, starts):
    roots = characteristic_roots(mass_ratio, inertia_ratio, 4)
    np.testing.assert_allclose(roots, limit_roots(function, starts), rtol=4 * EPS, atol=0)


def test_finite_ratios_go_over_into_infinite_ones():
    """Each infinite ratio leaves one root behind at zero."""
    held = characteristic_roots(INF, 0.7, 5, offset_ratio=0.2)
    heavy = characteristic_roots(1e15, 0.7, 6, offset_ratio=0.2)
    assert heavy[0] < 1e-3
    np.testing.assert_allclose(heavy[1:], held, rtol=1e-14)


def test_heavy_body_on_a_massless_spring():
    """Root below which the beam's own mass does not matter: x^4 = 3 / a, 4 / j."""
    assert characteristic_roots(1e12, 0.0, 1)[0] == pytest.approx((3.0 / 1e12) ** 0.25, rel=1e-12)
    assert characteristic_roots(0.0, 1e12, 1)[0] == pytest.approx(1e-3, rel=1e-12)
    assert characteristic_roots(1e100, 0.0, 1)[0] == pytest.approx((3.0 / 1e100) ** 0.25, rel=4 * EPS)


@pytest.mark.parametrize("count", [500, 2000])
@pytest.mark.parametrize(
    ("a", "j", "h"), [(*QTZ5613, 0.0), (0.0, 0.0, 0.0), (1e8, 1e8, 0.0), (1e-8, 1e8, 0.5), (INF, INF, 0.0)]
)
def test_many_modes_stay_finite_and_complete(a, j, h, count):
    roots = characteristic_roots(a, j, count, offset_ratio=h)
    assert np.isfinite(roots).all()
    # High modes lie pi apart, whatever the end does.
    assert (np.diff(roots[5:]) > 1.5).all()
    assert np.diff(roots[5:]).max() < 4.8
    indices = np.unique(np.linspace(1, count, 40).astype(int))
    for k in indices:
        between = 0.5 * (roots[k - 2] + roots[k - 1]) if k > 1 else 0.5 * roots[0]
        assert count_roots_below(between, a, j, offset_ratio=h) == k - 1
    assert has_root_within(roots[-1], 4e-16, a, j, h)


@pytest.mark.parametrize("mass_ratio", [1e3, 1e6, 1e9, 1e12])
def test_pair_of_roots_closer_than_any_search_step(mass_ratio):
    """Body with a mass matrix proportional to the end stiffness; its roots lie 0.24 / a apart, relatively."""
    roots = characteristic_roots(mass_ratio, mass_ratio / 12.0, 3, offset_ratio=-0.5)
    for root in roots:
        assert has_root_within(root, 4 * EPS, mass_ratio, mass_ratio / 12.0, -0.5)
    assert (roots[1] / roots[0] - 1.0) * mass_ratio == pytest.approx(0.238, abs=0.002)
    assert roots[2] == pytest.approx(4.7300407448627040, rel=2.0 / mass_ratio)


exponents = st.floats(-8.0, 8.0)
offsets = st.floats(-1.0, 1.0)


@settings(max_examples=150, deadline=None)
@given(exponents, exponents, offsets, st.floats(0.01, 3.0))
def test_more_mass_or_inertia_lowers_every_root(mass_exponent, inertia_exponent, offset, more):
    a, j = 10.0**mass_exponent, 10.0**inertia_exponent
    roots = characteristic_roots(a, j, 12, offset_ratio=offset)
    # Roots that neither mass nor inertia moves come out equal but for rounding.
    allowed = roots * (1 + 4 * EPS)
    assert (characteristic_roots(a * (1 + more), j, 12, offset_ratio=offset) <= allowed).all()
    assert (characteristic_roots(a, j * (1 + more), 12, offset_ratio=offset) <= allowed).all()


@settings(max_examples=150, deadline=None)
@given(exponents, exponents, offsets)
def test_roots_interlace_with_those_of_both_limits(mass_exponent, inertia_exponent, offset):
    """Two coordinates at the end: root n lies between root n - 2 of the clamped and n of the free end."""
    roots = characteristic_roots(10.0**mass_exponent, 10.0**inertia_exponent, 20, offset_ratio=offset)
    free, clamped = characteristic_roots(0.0, 0.0, 20), characteristic_roots(INF, INF, 18)
    assert (roots <= free * (1 + 4 * EPS)).all()
    assert (roots[2:] >= clamped * (1 - 4 * EPS)).all()
    assert (np.diff(roots) >= 0.0).all()


@settings(max_examples=150, deadline=None)
@given(st.floats(0.0, 400.0), exponents, exponents, offsets)
def test_count_agrees_with_the_roots(x, mass_exponent, inertia_exponent, offset):
    a, j = 10.0**mass_exponent, 10.0**inertia_exponent
    roots = characteristic_roots(a, j, 140, offset_ratio=offset)
    if np.abs(roots - x).min() > 1e-12 * x:
        assert count_roots_below(x, a, j, offset_ratio=offset) == (roots < x).sum()


def test_count_is_sound_at_roots_of_the_clamped_beam():
    """There both terms of the count jump, by one in opposite directions."""
    roots = characteristic_roots(*QTZ5613, 33)
    for clamped, k in product(characteristic_roots(INF, INF, 30), range(-6, 7)):
        x = clamped * (1 + k * EPS)
        assert count_roots_below(x, *QTZ5613) == (roots < x).sum()


@pytest.mark.parametrize(
    ("arguments", "offset", "name"),
    [
        ((-1e-9, 0.0, 1), 0.0, "mass_ratio"),
        ((float("nan"), 0.0, 1), 0.0, "mass_ratio"),
        ((1e101, 0.0, 1), 0.0, "mass_ratio"),
        ((0.0, -1.0, 1), 0.0, "inertia_ratio"),
        ((0.0, 0.0, 0), 0.0, "count"),
        ((0.0, 0.0, 1), INF, "offset_ratio"),
    ],
)
def test_refuses_what_makes_no_sense(arguments, offset, name):
    with pytest.raises(ValueError, match=name):
        characteristic_roots(*arguments, offset_ratio=offset)


@pytest.mark.parametrize("x", [-1.0, float("nan"), INF])
def test_count_refuses_a_bound_that_is_none(x):
    with pytest.raises(ValueError, match="x: "):
        count_roots_below(x, 1.0, 1.0)

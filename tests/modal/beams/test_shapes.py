"""Mode shapes against 50-digit arithmetic, boundary conditions, orthonormality with the body, quadrature."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

from modal import Beam, EndBody, cantilever_modes

INF = float("inf")
EPS = float(np.finfo(float).eps)
BEAM = Beam(23.8, 350.0, 206e9, 0.014)
LENGTH = BEAM.length
FREE, QTZ5613, HEAVY = (0.0, 0.0, 0.0), (2.877872, 2.009291, 0.0), (1e8, 1e8, 0.0)
OFFSET, SHORT, LIGHT = (1.4, 0.5, 0.3), (0.7, 0.02, -0.4), (0.05, 0.02, 0.4)
TWIN = (1e6, 1e6 / 12.0, -0.5)


def modes_of(ratios, count, beam=BEAM):
    a, j, h = ratios
    return cantilever_modes(beam, count, EndBody(a * beam.mass, j * beam.mass * beam.length**2, h * beam.length))


def exact_shape(ratios, root):
    """Shape on the unit length as a 50-digit function of z and derivative, normalised with unit beam mass."""
    a, j, h = (mpmath.mpf(value) for value in ratios)

    def pair(x, z, order):
        rates = (mpmath.mpf(1), mpmath.mpf(-1), mpmath.mpc(0, 1), mpmath.mpc(0, -1))
        waves = [rate**order * mpmath.exp(rate * x * z) * x**order for rate in rates]
        even = (waves[0] + waves[1] - waves[2] - waves[3]) / (2 * x**2)
        odd = (waves[0] - waves[1]) / (2 * x**3) - (waves[2] - waves[3]) / (2j * x**3)
        return mpmath.re(even), mpmath.re(odd)

    def rows(x):
        d0, d1, d2, d3 = (pair(x, 1, order) for order in range(4))
        force = [d3[k] + a * x**4 * (d0[k] + h * d1[k]) for k in (0, 1)]
        moment = [d2[k] + h * d3[k] - j * x**4 * d1[k] for k in (0, 1)]
        return force, moment

    def determinant(x):
        force, moment = rows(x)
        return force[0] * moment[1] - force[1] * moment[0]

    near = mpmath.mpf(float(root))
    x = mpmath.findroot(
        determinant, (near, near * (1 + mpmath.mpf(10) ** -14)), tol=mpmath.mpf(10) ** -80, verify=False
    )
    force, _ = rows(x)
    P, Q = -force[1], force[0]

    def shape(z, order=0):
        even, odd = pair(x, z, order)
        return P * even + Q * odd

    panels = mpmath.linspace(0, 1, 2 + int(x / 10))
    energy = mpmath.quad(lambda z: shape(z) ** 2, panels)
    energy += a * (shape(1) + h * shape(1, 1)) ** 2 + j * shape(1, 1) ** 2
    scale = mpmath.sign(shape(1)) / mpmath.sqrt(energy)
    return lambda z, order=0: scale * shape(mpmath.mpf(z), order)


@pytest.mark.parametrize(
    ("ratios", "index", "bound"),
    [
        (HEAVY, 0, 8e-16),
        (HEAVY, 1, 2e-15),
        (HEAVY, 2, 2e-15),
        ((1e4, 1e4, 0.0), 0, 2e-15),
        ((3.0, 1.0, 0.0), 0, 2e-15),
        ((1.0, 0.5, 0.0), 0, 2e-15),
        (QTZ5613, 0, 2e-15),
        (QTZ5613, 3, 2e-15),
        (QTZ5613, 9, 4e-15),
        (OFFSET, 1, 2e-15),
        (SHORT, 0, 2e-15),
        (LIGHT, 0, 2e-15),
        (LIGHT, 4, 2e-15),
        (FREE, 0, 1e-15),
        (FREE, 19, 1e-14),
    ],
)
def test_shape_and_derivatives_against_50_digits(ratios, index, bound):
    modes = modes_of(ratios, index + 1, Beam(1.0, 1.0, 1.0, 1.0))
    positions = np.array([0.1, 0.37, 0.8, 1.0])
    with mpmath.workdps(60):
        exact = exact_shape(ratios, modes.roots[index])
        for order in range(6):
            values = np.array([float(exact(float(z), order)) for z in positions])
            error = np.abs(modes(positions, order)[index] - values).max()
            assert error < bound * max(np.abs(values).max(), 0.1 * modes.roots[index] ** order), order


def test_highest_modes_of_five_hundred_stay_accurate():
    """Far from the ends a high mode is a plain wave; at the free end it is twice the root mean square."""
    modes = modes_of(FREE, 500)
    assert modes(LENGTH)[-1] * np.sqrt(BEAM.mass) == pytest.approx(2.0, rel=4e-13)
    middle = np.linspace(0.4, 0.6, 7)
    wave = np.sqrt(2.0) * np.sin(modes.roots[-1] * middle - np.pi / 4)
    values = modes(middle * LENGTH)[-1] * np.sqrt(BEAM.mass)
    assert min(np.abs(values - wave).max(), np.abs(values + wave).max()) < 4e-13


@pytest.mark.parametrize("ratios", [FREE, QTZ5613, OFFSET, SHORT, HEAVY, (1e-8, 1e8, 0.0)])
def test_boundary_conditions(ratios):
    a, j, h = ratios
    modes = modes_of(ratios, 40)
    x = modes.roots
    d0, d1, d2, d3 = (modes(LENGTH, order) * LENGTH**order for order in range(4))
    rate = np.maximum(x, 1.0)
    along = np.linspace(0.0, LENGTH, 400)
    size = np.max([np.abs(modes(along, n)).max(axis=1) * (LENGTH / rate) ** n for n in range(4)], axis=0)
    assert (np.abs(modes(0.0)) < 4 * EPS * size).all()
    assert (np.abs(modes(0.0, 1)) * LENGTH < 4 * EPS * size * rate).all()
    force = (d3, a * x**4 * d0, a * x**4 * h * d1)
    moment = (d2, h * d3, -j * x**4 * d1)
    # Rounding of the root moves the phase at the end by eps x, and all derivatives with it.
    phase = EPS * (1.0 + x) * size
    assert (np.abs(sum(force)) < 2 * phase * (rate**3 + a * x**4 * (1.0 + abs(h) * rate))).all()
    assert (np.abs(sum(moment)) < 2 * phase * (rate**2 + abs(h) * rate**3 + j * x**4 * rate)).all()


def orthonormality_error(modes):
    """Largest departure of the whole mass matrix from the unit matrix."""
    body = modes.end_body
    turn = modes(LENGTH, 1)
    move = modes(LENGTH) + body.offset * turn
    whole = modes.mass_matrix()
    whole += 0.0 if body.mass == INF else body.mass * np.outer(move, move)
    whole += 0.0 if body.rotary_inertia == INF else body.rotary_inertia * np.outer(turn, turn)
    return np.abs(whole - np.eye(modes.count)).max()


@pytest.mark.parametrize(
    ("ratios", "ten", "sixty"),
    [
        (FREE, 2e-15, 2e-14),
        (QTZ5613, 1e-13, 8e-12),
        (OFFSET, 1e-13, 5e-13),
        (SHORT, 1e-13, 5e-13),
        (LIGHT, 1e-13, 5e-13),
        (HEAVY, 6e-10, 7e-8),
        (TWIN, 4e-9, 4e-9),
        ((INF, 0.0, 0.0), 4e-15, 2e-14),
        ((0.0, INF, 0.0), 4e-15, 2e-14),
        ((INF, INF, 0.0), 4e-15, 2e-14),
        ((INF, 3.0, 0.2), 2e-13, 8e-13),
        ((2.0, INF, 0.2), 2e-14, 1e-13),
    ],
)
def test_orthonormal_in_the_mass_of_beam_and_body(ratios, ten, sixty):
    assert orthonormality_error(modes_of(ratios, 10)) < ten
    assert orthonormality_error(modes_of(ratios, 60)) < sixty


@pytest.mark.parametrize(
    ("ratios", "bound"),
    [(FREE, 2e-14), (QTZ5613, 2e-14), (OFFSET, 2e-14), (HEAVY, 2e-14), ((INF, 3.0, 0.2), 2e-14)],
)
def test_stiffness_matrix_is_the_diagonal_of_squared_frequencies(ratios, bound):
    modes = modes_of(ratios, 60)
    scaled = modes.stiffness_matrix() / np.outer(modes.angular_frequencies, modes.angular_frequencies)
    assert np.abs(scaled - np.eye(60)).max() < bound


def gauss(modes, count):
    """Gauss-Legendre points and weights in panels over the beam."""
    points, weights = np.polynomial.legendre.leggauss(20)
    edges = np.linspace(0.0, LENGTH, count + 1)
    half = 0.5 * np.diff(edges)[:, None]
    return (edges[:-1, None] + half * (points + 1.0)).ravel(), (half * weights).ravel()


@pytest.mark.parametrize(
    "ratios", [FREE, QTZ5613, OFFSET, HEAVY, TWIN, (3.0, 1.0, 0.0), (0.5, 0.1, 0.0), (INF, INF, 0.0)]
)
@pytest.mark.parametrize("count", [3, 40])
def test_integrals_against_quadrature(ratios, count):
    modes = modes_of(ratios, count)
    x, weights = gauss(modes, 60)
    m, EI = BEAM.mass_per_length, BEAM.bending_stiffness
    shape, slope, curvature = (modes(x, order) for order in range(3))
    zeroth, first = modes.mass_moments()
    pairs = [
        (modes.mass_matrix(), (m * weights * shape) @ shape.T),
        (modes.slope_matrix(), (weights * slope) @ slope.T),
        (modes.weight_matrix(), (m * weights * (LENGTH - x) * slope) @ slope.T),
        (modes.stiffness_matrix(), (EI * weights * curvature) @ curvature.T),
    ]
    for ours, theirs in pairs:
        size = np.sqrt(np.diag(theirs))
        assert np.abs((ours - theirs) / np.outer(size, size)).max() < 2e-14
        assert (ours == ours.T).all()
    size = np.sqrt(np.diag(pairs[0][1]) * BEAM.mass)
    assert np.abs((zeroth - shape @ (m * weights)) / size).max() < 2e-15
    assert np.abs((first - shape @ (m * weights * x)) / (size * LENGTH)).max() < 2e-15


def test_moments_follow_from_balance_of_forces():
    """Beam and body together: omega^2 times momentum is the shear force at the foot, and so for moments."""
    modes = modes_of(OFFSET, 12)
    body, EI = modes.end_body, BEAM.bending_stiffness
    zeroth, first = modes.mass_moments()
    turn = modes(LENGTH, 1)
    move = modes(LENGTH) + body.offset * turn
    arm = LENGTH + body.offset
    shear = modes.angular_frequencies**2 * (zeroth + body.mass * move)
    moment = modes.angular_frequencies**2 * (first + body.mass * arm * move + body.rotary_inertia * turn)
    np.testing.assert_allclose(EI * modes(0.0, 3), -shear, rtol=2e-10)
    np.testing.assert_allclose(EI * modes(0.0, 2), moment, rtol=2e-10)


@pytest.mark.parametrize("ratios", [FREE, QTZ5613, OFFSET, SHORT, HEAVY])
def test_end_deflects_to_the_positive_side(ratios):
    assert (modes_of(ratios, 8)(LENGTH) > 0.0).all()


def test_end_that_cannot_deflect_turns_or_curves_to_the_positive_side():
    for inertia in (0.0, 0.5):
        assert (modes_of((INF, inertia, 0.0), 8)(LENGTH, 1) > 0.0).all()
    assert (modes_of((INF, INF, 0.0), 8)(LENGTH, 2) > 0.0).all()


def test_frequencies():
    modes = modes_of(FREE, 2)
    unit = np.sqrt(206e9 * 0.014 / 350.0) / 23.8**2
    np.testing.assert_allclose(modes.angular_frequencies, unit * np.array([1.87510406871196, 4.69409113297417]) ** 2)
    np.testing.assert_allclose(modes.frequencies_hz * 2 * np.pi, modes.angular_frequencies, rtol=1e-15)


def test_no_modes_give_empty_arrays_of_the_right_shape():
    modes = modes_of(QTZ5613, 0)
    assert modes.count == 0
    assert modes.roots.shape == modes.angular_frequencies.shape == modes.frequencies_hz.shape == (0,)
    assert modes(3.0).shape == (0,)
    assert modes(np.zeros((2, 5)), 3).shape == (0, 2, 5)
    assert [moment.shape for moment in modes.mass_moments()] == [(0,), (0,)]
    for matrix in (modes.mass_matrix, modes.slope_matrix, modes.weight_matrix, modes.stiffness_matrix):
        assert matrix().shape == (0, 0)


def test_results_take_the_shape_of_the_positions():
    modes = modes_of(QTZ5613, 3)
    assert modes(1.0).shape == (3,)
    assert modes([1.0, 2.0]).shape == (3, 2)
    assert modes(np.zeros((4, 0))).shape == (3, 4, 0)
    np.testing.assert_array_equal(modes([[1.0, 2.0]])[:, 0, 1], modes(2.0))


def test_arrays_cannot_be_written_to():
    modes = modes_of(QTZ5613, 3)
    with pytest.raises(ValueError, match="read-only"):
        modes.roots[0] = 1.0
    with pytest.raises(ValueError, match="read-only"):
        modes.coefficients[0, 0] = 1.0


@pytest.mark.parametrize(("position", "derivative"), [(-0.1, 0), (23.9, 0), (float("nan"), 0)])
def test_refuses_positions_off_the_beam(position, derivative):
    with pytest.raises(ValueError, match="position"):
        modes_of(FREE, 2)([1.0, position], derivative)


@pytest.mark.parametrize("derivative", [-1, 0.5])
def test_refuses_orders_that_are_none(derivative):
    with pytest.raises(ValueError, match="derivative"):
        modes_of(FREE, 2)(1.0, derivative)


def test_refuses_a_negative_count():
    with pytest.raises(ValueError, match="count"):
        cantilever_modes(BEAM, -1)

"""The head's motion over time against finite rotations, on both sides of where its functions change form."""

import mpmath
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from towercrane.cranes.tower.equations.head import NEARLY_UPRIGHT, leaning_functions, move_head, upright_functions

SIZES = (0.01, 0.99 * NEARLY_UPRIGHT**0.5, 1.01 * NEARLY_UPRIGHT**0.5, 0.5)


@mpmath.workdps(50)
def exact_functions(square):
    """Functions of the tilt, of which the last two are zero over zero at an upright tower."""
    f = mpmath.sqrt(square)
    c0, c1, c2 = mpmath.sin(f) / f, (1 - mpmath.cos(f)) / f**2, (f - mpmath.sin(f)) / f**3
    return [float(value) for value in (c0, c1, c2, (c0 - 2 * c1) / f**2, (c1 - 3 * c2) / f**2)]


@pytest.mark.parametrize("square", [1e-12, 1e-4, 0.01, NEARLY_UPRIGHT])
def test_series_of_the_tilt_are_exact_as_far_as_they_are_used(square):
    np.testing.assert_allclose(upright_functions(square), exact_functions(square), rtol=4e-16)


@pytest.mark.parametrize("square", [NEARLY_UPRIGHT, 0.25, 2.0])
def test_functions_of_a_larger_tilt_lose_few_digits(square):
    found = leaning_functions(square)
    # Rounding over the powers of the tilt that the differences divide by.
    bounds = 1e-15 * np.array([1.0, 1.0 / square, 1.0 / square, 1.0 / square**2, 1.0 / square**2])
    assert np.all(abs(np.array(found) - exact_functions(square)) <= bounds)


def rotation(tilt, turn):
    """exp(tilt) Rz(turn)."""
    return (Rotation.from_rotvec([*tilt, 0.0]) * Rotation.from_rotvec([0.0, 0.0, turn])).as_matrix()


@pytest.mark.parametrize("size", SIZES)
def test_axes_and_spin_are_those_of_the_finite_rotation(size):
    rng = np.random.default_rng(3)
    tilt, tilting = rng.normal(size=2), rng.normal(size=2)
    tilt *= size / np.linalg.norm(tilt)
    turn, turning, velocity = 0.7, -0.4, rng.normal(size=2)

    def head(since=0.0):
        at, angle = tilt + since * tilting, turn + since * turning
        return move_head((*at, *tilting), np.cos(angle), np.sin(angle), turning, 0.0, *velocity)

    found = head()
    exact = rotation(tilt, turn)
    np.testing.assert_allclose(found.rows, exact, atol=4e-16)
    h = 1e-4
    steps = [rotation(tilt + k * h * tilting, turn + k * h * turning) for k in (-2, -1, 1, 2)]
    rate = (steps[0] - 8.0 * steps[1] + 8.0 * steps[2] - steps[3]) / (12.0 * h)
    spin = exact.T @ rate
    np.testing.assert_allclose(found.spin, [spin[2, 1], spin[0, 2], spin[1, 0]], atol=2e-11)
    np.testing.assert_allclose(found.top, exact.T @ [*velocity, 0.0], atol=1e-15)
    vector = rng.normal(size=3)
    np.testing.assert_allclose(found.to_fixed(vector), exact @ vector, atol=1e-15)
    np.testing.assert_allclose(found.to_head(vector), exact.T @ vector, atol=1e-15)
    turned = np.array(found.turn_x) * tilting[0] + np.array(found.turn_y) * tilting[1] + [0.0, 0.0, turning]
    np.testing.assert_allclose(found.spin, turned, atol=1e-15)
    # With constant rates the change of the spin is its bias.
    later, earlier = head(h), head(-h)
    np.testing.assert_allclose(found.spin_bias, np.subtract(later.spin, earlier.spin) / (2.0 * h), atol=1e-8)

"""Values and vectors of a pair of matrices beside SciPy's."""

import numpy as np
import pytest
import scipy.linalg

from towercrane.kernels.algebra import vibrations


@pytest.mark.parametrize("spread", [1.0, 1e6, 1e12])
def test_vibrations_are_those_of_scipy(spread):
    random = np.random.default_rng(3)
    one, other = random.normal(size=(2, 9, 9))
    mass, stiffness = one @ one.T + np.eye(9), other @ np.diag(np.geomspace(1.0, spread, 9)) @ other.T
    values, vectors = vibrations(stiffness, mass)
    assert values == pytest.approx(
        scipy.linalg.eigh(stiffness, mass, eigvals_only=True), rel=1e-13, abs=1e-14 * spread
    )
    assert vectors.T @ mass @ vectors == pytest.approx(np.eye(9), abs=1e-13)
    assert vectors.T @ stiffness @ vectors == pytest.approx(np.diag(values), abs=1e-13 * values[-1])

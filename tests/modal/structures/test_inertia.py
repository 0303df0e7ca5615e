"""Elimination of a symmetric matrix: signs of eigenvalues and the determinant, against eigenvalues by LAPACK."""

import numpy as np
import pytest

from modal.compiler.kinds import Row, Table
from modal.compiler.native import native
from modal.structures.kernels.inertia import inertia


def _eliminated(matrix: Table, size: Row) -> int:
    negative, size[0] = inertia(matrix)
    return negative


(eliminated,) = native("inertia", _eliminated)


def band_of(random, size, width):
    matrix = random.normal(size=(size, size))
    scale = 10.0 ** random.uniform(-2.0, 2.0, size=size)
    return np.triu(np.tril((matrix + matrix.T) * np.outer(scale, scale), width), -width)


@pytest.mark.parametrize("size", [1, 2, 3, 8, 40])
@pytest.mark.parametrize("width", [1, 3, 40])
@pytest.mark.parametrize("diagonal", [True, False])
def test_negative_eigenvalues_are_counted_and_the_determinant_is_found(size, width, diagonal):
    random, log = np.random.default_rng(size + 100 * width), np.zeros(1)
    for _ in range(20):
        matrix = band_of(random, size, width)
        if not diagonal:
            # Every pivot is one of two unknowns; an odd number of them has none for the last.
            np.fill_diagonal(matrix, 0.0)
            matrix[-1, -1] = size % 2
        scale = 1.0 / np.sqrt(np.abs(matrix).max(axis=0))
        values = np.linalg.eigvalsh(matrix * np.outer(scale, scale))
        _, wanted = np.linalg.slogdet(matrix)
        negative = eliminated(matrix.copy(), log)
        if np.abs(values).min() > 1e-12 * np.abs(values).max():
            assert negative == (values < 0.0).sum()
            assert log[0] == pytest.approx(wanted, abs=1e-9)


def test_a_pivot_beside_a_far_larger_number_is_not_taken():
    small, large, log = 1e-10, 1e11, np.zeros(1)
    matrix = np.array([[small, 1.0, 0.0], [1.0, 0.7, large], [0.0, large, 1.0]])
    assert eliminated(matrix, log) == 1
    assert log[0] == pytest.approx(np.log(1.0 - small * (0.7 - large**2)), abs=1e-12)


def test_a_matrix_of_zeros_has_no_negative_eigenvalue_and_no_determinant():
    log = np.zeros(1)
    assert eliminated(np.zeros((3, 3)), log) == 0
    assert log[0] == -np.inf


def test_only_the_upper_half_counts():
    random, log, other = np.random.default_rng(2), np.zeros(1), np.zeros(1)
    matrix = band_of(random, 12, 12)
    assert eliminated(np.triu(matrix), log) == eliminated(matrix, other)
    assert log[0] == other[0]

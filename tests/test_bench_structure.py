"""The benchmark's references in 50 digits: they meet the exact structures, and elements converge to them."""

import numpy as np
import pytest

from modal import chain_frequencies, crane_structure
from towercrane.bench import structure
from towercrane.case import load_case
from towercrane.towers import crane_frame

mp = pytest.importorskip("mpmath")


def test_tower_of_three_segments():
    table = structure.stepped_tower(1)
    errors = [record["error"] for record in table["records"]]
    assert errors[0] < 3e-13
    assert 1e-7 < errors[-1] < 1e-5
    assert (np.diff(errors[1:]) < 0.0).all()
    assert "50-digit" in table["notes"][0]


def test_reference_sees_a_shift():
    near = chain_frequencies(structure.TOWER, 3)
    exact, _ = structure._transfer_matrices(near * (1.0 + 1e-6))
    np.testing.assert_allclose(exact, near, rtol=1e-13)


@pytest.mark.parametrize("position", [0.0, 0.7, 23.0, 55.6])
def test_plane_crane(position):
    frame = crane_frame(load_case(structure.CASE))
    found = crane_structure(frame, position).angular_frequencies(4)
    np.testing.assert_allclose(found, structure._krylov_functions(frame, position, found), rtol=1e-13)

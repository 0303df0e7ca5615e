"""Exact structures and lattices in the benchmark: references in 50 digits, and elements that converge to them."""

import numpy as np
import pytest

from modal import chain_frequencies, crane_structure
from towercrane.bench.structures import structure
from towercrane.bench.structures.lattice import lattice
from towercrane.bench.structures.roots import roots
from towercrane.bench.structures.segments import segments
from towercrane.cases.case import load_case
from towercrane.cranes.tower.file.build import crane_frame
from towercrane.report.plots.bench.work import pictures

mp = pytest.importorskip("mpmath")


def test_tower_of_three_segments():
    table = structure.stepped_tower(1)
    errors = [record["error"] for record in table["records"]]
    assert errors[0] < 3e-13
    assert 1e-7 < errors[-1] < 1e-5
    assert (np.diff(errors[1:]) < 0.0).all()
    assert "50-digit" in table["notes"][0]


def test_towers_of_different_segments():
    table = segments(1, (1, 4))
    assert [record["segments"] for record in table["records"]] == [1, 4]
    assert all(record["error"] < 4e-15 for record in table["records"])
    assert all(min(record["milliseconds"].values()) > 0.0 for record in table["records"])
    assert "50-digit" in table["notes"][0]


def test_reference_sees_a_shift():
    near = chain_frequencies(structure.TOWER, 3)
    exact, _ = structure.transfer_matrices(structure.TOWER, near * (1.0 + 1e-6))
    np.testing.assert_allclose(exact, near, rtol=1e-13)


@pytest.mark.parametrize("position", [0.0, 0.7, 23.0, 55.6])
def test_plane_crane(position):
    frame = crane_frame(load_case(structure.CASE).checked)
    found = crane_structure(frame, position).angular_frequencies(4)
    np.testing.assert_allclose(found, structure._krylov_functions(frame, position, found), rtol=1e-13)


def test_beams_in_place_of_a_lattice():
    table = lattice(1)
    truss, *beams = table["records"]
    assert truss["model"] == "truss"
    assert truss["errors"] == {"bare": 0.0, "loaded": 0.0, "flexibility": 0.0}
    by_beam = {name: [r for r in beams if r["model"] == name] for name in ("shear-flexible", "euler")}
    for (exact, *elements), floor in zip(by_beam.values(), (4e-12, 1e-7), strict=True):
        assert exact["own_error"] < 1e-13
        assert (np.diff([r["own_error"] for r in elements]) < 0.0).all()
        assert floor / 10.0 < elements[-1]["own_error"] < floor
        # Elements are exact at nodes under a force: what is left is the beam's own departure from the truss.
        for row in elements:
            assert row["errors"]["flexibility"] == pytest.approx(exact["errors"]["flexibility"], rel=1e-4, abs=1e-10)
    shear, euler = (rows[0]["errors"] for rows in by_beam.values())
    assert 4e-5 < shear["loaded"] < 6e-5 < 0.1 < euler["loaded"] < 0.3
    assert shear["flexibility"] < 1e-11 < 0.1 < euler["flexibility"] < 0.12
    assert set(pictures({"subjects": [table]})) == {"lattice.png"}


def test_roots_by_three_methods():
    table = roots(1)
    errors = {record["method"]: record["error"] for record in table["records"]}
    assert errors["closed form, 500 roots"] < 5e-16
    assert errors["dynamic stiffness, 4 roots"] < 5e-15
    assert errors["dynamic stiffness, 50 roots"] < 1e-10
    # Fourth order of the roots' squares.
    ratio = errors["8 elements, 4 roots"] / errors["16 elements, 4 roots"]
    assert 14.0 < ratio < 18.0
    assert {record["family"] for record in table["records"]} == {
        "closed form",
        "dynamic stiffness",
        "finite elements",
    }
    assert set(pictures({"subjects": [table]})) == {"roots.png"}

"""Sums over the mass of a jib, and modes of torsion, against quadrature and exact limits."""

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss
from numpy.testing import assert_allclose
from samples import space_crane as space

from modal.beams.shapes import cantilever_modes
from modal.beams.torsion import Shaft, torsion_modes
from towercrane.cranes.tower.modes.mass_sums import point_sums, rigid_sums, uniform_sums
from towercrane.cranes.tower.modes.shape_table import shape_table

FIELDS = ("mass", "moment", "pitch", "yaw", "first", "second", "products")
JIB = space.CRANE.jib
SHAFT = Shaft(23.8, 400.0, 1.7e8)


def cloud(points, lateral, vertical, density=lambda x: JIB.mass_per_length * np.ones_like(x)):
    s, w = leggauss(points)
    x = 0.5 * JIB.length * (s + 1)
    return point_sums(x, 0.5 * JIB.length * w * density(x), lateral, vertical)


def largest_gap(a, b):
    """Difference over the largest entry, the worst of all sums."""
    pairs = [(np.asarray(getattr(a, field)), np.asarray(getattr(b, field))) for field in FIELDS]
    return max(float(np.max(abs(x - y)) / np.max(abs(x))) for x, y in pairs)


def test_uniform_jib_in_closed_form_is_its_cloud():
    lateral, vertical = cantilever_modes(JIB, 2), cantilever_modes(JIB, 3)
    exact = uniform_sums(JIB.length, JIB.mass_per_length, vertical, 2, 3)
    assert largest_gap(exact, cloud(16, lateral, vertical)) < 1e-13
    # Too few points are seen, so the comparison can fail.
    assert 1e-5 < largest_gap(exact, cloud(8, lateral, vertical)) < 1e-2


def test_sums_add_up_over_parts():
    lateral, vertical = cantilever_modes(JIB, 3), cantilever_modes(JIB, 3)
    whole = cloud(40, lateral, vertical, lambda x: 200.0 - 2.5 * x)
    parts = cloud(40, lateral, vertical, lambda x: 200.0 * np.ones_like(x))
    parts = parts + cloud(40, lateral, vertical, lambda x: x).scaled(-2.5)
    assert largest_gap(whole, parts) < 1e-13


def test_lumped_tip_and_rigid_part():
    lateral, vertical = cantilever_modes(JIB, 1), cantilever_modes(JIB, 1)
    tip = point_sums([JIB.length], [30.0], lateral, vertical)
    deflection = lateral(JIB.length)[0]
    assert_allclose(tip.first, 30.0 * deflection)
    assert_allclose(tip.second, 30.0 * deflection * JIB.length)
    assert_allclose(tip.products, 30.0 * deflection**2)
    assert (tip.mass, tip.moment, tip.pitch) == (30.0, 30.0 * JIB.length, 30.0 * JIB.length**2)
    behind = rigid_sums(100.0, -900.0, 8100.0, 2, roll=5.0, yaw=7.0)
    assert (behind.roll, behind.pitch, behind.yaw) == (5.0, 8100.0, 8107.0)
    assert np.all((tip + behind).products == tip.products)


def test_shape_table_reproduces_shapes_and_derivatives_everywhere():
    lateral, vertical = cantilever_modes(JIB, 2), cantilever_modes(JIB, 6)
    table = shape_table((lateral, vertical), (0.0, JIB.length))
    width = JIB.length / len(table)
    x = np.linspace(0.0, JIB.length, 777)
    cell = np.minimum((x / width).astype(int), len(table) - 1)
    xi = x - (cell + 0.5) * width
    expected = np.concatenate([lateral(x), vertical(x)])
    found = sum(table[cell, :, c].T * xi**c for c in range(table.shape[2]))
    assert np.max(abs(found - expected)) < 1e-14 * np.max(abs(expected)) * 10


def test_shaft_alone_has_quarter_waves():
    modes = torsion_modes(SHAFT, 4)
    assert_allclose(modes.roots, (np.arange(4) + 0.5) * np.pi, rtol=1e-14)
    assert_allclose(modes.mass_matrix(), np.eye(4), atol=1e-14)


def test_heavy_head_turns_on_the_shaft_as_on_a_spring():
    inertia = 1e4 * SHAFT.inertia
    modes = torsion_modes(SHAFT, 1, inertia)
    # Rayleigh: a third of the shaft's inertia takes part, to first order in the ratio.
    expected = np.sqrt(SHAFT.torsional_stiffness / SHAFT.length / (inertia + SHAFT.inertia / 3))
    assert_allclose(modes.angular_frequencies, expected, rtol=1e-9)


@pytest.mark.parametrize("ratio", [0.0, 0.1, 3.0, 800.0])
def test_torsion_modes_are_orthonormal_and_fulfil_the_end_condition(ratio):
    inertia = ratio * SHAFT.inertia
    modes = torsion_modes(SHAFT, 4, inertia)
    end = modes(SHAFT.length)
    assert np.all(end > 0.0)
    assert_allclose(modes.mass_matrix() + inertia * np.outer(end, end), np.eye(4), atol=1e-13)
    s, w = leggauss(60)
    z, weight = 0.5 * SHAFT.length * (s + 1), 0.5 * SHAFT.length * w * SHAFT.inertia_per_length
    assert_allclose(modes(z) @ weight, modes.mass_moment(), rtol=1e-12, atol=1e-12)
    # G J phi' = omega^2 J phi at the end.
    slope = modes.amplitudes[:, 0] * modes.roots / SHAFT.length * np.cos(modes.roots)
    balance = SHAFT.torsional_stiffness * slope - modes.angular_frequencies**2 * inertia * end
    size = SHAFT.torsional_stiffness * modes.amplitudes * modes.roots / SHAFT.length
    assert np.max(abs(balance) / (size * (1.0 + ratio * modes.roots))) < 1e-14


def test_torsion_s_arrays_cannot_be_written_to():
    modes = torsion_modes(SHAFT, 2, 5.0)
    for array in (modes.roots, modes.amplitudes, modes.phases):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0


def test_torsion_refuses_nonsense():
    with pytest.raises(ValueError, match=r"Shaft.torsional_stiffness: wanted a positive finite number, got 0.0"):
        Shaft(23.8, 400.0, 0.0)
    with pytest.raises(ValueError, match="count: wanted zero or more, got -1"):
        torsion_modes(SHAFT, -1)
    with pytest.raises(ValueError, match=r"end_inertia: wanted zero or more, got -1.0"):
        torsion_modes(SHAFT, 1, -1.0)
    assert torsion_modes(SHAFT, 0, 5.0)(SHAFT.length).shape == (0,)

"""Finite elements of the plane crane against exact dynamic stiffness, published values and limits."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

from modal import (
    Beam,
    Chain,
    CraneFrame,
    EndBody,
    Segment,
    cantilever_modes,
    crane_structure,
    finite_element_structure_frequencies,
)

TOWER = Beam(23.8, 350.0, 206e9, 0.014)
JIB = Beam(55.6, 123.8, 206e9, 0.0035)
QTZ5613 = {
    "head_mass": 159.3 * 12.3 + 15130.0,
    "head_inertia": 159.3 * 12.3**3 / 3.0 + 15130.0 * 12.3**2,
    "trolley_mass": 350.0,
    "payload_mass": 800.0,
    "rope_length": 18.0,
}
EXACT_HZ = {
    5.0: [0.117452, 0.347987, 0.802624, 2.405649, 3.044157],
    41.0: [0.117452, 0.311800, 0.794502, 2.409990, 3.018964],
}


def frame(tower, jib, *, head_mass, head_inertia, trolley_position, **crane):
    tower, jib = (Chain((Segment(b.length, b.mass_per_length, b.bending_stiffness),)) for b in (tower, jib))
    tower.bodies[1] = EndBody(head_mass, head_inertia)
    return crane_structure(CraneFrame(tower, jib, **crane), trolley_position)


def frame_frequencies(tower, jib, *, count=6, elements=40, **crane):
    return finite_element_structure_frequencies(frame(tower, jib, **crane), count, elements=elements)


def beam_dynamic_stiffness(beam, length, omega):
    """Exact 4 x 4 stiffness of a beam in harmonic motion, from its four waves; unknowns v0, v0', v1, v1'."""
    k = (beam.mass_per_length * omega**2 / beam.bending_stiffness) ** 0.25
    rates = np.array([1j * k, -1j * k, k, -k])
    ends = np.exp(np.outer([0.0, length], rates))
    motion = np.array([ends[0], rates * ends[0], ends[1], rates * ends[1]])
    forces = beam.bending_stiffness * np.array(
        [rates**3 * ends[0], -(rates**2) * ends[0], -(rates**3) * ends[1], rates**2 * ends[1]]
    )
    return (forces @ np.linalg.inv(motion)).real


def frame_determinant(omega, trolley_position, jib=JIB, gravity=9.81, **crane):
    """Determinant of the exact stiffness; unknowns u, gamma, jib at trolley (w, w'), jib tip (w, w')."""
    load = crane["trolley_mass"] + crane["payload_mass"]
    pendulum = gravity / crane["rope_length"]
    stiffness = np.zeros((6, 6))
    stiffness[:2, :2] = beam_dynamic_stiffness(TOWER, TOWER.length, omega)[2:, 2:]
    horizontal = crane["head_mass"] + jib.mass + crane["trolley_mass"]
    horizontal += crane["payload_mass"] * pendulum / (pendulum - omega**2)
    stiffness[0, 0] -= omega**2 * horizontal
    stiffness[1, 1] -= omega**2 * crane["head_inertia"]
    inner = np.zeros((4, 6))
    inner[1, 1], inner[2, 2], inner[3, 3] = -1.0, 1.0, 1.0
    stiffness += inner.T @ beam_dynamic_stiffness(jib, trolley_position, omega) @ inner
    stiffness[2:, 2:] += beam_dynamic_stiffness(jib, jib.length - trolley_position, omega)
    stiffness[2, 2] -= omega**2 * load
    return np.linalg.det(stiffness / 1e7)


@pytest.mark.parametrize(
    ("trolley_position", "bound"), [(5.0, 2e-7), (20.3, 2e-7), (41.0, 2e-7), (0.3, 2e-7), (55.3, 6e-7)]
)
def test_agrees_with_the_exact_dynamic_stiffness(trolley_position, bound):
    """Next to the jib's ends, too, where elements of very different length meet."""
    found = frame_frequencies(TOWER, JIB, trolley_position=trolley_position, **QTZ5613, count=6, elements=64)
    exact = [
        brentq(
            lambda omega: frame_determinant(omega, trolley_position, **QTZ5613),
            w * (1 - 1e-5),
            w * (1 + 1e-5),
            rtol=1e-14,
        )
        for w in found
    ]
    error = found / exact - 1.0
    assert np.abs(error[:3]).max() < 1e-8
    assert np.abs(error).max() < bound


@pytest.mark.parametrize("trolley_position", [5.0, 41.0])
def test_published_crane(trolley_position):
    crane = {"trolley_position": trolley_position, **QTZ5613, "count": 5}
    coarse = frame_frequencies(TOWER, JIB, **crane) / (2 * np.pi)
    fine = frame_frequencies(TOWER, JIB, **crane, elements=80) / (2 * np.pi)
    # Half a unit of the sixth decimal is the tables' own; the rest is the mesh.
    np.testing.assert_allclose(fine, EXACT_HZ[trolley_position], rtol=0, atol=5.3e-7)
    np.testing.assert_allclose(coarse, EXACT_HZ[trolley_position], rtol=0, atol=7.6e-7)


def test_fourth_order():
    def highest(n):
        crane = {"trolley_position": 27.8, **QTZ5613, "count": 8}
        return frame_frequencies(TOWER, JIB, **crane, elements=n)[-1]

    finest = highest(48)
    errors = [highest(n) - finest for n in (4, 8, 16)]
    order = np.log2(np.divide(errors[:-1], errors[1:]))
    assert ((order > 3.8) & (order < 4.15)).all(), order


def test_stiff_jib_becomes_the_end_body_of_the_tower():
    """The error left falls in proportion to the jib's flexibility."""
    inertia = QTZ5613["head_inertia"] + JIB.mass * JIB.length**2 / 3.0
    body = EndBody(QTZ5613["head_mass"] + JIB.mass, inertia)
    exact = cantilever_modes(TOWER, 2, body).angular_frequencies
    crane = {**QTZ5613, "payload_mass": 0.0, "trolley_mass": 0.0, "trolley_position": 5.0, "count": 2}
    errors = []
    for factor in (1e3, 1e4):
        jib = Beam(55.6, 123.8, 206e9, 0.0035 * factor)
        errors.append(np.abs(frame_frequencies(TOWER, jib, **crane, elements=8) / exact - 1.0).max())
    assert errors[1] < 2.1e-4
    assert errors[0] / errors[1] == pytest.approx(10.0, abs=0.2)


def test_pendulum_of_a_light_payload_swings_as_if_from_a_fixed_point():
    crane = {**QTZ5613, "payload_mass": 1e-3, "trolley_position": 10.0, "count": 1}
    assert frame_frequencies(TOWER, JIB, **crane)[0] == pytest.approx(np.sqrt(9.81 / 18.0), rel=1e-8)


def test_without_payload_only_the_pendulum_goes():
    crane = {**QTZ5613, "trolley_position": 10.0}
    bare = frame_frequencies(TOWER, JIB, **{**crane, "payload_mass": 0.0, "count": 3})
    light = frame_frequencies(TOWER, JIB, **{**crane, "payload_mass": 1e-3, "count": 4})
    np.testing.assert_allclose(light[1:], bare, rtol=1e-6)


@pytest.mark.parametrize("near", [0.0, 0.69, 27.1, 55.6])
def test_trolley_position_enters_smoothly(near):
    """Also across the point where another node of the mesh moves to the trolley."""
    crane = {**QTZ5613, "count": 4}
    step = 1e-6 if near < 55.0 else -1e-6
    there = frame_frequencies(TOWER, JIB, trolley_position=near, **crane)
    beside = frame_frequencies(TOWER, JIB, trolley_position=near + step, **crane)
    np.testing.assert_allclose(there, beside, rtol=2e-7)


def test_results_repeat_bit_for_bit_and_none_is_an_empty_array():
    crane = {**QTZ5613, "trolley_position": 12.0}
    assert (frame_frequencies(TOWER, JIB, **crane) == frame_frequencies(TOWER, JIB, **crane)).all()
    assert frame_frequencies(TOWER, JIB, **{**crane, "count": 0}).shape == (0,)


@pytest.mark.parametrize(
    ("change", "name"),
    [
        ({"head_mass": -1.0}, "mass"),
        ({"payload_mass": float("nan")}, "payload_mass"),
        ({"rope_length": 0.0}, "rope_length"),
        ({"gravity": float("inf")}, "gravity"),
        ({"trolley_position": 55.7}, "trolley_position"),
        ({"trolley_position": -0.1}, "trolley_position"),
        ({"elements": 300}, "elements"),
        ({"elements": 0}, "elements"),
        ({"count": -1}, "count"),
        ({"count": 163}, "count"),
    ],
)
def test_refuses_what_makes_no_sense(change, name):
    with pytest.raises(ValueError, match=name):
        frame_frequencies(TOWER, JIB, **{**QTZ5613, "trolley_position": 5.0, "count": 6, **change})

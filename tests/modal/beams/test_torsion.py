"""Torsion of a shaft that springs hold on its way, against polynomials that know nothing of sines."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial import Legendre
from numpy.polynomial.legendre import leggauss
from numpy.testing import assert_allclose
from scipy.linalg import eigh

from modal import Shaft, torsion_modes

LENGTH, INERTIA, STIFFNESS = 80.0, 700.0, 2.5e8
HEAD = 6e5
SPRINGS = {
    "two": ((30.0, 4e7), (55.0, 8e7)),
    "stiff": ((30.0, 2e9), (55.0, 2e9)),
    "soft": ((30.0, 1e2), (55.0, 0.0)),
    "at the end": ((55.0, 3e7), (LENGTH, 5e7)),
}


def polynomials(springs, head, count, degree=24, steps=()):
    """Lowest angular frequencies, by Ritz in polynomials on every piece."""
    nodes = np.array(sorted({0.0, LENGTH, *(at for at, *_ in (*springs, *steps))}))
    pieces, size = len(nodes) - 1, (degree + 1) * (len(nodes) - 1)
    stiffness, mass = np.zeros((size, size)), np.zeros((size, size))
    points, weights = leggauss(degree + 2)
    rows = [Legendre.basis(k) for k in range(degree + 1)]
    for piece, span in enumerate(np.diff(nodes)):
        at = slice(piece * (degree + 1), (piece + 1) * (degree + 1))
        inertia, torsion = [(INERTIA, STIFFNESS), *(step[1:] for step in steps if step[0] <= nodes[piece])][-1]
        values, slopes = (np.array([f(points) for f in fs]) for fs in (rows, [row.deriv() for row in rows]))
        mass[at, at] = inertia * 0.5 * span * (values * weights) @ values.T
        stiffness[at, at] = torsion * 2.0 / span * (slopes * weights) @ slopes.T
    ends = np.zeros((pieces + 1, size))
    for piece in range(pieces):
        ends[piece + 1, piece * (degree + 1) : (piece + 1) * (degree + 1)] = 1.0
    starts = np.zeros((pieces, size))
    for piece in range(pieces):
        starts[piece, piece * (degree + 1) : (piece + 1) * (degree + 1)] = (-1.0) ** np.arange(degree + 1)
    for at, spring in springs:
        there = ends[np.flatnonzero(nodes == at)[0]]
        stiffness += spring * np.outer(there, there)
    mass += head * np.outer(ends[-1], ends[-1])
    joined = np.linalg.svd(starts - ends[:-1])[2][pieces:].T
    # The reciprocal problem keeps the lowest exact to rounding under a heavy head.
    reciprocal = eigh(joined.T @ mass @ joined, joined.T @ stiffness @ joined, eigvals_only=True)
    return 1.0 / np.sqrt(reciprocal[::-1][:count])


@pytest.mark.parametrize("head", [0.0, HEAD, 1e9])
@pytest.mark.parametrize("springs", SPRINGS.values(), ids=SPRINGS)
def test_frequencies_on_springs_agree_with_polynomials(springs, head):
    modes = torsion_modes(Shaft(LENGTH, INERTIA, STIFFNESS, springs), 6, head)
    assert_allclose(modes.angular_frequencies, polynomials(springs, head, 6), rtol=2e-9)


@pytest.mark.parametrize("springs", [(), *SPRINGS.values()])
def test_modes_on_springs_are_orthonormal_and_share_out_their_stiffness(springs):
    modes = torsion_modes(Shaft(LENGTH, INERTIA, STIFFNESS, springs), 8, HEAD)
    end = modes(LENGTH)
    assert (end > 0.0).all()
    assert_allclose(
        modes.mass_matrix() + HEAD * np.outer(end, end),
        np.eye(8),
        atol=1e-11 if springs == SPRINGS["stiff"] else 3e-13,
    )
    nodes = np.array(sorted({0.0, LENGTH, *(at for at, _ in springs)}))
    s, w = leggauss(40)
    z = (nodes[:-1, None] + 0.5 * np.diff(nodes)[:, None] * (s + 1.0)).ravel()
    weight = (0.5 * np.diff(nodes)[:, None] * w).ravel()
    assert_allclose(modes.mass_moment(), INERTIA * modes(z) @ weight, rtol=1e-11, atol=1e-9)
    # int G J phi'^2 and what is in the springs are together omega^2; slopes by central differences.
    slopes = (modes(z + 1e-5) - modes(z - 1e-5)) / 2e-5
    held = sum(spring * modes(at) ** 2 for at, spring in springs)
    assert_allclose(STIFFNESS * slopes**2 @ weight + held, modes.angular_frequencies**2, rtol=1e-7)


def test_a_spring_without_stiffness_changes_nothing():
    plain = torsion_modes(Shaft(LENGTH, INERTIA, STIFFNESS), 5, HEAD)
    loose = torsion_modes(Shaft(LENGTH, INERTIA, STIFFNESS, ((20.0, 0.0), (LENGTH, 0.0))), 5, HEAD)
    assert_allclose(loose.angular_frequencies, plain.angular_frequencies, rtol=1e-14)
    z = np.linspace(0.0, LENGTH, 33)
    assert_allclose(loose(z), plain(z), atol=1e-14)


@pytest.mark.parametrize("springs", [((0.0, 1.0),), ((81.0, 1.0),), ((30.0, -1.0),), ((30.0, 1.0), (30.0, 1.0))])
def test_springs_off_the_shaft_are_refused(springs):
    with pytest.raises(ValueError, match=r"Shaft.springs: wanted"):
        Shaft(LENGTH, INERTIA, STIFFNESS, springs)


STEPS = {
    "thinner": ((30.0, 300.0, 4e7),),
    "stouter": ((20.0, 2e3, 3e10), (60.0, 50.0, 1e7)),
    "many": tuple((10.0 * k, INERTIA / k**2, STIFFNESS / k**3) for k in range(1, 8)),
    "none": ((40.0, INERTIA, STIFFNESS),),
}


@pytest.mark.parametrize("springs", [(), SPRINGS["two"], SPRINGS["at the end"]])
@pytest.mark.parametrize("head", [0.0, HEAD])
@pytest.mark.parametrize("steps", STEPS.values(), ids=STEPS)
def test_frequencies_of_a_shaft_in_steps_agree_with_polynomials(steps, head, springs):
    modes = torsion_modes(Shaft(LENGTH, INERTIA, STIFFNESS, springs, steps), 6, head)
    assert_allclose(modes.angular_frequencies, polynomials(springs, head, 6, steps=steps), rtol=2e-8)


@pytest.mark.parametrize("steps", STEPS.values(), ids=STEPS)
def test_modes_of_a_shaft_in_steps_are_orthonormal_and_share_out_their_stiffness(steps):
    shaft = Shaft(LENGTH, INERTIA, STIFFNESS, SPRINGS["two"], steps)
    modes = torsion_modes(shaft, 8, HEAD)
    end = modes(LENGTH)
    assert_allclose(modes.mass_matrix() + HEAD * np.outer(end, end), np.eye(8), atol=2e-10)
    s, w = leggauss(40)
    z = (shaft.nodes[:-1, None] + 0.5 * np.diff(shaft.nodes)[:, None] * (s + 1.0)).ravel()
    weight = (0.5 * np.diff(shaft.nodes)[:, None] * w).ravel()
    inertias, stiffnesses = (np.repeat(values, 40) for values in shaft.pieces)
    assert_allclose(modes.mass_moment(), modes(z) @ (inertias * weight), rtol=1e-10, atol=1e-9)
    assert_allclose(shaft.inertia, inertias @ weight)
    # The torque is continuous but for the springs'; slopes by central differences.
    slopes = (modes(z + 1e-5) - modes(z - 1e-5)) / 2e-5
    held = sum(spring * modes(at) ** 2 for at, spring in shaft.springs)
    assert_allclose(slopes**2 @ (stiffnesses * weight) + held, modes.angular_frequencies**2, rtol=1e-6)
    stiffer = modes.with_stiffness(4.0)
    springs = tuple((at, 4.0 * k) for at, k in shaft.springs)
    again = torsion_modes(Shaft(LENGTH, INERTIA, STIFFNESS, springs, steps), 8, HEAD)
    both = torsion_modes(replace(stiffer.shaft, springs=springs), 8, HEAD)
    assert_allclose(both.angular_frequencies, 2.0 * modes.angular_frequencies, rtol=1e-12)
    assert (again.angular_frequencies < both.angular_frequencies).all()


@pytest.mark.parametrize(
    ("steps", "message"),
    [
        (((90.0, 1.0, 1.0),), r"Shaft.steps: wanted more than 0\.0 and less than 80\.0 m, ascending, got 90\.0"),
        (((40.0, 1.0, 1.0), (30.0, 1.0, 1.0)), "Shaft.steps: wanted more than 40.0"),
        (((40.0, -1.0, 1.0),), "Shaft.steps: wanted a positive finite number, got -1.0"),
    ],
)
def test_a_shaft_says_what_is_wrong_with_its_steps(steps, message):
    with pytest.raises(ValueError, match=message):
        Shaft(LENGTH, INERTIA, STIFFNESS, steps=steps)

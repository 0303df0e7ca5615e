"""Frequencies, shapes and critical loads are the same however a beam is cut, tapers, and however soft it stands."""

from __future__ import annotations

import numpy as np
import pytest

from modal import Beam, Chain, EndBody, Foundation, Segment, cantilever_modes, chain_frequencies, chain_structure
from modal.beams.roots import characteristic_roots
from modal.structures.assembly import assembly
from modal.structures.chain_modes import chain_modes
from modal.structures.refinement import refined
from modal.structures.structure import Structure
from modal.structures.structure_modes import structure_modes

BODY = EndBody(1.0, 0.5)


def tapered(ratio, mass_power, bending_power):
    return Segment(1.0, 1.0, 1.0, end_ratio=ratio, mass_power=mass_power, bending_power=bending_power)


def cut(lengths, bodies, foundation=Foundation(), **changes):  # noqa: B008  frozen
    segments = tuple(Segment(float(length), 1.0, 1.0, **changes) for length in lengths)
    return Chain(segments, {(len(segments) if node < 0 else node): body for node, body in bodies.items()}, foundation)


def random_lengths(count, seed):
    lengths = np.random.default_rng(seed).exponential(size=count) ** 3
    return lengths / lengths.sum()


CUTS = {"50 equal": np.full(50, 0.02), "500 equal": np.full(500, 0.002), "300 of any length": random_lengths(300, 7)}


@pytest.mark.parametrize("name", CUTS)
def test_a_cut_beam_has_the_frequencies_of_a_whole_one(name):
    exact = characteristic_roots(BODY.mass, BODY.rotary_inertia, 8) ** 2
    np.testing.assert_allclose(chain_frequencies(cut(CUTS[name], {-1: BODY}), 8), exact, rtol=1e-12)


def test_unknowns_and_pieces_hang_on_waves_not_on_the_number_of_different_segments():
    sizes, pieces = [], []
    for number in (20, 80, 320):
        stiff = 1.0 + 0.5 * np.cos(np.arange(number))
        structure = chain_structure(Chain(tuple(Segment(1.0 / number, size, size) for size in stiff), {number: BODY}))
        highest = structure.angular_frequencies(4)[-1]
        sizes.append(assembly(refined(structure, highest), highest).points.shape[1])
        pieces.append(structure_modes(structure, 4).parts["tower"].ends.size - 1)
    assert sizes[0] == sizes[1] == sizes[2] <= 6
    assert pieces == [20, 80, 320]


def test_low_frequencies_do_not_hang_on_how_many_are_asked_for():
    exact = characteristic_roots(BODY.mass, BODY.rotary_inertia, 60) ** 2
    found = chain_frequencies(cut(np.full(50, 0.02), {-1: BODY}), 60)
    np.testing.assert_allclose(found, exact, rtol=1e-12)
    np.testing.assert_allclose(found[:2], exact[:2], rtol=2e-14)


@pytest.mark.parametrize("stiffness", [1e-6, 1e-17])
@pytest.mark.parametrize("pieces", [1, 10, 50])
def test_a_soft_spring_keeps_its_digits(stiffness, pieces):
    """The body of 1 kg at 1 m turns with the beam as if both were rigid but for a term of the spring's size."""
    chain = cut(np.full(pieces, 1.0 / pieces), {-1: EndBody(1.0)}, Foundation(stiffness))
    rigid = np.sqrt(stiffness / (1.0 + 1.0 / 3.0))
    # To first order the square falls by stiffness times int M^2 / EI over that of a unit moment at the foot.
    points, weights = np.polynomial.legendre.leggauss(8)
    x, w = 0.5 * (points + 1.0), 0.5 * weights
    moment = ((1.0 - x) + (2.0 - 3.0 * x + x**3) / 6.0) / (1.0 + 1.0 / 3.0)
    first = rigid * (1.0 - 0.5 * stiffness * (w @ moment**2))
    np.testing.assert_allclose(chain_frequencies(chain, 1)[0], first, rtol=1e-11)
    rotary = cut(np.full(pieces, 1.0 / pieces), {}, Foundation(stiffness), rotary_inertia=1e-3)
    np.testing.assert_allclose(
        chain_frequencies(rotary, 1)[0], np.sqrt(stiffness / (1.0 / 3.0 + 1e-3)), rtol=max(stiffness, 1e-14)
    )


def test_a_beam_on_two_soft_springs_moves_as_a_rigid_one():
    k = 1e-12
    found = chain_frequencies(Chain((Segment(1.0, 1.0, 1.0),), foundation=Foundation(k, k)), 3)
    mass, stiffness = np.array([[1.0, 0.5], [0.5, 1.0 / 3.0]]), k * np.eye(2)
    rigid = np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(mass, stiffness))))
    np.testing.assert_allclose(found[:2], rigid, rtol=1e-10)
    # A free beam has the frequencies of one with both ends held, which costs half the digits.
    np.testing.assert_allclose(found[2], 4.730040744862704**2, rtol=3e-8)


def test_a_structure_without_support_is_refused_by_name():
    structure = Structure(())
    structure.add_chain(Chain((Segment(1.0, 1.0, 1.0),)), (structure.add_unknown("m"), structure.add_unknown("rad")))
    with pytest.raises(ValueError, match="structure: wanted one that no motion leaves unstrained"):
        structure.angular_frequencies(1)


# Clamped wide end, free thin one; roots of wedge and cone by Bessel functions, the others by a power series of the
# mode about the thin end in 40-digit arithmetic.
THIN = {
    "mass to a point": ((1e-6, 1.0, 0.0), 7.92797, 32.2018),
    "mass to a thousandth": ((1e-3, 1.0, 0.0), 7.91218, None),
    "stiffness to a point": ((1e-6, 0.0, 1.0), 3.07064, 5.78319),
    "both to a point": ((1e-6, 1.0, 1.0), 7.15645, 26.0243),
    "wedge": ((1e-9, 1.0, 3.0), 5.31510, 13.1873),
    "cone": ((1e-12, 2.0, 4.0), 8.71926, 30.5298),
}


@pytest.mark.parametrize("name", THIN)
def test_a_thin_end_of_any_power_is_exact(name):
    taper, frequency, weight = THIN[name]
    chain = Chain((tapered(*taper),), gravity=0.0)
    np.testing.assert_allclose(chain_frequencies(chain, 1)[0], frequency, rtol=1e-6)
    if weight is not None:
        column = chain_structure(Chain((tapered(*taper),), gravity=1.0))
        np.testing.assert_allclose(column.buckling_factor(), weight, rtol=3e-6)


def test_own_weight_on_a_stiffness_that_fades_to_a_point_is_borne_up_to_the_zero_of_a_bessel_function():
    """``(EI theta')' = -P theta`` with both in proportion to the distance s from the tip: theta = J_0(sqrt(q) s)."""
    column = chain_structure(Chain((tapered(1e-9, 0.0, 1.0),), gravity=1.0))
    np.testing.assert_allclose(column.buckling_factor(), 2.404825557695773**2, rtol=1e-8)


@pytest.mark.parametrize("pieces", [1, 7, 60])
def test_shapes_under_a_heavy_body_are_those_of_the_closed_form(pieces):
    count, heavy = (50 if pieces == 1 else 20), EndBody(0.0, 1e8)
    ours = chain_modes(cut(np.full(pieces, 1.0 / pieces), {}), count, heavy)
    closed = cantilever_modes(Beam(1.0, 1.0, 1.0, 1.0), count, heavy)
    x = np.linspace(0.0, 1.0, 11)
    assert np.abs(ours(x) - closed(x)).max() < 1e-10
    assert ours(1.0)[-1] == pytest.approx(np.sqrt(2.0), rel=1e-10)
    modes = structure_modes(chain_structure(cut(np.full(pieces, 1.0 / pieces), {-1: heavy})), count)
    assert np.abs(modes.mass_matrix() - np.eye(count)).max() < 1e-9


def test_shapes_of_a_cut_chain_are_those_of_a_whole_one():
    bodies = {3: EndBody(0.2, 0.01, 0.05), -1: BODY}
    whole = structure_modes(chain_structure(cut([0.3, 0.3, 0.1, 0.3], bodies)), 6)
    lengths = [*(0.1 * random_lengths(90, 3)), 0.2, 0.3, 0.1, *(0.3 * random_lengths(40, 4))]
    finely = structure_modes(chain_structure(cut(lengths, {93: bodies[3], -1: BODY})), 6)
    x = np.linspace(0.0, 1.0, 7)
    for quantity in range(5):
        one, other = (modes.parts["tower"].evaluate(x, quantity) for modes in (whole, finely))
        assert np.abs(one - other).max() < 1e-9 * np.abs(one).max()
    assert np.abs(finely.mass_matrix() - np.eye(6)).max() < 1e-10

"""Mass that moves beyond the axis on a flexibility of its own: transfer matrices, elements, shapes, counts, bases."""

from __future__ import annotations

from dataclasses import replace

import mpmath
import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.determinants import state_matrix

from modal import Chain, EndBody, Segment, StructureElements, chain_frequencies, chain_structure
from modal.structures.chain_modes import chain_modes
from modal.structures.influence import influence, keeping
from modal.structures.structure_modes import structure_modes

BROAD = Segment(40.0, 300.0, 8e10, 5.7e7, 4800.0, mass_flexibility=1.6e-8)
"""Of 8 m by 8 m, legs of 60 cm^2, all else 6 cm^2: its masses vibrate on their flexibility at 73 Hz."""

SLEWING = EndBody(18e3, 5e6, 0.7)

STEPPED = (
    Segment(30.0, 300.0, 8e10, 5.7e7, 4800.0, 0.4, 0.7, 2.0, -0.3, True, 1.6e-8),
    Segment(10.0, 200.0, 8e9, 3e7, 4000.0, mass_flexibility=5e-9),
    Segment(10.0, 200.0, 8e9, 3e7, 4000.0),
)


def stiff(chain):
    return replace(chain, segments=tuple(replace(one, mass_flexibility=0.0) for one in chain.segments))


def closing(omega2):
    """Determinant of the bare column's end, clamped at its foot, by its transfer matrix; mass as it counts."""
    counts = BROAD.mass_per_length / (1 - BROAD.mass_flexibility * BROAD.mass_per_length * omega2)
    heavy = replace(BROAD, mass_per_length=counts, mass_flexibility=0.0)
    transfer = mpmath.expm(state_matrix(heavy, 0.0, omega2, "haringx") * BROAD.length)
    return mpmath.det(transfer[2:4, 2:4])


def test_frequencies_are_those_of_a_mass_that_counts_for_more():
    found = chain_frequencies(Chain((BROAD,)), 4)
    with mpmath.workdps(50):
        squares = [mpmath.findroot(closing, (w * (1 - 1e-9), w * (1 + 1e-9))) for w in map(mpmath.mpf, found**2)]
        assert_allclose(found, [float(mpmath.sqrt(w)) for w in squares], rtol=3e-15)
    lowered = found / chain_frequencies(stiff(Chain((BROAD,))), 4) - 1.0
    assert_allclose(lowered, [-5.75e-4, -5.29e-3, -1.64e-2, -3.1e-2], rtol=0.02)


@pytest.mark.parametrize("theory", ["haringx", "engesser"])
def test_elements_with_the_force_on_the_mass_as_a_field_agree(theory):
    chain = Chain(STEPPED, {3: SLEWING}, axial_load=1e6, gravity=9.81, shear_theory=theory)
    structure = chain_structure(chain)
    found = structure.angular_frequencies(4)
    assert_allclose(StructureElements(structure, 50).angular_frequencies(4), found, rtol=1e-11)
    near, far = STEPPED[0].split(11.0)
    cut = replace(chain, segments=(near, far, *STEPPED[1:]), bodies={4: SLEWING})
    assert_allclose(chain_frequencies(cut, 4), found, rtol=1e-14)
    assert np.abs(structure_modes(structure, 4).mass_matrix() - np.eye(4)).max() < 1e-12


def test_elements_without_shear_strain_refuse_it():
    with pytest.raises(ValueError, match="members: wanted shear strain where mass moves"):
        StructureElements(chain_structure(Chain((replace(BROAD, shear_stiffness=np.inf),))))


@pytest.mark.parametrize("segments", [(BROAD,), STEPPED[:1]])
def test_modes_crowd_below_the_frequency_of_the_mass_alone_and_none_is_missed(segments):
    structure = chain_structure(Chain(segments))
    limit = segments[0].mass_frequency
    by_elements = StructureElements(structure, 60).angular_frequencies(50)
    for part in (0.5, 0.8, 0.9, 0.95):
        assert structure.count_below(part * limit) == (by_elements < part * limit).sum() > 0
    with pytest.raises(ValueError, match="angular_frequency: wanted less than 456"):
        structure.count_below(limit)


def test_more_modes_than_there_are_below_it_are_refused():
    taper = Chain(STEPPED[:1])
    assert chain_frequencies(taper, 16)[-1] < STEPPED[0].mass_frequency
    with pytest.raises(ValueError, match=r"count: wanted at most \d\d frequencies, .* own flexibility; got 60"):
        chain_frequencies(taper, 60)


def test_shapes_hold_the_motion_of_the_mass_and_its_strain():
    omega = chain_frequencies(Chain(STEPPED[:2]), 4)
    shapes = structure_modes(chain_structure(Chain(STEPPED[:2])), 4).parts["tower"]
    assert_allclose(shapes.strain_matrix(), np.diag(omega**2), atol=1e-11 * omega[-1] ** 2)
    beyond = shapes.motion / shapes.at_points(0)
    expected = 1.0 / (1.0 - shapes.mass_flexibility * shapes.mass_per_length * omega[:, None, None] ** 2)
    assert_allclose(beyond, expected, rtol=1e-8)


def test_the_modes_of_a_larger_model_have_the_frequencies_of_the_column():
    """By as many modes without the flexibility; so there are as many as one likes."""
    for body, bound in ((SLEWING, 3e-7), (EndBody(), 3.1e-6)):
        modes = chain_modes(Chain((BROAD,)), 3, body)
        assert_allclose(modes.angular_frequencies, chain_frequencies(Chain((BROAD,), {1: body}), 3), rtol=bound)
        squared = modes.angular_frequencies**2
        assert_allclose(modes.stiffness_matrix(), np.diag(squared), atol=1e-13 * squared[-1])
        tip, turn = modes(40.0) + body.offset * modes.rotation(40.0), modes.rotation(40.0)
        whole = modes.mass_matrix() + body.mass * np.outer(tip, tip) + body.rotary_inertia * np.outer(turn, turn)
        assert_allclose(whole, np.eye(3), atol=1e-12)
        assert (tip > 0.0).all()
    assert chain_modes(Chain(STEPPED[:1]), 22).count == 22


def test_what_it_does_to_frequencies_is_predicted_with_the_shear():
    tower = Chain((replace(BROAD, rotary_inertia=0.0, shear_stiffness=1e10),))
    plain = structure_modes(chain_structure(keeping(tower, ())), 2)
    predicted = influence(plain, tower).changes["shear"]
    assert_allclose(predicted, chain_frequencies(tower, 2) / plain.angular_frequencies - 1.0, rtol=0.03)
    assert abs(influence(plain, stiff(tower)).changes["shear"][1]) < 0.7 * abs(predicted[1])

"""What holds a chain besides its own stiffness: springs and block at its foot, collars to a building."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.collocation import collocated_chain

from modal import (
    Chain,
    Collar,
    EndBody,
    Foundation,
    Segment,
    StructureElements,
    chain_frequencies,
    chain_structure,
    crane_structure,
)
from modal.structures.chain_modes import chain_modes
from modal.structures.crane_frame import CraneFrame
from modal.structures.influence import influence, keeping
from modal.structures.structure_modes import structure_modes

SEGMENTS = tuple(Segment(length, 700.0, 8e9, 2e8, 600.0) for length in (30.0, 25.0, 25.0))
TOP, BLOCK = EndBody(60e3, 1e7, 1.5), EndBody(120e3, 4e5)
COLLARS = {1: Collar(4e7), 2: Collar(4e7)}
GROUND = Foundation(1.5e10, 8e8)
TOWERS = {  # frequencies known beforehand [Hz]
    "clamped": (Chain(SEGMENTS, {3: TOP}), (0.12064, 0.81628, 2.0277, 4.2063)),
    "collars": (Chain(SEGMENTS, {3: TOP}, collars=COLLARS), (0.40024, 1.65497, 6.0286, 6.2168)),
    "foundation": (Chain(SEGMENTS, {0: BLOCK, 3: TOP}, GROUND), (0.11945, 0.81113, 2.0113, 4.1722)),
    "both": (Chain(SEGMENTS, {0: BLOCK, 3: TOP}, GROUND, collars=COLLARS), (0.40024, 1.65497, 5.9567, 6.1823)),
}
GENERAL = Chain(
    (
        Segment(10.0, 400.0, 6e9, 2e8, 30.0, end_ratio=0.8, mass_power=1.0),
        Segment(8.0, 350.0, 4e9, 1.5e8, 30.0),
        Segment(6.0, 300.0, 3e9, 1e8, 20.0),
    ),
    {0: EndBody(20e3, 3e4, -0.6), 2: EndBody(500.0, 100.0, 0.3), 3: EndBody(8000.0, 2e5, 1.1)},
    Foundation(1e10, 1e9, -2.5e9),
    gravity=9.81,
    collars={1: Collar(2e7, 3e8), 2: Collar(6e6)},
)


@pytest.mark.parametrize("name", TOWERS)
def test_a_tower_on_springs_and_collars_has_its_known_frequencies(name):
    tower, known = TOWERS[name]
    found = chain_frequencies(tower, 6)
    assert_allclose(found[:4] / (2.0 * np.pi), known, rtol=2.6e-5)
    assert_allclose(found, collocated_chain(tower, 6), rtol=1e-9)
    assert_allclose(found[:4], StructureElements(chain_structure(tower), 48).angular_frequencies(4), rtol=2e-9)


@pytest.mark.parametrize("theory", ["haringx", "engesser"])
@pytest.mark.parametrize("coupling", [-2.5e9, 0.0, 2.5e9])
def test_coupled_springs_and_collars_agree_with_collocation_and_elements(theory, coupling):
    ground = replace(GENERAL.foundation, coupling=coupling)
    chain = replace(GENERAL, shear_theory=theory, foundation=ground)
    found = chain_frequencies(chain, 6)
    assert_allclose(found, collocated_chain(chain, 6), rtol=1e-9)
    assert_allclose(found[:3], StructureElements(chain_structure(chain), 48).angular_frequencies(3), rtol=1e-8)
    for count in range(6):
        assert chain_structure(chain).count_below(found[count] * (1.0 - 1e-9)) == count


def test_a_spring_above_a_foot_that_is_rigid_is_a_coupled_foundation():
    """A rigid stub below, held at the height h of a spring: k in deflection, k h coupled, k h^2 more in rotation."""
    height, spring, turning = 1.3, 3e8, 2e9
    coupled = Foundation(turning + spring * height**2, spring, spring * height)
    segment, top = Segment(20.0, 300.0, 2e9, 2e8, 50.0), {1: EndBody(9e3, 1e5)}
    plain = chain_structure(Chain((segment,), top, Foundation(turning, 1.0)))
    # The foot's deflection is that of the spring's point less what the foot turns over the height.
    foot, rotation = plain.members[0].unknowns[:2]
    del plain.springs[foot, foot]
    for i, a in ((foot, 1.0), (rotation, height)):
        for j, b in ((foot, 1.0), (rotation, height)):
            plain.springs[i, j] += spring * a * b
    assert_allclose(chain_frequencies(Chain((segment,), top, coupled), 5), plain.angular_frequencies(5), rtol=1e-12)


def test_the_stiffness_of_a_basis_holds_its_springs():
    modes = chain_modes(GENERAL, 6)
    stiffness = modes.stiffness_matrix() - GENERAL.gravity * modes.weight_matrix()
    omega = modes.angular_frequencies
    assert np.abs(stiffness / np.outer(omega, omega) - np.eye(6)).max() < 1e-12
    assert np.abs(modes.mass_matrix() - np.eye(6)).max() < 1e-12


def test_a_node_more_leaves_bodies_and_collars_where_they_are():
    cut, node = GENERAL.with_node(4.0)
    assert node == 1
    assert {cut.nodes[k]: collar for k, collar in cut.collars.items()} == {
        GENERAL.nodes[k]: collar for k, collar in GENERAL.collars.items()
    }
    assert_allclose(chain_frequencies(cut, 5), chain_frequencies(GENERAL, 5), rtol=1e-13)


@pytest.mark.parametrize("coupling", [-7e9, 7e9])
def test_the_prediction_of_a_foundation_knows_its_coupling(coupling):
    bodies = {0: EndBody(5e3, 2e4), 1: EndBody(3e4)}
    tower = Chain((Segment(40.0, 700.0, 8e9),), bodies, Foundation(2e10, 4e9, coupling))
    plain = structure_modes(chain_structure(keeping(tower, ())), 2)
    actual = chain_frequencies(tower, 2) / plain.angular_frequencies - 1.0
    predicted = influence(plain, tower).changes["foundation"]
    assert_allclose(predicted[0], actual[0], rtol=2e-3)
    assert_allclose(predicted[1], actual[1], rtol=0.07)
    other = influence(plain, replace(tower, foundation=Foundation(2e10, 4e9, -coupling))).changes["foundation"]
    assert np.abs(other / predicted - 1.0).min() > 0.05


def test_collars_far_up_hold_the_crane_as_they_hold_its_tower():
    """On a rigid jib the crane is its tower with one body more."""
    tower = TOWERS["both"][0]
    structure = crane_structure(CraneFrame(tower), 0.0)
    assert_allclose(structure.angular_frequencies(5), chain_frequencies(tower, 5), rtol=1e-13)


@pytest.mark.parametrize("coupling", [5e9, -5e9, float("nan")])
def test_a_coupling_that_frees_the_foot_is_refused(coupling):
    with pytest.raises(ValueError, match=r"Foundation.coupling: wanted"):
        Foundation(5e9, 5e9, coupling)
    with pytest.raises(ValueError, match=r"Foundation.coupling: wanted"):
        Foundation(5e9, coupling=1.0)


@pytest.mark.parametrize(
    ("made", "named"),
    [
        (lambda: Collar(-1.0), "Collar.stiffness"),
        (lambda: Collar(1.0, float("inf")), "Collar.rotation_stiffness"),
        (lambda: replace(GENERAL, collars={0: Collar(1.0)}), "Chain.collars: wanted nodes 1 to 3, got 0"),
        (lambda: CraneFrame(GENERAL, jib=replace(GENERAL, gravity=0.0)), "CraneFrame.jib"),
    ],
)
def test_collars_that_cannot_be_are_refused(made, named):
    with pytest.raises(ValueError, match=named):
        made()

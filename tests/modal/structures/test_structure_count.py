"""The count of modes: monotone, with multiplicity, and blind to no mode that hides inside a member."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from modal.beams.beam import EndBody
from modal.beams.chain import Chain, Foundation, Pendulum
from modal.beams.roots import characteristic_roots
from modal.beams.segment import Segment
from modal.structures.members import HELD, Member, Unstable
from modal.structures.structure import Structure, chain_structure

BEAM = Segment(1.0, 1.0, 1.0)
CLAMPED = characteristic_roots(np.inf, np.inf, 3) ** 2
"""Circular frequencies of a clamped-clamped beam."""

decades = st.floats(-2.0, 2.0).map(lambda power: 10.0**power)
segments = st.builds(
    Segment,
    st.floats(0.3, 2.0),
    decades,
    decades,
    shear_stiffness=st.one_of(st.just(np.inf), decades.map(lambda value: 30.0 * value)),
    rotary_inertia=st.floats(0.0, 0.05),
    end_ratio=st.sampled_from([1.0, 0.5, 1.7]),
    mass_power=st.sampled_from([0.0, 1.0, 2.0]),
    bending_power=st.floats(0.0, 4.0),
)
bodies = st.builds(EndBody, decades, decades, st.floats(-0.3, 0.3))
chains = st.lists(segments, min_size=1, max_size=3).flatmap(
    lambda pieces: st.builds(
        Chain,
        st.just(tuple(pieces)),
        st.dictionaries(st.integers(0, len(pieces)), bodies, max_size=3),
        st.builds(Foundation, decades, decades),
        st.floats(-3.0, 0.01),
        st.sampled_from([0.0, 1e-4]),
        st.one_of(st.none(), st.just(Pendulum(0.3, 0.7))),
        st.sampled_from(["haringx", "engesser"]),
    )
)


@given(chains)
@settings(max_examples=12)
def test_every_frequency_is_counted_once(chain):
    structure = chain_structure(chain)
    try:
        frequencies = structure.angular_frequencies(5)
    except Unstable:
        assert structure.buckling_factor() < 1.0
        return
    assert (np.diff(frequencies) >= 0.0).all()
    assert frequencies[0] > 0.0
    for k, frequency in enumerate(frequencies):
        assert structure.count_below(frequency * (1.0 - 1e-6)) <= k
        assert structure.count_below(frequency * (1.0 + 1e-6)) >= k + 1
    counts = [structure.count_below(frequency) for frequency in np.geomspace(frequencies[0] / 2, frequencies[-1], 12)]
    assert counts == sorted(counts)


def test_pinned_beam_has_its_simply_supported_frequencies_and_no_others():
    structure = Structure(())
    ends = [(HELD, structure.add_unknown("rad")) for _ in range(2)]
    structure.members.append(Member(BEAM, (*ends[0], *ends[1])))
    k = np.arange(1, 31)
    np.testing.assert_allclose(structure.angular_frequencies(30), (k * np.pi) ** 2, rtol=1e-10)
    # Exactly on them, where two closed forms would vanish together, the count is one of its two neighbours.
    for number in k:
        assert structure.count_below((number * np.pi) ** 2) in (number - 1, number)


@pytest.mark.parametrize("heavy", [1e6, 1e8])
def test_modes_inside_a_member_between_heavy_nodes_are_found(heavy):
    node = EndBody(heavy, heavy)
    structure = chain_structure(Chain((BEAM, BEAM), {1: node, 2: node}))
    frequencies = structure.angular_frequencies(10)
    # Four slow modes of the two nodes; then both members vibrate alike, with fixed ends, in pairs.
    assert frequencies[3] < 20.0 / np.sqrt(heavy)
    np.testing.assert_allclose(frequencies[4:], np.repeat(CLAMPED, 2), rtol=20.0 / heavy)


def test_a_member_without_any_free_end_vibrates():
    structure = Structure((), [Member(BEAM, (HELD,) * 4)])
    np.testing.assert_allclose(structure.angular_frequencies(3), CLAMPED, rtol=1e-12)


def test_a_joint_may_turn_either_of_its_members_over():
    # A hairpin: the second member goes back from the first one's end, so that one of them turns against the node.
    parts = Segment(0.6, 1.0, 1.0), Segment(0.5, 0.8, 0.7)
    found = []
    for factors in (((1.0, 1.0), (1.0, -1.0)), ((1.0, -1.0), (1.0, 1.0))):
        structure = Structure(())
        node, end = ((structure.add_unknown("m"), structure.add_unknown("rad")) for _ in range(2))
        far, near = factors
        structure.members = [
            Member(parts[0], (HELD, HELD, *node), (1.0, 1.0, *far)),
            Member(parts[1], (*node, *end), (*near, 1.0, 1.0)),
        ]
        found.append(structure.angular_frequencies(6))
    np.testing.assert_allclose(found[0], found[1], rtol=1e-12)
    straight = chain_structure(Chain(parts)).angular_frequencies(6)
    assert abs(found[0] / straight - 1.0).min() > 1e-3


@pytest.mark.parametrize("copies", [2, 3])
def test_equal_chains_on_one_ground_have_every_frequency_as_often(copies):
    chain = Chain((Segment(0.4, 1.0, 1.0), Segment(0.6, 0.5, 0.3)), {2: EndBody(0.3, 0.02, 0.1)})
    single, structure = chain_structure(chain), Structure(())
    for _ in range(copies):
        structure.add_chain(chain, (HELD, HELD))
    wanted = np.repeat(single.angular_frequencies(5), copies)
    np.testing.assert_allclose(structure.angular_frequencies(5 * copies), wanted, rtol=1e-12)
    assert structure.count_below(wanted[-1] * (1.0 + 1e-9)) == 5 * copies


def test_nearly_equal_frequencies_are_told_apart():
    structure = Structure(())
    for factor in (1.0, 1.0 + 1e-9):
        structure.add_chain(Chain((Segment(1.0, 1.0, factor),)), (HELD, HELD))
    frequencies = structure.angular_frequencies(8)
    np.testing.assert_allclose(frequencies[1::2] / frequencies[::2] - 1.0, 0.5e-9, rtol=1e-3)


def test_sixty_modes_of_one_member():
    roots = np.sqrt(chain_structure(Chain((BEAM,))).angular_frequencies(60))
    errors = np.abs(roots / characteristic_roots(0.0, 0.0, 60) - 1.0)
    assert np.median(errors) < 2e-15
    assert errors.max() < 2e-10


def test_no_frequencies_are_asked_for_or_fewer():
    structure = chain_structure(Chain((BEAM,)))
    assert structure.angular_frequencies(0).shape == (0,)
    with pytest.raises(ValueError, match="count: wanted zero or more, got -1"):
        structure.angular_frequencies(-1)

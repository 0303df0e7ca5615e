"""A flat-top crane of segments in the plane of its jib: exact frequencies, and what simpler jibs make of them."""

from dataclasses import replace

import numpy as np
import pytest
from oracles.crane_transfer import determinant
from samples.flat_top_crane import COUNTER_JIB, FRAME, JIB, PIECES, TOP, TOWER

from modal import Chain, EndBody, Segment, crane_structure
from modal.structures.chain_modes import chain_modes

EXACT = {
    20.0: (0.11095, 0.22474, 0.62716, 0.97790, 2.40045),
    58.0: (0.11093, 0.20939, 0.47409, 0.93956, 2.14839),
}
PLACES = pytest.mark.parametrize("place", EXACT)


def frequencies(frame, place, count=5):
    return crane_structure(frame, place).angular_frequencies(count) / (2.0 * np.pi)


def uniform():
    """A jib of one piece with the mass of all and the first frequency of the jib by itself."""
    mean = Segment(60.0, JIB.inertia[0] / 60.0, 1e9)
    own, first = (chain_modes(chain, 1).angular_frequencies[0] for chain in (JIB, Chain((mean,))))
    return Chain((replace(mean, bending_stiffness=1e9 * (own / first) ** 2),))


@PLACES
def test_frequencies_are_those_of_transfer_matrices(place):
    found = frequencies(FRAME, place)
    assert found == pytest.approx(EXACT[place], rel=5e-5)
    for omega in 2.0 * np.pi * found:
        below, above = (determinant(FRAME, place, omega * (1.0 + sign * 1e-8)) for sign in (-1.0, 1.0))
        assert below * above < 0.0


SIMPLER = {
    "without shear": (
        Chain(tuple(replace(own, shear_stiffness=np.inf) for own in PIECES)),
        {20.0: (0.0, 0.9, 0.3, 4.3), 58.0: (0.1, 0.7, 0.1, 3.8)},
    ),
    "uniform with the first frequency": (uniform(), {20.0: (-2.8, -3.0, 2.0, 28.0), 58.0: (-2.0, 8.0, 3.0, 42.0)}),
    "with bodies on it": (
        replace(JIB, bodies={2: EndBody(1800.0), 24: EndBody(250.0)}),
        {20.0: (-2.2, -4.8, -1.1, -6.6), 58.0: (-2.0, -2.7, -0.3, -1.7)},
    ),
}
"""Jibs, and by how many per cent the frequencies from the second to the fifth are then off."""


@PLACES
@pytest.mark.parametrize("name", SIMPLER)
def test_a_simpler_jib_misses_frequencies(name, place):
    jib, errors = SIMPLER[name]
    changed = 100.0 * (frequencies(replace(FRAME, jib=jib), place) / frequencies(FRAME, place) - 1.0)
    wanted = np.array(errors[place])
    # The whole numbers are printed with no digit more.
    digit = np.where((wanted % 1.0 == 0.0) & (wanted != 0.0), 1.0, 0.1)
    assert np.all(abs(changed[1:] - wanted) < 0.6 * digit)


@PLACES
def test_a_rigid_counter_jib_loses_a_mode(place):
    mass, _, second, own = COUNTER_JIB.inertia
    whole = mass + TOP.mass
    head = EndBody(
        whole,
        TOP.rotary_inertia + second + own + TOP.mass * 1.2**2 - (TOP.mass * 1.2) ** 2 / whole,
        TOP.mass * 1.2 / whole,
    )
    rigid = replace(FRAME, tower=replace(TOWER, bodies={1: head}), counter_jib=None)
    exact, found = frequencies(FRAME, place), frequencies(rigid, place, 4)
    changed = 100.0 * (found[:3] / exact[:3] - 1.0)
    assert changed[1:] == pytest.approx({20.0: (0.2, 0.6), 58.0: (0.1, 0.0)}[place], abs=0.06)
    assert found[3] > 1.5 * exact[3]

"""Traced functions against the same functions called by Python."""

import numpy as np
import pytest
from numba import types

from modal.compiler.compiled import kernel
from modal.compiler.traced import traced
from towercrane.kernels.arrays import in_lanes
from towercrane.kernels.vector import LANES


def arithmetic(a, pair, fixed):
    """Every operation, each with its operands in both orders, with numbers and with constants."""
    b, c = pair
    parts = [
        a + b,
        a - b,
        a * b,
        a / b,
        2.0 + a,
        2.0 - a,
        2.0 * a,
        2.0 / a,
        a + 3,
        a - 3.0,
        a * 3,
        a / 3.0,
        -a,
        -(b - c),
        b / c,
    ]
    return (sum(parts[:4], fixed[1]), (parts[4], tuple(parts[5:])), 7.0)


def flat(nested):
    return np.hstack([flat(part) if isinstance(part, tuple) else part for part in nested])


def places(i, n, numbers, table, out):
    """Items at fixed places and at places that are known when the kernel runs."""
    out[n - 1, i] = numbers[0] + table[i, 2 * i, 1]
    out[i + 1, 0] = out[n - 1, i] * table[0, i, n - 2]


traced_arithmetic, traced_places = traced(arithmetic), traced(places)


@kernel(python_entry=True)
def compute(a, b, c, fixed):
    return traced_arithmetic(a, (b, c), fixed)


@kernel(python_entry=True)
def place(i, n, numbers, table, out):
    traced_places(i, n, numbers, table, out)


@kernel(python_entry=True)
def in_every_lane(numbers, found):
    lanes, results = in_lanes(numbers), in_lanes(found)
    total, (first, others), constant = traced_arithmetic(lanes[0], (lanes[1], 0.3), lanes)
    results[0], results[1], results[2], results[3] = total, first, others[0], others[8] + constant


def test_arithmetic_is_that_of_python_to_the_bit():
    rng = np.random.default_rng(7)
    for _ in range(20):
        a, b, c = rng.normal(size=3)
        fixed = rng.normal(size=2)
        assert np.array_equal(flat(compute(a, b, c, fixed)), flat(arithmetic(a, (b, c), fixed)))


def test_whole_numbers_become_floats_where_they_meet():
    assert compute(1.5, 2, 4, np.array([0.0, 1.0])) == arithmetic(1.5, (2, 4), [0.0, 1.0])


def test_items_are_read_and_written_where_python_does():
    rng = np.random.default_rng(8)
    numbers, table = rng.normal(size=1), rng.normal(size=(3, 5, 4))
    for i, n in ((0, 3), (1, 4), (2, 5)):
        found, wanted = np.zeros((5, 6)), np.zeros((5, 6))
        place(i, n, numbers, table, found)
        places(i, n, numbers, table, wanted)
        assert np.count_nonzero(wanted)
        assert np.array_equal(found, wanted)


def test_lanes_get_the_bits_of_single_numbers():
    rng = np.random.default_rng(9)
    numbers, found = rng.normal(size=(2, LANES)), np.empty((4, LANES))
    in_every_lane(numbers, found)
    for lane in range(LANES):
        total, (first, others), constant = arithmetic(numbers[0, lane], (numbers[1, lane], 0.3), numbers[:, lane])
        assert np.array_equal(found[:, lane], [total, first, others[0], others[8] + constant])


def test_a_branch_on_a_number_is_refused_where_it_is_compiled():
    @traced
    def larger(a, b):
        return a if a > b else b

    with pytest.raises(Exception, match="'>' not supported"):
        kernel(types.float64(types.float64, types.float64))(lambda a, b: larger(a, b))

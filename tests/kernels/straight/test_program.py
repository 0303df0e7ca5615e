"""Recorded operations against the same done by NumPy: folding, and machine code of numbers and of lanes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from samples.lane_calls import call_in_lanes

from modal.compiler.lanes import LANES
from towercrane.kernels.choices import below, choose, either, nth
from towercrane.kernels.straight.code import StraightCode
from towercrane.kernels.straight.graph import Graph
from towercrane.kernels.straight.program import evaluate
from towercrane.kernels.straight.written import written

TABLES = np.random.default_rng(3).normal(size=(5, 2, 3))
SHAPES = {"y": (6,), "inputs": (2, 3), "numbers": (3,), "tables": TABLES.shape}


def chosen(x):
    return either(below(abs(x), 0.5), lambda x: (x * x, 1.0 - x), lambda x: (np.sqrt(abs(x)), x / 3.0), x)


Floats = Table = Any


@dataclass(frozen=True)
class Constants:
    numbers: Floats
    table: Table


CONSTANTS = Constants(np.ones(3), TABLES)


def every_operation(own, t, y, inputs):
    """All that equations may do, with operands in both orders, numbers, constants and choices."""
    a, b, c, d, e, f = y
    one, other = chosen(f)
    cell = nth(a * 2.0, 5)
    rows = [
        a + b - c * d / e,
        2.0 - a + (b - 3.0) * 4.0 / (5.0 + c) - d / 7.0,
        -np.sin(a)
        + np.cos(b) * np.tanh(c)
        - np.sqrt(abs(d))
        + np.arctan2(e, f)
        - np.arctan2(2.0, a)
        + np.arctan2(b, 0.0)
        - np.arctan2(0.0, c),
        np.sign(e) * own.numbers[0] + own.numbers[1] * own.numbers[2] * f,
        choose(below(a, b), c, d) + choose(own.numbers[0], e, f) + below(c, 0.1) * 3.0,
        inputs[1, 0] + t * (inputs[1, 1] + t * inputs[0, 2]),
    ]
    return rows, [one + other * a, own.table[cell, 1, 2] * b + cell + 0.5, 4.25]


def program():
    return written(every_operation, CONSTANTS, [CONSTANTS.numbers], 6, (2, 3)).program


@pytest.fixture(scope="module")
def recorded():
    return program()


def drawn(rng, lanes):
    """States of which some are on either side of every choice, and beyond either end of the table."""
    y = rng.normal(size=(6, lanes)) * rng.choice([0.1, 1.0, 5.0], size=(6, lanes))
    return rng.normal(size=lanes), y, rng.normal(size=(2, 3, lanes)), rng.normal(size=(3, lanes))


def by_numpy(recorded, t, y, inputs, numbers):
    """Outputs of one state."""
    given = {"t": {(): t}, "y": y, "inputs": inputs, "constant": numbers, "tables": TABLES}
    values = evaluate(recorded.graph, recorded.needed, given)
    return np.array([values[place] for place in recorded.outputs.values()])


@pytest.fixture(scope="module")
def single(recorded):
    return StraightCode(recorded, SHAPES, lanes=False)


def by_code(single, recorded, t, y, inputs, numbers):
    dy, guards = np.empty(6), np.empty(3)
    single(t, y, dy, inputs, np.concatenate([numbers, recorded.constants(numbers)]), TABLES, guards)
    return np.concatenate([dy, guards])


def test_machine_code_does_what_was_recorded(single, recorded):
    rng = np.random.default_rng(7)
    for _ in range(300):
        t, y, inputs, numbers = (np.ascontiguousarray(part[..., 0]) for part in drawn(rng, 1))
        found = by_code(single, recorded, float(t[0]), y, inputs, numbers)
        assert np.array_equal(found, by_numpy(recorded, float(t[0]), y, inputs, numbers))
        # Sines are the C library's there and NumPy's here.
        plain = every_operation(Constants(numbers, TABLES), float(t[0]), y, inputs)
        np.testing.assert_allclose(found, np.concatenate(plain), rtol=4e-15, atol=4e-15)


def test_lanes_get_the_bits_of_single_runs(single, recorded):
    code = StraightCode(recorded, SHAPES, lanes=True)
    rng = np.random.default_rng(8)
    for _ in range(200):
        t, y, inputs, numbers = drawn(rng, LANES)
        behind = np.concatenate([numbers, recorded.constants(numbers)])
        dy, guards = np.empty((6, LANES)), np.empty((3, LANES))
        call_in_lanes(code, t[None], y, dy, inputs, behind, TABLES, guards)
        for lane in range(LANES):
            own = (np.ascontiguousarray(part[..., lane]) for part in (y, inputs, numbers))
            expected = by_code(single, recorded, t[lane], *own)
            assert np.array_equal(np.concatenate([dy[:, lane], guards[:, lane]]), expected)


def test_what_is_known_leaves_no_trace():
    graph = Graph()
    a, b = graph.given("y", 2)
    before = len(graph.nodes)
    assert (a + 0.0, a - 0.0, 0.0 + a, a * 1.0, a / 1.0, 1.0 * a) == (a,) * 6
    assert (a * 0.0, 0.0 * a, 0.0 / a) == (0.0,) * 3
    assert len(graph.nodes) == before
    assert (a + b).place == (b + a).place
    assert (a * -1.0).place == (0.0 - a).place == (-a).place
    assert (a - b).place != (b - a).place


def test_constants_are_worked_out_once_behind_the_numbers(recorded):
    numbers = np.array([1.5, 2.0, -3.0])
    assert recorded.constants(numbers).tolist() == [1.5, -6.0]
    assert sorted(recorded.slots.values()) == [3, 4]
    many = np.stack([numbers, 2.0 * numbers], axis=-1)
    assert recorded.constants(many).tolist() == [[1.5, 3.0], [-6.0, -24.0]]


def test_a_branch_on_a_number_is_refused_as_it_is_recorded():
    graph = Graph()
    (a,) = graph.given("y", 1)
    with pytest.raises(TypeError, match="wanted a named choice"):
        bool(a)
    with pytest.raises(TypeError, match="not supported"):
        max(a, 1.0)


def test_equations_of_systems_share_code_where_their_zeros_are_the_same():
    def equations(own, t, y, inputs):
        return [own.numbers[0] * y[0] + own.numbers[1]], []

    def write(*numbers):
        return written(equations, Constants(np.zeros(2), TABLES), [np.array(own) for own in numbers], 1, (1, 3))

    one, other, none = (2.0, 3.0), (-1.0, 4.0), (2.0, 0.0)
    assert write(one) is write(other)
    assert write(none) is not write(one)
    # Side by side nothing is left out that one of them has.
    assert write(none, one) is write(one)
    assert write(one).numbers(np.array(none)).tolist() == [2.0, 0.0, 2.0, 0.0]

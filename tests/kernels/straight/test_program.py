"""Recorded operations against the same done by NumPy: folding, and machine code of numbers and of lanes."""

import numpy as np
import pytest
from samples.lane_calls import call_in_lanes

from towercrane.kernels.arrays import lane_rhs_signature
from towercrane.kernels.choices import below, choose, either, nth
from towercrane.kernels.straight.code import straight_code
from towercrane.kernels.straight.graph import Graph, Table
from towercrane.kernels.straight.program import Program, evaluate
from towercrane.kernels.straight.written import Known, written
from towercrane.kernels.vector import LANES
from towercrane.simulation.system import rhs_signature

TABLES = np.random.default_rng(3).normal(size=(5, 2, 3))
SHAPES = {"y": (6,), "inputs": (2, 3), "numbers": (3,), "tables": TABLES.shape}


def small(x):
    return below(abs(x), 0.5)


chosen = either(small, lambda x: (x * x, 1.0 - x), lambda x: (np.sqrt(abs(x)), x / 3.0))
"""Only ever called with operands here, so its parts may be Python's."""


def every_operation(t, y, dy, inputs, numbers, vectors, matrices, tables, work, guards):
    """All that equations may do, with operands in both orders, numbers, constants and choices."""
    a, b, c, d, e, f = y
    rows = [
        a + b - c * d / e,
        2.0 - a + (b - 3.0) * 4.0 / (5.0 + c) - d / 7.0,
        -np.sin(a) + np.cos(b) * np.tanh(c) - np.sqrt(abs(d)),
        np.sign(e) * numbers[0] + numbers[1] * numbers[2] * f,
        choose(below(a, b), c, d) + choose(numbers[0], e, f) + below(c, 0.1) * 3.0,
        inputs[1, 0] + t * (inputs[1, 1] + t * inputs[0, 2]),
    ]
    dy[:] = rows
    one, other = chosen(f)
    cell = nth(a * 2.0, 5)
    guards[0] = one + other * a
    guards[1] = tables[cell, 1, 2] * b + cell + 0.5
    guards[2] = 4.25


def program():
    graph = Graph()
    guards, dy = np.zeros(3, dtype=object), np.zeros(6, dtype=object)
    given = graph.given("y", 6), dy, graph.given("inputs", 2, 3), graph.given("constant", 3)
    time = graph.operand("given", "t", ())
    every_operation(time, *given, None, None, Table(graph, "tables", TABLES.shape), None, guards)
    outputs = {("dy", i): graph.place(value) for i, value in enumerate(dy)}
    outputs |= {("guards", i): graph.place(value) for i, value in enumerate(guards)}
    return Program(graph, outputs, 3)


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
    return straight_code(recorded, SHAPES, rhs_signature(), 0)


def by_code(single, recorded, t, y, inputs, numbers):
    dy, guards, none = np.empty(6), np.empty(3), np.empty((0, 0))
    numbers = np.concatenate([numbers, recorded.constants({"constant": numbers})])
    single(t, y, dy, inputs, numbers, none, np.empty((0, 0, 0)), TABLES, none, guards)
    return np.concatenate([dy, guards])


def test_machine_code_does_what_was_recorded(single, recorded):
    rng = np.random.default_rng(7)
    for _ in range(300):
        t, y, inputs, numbers = (np.ascontiguousarray(part[..., 0]) for part in drawn(rng, 1))
        # Sines are the C library's here and NumPy's there.
        expected = by_numpy(recorded, float(t[0]), y, inputs, numbers)
        found = by_code(single, recorded, float(t[0]), y, inputs, numbers)
        np.testing.assert_allclose(found, expected, rtol=4e-15, atol=4e-15)


def test_lanes_get_the_bits_of_single_runs(single, recorded):
    code = straight_code(recorded, SHAPES, lane_rhs_signature(), LANES)
    rng = np.random.default_rng(8)
    for _ in range(200):
        t, y, inputs, numbers = drawn(rng, LANES)
        behind = np.concatenate([numbers, recorded.constants({"constant": numbers})])
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
    assert recorded.constants({"constant": numbers}).tolist() == [1.5, -6.0]
    assert sorted(recorded.slots.values()) == [3, 4]
    many = np.stack([numbers, 2.0 * numbers], axis=-1)
    assert recorded.constants({"constant": many}).tolist() == [[1.5, 3.0], [-6.0, -24.0]]


def test_a_branch_on_a_number_is_refused_as_it_is_recorded():
    graph = Graph()
    (a,) = graph.given("y", 1)
    with pytest.raises(TypeError, match="wanted a named choice"):
        bool(a)
    with pytest.raises(TypeError, match="not supported"):
        max(a, 1.0)


def test_equations_of_systems_share_code_where_their_zeros_are_the_same():
    def equations(t, y, dy, inputs, numbers, vectors, matrices, tables, work, guards):
        dy[0] = numbers[0] * y[0] + numbers[1]

    def data(*numbers):
        return {"numbers": np.array(numbers), "vectors": np.empty((0, 0))} | dict.fromkeys(
            ("matrices", "tables"), np.empty((0, 0, 0))
        )

    def write(*systems):
        return written(equations, (1, 0), Known(), systems, (1, 3), (0, 0))

    one, other, none = data(2.0, 3.0), data(-1.0, 4.0), data(2.0, 0.0)
    assert write(one) is write(other)
    assert write(none) is not write(one)
    # Side by side nothing is left out that one of them has.
    assert write(none, one) is write(one)
    assert write(one).numbers(none).tolist() == [2.0, 0.0, 2.0, 0.0]

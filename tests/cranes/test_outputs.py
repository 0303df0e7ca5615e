"""Outputs of cranes, which are functions of an instant: of numbers, of arrays of them, and recorded for rows."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.every_kind import KINDS, LOAD, Driven, jib_plan
from samples.jib_cranes import HEAVY

from towercrane.cranes.jib.linear import LinearSway
from towercrane.simulation.observed import Instant, observe

SCENES = KINDS | {"linear sway": lambda: Driven(LinearSway(HEAVY, LOAD), jib_plan())}


@pytest.fixture(params=SCENES, scope="module")
def drawn(request):
    """A model, its motions, and times, states, slopes and guards at random."""
    driven, random, times = SCENES[request.param](), np.random.default_rng(21), np.linspace(0.0, 2.0, 7)
    system = driven.model.system
    rows = [random.normal(size=(7, count)) for count in (system.size, system.size, len(system.guards))]
    return driven.model, driven.motions, times, rows


def instants(model, motions, times, rows):
    """What is known over time: arrays whose last axis is that of the times."""
    return Instant(
        *(array.T for array in rows), [[motions[name](times, k) for k in range(3)] for name in model.channels]
    )


def test_rows_numbers_and_arrays_of_numbers_give_the_same(drawn):
    model, motions, times, rows = drawn
    recorded = {name: one.values for name, one in model.observe(motions, times, *rows).items()}
    together = model.outputs(model.seen, instants(*drawn))
    for place, time in enumerate(times):
        alone = model.outputs(model.seen, instants(model, motions, time, [array[place] for array in rows]))
        for name, values in recorded.items():
            found = np.array(alone[name], dtype=float)
            assert_allclose(values[place], found, rtol=1e-12, atol=1e-12 * abs(values).max())
            assert_allclose(np.array(together[name])[..., place], found, rtol=1e-12, atol=1e-12 * abs(values).max())


def test_outputs_are_what_is_said_of_them(drawn):
    model, motions, times, rows = drawn
    recorded = model.observe(motions, times, *rows)
    assert list(recorded) == list(model.about)
    together = model.outputs(model.seen, instants(*drawn))
    for name, about in model.about.items():
        one = recorded[name]
        assert np.size(together[name]) in (about.size, about.size * len(times))
        assert (one.units, one.long_name, one.dims) == (about.units, about.long_name, ("time", *about.dims))
        assert one.values.shape == (len(times), *([about.size] if about.dims else []))


def test_who_asks_for_few_outputs_gets_these_alone(drawn):
    model, motions, times, rows = drawn
    recorded, asked = model.observe(motions, times, *rows), list(model.about)[::-2]
    few = observe(model, motions, times, *rows, names=asked)
    assert list(few) == asked
    assert all(np.array_equal(few[name].values, recorded[name].values) for name in asked)

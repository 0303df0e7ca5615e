"""Equations written out for their scene against the same with numbers, for every kind of crane."""

from dataclasses import replace

import numpy as np
import pytest
from samples.lane_calls import call_in_lanes
from samples.straight import found, made

from modal.compiler.folder import CacheWarning
from modal.compiler.lanes import LANES
from towercrane.cases.case import load_case
from towercrane.cases.models import model_of, motions_of
from towercrane.kernels import algebra
from towercrane.kernels.straight import written
from towercrane.motions.motion import phases
from towercrane.simulation.system import written_of

CASES = {
    "a crane in the plane": ("qtz5613/condition-3", []),
    "damping, drag and hinge": (
        "qtz5613/condition-3",
        ["model.tower_damping_ratio=0.01", "payload.drag_area=3 m^2", "payload.rope_damping=40 N m s"],
    ),
    "wind along the jib": ("qtz5613/condition-3", ["wind.speed=9 m/s"]),
    "a rigid crane": ("qtz5613/condition-3", ["model.tower_modes=0", "model.jib_vertical_modes=0"]),
    "a prescribed slewing": ("qtz5613/manoeuvre", []),
    "gusts": ("qtz5613/gusts-working", []),
    "a drive": ("qtz5613/soft-drive", []),
    "friction that sticks": ("hard/friction-sticks", []),
    "a smooth friction": ("slewing/multi-mass/example-1", []),
    "an elastic rope": ("slewing/enhanced/example-1", []),
    "joints on their plan": ("jib-crane/plan", []),
    "joints that are driven": ("jib-crane/combined", []),
    "an overhead crane": ("overhead-crane/travel", []),
}


def scene(name, options):
    """Model and the inputs of a phase in which things move."""
    case = load_case(name, options)
    model, motions = model_of(case), motions_of(case)
    cut = phases(tuple(motions[channel] for channel in model.channels), case.run.duration)
    return model, cut.inputs[min(1, len(cut.inputs) - 1)]


def drawn(model, inputs, rng):
    """A state at random about the start, its directions turned anywhere, and a time."""
    state = model.start(inputs, "zero")
    state = state + 0.05 * rng.normal(size=state.size)
    for first, rate, axes in model.system.directions:
        direction, turning = rng.normal(size=(2, axes))
        direction /= np.linalg.norm(direction)
        state[first : first + axes] = direction
        state[rate : rate + axes] = turning - turning @ direction * direction
    return rng.uniform(0.0, 3.0), state


def numbered(system, inputs):
    """Equations of one system, and all their numbers."""
    code = written_of([system], inputs.shape)
    return code, code.numbers(system.numbers)


@pytest.mark.parametrize("about", CASES)
def test_machine_code_has_the_bits_of_what_was_recorded(about):
    model, inputs = scene(*CASES[about])
    system, rng = model.system, np.random.default_rng(11)
    code, numbers = numbered(system, inputs)
    for _ in range(40):
        time, state = drawn(model, inputs, rng)
        found = np.concatenate(system.slope(time, state, inputs))
        given = {"t": {(): time}, "y": state, "inputs": inputs, "numbers": numbers, "tables": system.table}
        wanted = np.array(list(code.program.values(given).values()), dtype=float)
        assert np.array_equal(found, wanted)


@pytest.mark.parametrize("about", CASES)
def test_what_was_recorded_is_what_the_equations_give_for_numbers(about):
    model, inputs = scene(*CASES[about])
    system, rng = model.system, np.random.default_rng(14)
    for _ in range(10):
        time, state = drawn(model, inputs, rng)
        found, wanted = system.slope(time, state, inputs), system.equations(system.constants, time, state, inputs)
        for one, other in zip(found, wanted, strict=True):
            other = np.array(other, dtype=float)
            np.testing.assert_allclose(one, other, rtol=1e-11, atol=1e-12 * abs(other[np.isfinite(other)]).max())


@pytest.mark.parametrize("about", ["gusts", "a drive", "an elastic rope", "joints that are driven"])
def test_equations_take_arrays_of_states(about):
    model, inputs = scene(*CASES[about])
    system, rng = model.system, np.random.default_rng(15)
    states = np.stack([drawn(model, inputs, rng)[1] for _ in range(5)], axis=-1)
    together = system.equations(system.constants, 0.7, states, inputs)[0]
    for column, state in enumerate(states.T):
        alone = system.equations(system.constants, 0.7, state, inputs)[0]
        for one, other in zip(together, alone, strict=True):
            np.testing.assert_allclose(np.broadcast_to(one, 5)[column], other, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("about", ["gusts", "a drive", "an elastic rope", "joints that are driven"])
def test_lanes_of_every_kind_have_the_bits_of_single_states(about):
    model, inputs = scene(*CASES[about])
    system, rng = model.system, np.random.default_rng(12)
    code, numbers = numbered(system, inputs)
    draws = [drawn(model, inputs, rng) for _ in range(LANES)]
    times = np.array([[time for time, _ in draws]])
    states = np.stack([state for _, state in draws], axis=-1)
    slopes, guards = np.empty((system.size, LANES)), np.empty((len(system.guards), LANES))
    shared = [np.repeat(array[..., None], LANES, axis=-1) for array in (inputs, numbers)]
    call_in_lanes(code.rhs(lanes=True), times, states, slopes, *shared, system.table, guards)
    for lane, (time, state) in enumerate(draws):
        slope, margins = system.slope(time, state, inputs)
        assert np.array_equal(slopes[:, lane], slope)
        assert np.array_equal(guards[:, lane], margins)


def test_what_a_switch_changes_is_not_worked_out_beforehand():
    model, inputs = scene(*CASES["friction that sticks"])
    system, place = model.system, model.system.place_of("friction_state")
    rhs, numbers = system.code(inputs)
    rng = np.random.default_rng(13)
    time, state = drawn(model, inputs, rng)
    slopes = {}
    for value in (-1.0, 0.0, 1.0, 2.0):
        changed, slope, guards = numbers.copy(), np.empty(system.size), np.empty(len(system.guards))
        changed[place] = value
        rhs(time, state, slope, inputs, changed, system.table, guards)
        own = replace(system, constants=replace(system.constants, friction_state=value))
        assert np.array_equal(slope, own.slope(time, state, inputs)[0])
        slopes[value] = slope.tobytes()
    assert len(set(slopes.values())) == 3


@pytest.mark.parametrize("lanes", [0, LANES])
def test_a_system_of_many_unknowns_solved_in_loops_has_the_bits_of_one_written_out(lanes, monkeypatch):
    model, inputs = scene(*CASES["gusts"])
    system, rng = model.system, np.random.default_rng(16)
    draws = [drawn(model, inputs, rng) for _ in range(LANES)]
    found = []
    for most in (0, 99):
        monkeypatch.setattr(algebra, "MOST_UNROLLED", most)
        monkeypatch.setattr(written, "_WRITTEN", {})
        own = replace(system)
        if lanes:
            code, numbers = numbered(own, inputs)
            states = np.stack([state for _, state in draws], axis=-1)
            slopes, guards = np.empty_like(states), np.empty((len(system.guards), LANES))
            shared = [np.repeat(array[..., None], LANES, axis=-1) for array in (inputs, numbers)]
            call_in_lanes(
                code.rhs(lanes=True), np.full((1, LANES), 0.4), states, slopes, *shared, system.table, guards
            )
            found.append(slopes)
        else:
            found.append(np.array([own.slope(0.4, state, inputs)[0] for _, state in draws]))
    assert np.array_equal(*found)


def test_forces_at_rest_are_the_same_before_and_after_they_are_compiled(monkeypatch):
    model, inputs = scene(*CASES["gusts"])
    q = 0.1 * np.random.default_rng(17).normal(size=(model.coordinates, 6))
    by_numpy = model.static_forces(q, inputs)
    monkeypatch.setattr(written, "COMPILED_AFTER", 0)
    assert np.array_equal(model.static_forces(q, inputs), by_numpy)


def test_code_is_kept_by_its_content(tmp_path, monkeypatch):
    assert found(*made(2.0, tmp_path, monkeypatch)) == (2.0, 1)
    assert found(*made(3.0, tmp_path, monkeypatch)) == (3.0, 1)
    assert found(*made(2.0, tmp_path, monkeypatch)) == (2.0, 0)
    for kept in tmp_path.rglob("rhs.*.o"):
        kept.write_bytes(kept.read_bytes()[:-1] + b"x")
    with pytest.warns(CacheWarning, match="damaged machine code"):
        assert found(*made(3.0, tmp_path, monkeypatch)) == (3.0, 1)
    assert found(*made(3.0, tmp_path, monkeypatch)) == (3.0, 0)

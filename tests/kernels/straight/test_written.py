"""Equations written out for their scene against the same with loops, to the bit, for every kind of crane."""

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from samples.lane_calls import call_in_lanes
from samples.straight import found, made

from modal.compiler.folder import CacheWarning
from towercrane.cases.case import load_case
from towercrane.cases.models import model_of, motions_of
from towercrane.kernels.arrays import lane_rhs_signature
from towercrane.kernels.vector import LANES
from towercrane.motions.motion import phases
from towercrane.simulation import system as systems
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
    state = model.start(inputs, "zero", 0.0)
    state = state + 0.05 * rng.normal(size=state.size)
    for first, rate, axes in model.system.directions:
        direction, turning = rng.normal(size=(2, axes))
        direction /= np.linalg.norm(direction)
        state[first : first + axes] = direction
        state[rate : rate + axes] = turning - turning @ direction * direction
    return rng.uniform(0.0, 3.0), state


@pytest.mark.parametrize("about", CASES)
def test_written_out_equations_have_the_bits_of_those_with_loops(about):
    model, inputs = scene(*CASES[about])
    looped = replace(model.system, known=None)
    rng = np.random.default_rng(11)
    for _ in range(40):
        time, state = drawn(model, inputs, rng)
        written, wanted = (system.slope(time, state, inputs) for system in (model.system, looped))
        assert all(map(np.array_equal, written, wanted))


@pytest.mark.parametrize("about", ["gusts", "a drive", "an elastic rope", "joints that are driven"])
def test_lanes_of_every_kind_have_the_bits_of_single_states(about):
    model, inputs = scene(*CASES[about])
    system, rng = model.system, np.random.default_rng(12)
    own = written_of([system], inputs.shape)
    draws = [drawn(model, inputs, rng) for _ in range(LANES)]
    times = np.array([[time for time, _ in draws]])
    states = np.stack([state for _, state in draws], axis=-1)
    slopes, guards = np.empty((system.size, LANES)), np.empty((len(system.guards), LANES))
    shared = [np.repeat(array[..., None], LANES, axis=-1) for array in (inputs, own.numbers(system.data))]
    rhs = own.rhs(lane_rhs_signature(), LANES)
    call_in_lanes(rhs, times, states, slopes, shared[0], shared[1], system.tables, guards)
    for lane, (time, state) in enumerate(draws):
        slope, margins = system.slope(time, state, inputs)
        assert np.array_equal(slopes[:, lane], slope)
        assert np.array_equal(guards[:, lane], margins)


def test_what_a_switch_changes_is_not_worked_out_beforehand():
    model, inputs = scene(*CASES["friction that sticks"])
    system = model.system
    rhs, (numbers, *others) = system.code(inputs)
    rng, none = np.random.default_rng(13), np.zeros(system.work_shape)
    time, state = drawn(model, inputs, rng)
    (place,) = system.known.changing
    slopes = {}
    for value in (-1.0, 0.0, 1.0, 2.0):
        changed, slope, guards = numbers.copy(), np.empty(system.size), np.empty(len(system.guards))
        changed[place] = value
        rhs(time, state, slope, inputs, changed, *others, none, guards)
        own = replace(system, known=None, numbers=changed[: len(system.numbers)])
        assert np.array_equal(slope, own.slope(time, state, inputs)[0])
        slopes[value] = slope.tobytes()
    assert len(set(slopes.values())) == 3


def test_large_systems_keep_their_loops(monkeypatch):
    model, inputs = scene(*CASES["a crane in the plane"])
    monkeypatch.setattr(systems, "MOST_WRITTEN", model.size - 1)
    rhs, constants = replace(model.system).code(inputs)
    assert rhs is model.system.equations()
    assert constants == model.system.constants
    monkeypatch.setattr(systems, "MOST_WRITTEN", model.size)
    assert replace(model.system).code(inputs)[0] is not rhs


def test_code_is_kept_by_its_content(tmp_path, monkeypatch):
    assert found(made(2.0, tmp_path, monkeypatch)) == (2.0, 0)
    assert found(made(3.0, tmp_path, monkeypatch)) == (3.0, 0)
    assert found(made(2.0, tmp_path, monkeypatch)) == (2.0, 1)
    for kept in tmp_path.rglob("*.nbc"):
        kept.write_bytes(kept.read_bytes()[:-1] + b"x")
    with pytest.warns(CacheWarning, match="damaged machine code"):
        assert found(made(3.0, tmp_path, monkeypatch)) == (3.0, 0)
    assert found(made(3.0, tmp_path, monkeypatch)) == (3.0, 1)


def test_code_from_the_cache_is_not_taken_for_code_that_was_compiled_here(tmp_path):
    """Numba counts what a process compiles: what is third in two processes must not share a name."""
    run = (
        "import sys; sys.path.insert(0, sys.argv[1])\n"
        "from pathlib import Path; import pytest; from samples.straight import found, made\n"
        "with pytest.MonkeyPatch.context() as patch:\n"
        "    codes = [made(float(c), Path(sys.argv[2]), patch) for c in sys.argv[3:]]\n"
        "print(*map(found, codes))"
    )

    def process(*coefficients):
        tests = str(Path(__file__).parents[2])
        command = [sys.executable, "-c", run, tests, str(tmp_path), *coefficients]
        environment = dict(os.environ, PYTHONPATH=os.pathsep.join(sys.path))
        return subprocess.run(command, capture_output=True, text=True, check=True, env=environment).stdout.strip()

    assert process("2") == "(2.0, 0)"
    assert process("3", "2") == "(3.0, 0) (2.0, 1)"

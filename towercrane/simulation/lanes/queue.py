"""Runs that wait for a lane, runs under way, and what has become of them.

Arrays of runs have the run as their first axis, arrays of lanes the lane as their last.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from modal.compiler.kinds import Row, Stack, Stacks, Table, Whole, WholeRow
from modal.compiler.lanes import LANES
from towercrane.simulation.methods.step_size import FREELY

RUN, PHASE, SAMPLE, SAMPLES_END, FRESH, SUSPECT, CROSSED, RETAKEN, ASKS = range(9)
"""Rows of a lane's places: run (-1: idle), phase, next sample, first sample of the next phase, whether the slope at
the start is wanted, whether a guard has been near its floor, the guard that fell (-1: none), how often its step has
been taken anew, and what it asks of Python."""

NOTHING, BEGINS, CROSSES = range(3)
"""What a lane asks: nothing, or what holds at the start of its phase or after a guard."""

BEGIN, END, TIME, STEP, LONGEST, GROWTH, TRIAL, ACCEPTED_STEP, STOP, FRACTION, MOMENT, LOW, HIGH, FULL = range(14)
"""Rows of a lane's clock: start of the phase, its length, time since it began, next step, longest step allowed,
power by which steps grow, step that is tried, 1 where it was accepted, time it reaches, and for a look inside the
step its fraction, its time and the bracket of a guard's fall; and the longest step that is taken anew."""

ACCEPTED, REJECTED, EVALUATIONS, WRITTEN = range(4)
"""Columns of a run's counts."""

WAITING, NO_START, FINISHED, COLLAPSED, NOT_FINITE, OFF_BALANCE, STALLED, FIRST_GUARD = range(8)
"""Codes of outcomes; NO_START is for runs that never came to a lane, OFF_BALANCE is found
afterwards, those from FIRST_GUARD on are the guards'."""

LARGEST, LARGEST_TIME, SMALLEST, SMALLEST_TIME = range(4)
"""Columns of an output's extremes."""


class Queue(NamedTuple):
    """Runs that wait for a lane; the first axis counts the runs.

    Parameters
    ----------
    waiting : ndarray of int, shape (up to runs,)
        The runs to take, in this order.
    starts, atol : ndarray, shapes (runs, size)
    longest_steps : ndarray, shape (runs,)
    numbers, seen : ndarray, shape (runs, ...)
        Numbers of each run's equations and of its outputs, and behind them what follows from its constants.
    floors : ndarray, shape (runs, guards)
    phase_counts : ndarray of int, shape (runs,)
    phase_times : ndarray, shape (runs, phases + 1)
    inputs : ndarray, shape (runs, phases, channels, k)
    first_samples : ndarray of int, shape (runs, phases + 1)
        First sample of each phase.
    sample_times : ndarray, shape (samples,)
    tables : ndarray, shape (cells, modes, powers)
        The same for all runs, as are
    directions : ndarray of int, shape (count, 3)
    asks : int
        Whether Python says what holds at the start of a phase and after a guard.
    retakes : int
        How often a step that ends at a guard is taken anew.
    """

    waiting: WholeRow
    starts: Table
    atol: Table
    longest_steps: Row
    numbers: Table
    seen: Table
    floors: Table
    phase_counts: WholeRow
    phase_times: Table
    inputs: Stacks
    first_samples: Whole
    sample_times: Row
    tables: Stack
    directions: Whole
    asks: int
    retakes: int


class Answers(NamedTuple):
    """What the runs have come to.

    Parameters
    ----------
    outcomes : ndarray of int, shape (runs,)
    end_times, smallest_steps : ndarray, shape (runs,)
    end_states : ndarray, shape (runs, size)
    counts : ndarray of int, shape (runs, 4)
    extremes : ndarray, shape (runs, outputs, 4)
    series : ndarray, shape (runs or 0, samples, outputs)
    """

    outcomes: WholeRow
    end_times: Row
    smallest_steps: Row
    end_states: Table
    counts: Whole
    extremes: Stack
    series: Stack


class Lanes(NamedTuple):
    """Runs under way, and scratch.

    Parameters
    ----------
    next_run : ndarray of int, shape (1,)
        Place in ``waiting`` of the first run that no lane has taken.
    places : ndarray of int, shape (9, lanes)
    clock : ndarray, shape (14, lanes)
    y, new, trial, slope, atol : ndarray, shape (size, lanes)
    k : ndarray, shape (m, size, lanes)
    guards, lowest, highest, floors : ndarray, shape (guards, lanes)
    inputs, numbers, seen : ndarray, shapes (..., lanes)
        Of the run in each lane.
    norms : ndarray, shape (2, lanes)
    outputs : ndarray, shape (outputs, lanes)
    column : ndarray, shape (3, size)
        Of one lane: state, slope, tolerance.
    """

    next_run: WholeRow
    places: Whole
    clock: Table
    y: Table
    new: Table
    trial: Table
    slope: Table
    atol: Table
    k: Stack
    guards: Table
    lowest: Table
    highest: Table
    floors: Table
    inputs: Stack
    numbers: Table
    seen: Table
    norms: Table
    outputs: Table
    column: Table


def lanes_for(queue: Queue, stages: int, outputs: int) -> Lanes:
    """Idle lanes for the runs of a queue."""
    size, guards = queue.starts.shape[1], queue.floors.shape[1]

    def lanes(*shape: int) -> Any:
        return np.zeros((*shape, LANES))

    places = np.zeros((9, LANES), dtype=np.int64)
    places[RUN] = -1
    return Lanes(
        next_run=np.zeros(1, dtype=np.int64),
        places=places,
        clock=lanes(14),
        y=lanes(size),
        new=lanes(size),
        trial=lanes(size),
        slope=lanes(size),
        atol=lanes(size),
        k=lanes(stages, size),
        guards=lanes(guards),
        lowest=lanes(guards),
        highest=lanes(guards),
        floors=lanes(guards),
        # Before its first run a lane computes with ones: zeros would divide by zero.
        inputs=lanes(*queue.inputs.shape[2:]) + 1.0,
        numbers=lanes(queue.numbers.shape[1]) + 1.0,
        seen=lanes(queue.seen.shape[1]) + 1.0,
        norms=lanes(2),
        outputs=lanes(outputs),
        column=np.zeros((3, size)),
    )


def fill(queue: Queue, lanes: Lanes, lane: int) -> None:
    """Put the queue's next run into a lane."""
    run = queue.waiting[lanes.next_run[0]]
    lanes.next_run[0] += 1
    lanes.places[RUN, lane] = run
    lanes.places[PHASE, lane] = 0
    lanes.clock[STEP, lane] = 0.0
    lanes.clock[GROWTH, lane] = FREELY
    lanes.clock[LONGEST, lane] = queue.longest_steps[run]
    for m in range(lanes.y.shape[0]):
        lanes.y[m, lane] = queue.starts[run, m]
        lanes.atol[m, lane] = queue.atol[run, m]
    for i in range(lanes.numbers.shape[0]):
        lanes.numbers[i, lane] = queue.numbers[run, i]
    for g in range(lanes.floors.shape[0]):
        lanes.floors[g, lane] = queue.floors[run, g]
    for i in range(lanes.seen.shape[0]):
        lanes.seen[i, lane] = queue.seen[run, i]


def begin_phase(queue: Queue, lanes: Lanes, lane: int) -> None:
    """Let a lane's run enter its phase."""
    run, phase = lanes.places[RUN, lane], lanes.places[PHASE, lane]
    begin = queue.phase_times[run, phase]
    lanes.clock[BEGIN, lane] = begin
    lanes.clock[END, lane] = queue.phase_times[run, phase + 1] - begin
    lanes.clock[TIME, lane] = 0.0
    lanes.places[SAMPLE, lane] = queue.first_samples[run, phase]
    lanes.places[SAMPLES_END, lane] = queue.first_samples[run, phase + 1]
    lanes.places[FRESH, lane] = 1
    lanes.places[RETAKEN, lane], lanes.clock[FULL, lane] = 0, 0.0
    lanes.places[ASKS, lane] = BEGINS if queue.asks else NOTHING
    for channel in range(lanes.inputs.shape[0]):
        for c in range(lanes.inputs.shape[1]):
            lanes.inputs[channel, c, lane] = queue.inputs[run, phase, channel, c]


def pause(lanes: Lanes, lane: int) -> None:
    """Let a lane ask what holds after the guard that fell; it then goes on as at the start of a phase."""
    lanes.places[ASKS, lane] = CROSSES
    lanes.places[FRESH, lane] = 1
    lanes.clock[STEP, lane] = max(lanes.clock[TRIAL, lane], lanes.clock[FULL, lane])


def end_run(answers: Answers, lanes: Lanes, lane: int, outcome: int) -> None:
    """Write down how a lane's run ended, and leave the lane idle."""
    run = lanes.places[RUN, lane]
    answers.outcomes[run] = outcome
    answers.end_times[run] = lanes.clock[BEGIN, lane] + lanes.clock[TIME, lane]
    for m in range(lanes.y.shape[0]):
        answers.end_states[run, m] = lanes.y[m, lane]
    lanes.places[RUN, lane] = -1

"""Compiled steps of many runs side by side: what every crane shares.

The lanes take the steps that :func:`towercrane.stepper.advance` takes for one run, each lane with its own time, step,
phase and outcome; a lane whose run has ended takes the next of the queue. Arrays have the lane as their last axis.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from modal.compiled import kernel
from towercrane.lane_vector import LANES
from towercrane.payload import restore
from towercrane.stepper import GROW, SAFETY, SHRINK, _first_step

RUN, PHASE, SAMPLE, SAMPLES_END, FRESH, SUSPECT, CROSSED = range(7)
"""Rows of a lane's places: run (-1: idle), phase, next sample, first sample of the next phase, whether the slope at
the start is wanted, whether a stage has seen a guard fall, and the guard that fell (-1: none)."""

BEGIN, END, TIME, STEP, GROWTH, TRIAL, ACCEPTED_STEP, STOP, FRACTION, MOMENT, LOW, HIGH = range(12)
"""Rows of a lane's clock: start of the phase, its length, time since it began, next step, largest growth, step that
is tried, 1 where it was accepted, time it reaches, and for a look inside the step its fraction, its time and the
bracket of a guard's fall."""

ACCEPTED, REJECTED, EVALUATIONS, WRITTEN = range(4)
"""Columns of a run's counts."""

WAITING, NO_START, FINISHED, COLLAPSED, NOT_FINITE, FIRST_GUARD = range(6)
"""Codes of outcomes; NO_START is for runs that never came to a lane, those from FIRST_GUARD on are the guards'."""

LARGEST, LARGEST_TIME, SMALLEST, SMALLEST_TIME = range(4)
"""Columns of an output's extremes."""


class Queue(NamedTuple):
    """Runs that wait for a lane; the first axis counts the runs.

    Parameters
    ----------
    waiting : ndarray of int, shape (up to runs,)
        The runs to take, in this order.
    starts, atol : ndarray, shapes (runs, size)
    numbers, vectors, matrices : ndarray, shapes (runs, ...)
        Constants of each run, as its system has them.
    floors : ndarray, shape (runs, guards)
    watched : ndarray, shape (runs, linear outputs, coordinates)
        Outputs that are linear in the coordinates.
    phase_counts : ndarray of int, shape (runs,)
    phase_times : ndarray, shape (runs, phases + 1)
    inputs : ndarray, shape (runs, phases, channels, k)
    first_samples : ndarray of int, shape (runs, phases + 1)
        First sample of each phase.
    sample_times : ndarray, shape (samples,)
    tables : ndarray, shape (cells, modes, powers)
        The same for all runs.
    """

    waiting: Any
    starts: Any
    atol: Any
    numbers: Any
    vectors: Any
    matrices: Any
    floors: Any
    watched: Any
    phase_counts: Any
    phase_times: Any
    inputs: Any
    first_samples: Any
    sample_times: Any
    tables: Any


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

    outcomes: Any
    end_times: Any
    smallest_steps: Any
    end_states: Any
    counts: Any
    extremes: Any
    series: Any


class Lanes(NamedTuple):
    """Runs under way, and scratch.

    Parameters
    ----------
    next_run : ndarray of int, shape (1,)
        Place in ``waiting`` of the first run that no lane has taken.
    places : ndarray of int, shape (7, lanes)
    clock : ndarray, shape (12, lanes)
    y, new, trial, slope, atol : ndarray, shape (size, lanes)
    k : ndarray, shape (m, size, lanes)
    guards, lowest, floors : ndarray, shape (guards, lanes)
    inputs, numbers, vectors, matrices, watched : ndarray, shapes (..., lanes)
        Of the run in each lane.
    work : ndarray, shape (rows, columns, lanes)
    norms : ndarray, shape (2, lanes)
    outputs : ndarray, shape (outputs, lanes)
    """

    next_run: Any
    places: Any
    clock: Any
    y: Any
    new: Any
    trial: Any
    slope: Any
    atol: Any
    k: Any
    guards: Any
    lowest: Any
    floors: Any
    inputs: Any
    numbers: Any
    vectors: Any
    matrices: Any
    watched: Any
    work: Any
    norms: Any
    outputs: Any


def lanes_for(queue: Queue, stages: int, work_shape: tuple[int, int], outputs: int) -> Lanes:
    """Idle lanes for the runs of a queue."""
    size, guards = queue.starts.shape[1], queue.floors.shape[1]

    def lanes(*shape: int) -> Any:
        return np.zeros((*shape, LANES))

    places = np.zeros((7, LANES), dtype=np.int64)
    places[RUN] = -1
    return Lanes(
        next_run=np.zeros(1, dtype=np.int64),
        places=places,
        clock=lanes(12),
        y=lanes(size),
        new=lanes(size),
        trial=lanes(size),
        slope=lanes(size),
        atol=lanes(size),
        k=lanes(stages, size),
        guards=lanes(guards),
        lowest=lanes(guards),
        floors=lanes(guards),
        # Before its first run a lane computes with ones: zeros would divide by zero.
        inputs=lanes(*queue.inputs.shape[2:]) + 1.0,
        numbers=lanes(queue.numbers.shape[1]) + 1.0,
        vectors=lanes(*queue.vectors.shape[1:]),
        matrices=lanes(*queue.matrices.shape[1:]),
        watched=lanes(*queue.watched.shape[1:]),
        work=lanes(*work_shape),
        norms=lanes(2),
        outputs=lanes(outputs),
    )


@kernel()
def fill(queue: Any, lanes: Any, lane: int) -> None:
    """Put the queue's next run into a lane."""
    run = queue.waiting[lanes.next_run[0]]
    lanes.next_run[0] += 1
    lanes.places[RUN, lane] = run
    lanes.places[PHASE, lane] = 0
    lanes.clock[STEP, lane] = 0.0
    for m in range(lanes.y.shape[0]):
        lanes.y[m, lane] = queue.starts[run, m]
        lanes.atol[m, lane] = queue.atol[run, m]
    for i in range(lanes.numbers.shape[0]):
        lanes.numbers[i, lane] = queue.numbers[run, i]
    for g in range(lanes.floors.shape[0]):
        lanes.floors[g, lane] = queue.floors[run, g]
    for j in range(lanes.vectors.shape[1]):
        for i in range(lanes.vectors.shape[0]):
            lanes.vectors[i, j, lane] = queue.vectors[run, i, j]
        for i in range(lanes.watched.shape[0]):
            lanes.watched[i, j, lane] = queue.watched[run, i, j]
        for b in range(lanes.matrices.shape[0]):
            for i in range(lanes.matrices.shape[1]):
                lanes.matrices[b, i, j, lane] = queue.matrices[run, b, i, j]


@kernel()
def begin_phase(queue: Any, lanes: Any, lane: int, coordinates: int, axes: int) -> None:
    """Let a lane's run enter its phase, the state back on its constraints."""
    run, phase = lanes.places[RUN, lane], lanes.places[PHASE, lane]
    begin = queue.phase_times[run, phase]
    lanes.clock[BEGIN, lane] = begin
    lanes.clock[END, lane] = queue.phase_times[run, phase + 1] - begin
    lanes.clock[TIME, lane] = 0.0
    lanes.clock[GROWTH, lane] = GROW
    lanes.places[SAMPLE, lane] = queue.first_samples[run, phase]
    lanes.places[SAMPLES_END, lane] = queue.first_samples[run, phase + 1]
    lanes.places[FRESH, lane] = 1
    for channel in range(lanes.inputs.shape[0]):
        for c in range(lanes.inputs.shape[1]):
            lanes.inputs[channel, c, lane] = queue.inputs[run, phase, channel, c]
    restore(lanes.y[:, lane], coordinates, axes)


@kernel()
def end_run(answers: Any, lanes: Any, lane: int, outcome: int) -> None:
    """Write down how a lane's run ended, and leave the lane idle."""
    run = lanes.places[RUN, lane]
    answers.outcomes[run] = outcome
    answers.end_times[run] = lanes.clock[BEGIN, lane] + lanes.clock[TIME, lane]
    for m in range(lanes.y.shape[0]):
        answers.end_states[run, m] = lanes.y[m, lane]
    lanes.places[RUN, lane] = -1


@kernel()
def shortest(length: float) -> float:
    """Step below which a phase of that length is given up."""
    return 16.0 * np.finfo(np.float64).eps * length


@kernel()
def is_last(clock: Any, lane: int) -> bool:
    """Whether a lane's step ends its phase."""
    end = clock[END, lane]
    return bool(clock[TIME, lane] + clock[STEP, lane] >= end - shortest(end))


@kernel()
def choose_steps(places: Any, clock: Any) -> bool:
    """Step that each lane tries next, none where it is idle; whether some lane's step has collapsed."""
    collapsed = False
    for lane in range(LANES):
        clock[TRIAL, lane] = 0.0
        if places[RUN, lane] >= 0:
            if clock[STEP, lane] < shortest(clock[END, lane]):
                collapsed = True
            elif is_last(clock, lane):
                clock[TRIAL, lane] = clock[END, lane] - clock[TIME, lane]
            else:
                clock[TRIAL, lane] = clock[STEP, lane]
    return collapsed


@kernel()
def error_parts(error: Any, k: Any, y: Any, new: Any, rtol: float, atol: Any, unused: Any, norms: Any) -> None:
    """Sums of squares of the two error estimates in every lane, as in :func:`towercrane.stepper.advance`.

    ``k``, ``y``, ``new``, ``atol`` and ``norms`` hold lane vectors; ``unused`` is true where a state steers no step.
    """
    rows, stages = error.shape
    norms[0] = 0.0
    norms[1] = 0.0
    for m in range(y.size):
        if unused[m]:
            continue
        scale = atol[m] + rtol * max(abs(y[m]), abs(new[m]))
        for row in range(rows):
            estimate = k[0, m] * 0.0
            for i in range(stages):
                weight = error[row, i]
                if weight != 0.0:
                    estimate += weight * k[i, m]
            ratio = estimate / scale
            norms[row] += ratio * ratio


@kernel()
def judge_steps(
    places: Any, clock: Any, norms: Any, lowest: Any, floors: Any, counts: Any, smallest_steps: Any,
    sample_times: Any, stages: int, rows: int, error_order: int, active: int,
) -> int:  # fmt: skip
    """Accept or reject each lane's step; the lanes that want to look inside it, as bits."""
    looking = 0
    for lane in range(LANES):
        clock[ACCEPTED_STEP, lane] = 0.0
        run, step = places[RUN, lane], clock[TRIAL, lane]
        if run < 0:
            continue
        first, second = norms[0, lane], norms[1, lane]
        norm = 0.0
        if first != 0.0:
            if rows == 2:
                norm = step * first / np.sqrt((first + 0.01 * second) * active)
            else:
                norm = step * np.sqrt(first / active)
        counts[run, EVALUATIONS] += stages
        if not norm <= 1.0:
            counts[run, REJECTED] += 1
            factor = SAFETY * norm ** (-1.0 / (error_order + 1)) if np.isfinite(norm) else SHRINK
            clock[STEP, lane] = step * max(SHRINK, factor)
            clock[GROWTH, lane] = 1.0
            continue
        counts[run, ACCEPTED] += 1
        smallest_steps[run] = min(smallest_steps[run], step)
        clock[ACCEPTED_STEP, lane] = 1.0
        factor = GROW if norm == 0.0 else SAFETY * norm ** (-1.0 / (error_order + 1))
        growth = clock[GROWTH, lane]
        # The cut last step of a phase says nothing about the next one's length.
        if is_last(clock, lane):
            clock[STOP, lane] = clock[END, lane]
            clock[STEP, lane] = max(clock[STEP, lane], step * min(growth, factor))
        else:
            clock[STOP, lane] = clock[TIME, lane] + step
            clock[STEP, lane] = step * min(growth, max(SHRINK, factor))
        clock[GROWTH, lane] = GROW
        clock[LOW, lane], clock[HIGH, lane], places[CROSSED, lane] = 0.0, 0.0, -1
        places[SUSPECT, lane] = fallen(lowest, floors, lane) >= 0
        if places[SUSPECT, lane] or wants_sample(places, clock, sample_times, lane):
            looking |= 1 << lane
    return looking


@kernel()
def fallen(guards: Any, floors: Any, lane: int) -> int:
    """Index of a lane's first guard below its floor, or -1."""
    for g in range(guards.shape[0]):
        if guards[g, lane] < floors[g, lane]:
            return g
    return -1


@kernel()
def wants_sample(places: Any, clock: Any, sample_times: Any, lane: int) -> bool:
    """Whether a lane's accepted step reaches its next sample; if so, where in the step that is."""
    clock[FRACTION, lane] = 0.0
    sample = places[SAMPLE, lane]
    if clock[ACCEPTED_STEP, lane] == 0.0 or sample >= places[SAMPLES_END, lane]:
        return False
    moment = min(sample_times[sample] - clock[BEGIN, lane], clock[END, lane])
    if moment > clock[STOP, lane]:
        return False
    clock[FRACTION, lane] = (moment - clock[TIME, lane]) / clock[TRIAL, lane]
    clock[MOMENT, lane] = moment
    return True


@kernel()
def wanted_samples(places: Any, clock: Any, sample_times: Any) -> int:
    """Lanes whose steps reach another sample, as bits."""
    wanted = 0
    for lane in range(LANES):
        if wants_sample(places, clock, sample_times, lane):
            wanted |= 1 << lane
    return wanted


@kernel()
def record(
    lane_values: Any, wanted: int, places: Any, counts: Any, sample_times: Any, extremes: Any, series: Any
) -> None:
    """Keep the wanted lanes' outputs where they are extremes of their runs so far; go to the next samples.

    ``lane_values`` has a row per output.
    """
    for lane in range(LANES):
        if not wanted >> lane & 1:
            continue
        run, sample = places[RUN, lane], places[SAMPLE, lane]
        places[SAMPLE, lane] += 1
        counts[run, WRITTEN] += 1
        time = sample_times[sample]
        for output in range(extremes.shape[1]):
            value = lane_values[output, lane]
            if value > extremes[run, output, LARGEST]:
                extremes[run, output, LARGEST] = value
                extremes[run, output, LARGEST_TIME] = time
            if value < extremes[run, output, SMALLEST]:
                extremes[run, output, SMALLEST] = value
                extremes[run, output, SMALLEST_TIME] = time
            if series.shape[0]:
                series[run, sample, output] = value


@kernel()
def dense_states(y: Any, dense: Any, k: Any, h: Any, x: Any, out: Any) -> None:
    """State of every lane at its own fraction x of its step h; all of lane vectors but ``dense``."""
    for m in range(y.size):
        out[m] = 0.0
    for i in range(dense.shape[0]):
        used = False
        for d in range(dense.shape[1]):
            used = used or dense[i, d] != 0.0
        if used:
            weight = x * 0.0
            for d in range(dense.shape[1] - 1, -1, -1):
                weight = (weight + dense[i, d]) * x
            for m in range(y.size):
                out[m] += weight * k[i, m]
    for m in range(y.size):
        out[m] = y[m] + h * out[m]


@kernel()
def look_for_falls(places: Any, clock: Any, looks: int) -> int:
    """Lanes that have to look once more for the guard that a stage has seen fall, as bits, and where in their steps.

    The bracket is empty before the first look. It moves along the step, and is halved once a guard has fallen at
    its upper end.
    """
    looking = 0
    for lane in range(LANES):
        clock[FRACTION, lane] = 0.0
        if clock[ACCEPTED_STEP, lane] == 0.0 or not places[SUSPECT, lane]:
            continue
        if places[CROSSED, lane] < 0:
            part = round(clock[HIGH, lane] * looks) + 1
            if part > looks:
                continue
            clock[FRACTION, lane] = part / looks
        elif clock[HIGH, lane] - clock[LOW, lane] > 1e-12:
            clock[FRACTION, lane] = 0.5 * (clock[LOW, lane] + clock[HIGH, lane])
        else:
            continue
        clock[MOMENT, lane] = clock[TIME, lane] + clock[FRACTION, lane] * clock[TRIAL, lane]
        looking |= 1 << lane
    return looking


@kernel()
def note_looks(looking: int, places: Any, clock: Any, guards: Any, floors: Any, looks: int) -> None:
    """Narrow or move the brackets of the looking lanes by what their guards were."""
    for lane in range(LANES):
        if not looking >> lane & 1:
            continue
        guard, at = fallen(guards, floors, lane), clock[FRACTION, lane]
        if guard >= 0:
            if places[CROSSED, lane] < 0:
                clock[LOW, lane] = (round(at * looks) - 1.0) / looks
            clock[HIGH, lane] = at
            places[CROSSED, lane] = guard
        elif places[CROSSED, lane] < 0:
            clock[HIGH, lane] = at
        else:
            clock[LOW, lane] = at


@kernel()
def cut_steps(places: Any, clock: Any, states: Any, new: Any) -> None:
    """Let the steps in which a guard fell end there, in these states."""
    for lane in range(LANES):
        if clock[ACCEPTED_STEP, lane] and places[CROSSED, lane] >= 0:
            clock[STOP, lane] = clock[TIME, lane] + clock[HIGH, lane] * clock[TRIAL, lane]
            for m in range(new.shape[0]):
                new[m, lane] = states[m, lane]


@kernel()
def move_on(places: Any, clock: Any) -> bool:
    """Advance the lanes' times by their accepted steps; whether some lane's phase or run has ended."""
    ended = False
    for lane in range(LANES):
        if clock[ACCEPTED_STEP, lane]:
            clock[TIME, lane] = clock[STOP, lane]
            ended = ended or places[CROSSED, lane] >= 0 or clock[TIME, lane] >= clock[END, lane]
    return ended


@kernel()
def wants_entry(places: Any, waiting: int) -> bool:
    """Whether some lane is idle while runs wait, or stands at the start of a phase."""
    found = False
    for lane in range(LANES):
        found = found or (waiting > 0 and places[RUN, lane] < 0) or places[FRESH, lane] != 0
    return found


@kernel()
def count(these: int, places: Any, counts: Any, evaluations: int) -> None:
    """Add evaluations to these lanes' runs."""
    for lane in range(LANES):
        if these >> lane & 1:
            counts[places[RUN, lane], EVALUATIONS] += evaluations


@kernel()
def enter_phase(answers: Any, lanes: Any, lane: int, rtol: float) -> None:
    """Take a lane's slope as that at the start of its phase, unless the run ends there."""
    lanes.places[FRESH, lane] = 0
    answers.counts[lanes.places[RUN, lane], EVALUATIONS] += 1
    finite = True
    for m in range(lanes.y.shape[0]):
        lanes.k[0, m, lane] = lanes.slope[m, lane]
        finite = finite and np.isfinite(lanes.slope[m, lane])
    guard = fallen(lanes.guards, lanes.floors, lane)
    if not finite:
        end_run(answers, lanes, lane, NOT_FINITE)
    elif guard >= 0:
        end_run(answers, lanes, lane, FIRST_GUARD + guard)
    elif lanes.clock[STEP, lane] <= 0.0:
        lanes.clock[STEP, lane] = _first_step(
            lanes.y[:, lane], lanes.slope[:, lane], rtol, lanes.atol[:, lane], lanes.clock[END, lane]
        )

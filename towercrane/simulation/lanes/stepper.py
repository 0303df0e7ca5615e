"""Compiled steps of many runs side by side: what every crane shares.

The lanes take the steps that :func:`towercrane.simulation.stepper.advance` takes for one run, each lane with its own
time, step, phase and outcome.
"""

from __future__ import annotations

import numpy as np

from modal.compiler.kinds import LaneRow, LaneTable, Number, Row, Table, Whole
from modal.compiler.lanes import LANES
from towercrane.simulation.guards import NEAR
from towercrane.simulation.lanes.dense_output import fallen, near, wants_sample
from towercrane.simulation.lanes.queue import (
    ACCEPTED,
    ACCEPTED_STEP,
    ASKS,
    CROSSED,
    END,
    EVALUATIONS,
    FIRST_GUARD,
    FRESH,
    FULL,
    GROWTH,
    HIGH,
    LONGEST,
    LOW,
    NOT_FINITE,
    NOTHING,
    REJECTED,
    RETAKEN,
    RUN,
    STEP,
    STOP,
    SUSPECT,
    TIME,
    TRIAL,
    Answers,
    Lanes,
    end_run,
)
from towercrane.simulation.methods.step_size import SHORTEST, SLOWLY, first_step, step_factor


def shortest(length: float) -> float:
    """Step below which a phase of that length is given up."""
    return SHORTEST * length


def is_last(clock: Table, lane: int) -> bool:
    """Whether a lane's step ends its phase."""
    end = clock[END, lane]
    return bool(clock[TIME, lane] + clock[STEP, lane] >= end - shortest(end))


def choose_steps(places: Whole, clock: Table) -> bool:
    """Step that each lane tries next, none where it is idle; whether some lane's step has collapsed."""
    collapsed = False
    for lane in range(LANES):
        clock[TRIAL, lane] = 0.0
        if places[RUN, lane] >= 0:
            clock[STEP, lane] = min(clock[STEP, lane], clock[LONGEST, lane])
            if clock[STEP, lane] < shortest(clock[END, lane]):
                collapsed = True
            elif is_last(clock, lane):
                clock[TRIAL, lane] = clock[END, lane] - clock[TIME, lane]
            else:
                clock[TRIAL, lane] = clock[STEP, lane]
    return collapsed


def error_parts(
    error: Table, k: LaneTable, y: LaneRow, new: LaneRow, rtol: float, atol: LaneRow, limits: Row, norms: LaneRow
) -> None:
    """Sums of squares of the two error estimates in every lane, as in :func:`towercrane.simulation.stepper.advance`.

    ``k``, ``y``, ``new``, ``atol`` and ``norms`` hold lane vectors; ``limits`` is infinite where a state steers none.
    """
    rows, stages = error.shape
    norms[0] = 0.0
    norms[1] = 0.0
    for m in range(y.size):
        if np.isinf(limits[m]):
            continue
        scale = atol[m] + rtol * max(abs(y[m]), abs(new[m]))
        for row in range(rows):
            estimate: Number = 0.0
            for i in range(stages):
                weight = error[row, i]
                if weight != 0.0:
                    estimate += weight * k[i, m]
            ratio = estimate / scale
            norms[row] += ratio * ratio


def judge_steps(
    places: Whole, clock: Table, norms: Table, lowest: Table, highest: Table, floors: Table, counts: Whole,
    smallest_steps: Row, sample_times: Row, stages: int, rows: int, error_order: int, active: int,
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
            clock[STEP, lane] = step * step_factor(norm, error_order, clock[GROWTH, lane])
            clock[GROWTH, lane] = SLOWLY
            continue
        counts[run, ACCEPTED] += 1
        smallest_steps[run] = min(smallest_steps[run], step)
        clock[ACCEPTED_STEP, lane] = 1.0
        grown = step * step_factor(norm, error_order, clock[GROWTH, lane])
        # The cut last step of a phase says nothing about the next one's length.
        if is_last(clock, lane):
            clock[STOP, lane] = clock[END, lane]
            clock[STEP, lane] = max(clock[STEP, lane], grown)
        else:
            clock[STOP, lane] = clock[TIME, lane] + step
            clock[STEP, lane] = grown
        clock[LOW, lane], clock[HIGH, lane], places[CROSSED, lane] = 0.0, 0.0, -1
        places[SUSPECT, lane] = near(lowest, highest, floors, NEAR, lane)
        if places[SUSPECT, lane] or wants_sample(places, clock, sample_times, lane):
            looking |= 1 << lane
    return looking


def move_on(places: Whole, clock: Table) -> bool:
    """Advance the lanes' times by their accepted steps; whether some lane's phase or run has ended."""
    ended = False
    for lane in range(LANES):
        if clock[ACCEPTED_STEP, lane]:
            if places[CROSSED, lane] < 0:
                clock[FULL, lane], places[RETAKEN, lane] = 0.0, 0
            clock[TIME, lane] = clock[STOP, lane]
            ended = ended or places[CROSSED, lane] >= 0 or clock[TIME, lane] >= clock[END, lane]
    return ended


def wants_entry(places: Whole, waiting: int) -> bool:
    """Whether some lane is idle while runs wait, or stands at the start of a phase."""
    found = False
    for lane in range(LANES):
        found = found or (waiting > 0 and places[RUN, lane] < 0) or places[FRESH, lane] != 0
    return found


def asks(places: Whole) -> bool:
    """Whether some lane asks what holds for it."""
    found = False
    for lane in range(LANES):
        found = found or (places[RUN, lane] >= 0 and places[ASKS, lane] != NOTHING)
    return found


def count(these: int, places: Whole, counts: Whole, evaluations: int) -> None:
    """Add evaluations to these lanes' runs."""
    for lane in range(LANES):
        if these >> lane & 1:
            counts[places[RUN, lane], EVALUATIONS] += evaluations


def enter_phase(answers: Answers, lanes: Lanes, lane: int, rtol: float) -> None:
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
        state, slope, atol = lanes.column[0], lanes.column[1], lanes.column[2]
        for m in range(state.size):
            state[m], slope[m], atol[m] = lanes.y[m, lane], lanes.slope[m, lane], lanes.atol[m, lane]
        lanes.clock[STEP, lane] = first_step(state, slope, rtol, atol, lanes.clock[END, lane])

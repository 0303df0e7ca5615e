"""Compiled steps of many runs side by side: what every crane shares.

The lanes take the steps that :func:`towercrane.simulation.stepper.advance` takes for one run, each lane with its own
time, step, phase and outcome.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from modal.compiler.compiled import kernel
from towercrane.kernels.vector import LANES
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
    end_run,
)
from towercrane.simulation.methods.step_size import SHORTEST, SLOWLY, first_step, step_factor


@kernel()
def shortest(length: float) -> float:
    """Step below which a phase of that length is given up."""
    return SHORTEST * length


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
            clock[STEP, lane] = min(clock[STEP, lane], clock[LONGEST, lane])
            if clock[STEP, lane] < shortest(clock[END, lane]):
                collapsed = True
            elif is_last(clock, lane):
                clock[TRIAL, lane] = clock[END, lane] - clock[TIME, lane]
            else:
                clock[TRIAL, lane] = clock[STEP, lane]
    return collapsed


@kernel()
def error_parts(error: Any, k: Any, y: Any, new: Any, rtol: float, atol: Any, limits: Any, norms: Any) -> None:
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
            estimate = k[0, m] * 0.0
            for i in range(stages):
                weight = error[row, i]
                if weight != 0.0:
                    estimate += weight * k[i, m]
            ratio = estimate / scale
            norms[row] += ratio * ratio


@kernel()
def judge_steps(
    places: Any, clock: Any, norms: Any, lowest: Any, highest: Any, floors: Any, counts: Any, smallest_steps: Any,
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


@kernel()
def move_on(places: Any, clock: Any) -> bool:
    """Advance the lanes' times by their accepted steps; whether some lane's phase or run has ended."""
    ended = False
    for lane in range(LANES):
        if clock[ACCEPTED_STEP, lane]:
            if places[CROSSED, lane] < 0:
                clock[FULL, lane], places[RETAKEN, lane] = 0.0, 0
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
def asks(places: Any) -> bool:
    """Whether some lane asks what holds for it."""
    found = False
    for lane in range(LANES):
        found = found or (places[RUN, lane] >= 0 and places[ASKS, lane] != NOTHING)
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
        lanes.clock[STEP, lane] = first_step(
            lanes.y[:, lane], lanes.slope[:, lane], rtol, lanes.atol[:, lane], lanes.clock[END, lane]
        )

"""Compiled runs of the crane in radial motion side by side.

The equations are those of :mod:`towercrane.cranes.radial_kernel`, compiled for lane vectors; the steps are put together
from :mod:`towercrane.lane_stepper`.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from modal.compiled import kernel
from towercrane import lane_stepper as lane_steps
from towercrane.cranes import radial_kernel
from towercrane.lane_stepper import (
    ACCEPTED_STEP,
    BEGIN,
    CROSSED,
    END,
    EVALUATIONS,
    FINISHED,
    FIRST_GUARD,
    FRACTION,
    FRESH,
    MOMENT,
    NOT_FINITE,
    PHASE,
    RUN,
    SAMPLE,
    STEP,
    STOP,
    TIME,
    TRIAL,
    WRITTEN,
)
from towercrane.lane_vector import LANES, choose, in_lanes
from towercrane.stepper import LOOKS, _first_step, _stage

AXES = 2
"""The load swings in the plane of the jib."""

TOWER_TIP, JIB_TIP, SWING, TENSION = range(4)
"""Outputs: the two linear ones, then swing angle and rope tension."""

OUTPUTS = ("tower_tip_displacement", "jib_tip_deflection", "swing_angle", "rope_tension")
"""Their names."""

rhs = kernel()(radial_kernel.rhs.py_func)


@kernel(parallel_calls=True)
def advance(
    queue: Any,
    answers: Any,
    lanes: Any,
    stages: int,
    a: Any,
    c: Any,
    error: Any,
    dense: Any,
    error_order: int,
    rtol: float,
    most_steps: int,
) -> bool:
    """Carry all lanes on by at most so many steps each.

    Parameters
    ----------
    queue, answers, lanes
        See :mod:`towercrane.lane_stepper`.
    stages, a, c, error, dense, error_order
        As in :class:`towercrane.tableaus.Tableau`.
    rtol : float
        Relative tolerance per step.
    most_steps : int
        Steps tried in each lane before this returns.

    Returns
    -------
    bool
        Whether runs are left.
    """
    clock, places, floors = lanes.clock, lanes.places, lanes.floors
    clocks, guards, lowest = in_lanes(clock), in_lanes(lanes.guards), in_lanes(lanes.lowest)
    y, new, trial, slope, k = (
        in_lanes(lanes.y), in_lanes(lanes.new), in_lanes(lanes.trial), in_lanes(lanes.slope), in_lanes(lanes.k),
    )  # fmt: skip
    atol, norms, watched = in_lanes(lanes.atol), in_lanes(lanes.norms), in_lanes(lanes.watched)
    inputs, numbers, vectors, matrices, work, tables = (
        in_lanes(lanes.inputs), in_lanes(lanes.numbers), in_lanes(lanes.vectors), in_lanes(lanes.matrices),
        in_lanes(lanes.work), queue.tables,
    )  # fmt: skip
    size, coordinates = y.size, vectors.shape[1]
    rows, every_stage = error.shape[0], a.shape[0]
    # The same state steers no step in every run: the work done.
    unused = np.isinf(queue.atol[0])
    active = size - np.sum(unused)
    for _ in range(most_steps):
        busy, fresh = False, False
        for lane in range(LANES):
            while places[RUN, lane] < 0 and lanes.next_run[0] < queue.starts.shape[0]:
                lane_steps.fill(queue, lanes, lane)
                lane_steps.begin_phase(queue, lanes, lane, coordinates, AXES)
            busy = busy or places[RUN, lane] >= 0
            fresh = fresh or (places[RUN, lane] >= 0 and places[FRESH, lane] != 0)
        if not busy:
            return False
        if fresh:
            rhs(clocks[TIME], y, slope, inputs, numbers, vectors, matrices, tables, work, guards)
            for lane in range(LANES):
                if places[RUN, lane] >= 0 and places[FRESH, lane]:
                    places[FRESH, lane] = 0
                    answers.counts[places[RUN, lane], EVALUATIONS] += 1
                    finite = True
                    for m in range(size):
                        lanes.k[0, m, lane] = lanes.slope[m, lane]
                        finite = finite and np.isfinite(lanes.slope[m, lane])
                    guard = lane_steps.fallen(lanes.guards, floors, lane)
                    if not finite:
                        lane_steps.end_run(answers, lanes, lane, NOT_FINITE)
                    elif guard >= 0:
                        lane_steps.end_run(answers, lanes, lane, FIRST_GUARD + guard)
                    elif clock[STEP, lane] <= 0.0:
                        clock[STEP, lane] = _first_step(
                            lanes.y[:, lane], lanes.slope[:, lane], rtol, lanes.atol[:, lane], clock[END, lane]
                        )
        for lane in range(LANES):
            lane_steps.choose_step(answers, lanes, lane)

        for g in range(guards.size):
            lowest[g] = np.inf
        step, time = clocks[TRIAL], clocks[TIME]
        for i in range(1, stages + 1):
            _stage(y, a, i, k, step, trial)
            rhs(time + c[i] * step, trial, slope, inputs, numbers, vectors, matrices, tables, work, guards)
            for g in range(guards.size):
                lowest[g] = min(lowest[g], guards[g])
            for m in range(size):
                k[i, m] = slope[m]
        for m in range(size):
            new[m] = trial[m]
        lane_steps.error_parts(error, k, y, new, rtol, atol, unused, norms)
        look = False
        for lane in range(LANES):
            look |= lane_steps.judge_step(queue, answers, lanes, lane, stages, rows, error_order, active)
        if look:
            for i in range(stages + 1, every_stage):
                _stage(y, a, i, k, step, trial)
                rhs(time + c[i] * step, trial, slope, inputs, numbers, vectors, matrices, tables, work, guards)
                for m in range(size):
                    k[i, m] = slope[m]
            for lane in range(LANES):
                if clock[ACCEPTED_STEP, lane] and (
                    places[lane_steps.SUSPECT, lane] or lane_steps.wants_sample(queue, lanes, lane)
                ):
                    answers.counts[places[RUN, lane], EVALUATIONS] += every_stage - stages - 1
            _find_falls(answers, lanes, y, new, trial, slope, k, dense, clocks, inputs, numbers, vectors, matrices,
                        tables, work, guards)  # fmt: skip
            _take_samples(queue, answers, lanes, y, trial, slope, k, dense, clocks, inputs, numbers, vectors, matrices,
                          tables, work, guards, watched)  # fmt: skip
        accepted = clocks[ACCEPTED_STEP]
        for m in range(size):
            y[m] = choose(accepted, new[m], y[m])
            k[0, m] = choose(accepted, k[stages, m], k[0, m])
        for lane in range(LANES):
            if clock[ACCEPTED_STEP, lane]:
                clock[TIME, lane] = clock[STOP, lane]
                if places[CROSSED, lane] >= 0:
                    lane_steps.end_run(answers, lanes, lane, FIRST_GUARD + places[CROSSED, lane])
                elif clock[TIME, lane] >= clock[END, lane]:
                    places[PHASE, lane] += 1
                    if places[PHASE, lane] == queue.phase_counts[places[RUN, lane]]:
                        lane_steps.end_run(answers, lanes, lane, FINISHED)
                    else:
                        lane_steps.begin_phase(queue, lanes, lane, coordinates, AXES)
    return True


@kernel()
def _find_falls(
    answers: Any, lanes: Any, y: Any, new: Any, trial: Any, slope: Any, k: Any, dense: Any, clocks: Any,
    inputs: Any, numbers: Any, vectors: Any, matrices: Any, tables: Any, work: Any, guards: Any,
) -> None:  # fmt: skip
    """Decide by the dense output whether and where the guards fall that a stage has seen fall; cut those steps."""
    clock = lanes.clock
    suspect = False
    looking = True
    while looking:
        looking = False
        for lane in range(LANES):
            looking |= lane_steps.look_for_fall(lanes, lane, LOOKS)
        if looking:
            suspect = True
            lane_steps.dense_states(y, dense, k, clocks[TRIAL], clocks[FRACTION], trial)
            rhs(clocks[MOMENT], trial, slope, inputs, numbers, vectors, matrices, tables, work, guards)
            for lane in range(LANES):
                if clock[FRACTION, lane] > 0.0:
                    lane_steps.note_look(answers, lanes, lane, LOOKS)
    if not suspect:
        return
    lane_steps.dense_states(y, dense, k, clocks[TRIAL], clocks[lane_steps.HIGH], trial)
    for lane in range(LANES):
        if clock[ACCEPTED_STEP, lane] and lanes.places[CROSSED, lane] >= 0:
            clock[STOP, lane] = clock[TIME, lane] + clock[lane_steps.HIGH, lane] * clock[TRIAL, lane]
            for m in range(y.size):
                lanes.new[m, lane] = lanes.trial[m, lane]


@kernel()
def _take_samples(
    queue: Any, answers: Any, lanes: Any, y: Any, trial: Any, slope: Any, k: Any, dense: Any, clocks: Any,
    inputs: Any, numbers: Any, vectors: Any, matrices: Any, tables: Any, work: Any, guards: Any, watched: Any,
) -> None:  # fmt: skip
    """Record the outputs of every lane at the samples that its step reaches."""
    places, clock = lanes.places, lanes.clock
    n, series = vectors.shape[1], answers.series.shape[0] > 0
    while True:
        wanted = 0
        for lane in range(LANES):
            if lane_steps.wants_sample(queue, lanes, lane):
                wanted |= 1 << lane
        if wanted == 0:
            return
        lane_steps.dense_states(y, dense, k, clocks[TRIAL], clocks[FRACTION], trial)
        rhs(clocks[MOMENT], trial, slope, inputs, numbers, vectors, matrices, tables, work, guards)
        for output in range(watched.shape[0]):
            value = trial[0] * 0.0
            for i in range(n):
                value += watched[output, i] * trial[i]
            slope[output] = value
        for lane in range(LANES):
            if wanted >> lane & 1:
                run, sample = places[RUN, lane], places[SAMPLE, lane]
                places[SAMPLE, lane] += 1
                answers.counts[run, WRITTEN] += 1
                time = queue.sample_times[sample]
                for output in range(4):
                    if output == SWING:
                        value = np.arctan2(lanes.trial[n, lane], -lanes.trial[n + 1, lane])
                    elif output == TENSION:
                        value = lanes.guards[radial_kernel.TENSION, lane]
                    else:
                        value = lanes.slope[output, lane]
                    lane_steps.record(answers, run, output, time, value)
                    if series:
                        answers.series[run, sample, output] = value

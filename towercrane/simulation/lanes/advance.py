"""Compiled runs of a system side by side.

The steps are put together from :mod:`towercrane.simulation.lanes.stepper` and
:mod:`towercrane.simulation.lanes.dense_output`; the equations and the outputs come as function pointers, which are
compiled by themselves.
"""

from __future__ import annotations

import numpy as np

from modal.compiler.kinds import LaneRow, LaneTable, Procedure, Row, Stack, Table
from modal.compiler.lanes import LANES, choose, in_lanes
from modal.compiler.native import native
from towercrane.simulation.directions import longest_turn, restore, restore_state
from towercrane.simulation.guards import FEW_LOOKS, LOOKS, widen
from towercrane.simulation.lanes import dense_output as looks
from towercrane.simulation.lanes import queue as lane_queue
from towercrane.simulation.lanes import stepper as lane_stepper
from towercrane.simulation.lanes.queue import (
    ACCEPTED_STEP,
    COLLAPSED,
    CROSSED,
    END,
    FINISHED,
    FIRST_GUARD,
    FRACTION,
    FRESH,
    HIGH,
    MOMENT,
    PHASE,
    RUN,
    STEP,
    TIME,
    TRIAL,
    Answers,
    Lanes,
    Queue,
)
from towercrane.simulation.stepper import stage_state


def _take_stages(
    rhs: Procedure, first: int, last: int, a: Table, c: Row, y: LaneRow, trial: LaneRow, slope: LaneRow, k: LaneTable,
    clocks: LaneRow, inputs: LaneTable, numbers: LaneRow, tables: Stack, guards: LaneRow, lowest: LaneRow,
    highest: LaneRow,
) -> None:  # fmt: skip
    """Slopes of the stages from first to last in every lane, and the range of every guard."""
    step, time = clocks[TRIAL], clocks[TIME]
    for i in range(first, last + 1):
        stage_state(y, a, i, k, step, trial)
        rhs(time + c[i] * step, trial, slope, inputs, numbers, tables, guards)
        widen(lowest, highest, guards)
        for m in range(y.size):
            k[i, m] = slope[m]


def _advance(
    rhs: Procedure,
    observe: Procedure,
    queue: Queue,
    answers: Answers,
    lanes: Lanes,
    stages: int,
    a: Table,
    c: Row,
    error: Table,
    dense: Table,
    error_order: int,
    rtol: float,
    turn: float,
    most_steps: int,
) -> bool:
    """Carry all lanes on by at most so many steps each.

    Parameters
    ----------
    rhs : compiled function
        As in :class:`towercrane.kernels.straight.code.StraightCode`, of lanes.
    observe : compiled function
        Outputs in place of slopes, and the guards.
    queue, answers, lanes
        See :mod:`towercrane.simulation.lanes.queue`.
    stages, a, c, error, dense, error_order
        As in :class:`towercrane.simulation.methods.runge_kutta.RungeKutta`.
    rtol : float
        Relative tolerance per step.
    turn : float
        Largest turn of a direction in a step [rad].
    most_steps : int
        Steps tried in each lane before this returns.

    Returns
    -------
    bool
        Whether runs are left, or lanes ask what holds for them.
    """
    places, clock, clocks = lanes.places, lanes.clock, in_lanes(lanes.clock)
    lane_floors, lane_guards, guards = lanes.floors, lanes.guards, in_lanes(lanes.guards)
    lane_lowest, lowest = lanes.lowest, in_lanes(lanes.lowest)
    lane_highest, highest = lanes.highest, in_lanes(lanes.highest)
    lane_norms, norms, atol = lanes.norms, in_lanes(lanes.norms), in_lanes(lanes.atol)
    lane_trial, lane_new, lane_outputs = lanes.trial, lanes.new, lanes.outputs
    y, new, trial, slope, k = (
        in_lanes(lanes.y), in_lanes(lanes.new), in_lanes(lanes.trial), in_lanes(lanes.slope), in_lanes(lanes.k),
    )  # fmt: skip
    inputs, numbers, tables = in_lanes(lanes.inputs), in_lanes(lanes.numbers), queue.tables
    seen, outputs, sample_times = in_lanes(lanes.seen), in_lanes(lanes.outputs), queue.sample_times
    directions = queue.directions
    counts, smallest_steps, extremes, series = (
        answers.counts, answers.smallest_steps,
        answers.extremes, answers.series,
    )  # fmt: skip
    size, rows = y.size, error.shape[0]
    # A state without a tolerance steers no step, in every run the same.
    limits, active = queue.atol[0], 0
    for m in range(size):
        active += not np.isinf(limits[m])
    for _ in range(most_steps):
        if lane_stepper.wants_entry(places, queue.waiting.size - lanes.next_run[0]):
            for lane in range(LANES):
                if places[RUN, lane] < 0 and lanes.next_run[0] < queue.waiting.size:
                    lane_queue.fill(queue, lanes, lane)
                    lane_queue.begin_phase(queue, lanes, lane)
            if lane_stepper.asks(places):
                return True
            rhs(clocks[TIME], y, slope, inputs, numbers, tables, guards)
            for lane in range(LANES):
                if places[FRESH, lane]:
                    lane_stepper.enter_phase(answers, lanes, lane, rtol)
        idle = 0
        for lane in range(LANES):
            idle += places[RUN, lane] < 0
        if idle == LANES:
            return bool(lanes.next_run[0] < queue.waiting.size)
        if lane_stepper.choose_steps(places, clock):
            for lane in range(LANES):
                if places[RUN, lane] >= 0 and clock[TRIAL, lane] == 0.0:
                    lane_queue.end_run(answers, lanes, lane, COLLAPSED)

        for g in range(guards.size):
            lowest[g] = np.inf
            highest[g] = -np.inf
        _take_stages(
            rhs, 1, stages, a, c, y, trial, slope, k, clocks, inputs, numbers, tables, guards, lowest, highest
        )
        for m in range(size):
            new[m] = trial[m]
        lane_stepper.error_parts(error, k, y, new, rtol, atol, limits, norms)
        looking = lane_stepper.judge_steps(
            places, clock, lane_norms, lane_lowest, lane_highest, lane_floors, counts, smallest_steps, sample_times,
            stages, rows, error_order, active,
        )  # fmt: skip
        if looking:
            _take_stages(
                rhs, stages + 1, a.shape[0] - 1, a, c, y, trial, slope, k, clocks, inputs, numbers, tables, guards,
                lowest, highest,
            )  # fmt: skip
            lane_stepper.count(looking, places, counts, a.shape[0] - 1 - stages)
            # A stage is only an estimate of the state there, and blind beside it; the dense output decides.
            look, looking = 1, looks.look_along(places, clock, 1, FEW_LOOKS)
            while looking:
                looks.dense_states(y, dense, k, clocks[TRIAL], clocks[FRACTION], trial)
                rhs(clocks[MOMENT], trial, slope, inputs, numbers, tables, guards)
                lane_stepper.count(looking, places, counts, 1)
                widen(lowest, highest, guards)
                look += 1
                looking = looks.look_along(places, clock, look, FEW_LOOKS)
            looks.keep_close(places, lane_lowest, lane_highest, lane_floors)
            suspect, looking = False, looks.look_for_falls(places, clock, LOOKS, queue.retakes)
            while looking:
                looks.dense_states(y, dense, k, clocks[TRIAL], clocks[FRACTION], trial)
                rhs(clocks[MOMENT], trial, slope, inputs, numbers, tables, guards)
                lane_stepper.count(looking, places, counts, 1)
                looks.note_looks(looking, places, clock, lane_guards, lane_floors, LOOKS)
                suspect, looking = True, looks.look_for_falls(places, clock, LOOKS, queue.retakes)
            if suspect:
                looks.dense_states(y, dense, k, clocks[TRIAL], clocks[HIGH], trial)
                looks.cut_steps(places, clock, lane_trial, lane_new, counts, queue.retakes)
            wanted = looks.wanted_samples(places, clock, sample_times)
            while wanted:
                looks.dense_states(y, dense, k, clocks[TRIAL], clocks[FRACTION], trial)
                restore_state(trial, directions)
                observe(clocks[MOMENT], trial, outputs, inputs, seen, tables, guards)
                looks.record(lane_outputs, wanted, places, counts, sample_times, extremes, series)
                wanted = looks.wanted_samples(places, clock, sample_times)
        accepted = clocks[ACCEPTED_STEP]
        bound = longest_turn(k, stages, directions, turn)
        clocks[STEP] = choose(accepted, min(clocks[STEP], bound), clocks[STEP])
        restore(new, k, stages, directions)
        for m in range(size):
            y[m] = choose(accepted, new[m], y[m])
            k[0, m] = choose(accepted, k[stages, m], k[0, m])
        if lane_stepper.move_on(places, clock):
            for lane in range(LANES):
                if places[RUN, lane] < 0 or not clock[ACCEPTED_STEP, lane]:
                    continue
                if places[CROSSED, lane] >= 0 and queue.asks:
                    lane_queue.pause(lanes, lane)
                elif places[CROSSED, lane] >= 0:
                    lane_queue.end_run(answers, lanes, lane, FIRST_GUARD + places[CROSSED, lane])
                elif clock[TIME, lane] >= clock[END, lane]:
                    places[PHASE, lane] += 1
                    if places[PHASE, lane] == queue.phase_counts[places[RUN, lane]]:
                        lane_queue.end_run(answers, lanes, lane, FINISHED)
                    else:
                        lane_queue.begin_phase(queue, lanes, lane)
    return True


(advance,) = native("lanes", _advance)

"""The compiled loop of steps: one explicit Runge-Kutta pair with step control, dense output and guards.

It works through one phase, inside which the inputs are smooth, and allocates nothing. The step control is
that of :mod:`towercrane.simulation.methods.step_size`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from modal.compiler.native import native
from towercrane.simulation.directions import longest_turn, restore
from towercrane.simulation.guards import (
    CLOSE,
    FEW_LOOKS,
    LATE,
    LOOKS,
    NARROWEST,
    NEAR,
    ROUGHLY,
    SOON,
    any_near,
    fallen,
    widen,
)
from towercrane.simulation.methods.step_size import SHORTEST, SLOWLY, step_factor

if TYPE_CHECKING:
    from modal.compiler.kinds import Number, NumberRow, NumberTable, Procedure, Row, Stack, Table, Whole, WholeRow

FINISHED, PAUSED, GUARD, COLLAPSED, NOT_FINITE = range(5)
"""How far a phase has come."""

TIME, STEP, SMALLEST, LONGEST, RETAKES, TURN, GROWTH = range(7)
"""Entries of its clock: time since the phase began, next step, smallest step taken, longest step allowed [s]; how
often a step is taken anew; largest turn of a direction in a step [rad]; power by which steps grow."""

ACCEPTED, REJECTED, EVALUATIONS, WRITTEN, GUARD_INDEX = range(5)
"""Entries of its counts."""


def _error_norm(error: Table, k: Table, y: Row, new: Row, h: float, rtol: float, atol: Row) -> float:
    """Norm of the error estimate; at most 1 is accepted. Two rows are combined as in dop853.f."""
    first, second, active = 0.0, 0.0, 0
    rows, stages = error.shape
    for m in range(y.size):
        if np.isinf(atol[m]):
            continue
        active += 1
        scale = atol[m] + rtol * max(abs(y[m]), abs(new[m]))
        for row in range(rows):
            estimate = 0.0
            for i in range(stages):
                estimate += error[row, i] * k[i, m]
            square = (estimate / scale) * (estimate / scale)
            if row == 0:
                first += square
            else:
                second += square
    if first == 0.0:
        return 0.0
    if rows == 2:
        return h * first / np.sqrt((first + 0.01 * second) * active)
    return h * np.sqrt(first / active)


def stage_state(y: NumberRow, a: Table, row: int, k: NumberTable, h: Number, out: NumberRow) -> None:
    """State of stage ``row``: out = y + h sum_j a[row, j] k[j]."""
    for m in range(y.size):
        out[m] = 0.0
    for j in range(row):
        weight = a[row, j]
        if weight != 0.0:
            for m in range(y.size):
                out[m] += weight * k[j, m]
    for m in range(y.size):
        out[m] = y[m] + h * out[m]


def _dense(y: Row, dense: Table, k: Table, h: float, x: float, out: Row) -> None:
    """State at the fraction x of the step that began at y."""
    for m in range(y.size):
        out[m] = 0.0
    for i in range(dense.shape[0]):
        weight = 0.0
        for d in range(dense.shape[1] - 1, -1, -1):
            weight = (weight + dense[i, d]) * x
        if weight != 0.0:
            for m in range(y.size):
                out[m] += weight * k[i, m]
    for m in range(y.size):
        out[m] = y[m] + h * out[m]


def _advance(
    rhs: Procedure,
    stages: int,
    a: Table,
    c: Row,
    error: Table,
    dense: Table,
    error_order: int,
    t_end: float,
    clock: Row,
    counts: WholeRow,
    rtol: float,
    atol: Row,
    y: Row,
    directions: Whole,
    k: Table,
    scratch: Table,
    sample_times: Row,
    samples: Table,
    max_steps: int,
    inputs: Table,
    numbers: Row,
    tables: Stack,
    guards: Row,
    ranges: Table,
    floors: Row,
) -> int:
    """Carry y from clock[TIME] towards t_end, at most max_steps accepted steps.

    Parameters
    ----------
    rhs, inputs, numbers, tables
        As in :class:`towercrane.kernels.straight.code.StraightCode`.
    stages, a, c, error, dense, error_order
        As in :class:`towercrane.simulation.methods.runge_kutta.RungeKutta`.
    clock, counts : ndarray, shapes (7,) and (5,)
        Read and written.
    y : ndarray, shape (size,)
        State, carried on in place.
    directions : ndarray of int, shape (count, 3)
        As in :class:`towercrane.simulation.system.System`; every accepted step ends with them restored.
    k, scratch : ndarray, shapes (m, size) and (3, size)
        Stages, of which the first is the slope at the start; they must not be touched between two calls of one phase.
    sample_times, samples : ndarray, shapes (p,) and (p, size)
        Times since the phase began at which the state is wanted, increasing; the states.
    guards, ranges : ndarray, shapes (g,) and (2, g)
        Scratch for the guards, and for the least and largest of each in a step.
    floors : ndarray, shape (g,)
        Values that the guards must not fall below.

    Returns
    -------
    int
        One of FINISHED, PAUSED, GUARD, COLLAPSED.
    """
    new, trial, slope = scratch[0], scratch[1], scratch[2]
    lowest, highest = ranges[0], ranges[1]
    t, h = clock[TIME], clock[STEP]
    shortest = SHORTEST * t_end
    taken, full, retaken = 0, 0.0, 0
    while t < t_end:
        if taken == max_steps or h < shortest:
            clock[TIME], clock[STEP] = t, h
            return PAUSED if taken == max_steps else COLLAPSED
        h = h if h < clock[LONGEST] else clock[LONGEST]
        last = t + h >= t_end - shortest
        step = t_end - t if last else h
        t_new = t_end if last else t + step
        suspect, norm = False, 0.0
        for g in range(guards.size):
            lowest[g], highest[g] = np.inf, -np.inf
        for i in range(1, a.shape[0]):
            stage_state(y, a, i, k, step, trial)
            # The slopes go through a fixed array: a view of k per stage would cost a tenth of the right-hand side.
            rhs(t + c[i] * step, trial, slope, inputs, numbers, tables, guards)
            counts[EVALUATIONS] += 1
            for m in range(y.size):
                k[i, m] = slope[m]
            widen(lowest, highest, guards)
            if i == stages:
                for m in range(y.size):
                    new[m] = trial[m]
                norm = _error_norm(error, k, y, new, step, rtol, atol)
                suspect = any_near(lowest, highest, floors, NEAR)
                wanted = counts[WRITTEN] < sample_times.size and sample_times[counts[WRITTEN]] <= t_new
                # The stages beyond are for the dense output alone.
                if not (norm <= 1.0 and (suspect or wanted)):
                    break
        if not norm <= 1.0:
            counts[REJECTED] += 1
            h = step * step_factor(norm, error_order, clock[GROWTH])
            clock[GROWTH] = SLOWLY
            continue

        # A stage is only an estimate of the state there, and blind beside it; the dense output decides.
        if suspect:
            for look in range(1, FEW_LOOKS + 1):
                x = look / FEW_LOOKS
                _dense(y, dense, k, step, x, trial)
                rhs(t + x * step, trial, slope, inputs, numbers, tables, guards)
                counts[EVALUATIONS] += 1
                widen(lowest, highest, guards)
            suspect = any_near(lowest, highest, floors, CLOSE)
        low, high, crossed, anew = 0.0, 1.0 / LOOKS, -1, False
        while suspect:
            x = high if crossed < 0 else 0.5 * (low + high)
            _dense(y, dense, k, step, x, trial)
            rhs(t + x * step, trial, slope, inputs, numbers, tables, guards)
            counts[EVALUATIONS] += 1
            guard = fallen(guards, floors)
            if guard >= 0:
                high, crossed = x, guard
                for m in range(y.size):
                    new[m] = trial[m]
            elif crossed >= 0:
                low = x
            else:
                low, high = x, x + 1.0 / LOOKS
            anew = crossed >= 0 and retaken < clock[RETAKES] and SOON < high < LATE
            suspect = high <= 1.0 if crossed < 0 else high - low > (ROUGHLY * high if anew else NARROWEST)
        if anew:
            # Stages beyond the guard have seen the equations go on there, perhaps around another corner.
            full, h = max(full, step), high * step
            counts[REJECTED] += 1
            retaken += 1
            continue
        stop = t_new if crossed < 0 else t + high * step
        while counts[WRITTEN] < sample_times.size and sample_times[counts[WRITTEN]] <= stop:
            row = counts[WRITTEN]
            _dense(y, dense, k, step, (sample_times[row] - t) / step, samples[row])
            counts[WRITTEN] += 1
        bound = longest_turn(k, stages, directions, clock[TURN])
        restore(new, k, stages, directions)
        for m in range(y.size):
            y[m] = new[m]
            k[0, m] = k[stages, m]
        t = stop
        taken += 1
        counts[ACCEPTED] += 1
        clock[SMALLEST] = min(clock[SMALLEST], step)
        if crossed >= 0:
            clock[TIME], clock[STEP] = t, max(step, full)
            counts[GUARD_INDEX] = crossed
            return GUARD
        grown = step * step_factor(norm, error_order, clock[GROWTH])
        # The cut last step of a phase says nothing about the next one's length.
        h = min(max(h, grown) if last else grown, bound)
        full, retaken = 0.0, 0
    clock[TIME], clock[STEP] = t, h
    return FINISHED


def _evaluate(
    rhs: Procedure,
    times: Row,
    states: Table,
    slopes: Table,
    guards: Table,
    inputs: Table,
    numbers: Row,
    tables: Stack,
) -> None:
    """Right-hand side and guards at many states of one phase; slopes and guards have a row per state."""
    for row in range(times.size):
        rhs(times[row], states[row], slopes[row], inputs, numbers, tables, guards[row])


advance, evaluate = native("stepper", _advance, _evaluate)

"""SciPy's solvers on the same right-hand side: cross-checks of the compiled one."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.integrate

from towercrane.simulation.directions import restore_rows
from towercrane.simulation.guards import first_fall
from towercrane.simulation.methods.step_size import SHORTEST
from towercrane.simulation.outcomes import COLLAPSED, FINISHED, INTERRUPTED, NOT_FINITE
from towercrane.simulation.trajectory import ACCEPTED, EVALUATIONS, REJECTED, WRITTEN, leapt, phase_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from towercrane.motions.motion import Phases
    from towercrane.simulation.trajectory import Floats, Progress, Run

PROGRESS = 100
"""Steps between two reports of progress."""

FRESH_STEPS = 20
"""Least steps of a solver before another is begun: one that begins anew begins with short steps."""


def solve(
    run: Run,
    phases: Phases,
    sample_times: Floats,
    method: str,
    split: bool,
    progress: Progress | None,
) -> str:
    """Carry a run through its phases with one of SciPy's solvers; how it ended.

    Parameters
    ----------
    run : Run
        Carried on in place.
    phases, sample_times, split, progress
        As in :func:`towercrane.simulation.integrate.integrate`.
    method : str
        Name of its class in :mod:`scipy.integrate`.
    """
    system = run.system
    slope, guards = np.empty(system.size), np.empty(len(system.guards))
    current, (compiled, numbers) = 0, system.code(phases.inputs[0])

    def rhs(t: float, y: Floats) -> Floats:
        phase = current if split else min(int(phase_of(np.array([t]), phases)[0]), len(phases.inputs) - 1)
        local = t - phases.times[phase]
        compiled(local, np.ascontiguousarray(y), slope, phases.inputs[phase], numbers, system.table, guards)
        return slope.copy()

    def margins(t: float, y: Floats) -> Floats:
        run.counts[EVALUATIONS] += 1
        rhs(t, y)
        return (guards - system.floors)[watched]

    watched = np.flatnonzero(np.isfinite(system.floors))
    run.counts[REJECTED] = -1
    # A state that must not steer the step gets a tolerance that it always meets.
    atol = np.where(np.isinf(run.atol), 1e300, run.atol)
    owner = phase_of(sample_times, phases)
    try:
        for current in range(len(phases.inputs) if split else 1):
            if current:
                run.state = leapt(run, phases, current)
            run.time = float(phases.times[current])
            stop = float(phases.times[current + 1] if split else phases.times[-1])
            wanted = sample_times[owner == current] if split else sample_times
            if not np.all(np.isfinite(rhs(run.time, run.state))):
                return NOT_FINITE
            if len(fallen := np.flatnonzero(guards < system.floors)):
                return system.guards[int(fallen[0])]
            # Radau widens the difference of a state that no slope depends on, such as the work, until it is infinite.
            with np.errstate(over="ignore"):
                ended = _leg(
                    run,
                    partial(getattr(scipy.integrate, method), rhs, t_bound=stop, rtol=run.rtol, atol=atol),
                    wanted,
                    watched,
                    margins,
                    progress,
                )
            if progress is not None:
                progress(run.time)
            if ended:
                return ended
    except KeyboardInterrupt:
        return INTERRUPTED
    return FINISHED


def _leg(
    run: Run,
    begun: Callable[[float, Floats], Any],
    wanted: Floats,
    watched: NDArray[np.int64],
    margins: Callable[[float, Floats], Floats],
    progress: Progress | None,
) -> str:
    """Carry a run through one phase with solvers begun where it stands; what ended it there, empty if nothing did."""
    done, system, solver, steps = 0, run.system, begun(run.time, run.state), 0
    shortest = SHORTEST * (solver.t_bound - run.time)
    while solver.status == "running":
        before = solver.nfev
        solver.step()
        run.counts[EVALUATIONS] += solver.nfev - before
        if solver.status == "failed":
            return COLLAPSED
        if not np.all(np.isfinite(solver.y)):
            return NOT_FINITE  # LSODA calls that a success.
        if solver.t - solver.t_old < shortest and solver.status == "running":
            return COLLAPSED  # LSODA would go on for ever.
        time, state, dense = solver.t, solver.y, solver.dense_output()
        fallen = first_fall(solver.t_old, solver.t, dense, margins) if len(watched) else None
        if fallen is not None:
            time, state = fallen[0], dense(fallen[0])
        until = done + int(np.count_nonzero(wanted[done:] <= time))
        if until > done:
            first = int(run.counts[WRITTEN])
            run.samples[first : first + until - done] = dense(wanted[done:until]).T
            run.counts[WRITTEN] += until - done
            done = until
        run.counts[ACCEPTED] += 1
        run.smallest_step = min(run.smallest_step, solver.t - solver.t_old)
        run.time, run.state = float(time), state.copy()
        off = restore_rows(run.state, system.directions)
        if fallen is not None:
            return system.guards[int(watched[fallen[1]])]
        steps += 1
        if off > run.rtol and steps >= FRESH_STEPS and solver.status == "running":
            # Its own copy of the state, and its memory of it, cannot be put back.
            solver, steps = begun(run.time, run.state), 0
        if progress is not None and run.counts[ACCEPTED] % PROGRESS == 0:
            progress(run.time)
    return ""

"""SciPy's solvers on the same right-hand side: cross-checks of the compiled one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.integrate import solve_ivp

from towercrane.integrate import (
    ACCEPTED,
    COLLAPSED,
    EVALUATIONS,
    FINISHED,
    INTERRUPTED,
    NOT_FINITE,
    REJECTED,
    WRITTEN,
    phase_of,
)

if TYPE_CHECKING:
    from towercrane.integrate import Floats, Progress, Run
    from towercrane.motion import Phases


def solve(
    run: Run,
    phases: Phases,
    sample_times: Floats,
    method: str,
    split: bool,
    progress: Progress | None,
) -> str:
    """Carry a run through its phases with a method of :func:`scipy.integrate.solve_ivp`; how it ended.

    Parameters
    ----------
    run : Run
        Carried on in place.
    phases, sample_times, split, progress
        As in :func:`towercrane.integrate.integrate`.
    method : str
        SciPy's name of it.
    """
    system = run.system
    slope, guards, work = np.empty(system.size), np.empty(len(system.guards)), np.zeros(system.work_shape)
    current = 0

    def rhs(t: float, y: Floats) -> Floats:
        phase = current if split else int(phase_of(np.array([t]), phases)[0])
        local = t - phases.times[phase]
        system.rhs(local, np.ascontiguousarray(y), slope, phases.inputs[phase], *system.constants, work, guards)
        return slope.copy()

    def watch(index: int) -> Any:
        def guard(t: float, y: Floats) -> float:
            rhs(t, y)
            return float(guards[index] - system.floors[index])

        guard.terminal, guard.direction = True, -1.0  # type: ignore[attr-defined]
        return guard

    run.counts[REJECTED] = -1
    # A state that must not steer the step gets a tolerance that it always meets.
    atol = np.where(np.isinf(run.atol), 1e300, run.atol)
    watched = [index for index, floor in enumerate(system.floors) if np.isfinite(floor)]
    owner = phase_of(sample_times, phases)
    legs = range(len(phases.inputs)) if split else range(1)
    for current in legs:
        run.restart(phases, current)
        stop = float(phases.times[current + 1] if split else phases.times[-1])
        wanted = sample_times[owner == current] if split else sample_times
        if not np.all(np.isfinite(rhs(run.time, run.state))):
            return NOT_FINITE
        if fallen := [index for index in watched if guards[index] < system.floors[index]]:
            return system.guards[fallen[0]]
        try:
            # Radau widens the difference of a state that no slope depends on, such as the work, until it is infinite.
            with np.errstate(over="ignore"):
                solution = solve_ivp(
                    rhs, (run.time, stop), run.state, method=method, rtol=run.rtol, atol=atol, dense_output=True,
                    events=[watch(index) for index in watched],
                )  # fmt: skip
        except KeyboardInterrupt:
            return INTERRUPTED
        reached = wanted[wanted <= solution.t[-1]]
        first = int(run.counts[WRITTEN])
        run.samples[first : first + len(reached)] = solution.sol(reached).T
        run.counts[[ACCEPTED, EVALUATIONS, WRITTEN]] += (len(solution.t) - 1, solution.nfev, len(reached))
        run.smallest_step = min(run.smallest_step, float(np.diff(solution.t).min()))
        run.time, run.state = float(solution.t[-1]), solution.y[:, -1].copy()
        if progress is not None:
            progress(run.time)
        for index, times in zip(watched, solution.t_events or (), strict=True):
            if len(times):
                return system.guards[index]
        if not np.all(np.isfinite(run.state)):
            return NOT_FINITE  # LSODA calls that a success.
        if not solution.success:
            return COLLAPSED
    return FINISHED

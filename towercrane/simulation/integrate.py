"""Solving a system phase by phase: restart at every switch point, sample, stop at a guard."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.motions.motion import SAME_INSTANT
from towercrane.simulation.arguments import check_times, check_tolerances
from towercrane.simulation.directions import restore_rows
from towercrane.simulation.outcomes import COLLAPSED, FINISHED, INTERRUPTED, NOT_FINITE, STALLED
from towercrane.simulation.tableaus import TABLEAUS, Tableau
from towercrane.simulation.trajectory import ACCEPTED, EVALUATIONS, REJECTED, WRITTEN, Run, Trajectory, phase_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.motions.motion import Phases
    from towercrane.simulation.system import System
    from towercrane.simulation.trajectory import Progress

    Floats = NDArray[np.float64]

SCIPY_METHODS = {
    "scipy-dop853": "DOP853",
    "scipy-rk45": "RK45",
    "scipy-radau": "Radau",
    "scipy-lsoda": "LSODA",
}
METHODS = (*TABLEAUS, *SCIPY_METHODS)
"""Names of all methods; those of SciPy run the same right-hand side as a cross-check."""

STEPS_PER_CALL = 20_000
"""Steps between two looks at progress and the keyboard."""

MOST_STALLED = 20
"""Switches in a row without time passing at which a run is given up."""


def integrate(
    system: System,
    phases: Phases,
    start: Floats,
    sample_times: Floats,
    *,
    method: str = "dop853",
    rtol: float = 1e-8,
    atol: float = 1e-10,
    split: bool = True,
    progress: Progress | None = None,
) -> Trajectory:
    """Solve a system over its phases.

    Parameters
    ----------
    system : System
    phases : Phases
        Times and input polynomials.
    start : ndarray, shape (size,)
        State at the first time.
    sample_times : ndarray, shape (p,)
        Increasing times at which states are wanted [s].
    method : str
        One of METHODS.
    rtol, atol : float
        Tolerances per step, from 1e-13 and 1e-20 to 1; atol is multiplied by ``system.scale``.
    split : bool
        Restart the step control at switch points. Without it (SciPy's methods only) the error is erratic; it
        is offered to show that.
    progress : callable, optional
        Called with the time reached [s].

    Raises
    ------
    ValueError
        If an argument is out of its range, or the combination is not offered: SciPy's methods know no switch.
    """
    if method not in METHODS:
        raise ValueError(f"method: wanted one of {', '.join(METHODS)}, got {method!r}")
    check_tolerances(rtol, atol)
    check_times(sample_times)
    if np.shape(start) != (system.size,):
        raise ValueError(f"start: wanted {system.size} states in one row, got the shape {np.shape(start)}")
    if method not in TABLEAUS and system.switch is not None and system.switch.changes_equations:
        # They would take a sign for a smooth function and creep to a halt at the first reversal.
        raise ValueError(
            f"method: wanted one of {', '.join(TABLEAUS)} for equations that switch, as friction that sticks, "
            f"got {method!r}"
        )
    began, began_cpu = time.perf_counter(), time.process_time()
    run = Run(system, rtol, atol, np.array(start, dtype=float), np.empty((len(sample_times), system.size)))
    restore_rows(run.state, system.directions)
    if method not in TABLEAUS:
        from towercrane.simulation.scipy_solver import solve

        outcome = solve(run, phases, sample_times, SCIPY_METHODS[method], split, progress)
    elif split:
        outcome = _compiled(run, phases, sample_times, TABLEAUS[method], progress)
    else:
        raise ValueError(f"split=False: wanted one of {', '.join(SCIPY_METHODS)}, got {method!r}")
    written = int(run.counts[WRITTEN])
    # Between steps the dense output keeps a direction as well as it keeps anything.
    restore_rows(run.samples[:written], system.directions)
    if outcome == FINISHED:
        run.samples[written:], written = run.state, len(sample_times)
    elif written == 0 and len(sample_times) and sample_times[0] == run.time:
        run.samples[0], written = run.state, 1
    return Trajectory(
        times=np.array(sample_times[:written]),
        states=run.samples[:written],
        outcome=outcome,
        end_time=run.time,
        end_state=run.state,
        evaluations=int(run.counts[EVALUATIONS]),
        accepted=int(run.counts[ACCEPTED]),
        rejected=int(run.counts[REJECTED]),
        smallest_step=run.smallest_step,
        cpu_seconds=time.process_time() - began_cpu,
        wall_seconds=time.perf_counter() - began,
    )


def _compiled(run: Run, phases: Phases, sample_times: Floats, tableau: Tableau, progress: Progress | None) -> str:
    from towercrane.simulation import stepper

    system = run.system
    guards, numbers, floors = np.empty(len(system.guards)), system.numbers.copy(), system.floors.copy()
    ranges = np.empty((2, len(guards)))
    k, scratch = np.empty((len(tableau.a), system.size)), np.empty((3, system.size))
    work, step = np.zeros(system.work_shape), 0.0
    owner = phase_of(sample_times, phases)
    for phase, inputs in enumerate(phases.inputs):
        begin, t_end = float(phases.times[phase]), float(phases.times[phase + 1] - phases.times[phase])
        clock = np.array([0.0, step, run.smallest_step, tableau.longest_step(system.fastest)])
        mine = owner == phase
        first = int(np.count_nonzero(owner < phase))
        counts = np.zeros(len(run.counts), dtype=np.int64)
        constants = (numbers, *system.constants[1:])

        def guards_at(inputs: Floats = inputs, clock: Floats = clock, constants: Any = constants) -> Floats:
            system.rhs(clock[stepper.TIME], run.state, scratch[0], inputs, *constants, work, guards)
            return guards

        if system.switch is not None:
            system.switch.begin(run.state, numbers, floors, guards_at)
        arguments = (
            system.rhs, tableau.stages, tableau.a, tableau.c, tableau.error, tableau.dense,
            tableau.error_order, t_end, clock, counts, run.rtol, run.atol, run.state, system.directions, k, scratch,
            np.minimum(sample_times[mine] - begin, t_end), run.samples[first : first + np.count_nonzero(mine)],
            STEPS_PER_CALL, inputs, *constants, work, guards, ranges, floors,
        )  # fmt: skip
        status, interrupted, stalled, fresh = stepper.PAUSED, False, 0, True
        while status == stepper.PAUSED and not interrupted:
            before = clock[stepper.TIME]
            try:
                if fresh:
                    guards_at()
                    status = _enter(run, scratch[0], guards, floors, clock, counts, t_end)
                    k[0], fresh = scratch[0], False
                if status == stepper.PAUSED:
                    status = stepper.advance(*arguments)
                if progress is not None:
                    progress(begin + clock[stepper.TIME])
            except KeyboardInterrupt:
                interrupted = True
            if status == stepper.GUARD and system.switch is not None:
                # Switches that follow each other without time passing would go on for ever.
                stalled = stalled + 1 if clock[stepper.TIME] - before < SAME_INSTANT else 0
                if stalled > MOST_STALLED:
                    run.counts += counts
                    run.time, run.smallest_step = begin + float(clock[stepper.TIME]), float(clock[stepper.SMALLEST])
                    return STALLED
                crossed = int(counts[stepper.GUARD_INDEX])
                if system.switch.cross(crossed, run.state, numbers, floors, guards_at):
                    status, fresh = stepper.PAUSED, True
        run.counts += counts
        run.time, run.smallest_step = begin + float(clock[stepper.TIME]), float(clock[stepper.SMALLEST])
        step = float(clock[stepper.STEP])
        if interrupted:
            return INTERRUPTED
        if status == stepper.GUARD:
            return system.guards[int(counts[stepper.GUARD_INDEX])]
        if status == stepper.COLLAPSED:
            return COLLAPSED
        if status == stepper.NOT_FINITE:
            return NOT_FINITE
    return FINISHED


def _enter(
    run: Run, slope: Floats, guards: Floats, floors: Floats, clock: Floats, counts: NDArray[np.int64], t_end: float
) -> int:
    """Whether the run goes on, with the slope and the guards where it stands; a first step if it has none."""
    from towercrane.simulation import stepper

    counts[EVALUATIONS] += 1
    if not np.all(np.isfinite(slope)):
        return stepper.NOT_FINITE
    if len(fallen := np.flatnonzero(guards < floors)):
        counts[stepper.GUARD_INDEX] = fallen[0]
        return stepper.GUARD
    if clock[stepper.STEP] <= 0.0:
        clock[stepper.STEP] = stepper.first_step(run.state, slope, run.rtol, run.atol, t_end)
    return stepper.PAUSED


def evaluate(system: System, phases: Phases, times: Floats, states: Floats) -> tuple[Floats, Floats]:
    """Slopes and guards at known states; at a switch time, as at the end of the last phase, the right limits.

    Parameters
    ----------
    system, phases
        As in :func:`integrate`.
    times, states : ndarray, shapes (p,) and (p, size)

    Returns
    -------
    slopes, guards : ndarray, shapes (p, size) and (p, len(system.guards))
    """
    from towercrane.simulation import stepper

    slopes, guards = np.empty_like(states), np.empty((len(times), len(system.guards)))
    work, owner = np.zeros(system.work_shape), phase_of(times, phases)
    switch = system.switch if system.switch is not None and system.switch.changes_equations else None
    numbers, floors = system.numbers.copy(), system.floors.copy()
    for phase in np.unique(owner):
        mine = np.flatnonzero(owner == phase)
        inputs = phases.inputs[phase] if phase < len(phases.inputs) else phases.after
        # Where equations switch, each state has its own.
        parts = [slice(mine[0], mine[-1] + 1)] if switch is None else [slice(row, row + 1) for row in mine]
        for part in parts:
            arguments = (
                system.rhs, times[part] - phases.times[phase], states[part], slopes[part], guards[part], inputs,
                numbers, *system.constants[1:], work,
            )  # fmt: skip
            if switch is not None:

                def guards_at(arguments: Any = arguments, row: Floats = guards[part.start]) -> Floats:
                    stepper.evaluate(*arguments)
                    return row

                switch.begin(states[part.start].copy(), numbers, floors, guards_at)
            stepper.evaluate(*arguments)
    return slopes, guards

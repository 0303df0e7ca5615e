"""Solving a system phase by phase: restart at every switch point, sample, stop at a guard."""

from __future__ import annotations

import time
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.simulation.arguments import check_times, check_tolerances
from towercrane.simulation.directions import restore_rows
from towercrane.simulation.methods.method import DEFAULT
from towercrane.simulation.methods.registry import METHODS, method_of
from towercrane.simulation.outcomes import FINISHED
from towercrane.simulation.trajectory import ACCEPTED, EVALUATIONS, REJECTED, WRITTEN, Run, Trajectory, phase_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from towercrane.motions.motion import Phases
    from towercrane.simulation.system import Switch, System
    from towercrane.simulation.trajectory import Progress

    Floats = NDArray[np.float64]


def integrate(
    system: System,
    phases: Phases,
    start: Floats,
    sample_times: Floats,
    *,
    method: str = DEFAULT,
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
        One of :data:`towercrane.simulation.methods.registry.METHODS`.
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
    solver = method_of(method)
    check_tolerances(rtol, atol)
    check_times(sample_times)
    if np.shape(start) != (system.size,):
        raise ValueError(f"start: wanted {system.size} states in one row, got the shape {np.shape(start)}")
    if not solver.follows_switches and system.switch is not None and system.switch.changes_equations:
        # They would take a sign for a smooth function and creep to a halt at the first reversal.
        able = ", ".join(name for name, own in METHODS.items() if own.follows_switches)
        raise ValueError(
            f"method: wanted one of {able} for equations that switch, as friction that sticks, got {method!r}"
        )
    if not (split or solver.crosses_phases):
        able = ", ".join(name for name, own in METHODS.items() if own.crosses_phases)
        raise ValueError(f"split=False: wanted one of {able}, got {method!r}")
    if system.crossings is not None:
        if not split and system.crossings.crosses(phases):
            raise ValueError("split: wanted True where rates or the load jump, as at a joint of the jib, got False")
        phases = system.crossings.cut(phases)
    began, began_cpu = time.perf_counter(), time.process_time()
    run = Run(system, rtol, atol, np.array(start, dtype=float), np.empty((len(sample_times), system.size)))
    restore_rows(run.state, system.directions)
    outcome = solver.carry(run, phases, sample_times, split, progress)
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
        switch_times=np.array([time for time, _ in run.switched]),
        switch_states=np.array([state for _, state in run.switched]).reshape(-1, system.size),
    )


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
    slopes, guards = np.empty_like(states), np.empty((len(times), len(system.guards)))
    if system.crossings is not None:
        phases = system.crossings.cut(phases)
    owner = phase_of(times, phases)
    for phase in np.unique(owner):
        mine = np.flatnonzero(owner == phase)
        part = slice(mine[0], mine[-1] + 1)
        inputs = phases.inputs[phase] if phase < len(phases.inputs) else phases.after
        rhs, numbers = system.code(inputs)
        under = partial(_under, rhs, times[part] - phases.times[phase], states[part], inputs, system.table)
        if system.switch is not None and system.switch.changes_equations:
            slopes[part], guards[part] = _switched(system, system.switch, states[part], numbers, under)
        else:
            under(numbers, slopes[part], guards[part])
    return slopes, guards


def _under(
    rhs: Any, times: Floats, states: Floats, inputs: Floats, table: Floats, numbers: Floats, slopes: Floats,
    guards: Floats,
) -> None:  # fmt: skip
    """Write slopes and guards of one phase, with these numbers in place of the system's own."""
    from towercrane.simulation import stepper

    stepper.evaluate(rhs, times, states, slopes, guards, inputs, numbers, table)


def _switched(
    system: System, switch: Switch, states: Floats, own: Floats, under: Callable[[Floats, Floats, Floats], None]
) -> tuple[Floats, Floats]:
    """Slopes and guards where equations switch: each state has its own, but few of them differ."""
    slopes, guards = np.empty_like(states), np.empty((len(states), len(system.guards)))
    numbers, floors = own.copy(), system.floors.copy()
    found: dict[bytes, tuple[Floats, Floats]] = {}

    def of_all() -> tuple[Floats, Floats]:
        key = numbers.tobytes()
        if key not in found:
            found[key] = np.empty_like(slopes), np.empty_like(guards)
            under(numbers, *found[key])
        return found[key]

    for row, state in enumerate(states):
        switch.begin(state.copy(), numbers, floors, lambda row=row: of_all()[1][row])  # type: ignore[misc]
        slopes[row], guards[row] = (values[row] for values in of_all())
    return slopes, guards

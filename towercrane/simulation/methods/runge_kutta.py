"""Explicit Runge-Kutta pairs, and how one carries a run through its phases in compiled steps."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from towercrane.motions.motion import SAME_INSTANT
from towercrane.simulation.methods.method import Method
from towercrane.simulation.outcomes import COLLAPSED, FINISHED, INTERRUPTED, NOT_FINITE, STALLED
from towercrane.simulation.trajectory import EVALUATIONS, Run, leapt, phase_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from towercrane.motions.motion import Phases
    from towercrane.simulation.trajectory import Progress

    Floats = NDArray[np.float64]

STEPS_PER_CALL = 20_000
"""Steps between two looks at progress and the keyboard."""

CONSISTENT = 1e-12
"""Rounding of coefficients."""

TURN_TOLERANCE = 1e-8
"""Relative tolerance for which pairs state their largest turn."""

REACH_USED = 0.9
"""Part of a pair's reach that its steps use: the fastest vibration is known for small motions only."""


@dataclass(frozen=True, eq=False, kw_only=True)
class RungeKutta(Method):
    """Explicit Runge-Kutta pair whose last regular stage is the slope at the end of the step.

    Parameters
    ----------
    name, order, energy_drift, loosest
        As in :class:`towercrane.simulation.methods.method.Method`.
    error_order : int
        Order of the error estimate: a step's estimate falls like h^(error_order + 1).
    dense_order : int
        Order of the dense output.
    stages : int
        Stages s of a step; stage s (counted from 0) is the slope at its end.
    a : ndarray, shape (m, m)
        Strictly lower triangular. Row s holds the weights of the step itself; rows beyond belong to the stages
        that only dense output needs.
    c : ndarray, shape (m,)
        Nodes.
    error : ndarray, shape (1 or 2, s + 1)
        Weights of the error estimate; two rows are combined as in dop853.f.
    dense : ndarray, shape (m, degree)
        y(x) = y0 + h sum_i K_i sum_d dense[i, d] x^(d + 1) for 0 <= x <= 1.
    reach : float
        Largest step times angular frequency of a vibration at which no such step makes it grow; none where every
        long step does.
    turn : float
        Largest angle by which a step at rtol 1e-8 may turn a direction among the states, as
        :func:`towercrane.simulation.directions.longest_turn` takes it [rad].

    Raises
    ------
    ValueError
        If the coefficients do not fit each other, or the figures of its energy are out of order.
    """

    error_order: int
    dense_order: int
    stages: int
    a: Floats
    c: Floats
    error: Floats
    dense: Floats
    reach: float = np.inf
    turn: float = np.inf

    compiled: ClassVar[bool] = True
    follows_switches: ClassVar[bool] = True

    def __post_init__(self) -> None:
        super().__post_init__()
        last = self.stages
        wanted = {
            "a strictly lower triangular": not np.triu(self.a).any(),
            "a whose rows add up to c": _same(self.a.sum(axis=1), self.c),
            "a last regular stage at the end of the step": 0 < last < len(self.a) and self.c[last] == 1.0,
            "error weights for the regular stages": self.error.shape in ((1, last + 1), (2, last + 1)),
            "error weights that add up to nothing": _same(self.error.sum(axis=1), np.zeros(len(self.error))),
            "a dense output that ends in the step": _same(self.dense.sum(axis=1)[None], self.a[last : last + 1]),
        }
        if missing := [what for what, fits in wanted.items() if not fits]:
            raise ValueError(f"{self.name}: wanted {missing[0]}")

    def longest_step(self, fastest: Callable[[], float] | None) -> float:
        """Longest step that feeds no vibration [s]: the error estimate sees it late.

        Parameters
        ----------
        fastest : callable or None
            Angular frequency of the fastest vibration [rad/s], as in :class:`towercrane.simulation.system.System`.
        """
        if fastest is None or np.isinf(self.reach):
            return np.inf
        frequency = fastest()
        return REACH_USED * self.reach / frequency if frequency > 0.0 else np.inf

    def longest_turn(self, rtol: float) -> float:
        """Largest turn of a direction in a step at a relative tolerance [rad].

        Errors that come back with the other sign half a swing later leave nothing behind: what a method takes from
        the energy is of an even power of the step, beyond its order. With that power the error at the end falls as
        the tolerance does.
        """
        power = self.order + 2 - self.order % 2
        return float(self.turn * (rtol / TURN_TOLERANCE) ** (1.0 / power))

    def carry(self, run: Run, phases: Phases, sample_times: Floats, split: bool, progress: Progress | None) -> str:
        """Carry a run on through its phases, in place; how it ended."""
        from towercrane.simulation import stepper
        from towercrane.simulation.guards import MOST_RETAKES, MOST_STALLED
        from towercrane.simulation.methods.step_size import FREELY

        system = run.system
        guards, floors = np.empty(len(system.guards)), system.floors.copy()
        rhs, own = system.code(phases.inputs[0])
        numbers, table = own.copy(), system.table
        ranges = np.empty((2, len(guards)))
        k, scratch = np.empty((len(self.a), system.size)), np.empty((3, system.size))
        fastest = system.fastest_in(phases)
        step, growth, turn = 0.0, FREELY, self.longest_turn(run.rtol)
        owner = phase_of(sample_times, phases)
        for phase, inputs in enumerate(phases.inputs):
            if phase:
                run.state[:] = leapt(run, phases, phase)
            begin, t_end = float(phases.times[phase]), float(phases.times[phase + 1] - phases.times[phase])
            # Where a guard ends the run, nothing goes on from its state.
            retakes = 0.0 if system.switch is None else MOST_RETAKES
            longest = self.longest_step(fastest)
            clock = np.array([0.0, step, run.smallest_step, longest, retakes, turn, growth])
            mine = owner == phase
            first = int(np.count_nonzero(owner < phase))
            counts = np.zeros(len(run.counts), dtype=np.int64)

            def guards_at(inputs: Floats = inputs, clock: Floats = clock) -> Floats:
                rhs(clock[stepper.TIME], run.state, scratch[0], inputs, numbers, table, guards)
                return guards

            held = numbers.copy()
            if system.switch is not None:
                system.switch.begin(run.state, numbers, floors, guards_at)
                if phase and not np.array_equal(held, numbers):
                    run.switched.append((begin, run.state.copy()))
            arguments = (
                rhs, self.stages, self.a, self.c, self.error, self.dense,
                self.error_order, t_end, clock, counts, run.rtol, run.atol, run.state, system.directions, k, scratch,
                np.minimum(sample_times[mine] - begin, t_end), run.samples[first : first + np.count_nonzero(mine)],
                STEPS_PER_CALL, inputs, numbers, table, guards, ranges, floors,
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
                        break
                    crossed = int(counts[stepper.GUARD_INDEX])
                    held = numbers.copy()
                    if system.switch.cross(crossed, run.state, numbers, floors, guards_at):
                        status, fresh = stepper.PAUSED, True
                        if not np.array_equal(held, numbers):
                            run.switched.append((begin + float(clock[stepper.TIME]), run.state.copy()))
            run.counts += counts
            run.time, run.smallest_step = begin + float(clock[stepper.TIME]), float(clock[stepper.SMALLEST])
            step, growth = float(clock[stepper.STEP]), float(clock[stepper.GROWTH])
            if interrupted:
                return INTERRUPTED
            if stalled > MOST_STALLED:
                return STALLED
            if status == stepper.GUARD:
                return system.guards[int(counts[stepper.GUARD_INDEX])]
            if status == stepper.COLLAPSED:
                return COLLAPSED
            if status == stepper.NOT_FINITE:
                return NOT_FINITE
        return FINISHED


def _same(found: Floats, wanted: Floats) -> bool:
    return bool(found.shape == wanted.shape and np.all(abs(found - wanted) < CONSISTENT))


def _enter(
    run: Run, slope: Floats, guards: Floats, floors: Floats, clock: Floats, counts: NDArray[np.int64], t_end: float
) -> int:
    """Whether the run goes on, with the slope and the guards where it stands; a first step if it has none."""
    from towercrane.simulation import stepper
    from towercrane.simulation.methods.step_size import first_step

    counts[EVALUATIONS] += 1
    if not np.all(np.isfinite(slope)):
        return stepper.NOT_FINITE
    if len(fallen := np.flatnonzero(guards < floors)):
        counts[stepper.GUARD_INDEX] = fallen[0]
        return stepper.GUARD
    if clock[stepper.STEP] <= 0.0:
        clock[stepper.STEP] = first_step(run.state, slope, run.rtol, run.atol, t_end)
    return stepper.PAUSED

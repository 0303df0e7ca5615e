"""Many runs of a kind of crane at once: vector lanes inside, threads on top.

Every run takes the steps that :func:`towercrane.simulation.integrate.integrate` would take for it alone, to the last
bit; what shares a lane or a thread with it changes nothing.
"""

from __future__ import annotations

import os
import threading
from concurrent.futures import ThreadPoolExecutor, wait
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from modal.compiler.lanes import LANES
from towercrane.kernels.straight.leaves import numbers_of
from towercrane.kernels.straight.written import written
from towercrane.simulation.arguments import check_times, check_tolerances
from towercrane.simulation.directions import restore_rows
from towercrane.simulation.energy_balance import NOT_CONSERVED
from towercrane.simulation.lanes.advance import advance
from towercrane.simulation.lanes.ends import record_ends
from towercrane.simulation.lanes.energy import off_balance
from towercrane.simulation.lanes.events import Events, asks, retakes
from towercrane.simulation.lanes.queue import (
    ACCEPTED,
    EVALUATIONS,
    FIRST_GUARD,
    LARGEST,
    NO_START,
    OFF_BALANCE,
    REJECTED,
    SMALLEST,
    WAITING,
    Answers,
    Queue,
    lanes_for,
)
from towercrane.simulation.lanes.queue import COLLAPSED as COLLAPSED_CODE
from towercrane.simulation.lanes.queue import FINISHED as FINISHED_CODE
from towercrane.simulation.lanes.queue import NOT_FINITE as NOT_FINITE_CODE
from towercrane.simulation.lanes.queue import STALLED as STALLED_CODE
from towercrane.simulation.methods.method import DEFAULT
from towercrane.simulation.methods.registry import pair_of
from towercrane.simulation.observed import Looked, scalars
from towercrane.simulation.outcomes import COLLAPSED, FINISHED, INTERRUPTED, NOT_FINITE, STALLED
from towercrane.simulation.system import written_of
from towercrane.simulation.trajectory import phase_of

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from towercrane.kernels.straight.written import Written
    from towercrane.simulation.lanes.run import LaneRun
    from towercrane.simulation.methods.runge_kutta import RungeKutta
    from towercrane.simulation.system import System

    Floats = NDArray[np.float64]

STEPS_PER_CALL = 2_000
"""Steps of each lane between two looks at progress and the keyboard."""

RUNS_PER_TASK = 256
"""Largest number of runs that a thread takes at a time."""


@dataclass(frozen=True, eq=False)
class LaneAnswers:
    """How many runs ended.

    Parameters
    ----------
    outcomes : list of str
        As a single run names them; "energy not conserved" where the balance is off at the end.
    end_times, smallest_steps : ndarray, shape (runs,)
        [s]
    end_states : ndarray, shape (runs, size)
    evaluations, accepted, rejected : ndarray of int, shape (runs,)
    extremes : ndarray, shape (runs, outputs, 4)
        Of each output in the order of the crane: largest value, its time,
        smallest value, its time; among the sample times and the end of a run that ended early. Not a number where
        a run was interrupted.
    series : ndarray, shape (runs or 0, samples, outputs)
        The outputs at the sample times; not a number after a run's end.
    """

    outcomes: list[str]
    end_times: Floats
    smallest_steps: Floats
    end_states: Floats
    evaluations: NDArray[np.int64]
    accepted: NDArray[np.int64]
    rejected: NDArray[np.int64]
    extremes: Floats
    series: Floats


def integrate_many(
    runs: Sequence[LaneRun],
    sample_times: Floats,
    *,
    outputs: Sequence[str] | None = None,
    method: str = DEFAULT,
    rtol: float = 1e-8,
    atol: float = 1e-10,
    threads: int | None = None,
    series: bool = False,
    progress: Callable[[int], None] | None = None,
) -> LaneAnswers:
    """Solve many runs side by side.

    Parameters
    ----------
    runs : sequence of LaneRun
        Whose equations are alike but for their numbers.
    sample_times : ndarray, shape (p,)
        Increasing times at which the outputs are looked at [s].
    outputs : sequence of str, optional
        Names of single numbers that the model shows; all by default.
    method : str
        Name of a Runge-Kutta pair.
    rtol, atol : float
        Tolerances, as in :func:`towercrane.simulation.integrate.integrate`.
    threads : int, optional
        Threads; all cores by default.
    series : bool
        Keep the outputs over time.
    progress : callable, optional
        Called with the number of runs that have ended.

    Raises
    ------
    ValueError
        If the runs cannot share lanes, or an argument is out of its range.
    """
    pair = pair_of(method)
    check_tolerances(rtol, atol)
    check_times(sample_times)
    if threads is not None and threads < 1:
        raise ValueError(f"threads: wanted one or more, got {threads!r}")
    if not runs:
        raise ValueError("runs: wanted one or more, got none")
    model, system = runs[0].model, runs[0].model.system
    if any(not run.model.system.alike(system) for run in runs):
        raise ValueError("runs: wanted the same numbers and shapes of modes in all, got different ones")
    names = scalars(model) if outputs is None else tuple(outputs)
    if unknown := set(names) - set(scalars(model)):
        raise ValueError(f"outputs: wanted some of {', '.join(scalars(model))}, got {min(unknown)!r}")
    runs = [run.cut() for run in runs]
    answers = _answers(len(runs), system, len(names), len(sample_times) if series else 0)
    workers = threads or available_cores()
    share = min(RUNS_PER_TASK, max(LANES, -(-len(runs) // (4 * workers))))
    turn, stop = pair.longest_turn(rtol), threading.Event()
    # Runs with polynomials of lower degree are padded.
    shape = max(run.phases.inputs.shape[1:] for run in runs)
    code = written_of([run.model.system for run in runs], shape)
    looked = Looked(system.equations, model.outputs, names, len(model.channels))
    seen = [numbers_of(run.model.seen) for run in runs]
    looks = written(looked, model.seen, seen, system.size, shape)
    rhs, observe = code.rhs(lanes=True), looks.rhs(lanes=True)
    if asks(runs[0]):
        # Events evaluate single states: compiled before threads ask for that at once.
        code.rhs()

    def work(first: int) -> None:
        task = slice(first, first + share)
        mine = Answers._make(array[task] for array in answers)
        queue = _queue(runs[task], mine, sample_times, atol, pair, code, looks.numbers(np.array(seen[task]).T).T)
        lanes = lanes_for(queue, len(pair.a), len(names))
        events = Events(runs[task], queue, mine, lanes, code) if queue.asks else None
        left = True
        while left and not stop.is_set():
            left = advance(
                rhs, observe, queue, mine, lanes, pair.stages, pair.a, pair.c, pair.error, pair.dense,
                pair.error_order, rtol, turn, STEPS_PER_CALL,
            )  # fmt: skip
            if events is not None:
                events.attend()
        record_ends(names, runs[task], queue, mine)
        off = off_balance(runs[task], queue, mine, rtol, atol)
        mine.outcomes[(mine.outcomes > NO_START) & off] = OFF_BALANCE

    with ThreadPoolExecutor(workers) as pool:
        futures = [pool.submit(work, first) for first in range(0, len(runs), share)]
        try:
            # A wait without end could not be interrupted everywhere.
            while wait(futures, timeout=0.1).not_done:
                if progress is not None:
                    progress(int(np.count_nonzero(answers.outcomes)))
        except KeyboardInterrupt:
            pool.shutdown(wait=False, cancel_futures=True)
        finally:
            stop.set()
        for future in futures:
            if not future.cancelled():
                future.result()
    return _told(runs, answers)


def available_cores() -> int:
    """Cores that this process may use."""
    affinity = getattr(os, "sched_getaffinity", None)
    return len(affinity(0)) if affinity is not None else os.cpu_count() or 1


def _queue(
    runs: Sequence[LaneRun], answers: Answers, sample_times: Floats, atol: float, pair: RungeKutta, code: Written,
    seen: Floats,
) -> Queue:  # fmt: skip
    """The runs' data as the compiled steps want them; runs with fewer phases are padded."""
    systems = [run.model.system for run in runs]
    starts = np.empty((len(runs), systems[0].size))
    # Runs that differ in their motions alone begin in the same state.
    found: dict[tuple[Any, ...], tuple[Floats, int]] = {}
    for number, run in enumerate(runs):
        data = run.start_inputs, run.model.system.numbers
        key = (run.begins, *(array.tobytes() for array in data))
        if key not in found:
            state, refusal = run.start()
            found[key] = state, NO_START if refusal else WAITING
        starts[number], answers.outcomes[number] = found[key]
    restore_rows(starts, systems[0].directions)
    # Those without a start end in it.
    answers.end_states[:] = starts
    most = max(len(run.phases.inputs) for run in runs)
    times = np.full((len(runs), most + 1), np.inf)
    inputs = np.zeros((len(runs), most, *code.shapes["inputs"]))
    first_samples = np.full((len(runs), most + 1), len(sample_times))
    for number, run in enumerate(runs):
        cut = run.phases
        count, _, width = cut.inputs.shape
        times[number, : count + 1] = cut.times
        inputs[number, :count, :, :width] = cut.inputs
        owner = phase_of(sample_times, cut)
        first_samples[number, : count + 1] = np.searchsorted(owner, np.arange(count + 1))
    return Queue(
        waiting=np.flatnonzero(answers.outcomes == WAITING),
        starts=starts,
        atol=atol * np.array([system.scale for system in systems]),
        longest_steps=np.array([pair.longest_step(run.model.system.fastest_in(run.phases)) for run in runs]),
        numbers=np.ascontiguousarray(code.numbers(np.array([system.numbers for system in systems]).T).T),
        floors=np.array([system.floors for system in systems]),
        seen=np.ascontiguousarray(seen),
        phase_counts=np.array([len(run.phases.inputs) for run in runs]),
        phase_times=times,
        inputs=inputs,
        first_samples=first_samples,
        sample_times=np.array(sample_times, dtype=float),
        tables=systems[0].table,
        directions=systems[0].directions,
        asks=int(asks(runs[0])),
        retakes=retakes(runs[0]),
    )


def _answers(count: int, system: System, outputs: int, samples: int) -> Answers:
    extremes = np.zeros((count, outputs, 4))
    extremes[..., LARGEST], extremes[..., SMALLEST] = -np.inf, np.inf
    return Answers(
        outcomes=np.zeros(count, dtype=np.int64),
        end_times=np.zeros(count),
        smallest_steps=np.full(count, np.inf),
        end_states=np.zeros((count, system.size)),
        counts=np.zeros((count, 4), dtype=np.int64),
        extremes=extremes,
        series=np.full((count if samples else 0, samples, outputs), np.nan),
    )


def _told(runs: Sequence[LaneRun], answers: Answers) -> LaneAnswers:
    """Outcomes by name; nothing of runs that were interrupted."""
    names = {
        WAITING: INTERRUPTED, FINISHED_CODE: FINISHED, COLLAPSED_CODE: COLLAPSED,
        NOT_FINITE_CODE: NOT_FINITE, OFF_BALANCE: NOT_CONSERVED, STALLED_CODE: STALLED,
    }  # fmt: skip
    codes = zip(runs, answers.outcomes.tolist(), strict=True)
    outcomes = [
        run.start()[1] if code == NO_START else names.get(code) or run.model.system.guards[code - FIRST_GUARD]
        for run, code in codes
    ]
    answers.extremes[answers.outcomes == WAITING] = np.nan
    counts = answers.counts
    return LaneAnswers(
        outcomes, answers.end_times, answers.smallest_steps, answers.end_states,
        counts[:, EVALUATIONS], counts[:, ACCEPTED], counts[:, REJECTED], answers.extremes, answers.series,
    )  # fmt: skip

"""From a model, its motions and a duration to a labelled result."""

from __future__ import annotations

import inspect
import json
import time
import warnings
from dataclasses import replace
from functools import wraps
from typing import TYPE_CHECKING, Any, ParamSpec

import numpy as np

from modal.checks import check_positive
from towercrane.motions.motion import Motion, phases
from towercrane.results.recording import Recording
from towercrane.results.versions import versions
from towercrane.simulation import energy_balance
from towercrane.simulation.arguments import check_tolerances
from towercrane.simulation.integrate import evaluate, integrate
from towercrane.simulation.methods.method import DEFAULT, EnergyDriftWarning
from towercrane.simulation.methods.registry import method_of
from towercrane.simulation.outcomes import FINISHED, INTERRUPTED
from towercrane.simulation.run import Run
from towercrane.simulation.starts.begin import begin
from towercrane.simulation.starts.start import HANGING, Start
from towercrane.simulation.system import Model, NoEquilibrium, start_inputs
from towercrane.simulation.trajectory import Trajectory

if TYPE_CHECKING:
    from collections.abc import Callable

    import xarray as xr

    from towercrane.simulation.trajectory import Progress

Arguments = ParamSpec("Arguments")

LOOK = 0.05
"""Time between two looks at a case's run, however far apart its rows are [s]."""

MOST_LOOKS = 200_000
"""Looks at a run whose rows are fewer; beyond them memory runs short, and it is looked at less often."""


def record(
    model: Model,
    motions: dict[str, Motion],
    duration: float,
    *,
    output_step: float = 0.05,
    start: Start = HANGING,
    method: str = DEFAULT,
    rtol: float = 1e-8,
    atol: float = 1e-10,
    split: bool = True,
    progress: Progress | None = None,
    looks: int = 1,
) -> Run:
    """Simulate a crane: a `Run`, from :func:`simulate` an `xarray.Dataset`.

    Parameters
    ----------
    model : Model
        The crane, such as a :class:`towercrane.cranes.tower.model.FlexibleModel`.
    motions : dict of str to Motion
        One for each of the model's channels, such as "trolley" and "rope" [m].
    duration : float
        Simulated time [s].
    output_step : float
        Time between two rows of the result [s].
    start : Start
        By default at rest, where a wind blows in its mean.
    method, rtol, atol, split, progress
        As in :func:`towercrane.simulation.integrate.integrate`.
    looks : int
        Times per row at which a `Recording` has the outputs, see :func:`looks_per_row`; a data set has the rows only.

    Returns
    -------
    Run, xarray.Dataset
        Variables over ``time`` with units; the attribute ``outcome`` is "finished" or names what ended the run,
        with ``end_time`` [s]. Rows of an outcome "energy not conserved" end where the balance is off, see
        :mod:`towercrane.simulation.energy_balance`.

    Raises
    ------
    ValueError
        If an argument is out of its range, or the method feeds free vibration at these tolerances.

    Warns
    -----
    EnergyDriftWarning
        If a free vibration would gain or lose more than one per cent of its energy in 600 s.
    """
    check_positive("output_step", output_step)
    check_positive("duration", duration)
    if output_step > duration:
        raise ValueError(f"output_step, duration: wanted 0 < step <= duration, got {output_step}, {duration}")
    check_tolerances(rtol, atol)
    solver = method_of(method)
    if reason := solver.refusal(rtol, atol):
        raise ValueError(f"rtol, atol: {reason}, got {rtol:g}, {atol:g}")
    if said := solver.notice(rtol, atol):
        warnings.warn(said, EnergyDriftWarning, stacklevel=3)
    began = time.perf_counter()
    cut = phases(tuple(_motion(motions, channel) for channel in model.channels), duration)
    lengths = np.append(cut.inputs, cut.after[None], axis=0)[:, [name == "rope" for name in model.channels], 0]
    if (shortest := float(lengths.min(initial=np.inf))) <= 0.0:
        raise ValueError(f"motions: wanted a rope longer than 0 m, got {shortest:g} m")
    sample_times = rows_of(duration, output_step, looks)
    message, inputs = "", start_inputs(model, motions, cut.inputs[0])
    if hasattr(model, "standing"):
        model = model.standing(inputs)
    try:
        began_at = begin(model, inputs, start)
    except NoEquilibrium as failure:
        message = str(failure)
        run = _nothing(begin(model, inputs, replace(start, state="zero")), failure.outcome)
    else:
        run = integrate(
            model.system, cut, began_at, sample_times,
            method=method, rtol=rtol, atol=atol, split=split, progress=progress,
        )  # fmt: skip
    times, states = run.times, run.states
    if run.outcome != FINISHED and (len(times) == 0 or times[-1] < run.end_time):
        # What ended the run shows in its last row.
        times, states = np.append(times, run.end_time), np.vstack([states, run.end_state])
    slopes, guards = evaluate(model.system, cut, times, states)
    quantities, about = model.observe(motions, times, states, slopes, guards), model.provenance()
    outcome, end_time, end_state = run.outcome, run.end_time, run.end_state
    # A linear model keeps no account of its energy.
    if outcome != INTERRUPTED and "total_energy" in quantities:
        values = {name: quantity.values for name, quantity in quantities.items()}
        weight = about["payload_mass"] * about["gravity"]
        row, off = energy_balance.first_off(values, weight, run.accepted, rtol, atol)
        if off:
            # Whatever a guard says of such a state is no news of the crane.
            outcome, message = energy_balance.NOT_CONSERVED, off
            end_time, end_state = float(times[row]), states[row]
            times = times[: row + 1]
            quantities = {name: replace(q, values=q.values[: row + 1]) for name, q in quantities.items()}
    provenance = {
        **about,
        "outcome": outcome,
        "message": message,
        "end_time": end_time,
        "end_state": end_state,
        "time_before": start.time,
        "output_step": output_step,
        "method": method,
        "rtol": rtol,
        "atol": atol,
        "evaluations": run.evaluations,
        "steps_accepted": run.accepted,
        "steps_rejected": run.rejected,
        "smallest_step": run.smallest_step if np.isfinite(run.smallest_step) else 0.0,
        "solver_cpu_seconds": run.cpu_seconds,
        "solver_wall_seconds": run.wall_seconds,
        "wall_seconds": time.perf_counter() - began,
        "versions": json.dumps(versions()),
    }
    switches = None
    if len(run.switch_times):
        limits = evaluate(model.system, cut, run.switch_times, run.switch_states)
        seen = model.observe(motions, run.switch_times, run.switch_states, *limits)
        switches = Recording(run.switch_times, seen, provenance)
    states = states[: len(times)]
    return Run(times, quantities, provenance, looks, model=model, motions=motions, states=states, switches=switches)


def _motion(motions: dict[str, Motion], channel: str) -> Motion:
    """What drives a channel."""
    found = motions.get(channel)
    if not isinstance(found, Motion):
        raise ValueError(f"motions: wanted a Motion for {channel!r}, got {found!r}")
    return found


def labelled(name: str, recorded: Callable[Arguments, Run]) -> Callable[Arguments, xr.Dataset]:
    """The same simulation, under its own name, with a labelled data set as its result."""

    @wraps(recorded)
    def rows(*args: Arguments.args, **kwargs: Arguments.kwargs) -> xr.Dataset:
        return recorded(*args, **kwargs).rows.dataset()

    rows.__name__ = rows.__qualname__ = name
    returns = inspect.signature(recorded).replace(return_annotation="xr.Dataset")
    rows.__signature__ = returns  # type: ignore[attr-defined]
    return rows


simulate = labelled("simulate", record)


def rows_of(duration: float, output_step: float, looks: int = 1) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Times of a result's rows [s], or of so many looks per row, every ``looks``-th of them a row; shape (times,)."""
    count = int(np.floor(duration / output_step * looks * (1.0 + 1e-12))) + 1
    return np.asarray(np.minimum(np.arange(count) / looks * output_step, duration))


def looks_per_row(duration: float, output_step: float) -> int:
    """Looks per row that leave at most `LOOK` between two, or that make `MOST_LOOKS` of a long run."""
    wanted = int(np.ceil(output_step / LOOK * (1.0 - 1e-12)))
    return max(1, min(wanted, int(MOST_LOOKS * output_step / duration)))


def _nothing(start: np.ndarray[Any, np.dtype[np.float64]], outcome: str) -> Trajectory:
    """Run that ended before its first step."""
    none = np.empty(0), np.empty((0, len(start)))
    return Trajectory(np.zeros(1), start[None], outcome, 0.0, start, 0, 0, 0, np.inf, 0.0, 0.0, *none)

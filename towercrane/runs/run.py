"""The run of a case: its model and solver, as it states them or chosen for an error, and what is known of it."""

from __future__ import annotations

import json
import warnings
from typing import TYPE_CHECKING

from towercrane.cases.assumptions import as_attribute, rests_on
from towercrane.cases.models import model_of, motions_of, targets_of
from towercrane.cases.result_case import start_of
from towercrane.cases.table_notices import table_notices
from towercrane.cases.wind_file import rises_until
from towercrane.cranes.registry import KINDS
from towercrane.simulation.methods.method import EnergyDriftWarning
from towercrane.simulation.simulate import labelled, looks_per_row, record
from towercrane.simulation.starts.end import end_of
from towercrane.simulation.system import NoEquilibrium

if TYPE_CHECKING:
    from towercrane.cases.case import Case
    from towercrane.motions.motion import Motion
    from towercrane.simulation.run import Run
    from towercrane.simulation.system import Model
    from towercrane.simulation.trajectory import Progress


def record_case(
    case: Case,
    *,
    model: Model | None = None,
    motions: dict[str, Motion] | None = None,
    progress: Progress | None = None,
) -> Run:
    """Simulate a case: a `Run`, from :func:`run_case` an `xarray.Dataset`.

    Text and assumed values go into the result's attributes.
    Where the case asks for an error, model and solver are chosen by it, and the attribute ``accuracy`` says how.

    Parameters
    ----------
    case : Case
    model : Model, optional
        Another one of its crane.
    motions : dict of str to Motion, optional
        Those of the case, where they have been built.
    progress : callable, optional
        As in :func:`towercrane.simulation.integrate.integrate`.
    """
    with warnings.catch_warnings():
        # The summary says it.
        warnings.simplefilter("ignore", EnergyDriftWarning)
        result = _to_target(case, progress) if model is None else None
        result = result or _as_stated(case, model, motions, progress)
    result.attrs["title"] = case.title
    result.attrs["case"] = case.name
    result.attrs["evaluated_from"] = rises_until(case.checked)
    result.attrs["changes"] = json.dumps(case.changes)
    result.attrs["case_text"] = json.dumps(case.as_written)
    said = KINDS[case.kind].notices
    # What another run needs to go on from here.
    before, until = result.attrs["time_before"], result.attrs["end_time"]
    end = end_of(result.model, result.motions, until) | {"time": before + until}
    result.attrs["end"] = json.dumps(end)
    goes_on = [f"goes on from {case.start.from_} after {before:g} s: the clock is set back, the work is not"]
    notices = [*table_notices(case), *(goes_on if case.start.from_ else [])]
    result.attrs["notices"] = json.dumps([*notices, *(said(case.checked, result.model) if said else ())])
    result.attrs["assumed"] = as_attribute(rests_on(case))
    return result


def _to_target(case: Case, progress: Progress | None) -> Run | None:
    """The run of a case that asks for an error; None for one that does not."""
    if not targets_of(case):
        return None
    from towercrane.accuracy.promise import chosen, promise

    try:
        choice, result = chosen(case, progress)
    except NoEquilibrium:
        # Nothing can be chosen for a tower that its weight buckles; the run says so at its start.
        return _as_stated(case, model_of(case, weight_softening=True), None, progress)
    result.attrs["accuracy"] = json.dumps(promise(case, choice, result))
    return result


def _as_stated(case: Case, model: Model | None, motions: dict[str, Motion] | None, progress: Progress | None) -> Run:
    """The run of a case with the solver that it states."""
    if model is None:
        model = model_of(case)
        motions = motions_of(case, model)
    motions = motions or motions_of(case, model)
    start = start_of(case, model, motions)
    return record(
        model,
        motions,
        case.run.duration,
        output_step=case.run.output_step,
        looks=looks_per_row(case.run.duration, case.run.output_step),
        start=start,
        method=case.solver.method,
        rtol=case.solver.rtol,
        atol=case.solver.atol,
        progress=progress,
    )


run_case = labelled("run_case", record_case)

"""The run of a case: its model and solver, as it states them or chosen for an error, and what is known of it."""

from __future__ import annotations

import json
import warnings
from typing import TYPE_CHECKING

from towercrane.accuracy.promise import chosen, promise, targets_of
from towercrane.cases.assumptions import as_attribute, rests_on
from towercrane.cases.models import model_of, motions_of
from towercrane.cases.table_notices import table_notices
from towercrane.simulation.methods.method import EnergyDriftWarning
from towercrane.simulation.simulate import labelled, looks_per_row, record
from towercrane.simulation.system import NoEquilibrium

if TYPE_CHECKING:
    from towercrane.cases.case import Case
    from towercrane.results.recording import Recording
    from towercrane.simulation.system import Model
    from towercrane.simulation.trajectory import Progress


def record_case(case: Case, *, model: Model | None = None, progress: Progress | None = None) -> Recording:
    """Simulate a case, or another model of its crane: a `Recording`, from :func:`run_case` an `xarray.Dataset`.

    Text and assumed values go into the result's attributes.
    Where the case asks for an error, model and solver are chosen by it, and the attribute ``accuracy`` says how.
    """
    with warnings.catch_warnings():
        # The summary says it.
        warnings.simplefilter("ignore", EnergyDriftWarning)
        found = None
        if model is None:
            try:
                found = _to_target(case, progress)
            except NoEquilibrium:
                # Nothing can be chosen for a tower that its weight buckles; the run says so at its start.
                model = model_of(case, weight_softening=True)
        result = found or record(
            model_of(case) if model is None else model,
            motions_of(case),
            case.run.duration,
            output_step=case.run.output_step,
            looks=looks_per_row(case.run.duration, case.run.output_step),
            state="equilibrium" if case.start.state == "equilibrium" else "zero",
            swing_angle=case.start.swing_angle,
            method=case.solver.method,
            rtol=case.solver.rtol,
            atol=case.solver.atol,
            progress=progress,
        )
    result.attrs["title"] = case.title
    result.attrs["case"] = case.name
    result.attrs["changes"] = json.dumps(case.changes)
    result.attrs["case_text"] = json.dumps(case.as_written)
    result.attrs["notices"] = json.dumps(table_notices(case))
    result.attrs["assumed"] = as_attribute(rests_on(case))
    return result


def _to_target(case: Case, progress: Progress | None) -> Recording | None:
    """The run of a case that asks for an error; None for one that does not."""
    if not targets_of(case):
        return None
    choice, result = chosen(case, progress)
    result.attrs["accuracy"] = json.dumps(promise(case, choice, result))
    return result


run_case = labelled("run_case", record_case)

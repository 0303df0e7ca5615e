"""What the runs of a sweep come to: extremes of their outputs, run by run, as a labelled data set."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cases.assumptions import as_notes, left_out, rests_on
from towercrane.cases.kinds import unit_of
from towercrane.cases.models import targets_of
from towercrane.results.versions import versions
from towercrane.simulation.methods.registry import method_of
from towercrane.simulation.outcomes import INTERRUPTED

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import xarray as xr
    from numpy.typing import NDArray

    from towercrane.cases.case import Case
    from towercrane.schema.faults import CaseError

    Floats = NDArray[np.float64]
    Value = float | int | str

BAD_INPUT = "bad input"
"""Outcome of a run that a single run would refuse; the variable ``fault`` says why."""

EXTREMES = ("max", "max_time", "min", "min_time")
"""What is kept of every output, as endings of names."""


@dataclass(eq=False)
class Found:
    """What the runs came to, by the number of the run where it is known.

    Parameters
    ----------
    count : int
        Number of runs.
    outputs : dict of str to (str, str)
        Units and long names; of cranes of all kinds together.
    rows : dict of int to tuple
        Outcome, end time [s], evaluations and the extremes of each output by name.
    series : dict of int to ndarray, shape (rows, outputs)
    promises : dict of int to str
        Outcomes of the errors asked for.
    faults : dict of int to CaseError
        Why a run cannot be.
    cranes, assumed, notices, solvers : dict
        Without repetition, in the order met: names, values that no source gives, what is to be said, and method and
        tolerances.
    times : ndarray
        Those of the series [s].
    """

    count: int
    outputs: dict[str, tuple[str, str]] = field(default_factory=dict)
    rows: dict[int, tuple[str, float, int, dict[str, Any]]] = field(default_factory=dict)
    series: dict[int, Floats] = field(default_factory=dict)
    promises: dict[int, str] = field(default_factory=dict)
    faults: dict[int, CaseError] = field(default_factory=dict)
    cranes: dict[str, None] = field(default_factory=dict)
    assumed: dict[tuple[str, str, str], None] = field(default_factory=dict)
    notices: dict[str, None] = field(default_factory=dict)
    solvers: dict[tuple[str, float, float], None] = field(default_factory=dict)
    times: Floats = field(default_factory=lambda: np.empty(0))

    def met(self, case: Case) -> None:
        """Note what a run of this case rests on."""
        solver = case.solver
        self.cranes[case.crane.name] = None
        self.assumed |= dict.fromkeys(as_notes(rests_on(case)))
        self.notices |= dict.fromkeys(left_out(case))
        if not targets_of(case):
            self.solvers[solver.method, solver.rtol, solver.atol] = None
            if said := method_of(solver.method).notice(solver.rtol, solver.atol):
                self.notices[said] = None


def _in_one_line(refused: CaseError) -> str:
    """What is wrong with a case, for a cell of a table."""
    faults = []
    for f in refused.faults:
        place, hint = f"{f.file}: {f.key}" if f.key else f.file, f"; {f.hint}" if f.hint else ""
        faults.append(f"{place}: wanted {f.wanted}, got {f.got}{hint}")
    return " | ".join(faults)


def dataset(case: Case, values: Mapping[str, Sequence[Value]], found: Found) -> xr.Dataset:
    """Labelled data set over the runs."""
    import xarray as xr

    count = found.count
    nothing: tuple[str, float, int, dict[str, Any]] = (INTERRUPTED, np.nan, 0, {})
    rows = [
        (BAD_INPUT, np.nan, 0, {}) if run in found.faults else found.rows.get(run, nothing) for run in range(count)
    ]
    outcomes, end_times, evaluations, extremes = zip(*rows, strict=True)

    def texts(of_runs: Mapping[int, str], long_name: str) -> Any:
        return "run", np.array([of_runs.get(run, "") for run in range(count)], dtype=object), {"long_name": long_name}

    variables: dict[str, Any] = {
        "outcome": texts(dict(enumerate(outcomes)), "how the run ended"),
        "end_time": ("run", np.array(end_times), {"units": "s", "long_name": "time at which the run ended"}),
        "evaluations": ("run", np.array(evaluations), {"units": "1", "long_name": "right-hand sides"}),
    }
    if found.faults:
        faults = {run: _in_one_line(refused) for run, refused in found.faults.items()}
        variables["fault"] = texts(faults, "why the run cannot be")
    if found.promises:
        variables["accuracy"] = texts(found.promises, "whether the error asked for is promised")
    unknown = np.full(len(EXTREMES), np.nan)
    for name, (units, words) in found.outputs.items():
        columns = np.array([of_run.get(name, unknown) for of_run in extremes])
        for column, ending in zip(columns.T, EXTREMES, strict=True):
            extreme = "largest" if ending.startswith("max") else "smallest"
            about = {"units": units, "long_name": f"{extreme} {words}"}
            if ending.endswith("time"):
                about = {"units": "s", "long_name": f"time of the {extreme} {words}"}
            variables[f"{name}_{ending}"] = ("run", column, about)
    coordinates: dict[str, Any] = {"run": ("run", np.arange(1, count + 1))}
    if found.series:
        coordinates["time"] = ("time", found.times, {"units": "s"})
        unknown = np.full((len(found.times), len(found.outputs)), np.nan)
        whole = np.array([found.series.get(run, unknown) for run in range(count)])
        for number, (name, (units, words)) in enumerate(found.outputs.items()):
            # A varied value may have the name of an output, such as the length of the rope.
            taken = name in {key.replace(".", "_") for key in values}
            series = "run", "time"
            about = {"units": units, "long_name": words}
            variables[f"{name}_over_time" if taken else name] = (series, whole[..., number], about)
    for key, given in values.items():
        unit = unit_of(case.kind, key)
        about = {"key": key, "units": unit or "1", "long_name": key.replace(".", " ").replace("_", " ")}
        coordinates[key.replace(".", "_")] = ("run", np.array(given), about)
    attributes: dict[str, Any] = {
        "title": case.title,
        "case": case.name,
        "crane": ", ".join(found.cranes),
        "changes": json.dumps(case.changes),
        "varied": json.dumps(list(values)),
        "outputs": json.dumps(list(found.outputs)),
        "assumed": json.dumps([list(entry) for entry in found.assumed]),
        "notices": json.dumps(list(found.notices)),
        "versions": json.dumps(versions()),
    }
    if len(found.solvers) == 1 and not found.promises:
        attributes |= dict(zip(("method", "rtol", "atol"), next(iter(found.solvers)), strict=True))
    return xr.Dataset(variables, coordinates, attributes)

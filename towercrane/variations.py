"""Many runs of one case in which some of its values vary: extremes of the outputs, run by run.

Cranes in radial motion run side by side in vector lanes, all others one after the other; the answer is the same.
"""

from __future__ import annotations

import dataclasses
import itertools
import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.case import load_case
from towercrane.integrate import INTERRUPTED
from towercrane.kinds import unit_of
from towercrane.models import radial_model
from towercrane.motion import Phases, phases
from towercrane.simulate import record_case, rows_of, versions
from towercrane.summary import accuracy, peaks
from towercrane.tableaus import TABLEAUS
from towercrane.units import UnitError, to_si

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    import xarray as xr
    from numpy.typing import NDArray

    from towercrane.case import Case
    from towercrane.lanes import LaneRun

    Floats = NDArray[np.float64]
    Value = float | int | str
    Progress = Callable[[int], None]

LOAD, ROPE = "payload.mass", "rope.length"
"""Keys whose every value needs no reading of the case: it is read with the smallest and the largest of them."""

EXTREMES = ("max", "max_time", "min", "min_time")
"""What is kept of every output, as endings of names."""

RADIAL_OUTPUTS = {
    "tower_tip_displacement": ("m", "horizontal displacement of the tower top, positive outward"),
    "jib_tip_deflection": ("m", "deflection of the jib tip from the tilted straight jib, positive up"),
    "swing_angle": ("rad", "swing of the rope from the vertical in the jib's plane, positive outward"),
    "rope_tension": ("N", "rope tension"),
}
"""Outputs of a crane in radial motion: units and long names."""


@dataclass(frozen=True, eq=False)
class _Extremes:
    """Outcomes and extremes of all runs; ``values`` has the shape (runs, outputs, 4).

    ``promises`` are the outcomes of the errors asked for, None where none was.
    """

    outputs: dict[str, tuple[str, str]]
    outcomes: list[str]
    end_times: Floats
    evaluations: NDArray[np.int64]
    values: Floats
    series: Floats | None = None
    promises: list[str] | None = None


def grid(vary: Mapping[str, Sequence[Value]]) -> dict[str, list[Value]]:
    """All combinations of the keys' values, the last key changing fastest."""
    combinations = list(itertools.product(*vary.values()))
    return {key: [combination[i] for combination in combinations] for i, key in enumerate(vary)}


def sweep(
    case: Case | str,
    vary: Mapping[str, Sequence[Value] | Floats],
    *,
    threads: int | None = None,
    series: bool = False,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Run a case many times with varied values.

    Parameters
    ----------
    case : Case or str
        Case, or what :func:`towercrane.load_case` takes.
    vary : mapping of str to sequence
        For each key of the case file as many values as there are runs: numbers in SI, or text with units. For all
        combinations of a few values see :func:`grid`.
    threads : int, optional
        Threads for cranes in radial motion; all cores by default.
    series : bool
        Keep the outputs over time as well; for cranes in radial motion.
    progress : callable, optional
        Called with the number of runs that have ended.

    Returns
    -------
    xarray.Dataset
        Over ``run``: the varied values as coordinates, ``outcome``, ``end_time``, ``evaluations``, and of every
        output ``<output>_max``, ``_max_time``, ``_min`` and ``_min_time`` among the rows of a single run. After
        Ctrl-C the runs that had not ended are "interrupted", and nothing is known of them.

    Raises
    ------
    CaseError
        If a key or value does not fit the case.
    ValueError
        If the values are not equally many, or series are wanted that cannot be kept.
    """
    if threads is not None and threads < 1:
        raise ValueError(f"threads: wanted one or more, got {threads!r}")
    loaded = load_case(case) if isinstance(case, str) else case
    values = _read(loaded, vary)
    runs = _variants(loaded, values)
    in_lanes = all(_fits_lanes(variant) for variant, _ in runs)
    if series and not in_lanes:
        raise ValueError("series: wanted a crane in radial motion and a compiled method, got another; see run_case")
    found = _side_by_side(runs, threads, series, progress) if in_lanes else _one_by_one(loaded, values, progress)
    return _dataset(loaded, values, found, runs[0][0])


def _read(case: Case, vary: Mapping[str, Sequence[Value] | Floats]) -> dict[str, list[Value]]:
    """The varied values in SI, all keys known."""
    counts = {key: len(given) for key, given in vary.items()}
    if not counts or len(set(counts.values())) != 1 or 0 in counts.values():
        raise ValueError(f"vary: wanted keys with equally many values, one or more, got {counts}")
    values: dict[str, list[Value]] = {}
    for key, given in vary.items():
        # The first value tells whether the key exists; the message is the case's own.
        plain = [value.item() if isinstance(value, np.generic) else value for value in given]
        load_case(case.path, [*case.changes, _change(key, plain[0])])
        unit = unit_of(case.kind, key)
        values[key] = plain if unit is None else [_in_si(case, key, value, unit) for value in plain]
    return values


def _in_si(case: Case, key: str, value: Value, unit: str) -> float:
    try:
        return to_si(value, unit)
    except UnitError:
        load_case(case.path, [*case.changes, _change(key, value)])
        raise


def _change(key: str, value: Value) -> str:
    """Override that sets a key."""
    return f"{key}={value if isinstance(value, str) else json.dumps(value)}"


def _changes(values: dict[str, list[Value]], run: int, keys: Sequence[str]) -> list[str]:
    return [_change(key, values[key][run]) for key in keys]


def _variants(case: Case, values: dict[str, list[Value]]) -> list[tuple[Case, dict[str, float]]]:
    """For every run the case with all but the quick keys set, and the values of those."""
    # A rope that is hauled begins its motion at its length: then the motion has to be made anew.
    quick = [key for key in (LOAD, ROPE) if key in values and case.kind == "radial" and not _hauls(case)]
    slow = [key for key in values if key not in quick]
    cases: dict[tuple[Value, ...], Case] = {}
    variants = []
    for run in range(len(next(iter(values.values())))):
        combination = tuple(values[key][run] for key in slow)
        if combination not in cases:
            cases[combination] = load_case(case.path, [*case.changes, *_changes(values, run, slow)])
        variants.append((cases[combination], {key: float(values[key][run]) for key in quick}))
    # Plausible values of these keys are those between two bounds.
    for bounds in itertools.product(*((min(values[key]), max(values[key])) for key in quick)):
        settings = [_change(key, bound) for key, bound in zip(quick, bounds, strict=True)]
        load_case(case.path, [*case.changes, *_changes(values, 0, slow), *settings])
    return variants


def _hauls(case: Case) -> bool:
    low, high = case.rope_motion().range(1)
    return low != 0.0 or high != 0.0


def _fits_lanes(case: Case) -> bool:
    """Whether a run can share lanes; one that chooses its own model and tolerance for an error cannot."""
    return case.kind == "radial" and case.solver.method in TABLEAUS and not case.accuracy.targets


def _side_by_side(
    runs: list[tuple[Case, dict[str, float]]],
    threads: int | None,
    series: bool,
    progress: Progress | None,
) -> _Extremes:
    """Run in vector lanes, those together that can share them."""
    from towercrane.lanes import LaneAnswers, LaneRun, integrate_many

    groups: dict[tuple[Any, ...], list[int]] = {}
    for number, (case, _) in enumerate(runs):
        groups.setdefault(_company(case), []).append(number)
    if series and len({key[:2] for key in groups}) > 1:
        raise ValueError("series: wanted the same duration and output step in all runs, got different ones")
    lane_runs = _lane_runs(runs, LaneRun)
    count, outputs = len(runs), len(RADIAL_OUTPUTS)
    outcomes, ended = [INTERRUPTED] * count, 0
    end_times, evaluations = np.full(count, np.nan), np.zeros(count, dtype=np.int64)
    extremes = np.full((count, outputs, 4), np.nan)
    kept: list[tuple[list[int], Floats]] = []
    for (duration, output_step, method, rtol, atol, *_), members in groups.items():
        found: LaneAnswers = integrate_many(
            [lane_runs[i] for i in members], rows_of(duration, output_step), method=method, rtol=rtol, atol=atol,
            threads=threads, series=series,
            progress=_counted(progress, ended),
        )  # fmt: skip
        for place, number in enumerate(members):
            outcomes[number] = found.outcomes[place]
        end_times[members], evaluations[members] = found.end_times, found.evaluations
        extremes[members] = found.extremes
        kept.append((members, found.series))
        ended += len(members)
        if INTERRUPTED in found.outcomes:
            break
    whole = None
    if series:
        whole = np.full((count, kept[0][1].shape[1], outputs), np.nan)
        for members, part in kept:
            whole[members] = part
    return _Extremes(RADIAL_OUTPUTS, outcomes, end_times, evaluations, extremes, whole)


def _counted(progress: Progress | None, before: int) -> Progress | None:
    """Progress of a group of runs after others."""
    return None if progress is None else lambda done: progress(before + done)


def _company(case: Case) -> tuple[Any, ...]:
    """What runs that share lanes have in common."""
    run, solver, jib = case.run, case.solver, case.jib_beam()
    modes = (case.model.tower_modes, case.model.jib_modes)
    return (
        run.duration, run.output_step, solver.method, solver.rtol, solver.atol, *modes,
        jib.length, jib.mass_per_length,
    )  # fmt: skip


def _lane_runs(runs: list[tuple[Case, dict[str, float]]], lane_run: type[LaneRun]) -> list[LaneRun]:
    """Models and motions of every run; what does not depend on load and rope is made once per case."""
    models: dict[Case, Any] = {}
    made = []
    for case, quick in runs:
        if case not in models:
            models[case] = (
                radial_model(case),
                phases((case.trolley_motion(), case.rope_motion()), case.run.duration),
            )
        model, cut = models[case]
        if LOAD in quick:
            model = model.with_load(dataclasses.replace(model.load, mass=quick[LOAD]))
        if ROPE in quick:
            inputs = cut.inputs.copy()
            inputs[:, 1, 0] = quick[ROPE]
            cut = Phases(cut.times, inputs)
        state = "equilibrium" if case.start.state == "equilibrium" else "zero"
        made.append(lane_run(model, cut, state, case.start.swing_angle))
    return made


def _one_by_one(case: Case, values: dict[str, list[Value]], progress: Progress | None) -> _Extremes:
    """Run one after the other."""
    count = len(next(iter(values.values())))
    outputs: dict[str, tuple[str, str]] = dict(RADIAL_OUTPUTS) if case.kind == "radial" else {}
    outcomes, end_times = [INTERRUPTED] * count, np.full(count, np.nan)
    evaluations, rows = np.zeros(count, dtype=np.int64), {}
    promises = [""] * count
    for run in range(count):
        try:
            result = record_case(load_case(case.path, [*case.changes, *_changes(values, run, list(values))]))
        except KeyboardInterrupt:
            break
        if result.attrs["outcome"] == INTERRUPTED:
            break
        found = peaks(result)
        for name in [] if outputs else found:
            outputs[name] = (result[name].attrs["units"], result[name].attrs["long_name"])
        outcomes[run], end_times[run] = result.attrs["outcome"], result.attrs["end_time"]
        evaluations[run] = result.attrs["evaluations"]
        promises[run] = (accuracy(result) or {"outcome": ""})["outcome"]
        ways = ("maximum", "maximum_time_s", "minimum", "minimum_time_s")
        rows[run] = [[found[name][way] for way in ways] for name in outputs]
        if progress is not None:
            progress(run + 1)
    extremes = np.full((count, len(outputs), 4), np.nan)
    for run, row in rows.items():
        extremes[run] = row
    return _Extremes(outputs, outcomes, end_times, evaluations, extremes, None, promises if any(promises) else None)


def _dataset(case: Case, values: dict[str, list[Value]], found: _Extremes, first: Case) -> xr.Dataset:
    """Labelled data set over the runs."""
    import xarray as xr

    variables: dict[str, Any] = {
        "outcome": ("run", np.array(found.outcomes, dtype=object), {"long_name": "how the run ended"}),
        "end_time": ("run", found.end_times, {"units": "s", "long_name": "time at which the run ended"}),
        "evaluations": ("run", found.evaluations, {"units": "1", "long_name": "right-hand sides"}),
    }
    if found.promises is not None:
        about = {"long_name": "whether the error asked for is promised"}
        variables["accuracy"] = ("run", np.array(found.promises, dtype=object), about)
    for number, (name, (units, words)) in enumerate(found.outputs.items()):
        for column, ending in enumerate(EXTREMES):
            kind = "largest" if ending.startswith("max") else "smallest"
            about = {"units": units, "long_name": f"{kind} {words}"}
            if ending.endswith("time"):
                about = {"units": "s", "long_name": f"time of the {kind} {words}"}
            variables[f"{name}_{ending}"] = ("run", found.values[:, number, column], about)
    coordinates: dict[str, Any] = {"run": ("run", np.arange(1, len(found.outcomes) + 1))}
    if found.series is not None:
        coordinates["time"] = ("time", rows_of(first.run.duration, first.run.output_step), {"units": "s"})
        for number, (name, (units, words)) in enumerate(found.outputs.items()):
            variables[name] = (("run", "time"), found.series[..., number], {"units": units, "long_name": words})
    for key, given in values.items():
        unit = unit_of(case.kind, key)
        about = {"key": key, "units": unit or "1", "long_name": key.replace(".", " ").replace("_", " ")}
        coordinates[key.replace(".", "_")] = ("run", np.array(given), about)
    rests_on = [a for a in case.rests_on if a.key not in values]
    attributes: dict[str, Any] = {
        "title": case.title,
        "case": case.name,
        "crane": case.crane.name,
        "changes": json.dumps(case.changes),
        "varied": json.dumps(list(values)),
        "outputs": json.dumps(list(found.outputs)),
        "assumed": json.dumps([[a.key, str(a.value), a.why] for a in rests_on]),
        "versions": json.dumps(versions()),
    }
    if found.promises is None:
        solver = case.solver
        attributes |= {"method": solver.method, "rtol": solver.rtol, "atol": solver.atol}
    return xr.Dataset(variables, coordinates, attributes)

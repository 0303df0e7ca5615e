"""Many runs of one case in which some of its values vary: extremes of the outputs, run by run.

Runs go side by side in vector lanes, but for those that choose their model for an error that is asked for or whose
solver is SciPy's: these run one after the other. The answer is the same.
"""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cases.case import Case, load_case
from towercrane.cases.kinds import knows, unit_of
from towercrane.cranes.registry import KINDS
from towercrane.runs.run import record_case
from towercrane.runs.summary import accuracy, peaks
from towercrane.runs.sweep_data import Found, dataset
from towercrane.runs.variants import Variant, Variants, change, varied_case
from towercrane.schema.faults import CaseError
from towercrane.schema.units import UnitError, to_si
from towercrane.simulation.observed import scalars
from towercrane.simulation.outcomes import INTERRUPTED
from towercrane.simulation.simulate import looks_per_row, rows_of

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Mapping, Sequence

    import xarray as xr
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Value = float | int | str
    Progress = Callable[[int], None]


FEWEST = 8
"""Runs that must be alike to share lanes."""


class UnknownOutput(ValueError):
    """An output is asked for that a run does not show."""


def grid(vary: Mapping[str, Sequence[Value]]) -> dict[str, list[Value]]:
    """All combinations of the keys' values, the last key changing fastest."""
    combinations = list(itertools.product(*vary.values()))
    return {key: [combination[i] for combination in combinations] for i, key in enumerate(vary)}


def sweep(
    case: Case | str | os.PathLike[str],
    vary: Mapping[str, Sequence[Value] | Floats],
    *,
    outputs: Sequence[str] | None = None,
    threads: int | None = None,
    series: bool = False,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Run a case many times with varied values.

    Parameters
    ----------
    case : Case, str or path-like
        Case, or what :func:`towercrane.load_case` takes.
    vary : mapping of str to sequence
        For each key of the case file as many values as there are runs: numbers in SI, or text with units. For all
        combinations of a few values see :func:`grid`.
    outputs : sequence of str, optional
        Those that are wanted; by default all single numbers that a run shows.
    threads : int, optional
        Threads for runs in lanes; all cores by default.
    series : bool
        Keep the outputs over time as well; of runs in lanes.
    progress : callable, optional
        Called with the number of runs that have ended.

    Returns
    -------
    xarray.Dataset
        Over ``run``: the varied values as coordinates, ``outcome``, ``end_time``, ``evaluations``, and of every
        output ``<output>_max``, ``_max_time``, ``_min`` and ``_min_time`` among the looks at a single run. A run that
        a single run would refuse has the outcome "bad input", and ``fault`` says why. After Ctrl-C the runs that had
        not ended are "interrupted", and nothing is known of them.

    Raises
    ------
    CaseError
        If a key does not fit the case, a value has another unit than its key, or every run is bad input.
    ValueError
        If the values are not equally many, or series are wanted that cannot be kept.
    """
    if threads is not None and threads < 1:
        raise ValueError(f"threads: wanted one or more, got {threads!r}")
    if isinstance(outputs, str):
        raise ValueError(f"outputs: wanted names in a list, got {outputs!r}")
    given = _given(vary)
    first = {key: change(key, values[0]) for key, values in given.items()}
    loaded = case if isinstance(case, Case) else varied_case(case, (), list(first.values()))
    values = {key: _read(loaded, key, column, first) for key, column in given.items()}
    found, variants = Found(len(next(iter(values.values())))), Variants(loaded, values)
    waiting = _one_by_one(variants, found, outputs, series, progress)
    if not series:
        waiting = _in_company(variants, waiting, found, outputs, progress)
    _side_by_side(waiting, found, outputs, threads, series, progress)
    if len(found.faults) == found.count:
        raise CaseError(found.faults[0].faults)
    return dataset(loaded, values, found)


def _given(vary: Mapping[str, Sequence[Value] | Floats]) -> dict[str, list[Value]]:
    """The varied values as plain ones, equally many of each key."""
    if texts := [key for key, given in vary.items() if isinstance(given, str)]:
        raise ValueError(f"vary: wanted a list of values for {texts[0]}, got {vary[texts[0]]!r}")
    counts = {key: len(given) for key, given in vary.items()}
    if not counts or len(set(counts.values())) != 1 or 0 in counts.values():
        raise ValueError(f"vary: wanted keys with equally many values, one or more, got {counts}")
    return {
        key: [value.item() if isinstance(value, np.generic) else value for value in given]
        for key, given in vary.items()
    }


def _read(case: Case, key: str, given: list[Value], first: dict[str, str]) -> list[Value]:
    """The values of a key in SI; ``first`` are the overrides of the first run by key."""
    unit = unit_of(case.kind, key)
    if not knows(case.kind, key):
        # The message is the case's own.
        load_case(case.path, [*case.changes, *first.values()])
    return given if unit is None else [_in_si(case, key, value, unit, first) for value in given]


def _in_si(case: Case, key: str, value: Value, unit: str, first: dict[str, str]) -> float:
    """A value in SI; what is no number of a float is the fault of its run alone."""
    if isinstance(value, float) and not np.isfinite(value):
        return value
    try:
        return to_si(value, unit)
    except UnitError:
        load_case(case.path, [*case.changes, *(first | {key: change(key, value)}).values()])
        raise


def _one_by_one(
    variants: Variants, found: Found, outputs: Sequence[str] | None, series: bool, progress: Progress | None
) -> dict[tuple[Any, ...], dict[int, Variant]]:
    """Build every run and let those that fit no lanes run at once; the others by their company."""
    waiting: dict[tuple[Any, ...], dict[int, Variant]] = {}
    met: Case | None = None
    for run in range(found.count):
        try:
            variant = variants[run]
            if variant.case is not met:
                met = variant.case
                found.met(met)
            if variant.fits_lanes:
                waiting.setdefault(variant.company, {})[run] = variant
                continue
            if series:
                raise ValueError(
                    "series: wanted runs that share lanes, got one that asks for an error or has a solver of SciPy; "
                    "see run_case"
                )
            _recorded(found, run, variant, outputs)
        except CaseError as refused:
            found.faults[run] = refused
        except KeyboardInterrupt:
            return {}
        if progress is not None:
            progress(len(found.rows) + len(found.faults))
    return waiting


def _in_company(
    variants: Variants,
    waiting: dict[tuple[Any, ...], dict[int, Variant]],
    found: Found,
    outputs: Sequence[str] | None,
    progress: Progress | None,
) -> dict[tuple[Any, ...], dict[int, Variant]]:
    """Let runs of small companies run at once: lanes have code of their own to compile."""
    for members in [members for members in waiting.values() if len(members) < FEWEST]:
        try:
            for run in members:
                # Its own case: one that was altered for lanes has another's.
                _recorded(found, run, Variant(variants.case_of(run)), outputs)
                if progress is not None:
                    progress(len(found.rows) + len(found.faults))
        except KeyboardInterrupt:
            return {}
    return {company: members for company, members in waiting.items() if len(members) >= FEWEST}


def _recorded(found: Found, run: int, variant: Variant, outputs: Sequence[str] | None) -> None:
    """Record a run and keep its extremes."""
    result = record_case(variant.case, model=variant.run.model if variant.run else None)
    if result.attrs["outcome"] == INTERRUPTED:
        raise KeyboardInterrupt
    extremes = peaks(result)
    names = _names(variant.case, tuple(extremes), outputs)
    found.outputs |= {name: (result[name].attrs["units"], result[name].attrs["long_name"]) for name in names}
    ways = ("maximum", "maximum_time_s", "minimum", "minimum_time_s")
    kept = {name: [extremes[name][way] for way in ways] for name in names}
    attributes = result.attrs
    found.rows[run] = attributes["outcome"], attributes["end_time"], attributes["evaluations"], kept
    if promised := accuracy(result):
        found.promises[run] = promised["outcome"]


def _names(case: Case, known: tuple[str, ...], outputs: Sequence[str] | None) -> tuple[str, ...]:
    """The outputs that are wanted, those first that say most of a kind of crane.

    Raises
    ------
    UnknownOutput
        If one is asked for that no run of this kind of crane shows.
    """
    if outputs is not None:
        named = KINDS[case.kind].outputs
        elsewhere = named() if named else ()
        if unknown := [name for name in outputs if name not in (*known, *elsewhere)]:
            raise UnknownOutput(f"wanted some of {', '.join(known)}, got {unknown[0]!r}")
        return tuple(name for name in outputs if name in known)
    signals = KINDS[case.kind].signals
    first = [name for name in (signals.vibration, *signals.swings, "hoist_rope_force") if name in known]
    return tuple(dict.fromkeys([*first, *known]))


def _side_by_side(
    waiting: dict[tuple[Any, ...], dict[int, Variant]],
    found: Found,
    outputs: Sequence[str] | None,
    threads: int | None,
    series: bool,
    progress: Progress | None,
) -> None:
    """Run in vector lanes, those together that can share them."""
    if not waiting:
        return
    from towercrane.simulation.lanes.many import integrate_many

    if series and len({company[:2] for company in waiting}) > 1:
        raise ValueError("series: wanted the same duration and output step in all runs, got different ones")
    for (duration, output_step, risen, method, rtol, atol, *_), members in waiting.items():
        runs = [variant.run for variant in members.values() if variant.run is not None]
        about = runs[0].model.about
        names = _names(next(iter(members.values())).case, scalars(runs[0].model), outputs)
        found.outputs |= {name: (about[name].units, about[name].long_name) for name in names}
        looks = looks_per_row(duration, output_step)
        times = rows_of(duration, output_step, looks)
        found.times = times[::looks]
        if not series:
            # While turbulence rises no extremes are taken.
            times = times[np.searchsorted(times, risen) :]
        answers = integrate_many(
            runs, times, outputs=names, method=method, rtol=rtol, atol=atol, threads=threads, series=series,
            progress=_counted(progress, len(found.rows) + len(found.faults)),
        )  # fmt: skip
        for place, run in enumerate(members):
            if answers.outcomes[place] == INTERRUPTED:
                continue
            found_at = _extremes(times, answers.series[place], risen) if series and risen else answers.extremes[place]
            extremes = dict(zip(names, found_at, strict=True))
            ended = float(answers.end_times[place]), int(answers.evaluations[place])
            found.rows[run] = answers.outcomes[place], *ended, extremes
            if series:
                found.series[run] = answers.series[place][::looks]
        if INTERRUPTED in answers.outcomes:
            break


def _extremes(times: Floats, series: Floats, risen: float) -> Floats:
    """Extremes of outputs from a time on [s], or of the end of a run that ended before; shape (outputs, 4)."""
    looked = np.flatnonzero(np.isfinite(series).all(axis=1) & (times >= min(risen, times[-1])))
    looked = looked if len(looked) else np.flatnonzero(np.isfinite(series).all(axis=1))[-1:]
    high, low = looked[series[looked].argmax(axis=0)], looked[series[looked].argmin(axis=0)]
    outputs = np.arange(series.shape[1])
    return np.stack([series[high, outputs], times[high], series[low, outputs], times[low]], axis=1)


def _counted(progress: Progress | None, before: int) -> Progress | None:
    """Progress of a group of runs after others."""
    return None if progress is None else lambda done: progress(before + done)

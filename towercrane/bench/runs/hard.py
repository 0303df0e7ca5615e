"""Hard cases: each ends within its stated target or with its named outcome, and says which."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.bench.clock import short
from towercrane.cases.case import list_cases, load_case
from towercrane.cranes.registry import KINDS
from towercrane.runs.run import run_case
from towercrane.runs.summary import energy_balance, expected
from towercrane.simulation.outcomes import INTERRUPTED

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    import xarray as xr

    from towercrane.schema.fields import Expect

FOLDER = "hard/"
"""Of the shipped cases, those under this name."""

TIGHTER = 1e-2
"""Tolerances of the reference, of those of the run."""

SECOND = ("dopri5", 1e-1)
"""Method that cross-checks the reference, and its tolerance over that of the run."""

MOST_EVALUATIONS = 500_000
"""Right-hand sides of a run beyond which the second method, five times as dear, is left out."""

ROUNDING = 4e-15
"""Relative error within which the roots are wanted."""


def hard_cases(say: Callable[[str], None] = print) -> dict[str, Any]:
    """Run every hard case and every hard question to roots and finite elements.

    Returns
    -------
    dict
        A subject as in :func:`towercrane.bench.measure`, with ``met``: whether every record is.
    """
    names = [name for name, _ in list_cases() if name.startswith(FOLDER)]
    records = []
    for name in names:
        say(f"running: {name}")
        records.append(run_hard_case(name))
    records += root_records()
    return {
        "name": "hard",
        "title": "Hard cases: inside the target or ended with the outcome named for them",
        "columns": [
            "case",
            "outcome",
            "error",
            "target",
            "2nd method",
            "energy gap",
            "CPU [s]",
            "evaluations",
            "met",
        ],
        "left": 2,
        "rows": [_row(record) for record in records],
        "records": records,
        "met": all(record["met"] for record in records),
        "notes": [
            "error: against the same run with a hundredth of the tolerances; worst of load and structure, "
            "relative to how far each moves; for a run that ended early the time of its end",
            "2nd method: dopri5 with a tenth of the tolerances against that reference; '-': it takes minutes",
            "roots: the interval around each that the count of roots confirms",
        ],
    }


def run_hard_case(name: str) -> dict[str, Any]:
    """One case beside its references and what it expects."""
    case = load_case(name)
    wanted = case.expect
    if wanted is None:
        raise ValueError(f"{name}: wanted a table [expect] in a hard case, got none")
    result = run_case(case)
    if result.attrs["outcome"] == INTERRUPTED:
        raise KeyboardInterrupt
    rtol, atol = case.solver.rtol, case.solver.atol

    def solved(method: str, factor: float) -> xr.Dataset:
        changes = (f"solver.method={method}", f"solver.rtol={factor * rtol}", f"solver.atol={factor * atol}")
        return run_case(load_case(name, changes))

    reference = solved(case.solver.method, TIGHTER)
    second = None
    if result.attrs["evaluations"] <= MOST_EVALUATIONS:
        second = difference(case.kind, solved(*SECOND), reference)
    error = difference(case.kind, result, reference)
    misses = (expected(case, result) or {})["misses"]
    return {
        "case": name.removeprefix(FOLDER),
        "title": case.title,
        "outcome": result.attrs["outcome"],
        "error": error,
        "target": wanted.error,
        "second_method": second,
        "energy_gap": energy_balance(result)["relative_gap"],
        "cpu_seconds": result.attrs["solver_cpu_seconds"],
        "evaluations": result.attrs["evaluations"],
        "misses": misses,
        "met": not misses and within(error, second, wanted),
    }


def within(error: float | None, second: float | None, wanted: Expect) -> bool:
    """Whether run and second method keep the target; a run without a target has to end as named, no more."""
    if wanted.error is None:
        return wanted.outcome != "finished"
    # The second method need only confirm the reference to the target, not to its own tolerance.
    return error is not None and error <= wanted.error and (second is None or second <= wanted.error)


def difference(kind: str, run: xr.Dataset, reference: xr.Dataset) -> float | None:
    """Error of load and structure over time, relative to how far each moves; None if the runs ended differently.

    Runs that ended early are compared by the time of their end, relative.
    """
    if run.attrs["outcome"] != reference.attrs["outcome"]:
        return None
    if run.attrs["outcome"] != "finished":
        ends = run.attrs["end_time"], reference.attrs["end_time"]
        return 0.0 if ends[0] == ends[1] else float(abs(ends[0] - ends[1]) / ends[1])
    errors = []
    for name in ("payload_position", KINDS[kind].signals.vibration):
        values, exact = (r[name].values.reshape(len(r["time"]), -1) for r in (run, reference))
        moved = np.linalg.norm(exact - exact[0], axis=1).max()
        errors.append(float(np.linalg.norm(values - exact, axis=1).max() / moved))
    return max(errors)


def root_records() -> list[dict[str, Any]]:
    """Characteristic roots where they are hardest, and finite elements past their round-off floor."""
    from modal.beams.beam import Beam
    from modal.elements.beam_elements import MOST_ELEMENTS
    from modal.elements.structure_elements import finite_element_frequencies

    ratios = (1e-8, 1e-4, 1.0, 1e4, 1e8)
    every = [(a, j, 0.0, n) for a in ratios for j in ratios for n in range(1, 7)]
    records = [
        _root_record("500th root", [(1.0, 0.1, 0.0, 500)]),
        _root_record("mass and inertia ratios 1e-8 to 1e8", every),
        # With the body's centre of mass half a length back, sway and rotation part; 12 j = a makes them equally fast.
        _root_record("near-double root", [(1e6, 1e6 / 12.0, -0.5, n) for n in (1, 2)]),
    ]
    beam = Beam(23.8, 350.0, 206e9, 0.014)
    elements = 2 * MOST_ELEMENTS
    try:
        finite_element_frequencies(beam, 4, elements=elements)
        outcome = "not refused"
    except ValueError:
        outcome = "refused"
    records.append(_record(f"{elements} finite elements, past round-off", outcome, None, None, outcome == "refused"))
    return records


def _root_record(name: str, roots: Iterable[tuple[float, float, float, int]]) -> dict[str, Any]:
    from modal.beams.roots import characteristic_roots, count_roots_below

    worst = 0.0
    for a, j, h, n in roots:
        root = float(characteristic_roots(a, j, n, offset_ratio=h)[-1])
        margin = 2.0**-52

        def confirmed(
            margin: float, root: float = root, a: float = a, j: float = j, h: float = h, n: int = n
        ) -> bool:
            low, high = root * (1.0 - margin), root * (1.0 + margin)
            below = count_roots_below(low, a, j, offset_ratio=h), count_roots_below(high, a, j, offset_ratio=h)
            return below[0] < n <= below[1]

        while margin < 1.0 and not confirmed(margin):
            margin *= 2.0
        worst = max(worst, margin)
    return _record(name, "confirmed by count" if worst < 1.0 else "not confirmed", worst, ROUNDING, worst <= ROUNDING)


def _record(name: str, outcome: str, error: float | None, target: float | None, met: bool) -> dict[str, Any]:
    return {"case": name, "outcome": outcome, "error": error, "target": target, "misses": [], "met": met}


def _row(record: dict[str, Any]) -> list[str]:
    cpu, evaluations = record.get("cpu_seconds"), record.get("evaluations")
    return [
        record["case"],
        record["outcome"],
        short(record["error"]),
        short(record["target"]),
        short(record.get("second_method")),
        short(record.get("energy_gap")),
        "-" if cpu is None else f"{cpu:.2f}",
        "-" if evaluations is None else str(evaluations),
        "yes" if record["met"] else "; ".join(["NO", *record["misses"]]),
    ]

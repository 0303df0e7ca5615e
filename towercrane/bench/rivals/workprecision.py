"""Work against precision: what every solver pays for its error on the same run, rivals included."""

from __future__ import annotations

from dataclasses import asdict
from functools import partial
from typing import TYPE_CHECKING, Any

from towercrane.bench.clock import difference, interleaved, short
from towercrane.bench.rivals.solvers import EXTRA, OWN, RIVALS, Failed, Family, own

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from towercrane.bench.clock import Timing
    from towercrane.bench.scenes.prepared import Scene

    Floats = NDArray[np.float64]

REFERENCE = 1e-12
"""rtol of the reference, a hundredth of the tightest that is measured."""

SECOND = ("scipy-lsoda", 1e-11)
"""Method that cross-checks it."""

EXPRESSIONS = (
    "heyoka gets the plain equations as its own expressions and compiles them in its first run at each tolerance, "
    "1 to 6 s that 'first run' shows unless its cache on disk has them; its evaluations are steps times order"
)


def work_precision(scene: Scene, repeats: int, *, quick: bool = False) -> dict[str, Any]:
    """Error and cost of every solver at its tolerances.

    Returns
    -------
    dict
        A subject as in :func:`towercrane.bench.measure`; each record has ``family``, ``rtol`` and, unless it failed,
        ``error``, ``cpu_seconds``, ``first_seconds``, ``wall_seconds``, ``evaluations``; otherwise ``failure``.
    """
    reference = scene.outputs(own("dop853")(scene, REFERENCE)[0])
    floor = difference(scene.outputs(own(SECOND[0])(scene, SECOND[1])[0]), reference)
    contestants: dict[str, Callable[[], Any]] = {}
    runs: dict[str, tuple[Family, float]] = {}
    missing, notes = [], []
    for family in (*OWN, *RIVALS):
        if (family.plain and scene.plain is None) or (family.slow and quick):
            continue
        if not family.installed:
            missing.append(family)
            continue
        tolerances = family.tolerances[-1:] if quick and family not in OWN else family.tolerances
        for rtol in sorted(tolerances, reverse=True):
            name = f"{family.name} {rtol:.0e}"
            contestants[name], runs[name] = partial(_attempt, family, scene, rtol), (family, rtol)
    found, timings = interleaved(contestants, repeats)
    records = [_record(scene, runs[name], found[name], timings[name], reference) for name in runs]
    records += [{"family": f.name, "rtol": None, "failure": f"not installed: {EXTRA}"} for f in missing]
    cheapest = _cheapest(records, scene.wanted)
    if scene.plain is not None:
        notes.append(EXPRESSIONS)
    if quick:
        slow = (f.name for f in RIVALS if f.slow and (scene.plain or not f.plain))
        notes.append(f"the quick benchmark leaves out runs of seconds: {', '.join(slow)}")
    elif scene.plain is None:
        notes.append(
            "equations in NumPy and as heyoka's expressions exist for the crane in the plane only: heyoka calls no "
            "compiled right-hand side, and every crane's equations would have to be written and checked once more"
        )
    if scene.system.switch is not None:
        notes.append("towercrane also restarts where the drive's stiffness bends, which the rivals cannot see")
    return {
        "name": scene.name,
        "title": f"{scene.title}: error of {scene.measured} against CPU time",
        "columns": [
            "solver",
            "rtol",
            "error",
            "CPU [ms]",
            "first run [ms]",
            "evaluations",
            f"cost at {scene.wanted:.0e}",
        ],
        "rows": [_row(record, cheapest) for record in records],
        "records": records,
        "within": {"error": scene.wanted, "cpu_seconds": cheapest},
        "notes": [
            f"error: largest difference over largest value, {len(scene.grid)} samples; reference: dop853 at "
            f"{REFERENCE:.0e}, which LSODA at {SECOND[1]:.0e} meets within {floor:.0e}",
            f"cost at {scene.wanted:.0e}: CPU time of a solver's cheapest run within that error over towercrane's",
            "one compiled right-hand side for all unless NumPy or heyoka is named; restarted at switch points unless "
            "said otherwise; CPU: median, half the interquartile range",
            "absent rivals are in the extra 'rivals'",
            *notes,
        ],
    }


def _attempt(family: Family, scene: Scene, rtol: float) -> tuple[Floats, int] | Failed:
    try:
        return family.solve(scene, rtol)
    except Failed as failure:
        return failure


def _record(
    scene: Scene, run: tuple[Family, float], found: tuple[Floats, int] | Failed, timing: Timing, reference: Floats
) -> dict[str, Any]:
    record: dict[str, Any] = {"family": run[0].name, "rtol": run[1]}
    if isinstance(found, Failed):
        return {**record, "failure": str(found)}
    states, evaluations = found
    return {
        **record,
        "error": difference(scene.outputs(states), reference),
        "cpu_seconds": timing.cpu,
        "wall_seconds": timing.wall,
        "first_seconds": timing.first,
        "evaluations": evaluations,
        "timing": {**asdict(timing), "shown": timing.spread},
    }


def _cheapest(records: list[dict[str, Any]], wanted: float) -> dict[str, float]:
    """CPU time of each family's cheapest run within the wanted error [s]."""
    cheapest: dict[str, float] = {}
    for record in records:
        if record.get("error", 1.0) <= wanted:
            before = cheapest.get(record["family"], float("inf"))
            cheapest[record["family"]] = min(before, record["cpu_seconds"])
    return cheapest


def _row(record: dict[str, Any], cheapest: dict[str, float]) -> list[str]:
    family, rtol = record["family"], record["rtol"]
    name = [family, "-" if rtol is None else f"{rtol:.0e}"]
    if "failure" in record:
        return [*name, record["failure"], "-", "-", "-", "-"]
    ours = min((cpu for name, cpu in cheapest.items() if name.startswith("towercrane")), default=None)
    ratio = ""
    if ours is not None and cheapest.get(family) == record["cpu_seconds"]:
        ratio = f"{record['cpu_seconds'] / ours:.3g} x"
    return [
        *name, short(record["error"]), record["timing"]["shown"], f"{1e3 * record['first_seconds']:.0f}",
        str(record["evaluations"]), ratio,
    ]  # fmt: skip

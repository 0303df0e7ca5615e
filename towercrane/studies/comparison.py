"""A case in models from rigid to rich: what each kind of modes that is left out costs, and which kinds are needed."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cases.assumptions import as_entries, left_out, rests_on
from towercrane.cases.models import model_of, motions_of
from towercrane.cranes.registry import KINDS, serving
from towercrane.results.measures import PLACE, peak
from towercrane.runs.run import record_case
from towercrane.simulation.outcomes import FINISHED, INTERRUPTED
from towercrane.simulation.system import NoEquilibrium

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    import xarray as xr
    from numpy.typing import NDArray

    from towercrane.cases.case import Case
    from towercrane.simulation.system import Model

    Floats = NDArray[np.float64]

TARGET = 1e-2
"""Error that is asked for where neither the case nor the user does."""

RICHER = {"tower_modes": 1, "torsion_modes": 1, "jib_lateral_modes": 2, "jib_vertical_modes": 2}
"""More modes of each kind in the richest model; of the counter-jib, where it bends, one."""

ALIKE = {
    "jib_lateral_modes": "counter_jib_lateral_modes", "jib_vertical_modes": "counter_jib_vertical_modes",
}  # fmt: skip
"""Kinds of the counter-jib's modes, which bends where the jib does."""

MOST = 14
"""Modes of a kind that a case may have."""

RIGID, BARE = "rigid", "no modes"
"""What a crane without modes is called: one on ties or with a jib that pivots moves in what holds its jib."""

ONE_OF_EACH, OWN, RICHEST = "one mode of each", "the case's own", "richest"


@dataclass(frozen=True)
class Variant:
    """A model of a case.

    Parameters
    ----------
    name : str
    counts : dict of str to int
        Number of modes by the case's key.
    counter : dict of str to int
        Of the counter-jib.
    """

    name: str
    counts: dict[str, int]
    counter: dict[str, int]

    @property
    def kinds(self) -> frozenset[str]:
        """Keys of the kinds of modes that it keeps."""
        return frozenset(key for key, count in self.counts.items() if count)

    def model(self, case: Case) -> Model:
        """The model."""
        return model_of(case, **self.counts, **self.counter)


def modes_of(case: Case) -> Mapping[str, str]:
    """Kinds of modes that move in a case, by the key that counts them."""
    modes = KINDS[case.kind].modes
    return modes(case.checked) if modes else {}


def variants(case: Case) -> list[Variant]:
    """Models from rigid to rich: every choice of the kinds that the case includes, the richest last."""
    from towercrane.cranes.tower.crane_model import described
    from towercrane.cranes.tower.file.build import asked_modes, crane_of
    from towercrane.cranes.tower.file.case_tables import TowerCase

    tables, names = case.tables(TowerCase), modes_of(case)
    own = {key: int(getattr(case.checked.model, key)) for key in names}  # type: ignore[union-attr]
    kept = [key for key, count in own.items() if count]
    rigid = dict.fromkeys(own, 0)
    asked, known = asked_modes(tables), described(crane_of(tables))
    # What a case leaves out by stating zero stays left out.
    bends = {key: o for key, o in ALIKE.items() if o in known and getattr(tables.model, o) != 0}
    bare = RIGID if tables.crane.tower_head is None and tables.crane.jib.luffing is None else BARE

    def variant(name: str, counts: dict[str, int], more: int = 0) -> Variant:
        return Variant(name, counts, {o: (asked[o] + more) * bool(counts.get(k)) for k, o in bends.items()})

    found = []
    for size in range(len(kept) + 1):
        for chosen in combinations(kept, size):
            name = " + ".join(names[key] for key in chosen) or bare
            whole = OWN if size == len(kept) and kept else name
            found.append(variant(whole, rigid | {key: own[key] for key in chosen}))
    single = rigid | dict.fromkeys(kept, 1)
    if kept and single != own:
        found.insert(-1, variant(ONE_OF_EACH, single))
    return [*found, variant(RICHEST, rigid | {key: min(own[key] + RICHER[key], MOST) for key in kept}, 1)]


def compare(
    case: Case, target: float, *, progress: Callable[[float], None] | None = None
) -> tuple[dict[str, Any], dict[str, xr.Dataset]]:
    """Run a case in all its `variants`.

    Parameters
    ----------
    case : Case
        Of a tower crane.
    target : float
        Largest error of the load's place that is accepted, relative to how far the load departs from where it would
        hang on a rigid crane at rest.
    progress : callable, optional
        Called with the part that is done.

    Returns
    -------
    report : dict
        ``rows`` (a dict for each variant, see :func:`_row`), ``departure_m`` (what errors are relative to),
        ``target``, ``recommended`` (the cheapest row within the target, None without one), ``needed`` kinds of modes
        and ``reasons``, ``assumed``. Ready for JSON.
    results : dict of str to Dataset
        Looks at the runs by the variant's name.

    Raises
    ------
    ValueError
        If the crane is of another kind, or the model has no modes at all.
    """
    if "compare" not in KINDS[case.kind].serves:
        raise ValueError(f"case: wanted a case of kind {' or '.join(serving('compare'))}, got {case.kind!r}")
    if why := KINDS[case.kind].refusal("compare", case.checked):
        raise ValueError(f"case: {why}")
    chosen = variants(case)
    if len(chosen[-1].kinds) == 0:
        raise ValueError("case: wanted one mode or more to compare with a rigid crane, got none")
    results, motions = {}, motions_of(case)
    for number, variant in enumerate(chosen):
        results[variant.name] = record_case(case, model=variant.model(case), motions=motions).dataset()
        if results[variant.name].attrs["outcome"] == INTERRUPTED:
            raise KeyboardInterrupt
        if progress is not None:
            progress((number + 1) / len(chosen))
    richest = results[RICHEST]
    departure = peak(richest, PLACE)
    rows = [_row(case, variant, results[variant.name], richest, departure) for variant in chosen]
    report: dict[str, Any] = {
        "case": case.name,
        "title": case.title,
        "crane": case.crane.name,
        "kind": case.kind,
        "target": target,
        "departure_m": departure,
        "kinds_of_modes": list(modes_of(case).values()),
        "left_out": left_out(case),
        "rows": rows,
        **_needed(case, rows, chosen, target),
        "assumed": as_entries(rests_on(case, all_modes=True)),
    }
    return report, results


def gaps(result: xr.Dataset, richest: xr.Dataset) -> Floats:
    """Horizontal and vertical distance of the load from the richest model's [m], shape (times of both, 2)."""
    rows = min(len(result["time"]), len(richest["time"]))
    gap = result["payload_position"].values[:rows] - richest["payload_position"].values[:rows]
    return np.stack([np.hypot(gap[:, 0], gap[:, 1]), abs(gap[:, 2])], axis=1)


def _row(case: Case, variant: Variant, result: xr.Dataset, richest: xr.Dataset, departure: float) -> dict[str, Any]:
    """One variant's sway (peak and after the drives have stopped [deg]), torque [N m], errors [m] and cost."""
    moves = (m for name, m in motions_of(case).items() if name.partition("_")[0] not in ("wind", "ground", "floor"))
    stop = max((motion.stop for motion in moves), default=0.0)
    free = result["time"].values >= stop
    sway = {}
    for name in (name for name in KINDS[case.kind].sways if name in result):
        angle = np.degrees(abs(result[name].values))
        sway[name] = {
            "peak_deg": float(angle.max()),
            "residual_deg": float(angle[free].max()) if free.any() else None,
        }
    same = result.attrs["outcome"] == richest.attrs["outcome"] == FINISHED
    horizontal, vertical = gaps(result, richest).max(axis=0).tolist()
    gap = float(np.linalg.norm(gaps(result, richest), axis=1).max())
    torque = float(abs(result["slewing_torque"]).max()) if "slewing_torque" in result else None
    return {
        "name": variant.name,
        "modes": variant.counts,
        "outcome": result.attrs["outcome"],
        "sway": sway,
        "slewing_torque_nm": torque,
        "tower_tip_m": float(np.ptp(result["tower_tip_displacement"].values)),
        "horizontal_error_m": horizontal if same else None,
        "vertical_error_m": vertical if same else None,
        "relative_error": gap / departure if same and departure > 0.0 else None,
        "slowest_hz": slowest(case, variant, result),
        "evaluations": int(result.attrs["evaluations"]),
        "cpu_seconds": float(result.attrs["solver_cpu_seconds"]),
    }


def slowest(case: Case, variant: Variant, result: xr.Dataset) -> dict[str, float]:
    """Lowest natural frequency along and, in space, across the jib where a run ended [Hz]; none if it buckles."""
    from towercrane.cranes.tower.equations.small_motions import natural_modes, plane_modes

    model: Any = variant.model(case)
    motions, end = motions_of(case), float(result["time"][-1])
    place, rope, *turned = (float(motions[channel](end)) for channel in model.channels[: model.axes])
    try:
        if model.axes == 2:
            return {"along": float(plane_modes(model, place, rope)[0][0] / (2.0 * np.pi))}
        modes = natural_modes(model, place, rope, *turned)
    except NoEquilibrium:
        return {}
    in_plane = [mode.shares["radial"] + mode.shares["radial sway"] > 0.5 for mode in modes]
    ways = ["along" if plane else "across" for plane in in_plane]
    return {way: modes[ways.index(way)].frequency_hz for way in ("along", "across") if way in ways}


def _needed(case: Case, rows: list[dict[str, Any]], chosen: list[Variant], target: float) -> dict[str, Any]:
    """The cheapest row within the target, the kinds that it keeps, and why each kind stays or goes."""
    names, richest = modes_of(case), rows[-1]
    within = [
        (row, variant)
        for row, variant in zip(rows[:-1], chosen, strict=False)
        if row["relative_error"] is not None and row["relative_error"] <= target
    ]
    best = min(within, key=lambda pair: (len(pair[1].kinds), pair[0]["evaluations"]), default=None)
    kept = best[1].kinds if best else chosen[-1].kinds
    reasons = []
    for key in (key for key in names if key in chosen[-1].kinds):
        without = next(i for i, v in enumerate(chosen) if v.kinds == chosen[-1].kinds - {key})
        reasons.append(_reason(names[key], key in kept, rows[without], richest, target))
    return {
        "recommended": best[0]["name"] if best else None,
        "needed": [names[key] for key in names if key in kept],
        "reasons": reasons,
    }


def _reason(name: str, kept: bool, without: dict[str, Any], richest: dict[str, Any], target: float) -> str:
    """What leaving one kind of modes out does, in words."""
    if without["relative_error"] is None:
        return f'{name}: {"needed" if kept else "not needed"}; without it the run ends as "{without["outcome"]}"'
    verdict = "needed" if kept else "not needed"
    compared = "above" if without["relative_error"] > target else "within"
    text = (
        f"{name}: {verdict}; without it alone the load is up to {without['horizontal_error_m']:.3g} m off "
        f"horizontally and {without['vertical_error_m']:.3g} m vertically, {without['relative_error']:.2g}, "
        f"{compared} the target"
    )
    for way, frequency in richest["slowest_hz"].items():
        other = without["slowest_hz"].get(way)
        if other is not None and abs(other / frequency - 1.0) > 1e-2:
            text += f"; the slowest motion {way} the jib is then at {other:.4f} instead of {frequency:.4f} Hz"
    return text

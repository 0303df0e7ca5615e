"""Benchmark of what is on the head: what tie bars cost, and a jib that pivots."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from towercrane.bench.evaluations import Instant, evaluations
from towercrane.cases.case import load_case
from towercrane.cases.models import motions_of
from towercrane.cranes.tower.crane_model import tower_crane_model
from towercrane.cranes.tower.equations.small_motions import natural_modes
from towercrane.cranes.tower.file.build import described_model
from towercrane.cranes.tower.file.case_tables import TowerCase
from towercrane.motions.motion import phases, rest

if TYPE_CHECKING:
    from towercrane.cranes.tower.model import FlexibleModel
    from towercrane.cranes.tower.modes.parameters import TowerCrane
    from towercrane.motions.motion import Motion

TIED, PIVOTING = "hammerhead/manoeuvre", "luffing/manoeuvre"
"""Cases whose cranes are taken, all drives at once."""

AT = 6.5
"""Time at which right-hand sides are taken [s]: all drives move."""


def heads(repeats: int) -> dict[str, Any]:
    """One evaluation of the right-hand side without and with ties, without and with a jib that pivots."""
    tied, pivoting = (described_model(load_case(case).tables(TowerCase)) for case in (TIED, PIVOTING))
    bars, crane = tied["crane"].tie_bars, pivoting["crane"]
    cranes: dict[str, TowerCrane] = {
        "jibs clamped, no ties": replace(tied["crane"], tie_bars=None),
        "one tie to either side": replace(tied["crane"], tie_bars=replace(bars, jib=bars.jib[-1:])),
        "two ties of the jib, one of the counter-jib": tied["crane"],
    }
    built = {name: tower_crane_model(**tied | {"crane": own}) for name, own in cranes.items()}
    models = {name: _instant(model, motions_of(load_case(TIED))) for name, model in built.items()}
    rest_of_head = crane.luffing.rest_sums(crane)
    level = replace(
        crane, luffing=None, trolley_mass=crane.luffing.tip_mass, counterweight=rest_of_head.mass,
        counter_jib_length=-rest_of_head.forward / rest_of_head.mass,
    )  # fmt: skip
    motions = {**motions_of(load_case(PIVOTING)), "trolley": rest(crane.jib.length)}
    for name, own in (("jib clamped, its trolley at its end", level), ("jib that pivots", crane)):
        models[name] = _instant(tower_crane_model(**pivoting | {"crane": own}), motions)

    found = evaluations("heads-rhs", "Right-hand side with tie bars and with a jib that pivots", models, repeats)
    pitches = {name: _pitch(model) for name, model in built.items()}
    *_, true = pitches.values()
    for row, record in zip(found["rows"], found["records"], strict=True):
        pitch = pitches.get(record["model"])
        record["frequency"] = pitch
        row += ["-"] * 2 if pitch is None else [f"{pitch:.3f}", f"{100.0 * (pitch / true - 1.0):+.0f} %"]
    clamped, pivots = (record["nanoseconds"] for record in found["records"][-2:])
    notes = [
        f"a jib that pivots costs {pivots / clamped:.2f} times one that is clamped, in as many modes",
        "frequency: the second in the jib's plane, trolley at 15 m; its error is what leaving ties out costs",
    ]
    more = ["frequency [Hz]", "error"]
    return {**found, "columns": [*found["columns"], *more], "notes": [*found["notes"], *notes]}


def _instant(model: FlexibleModel, motions: dict[str, Motion]) -> Instant:
    cut = phases(tuple(motions[channel] for channel in model.channels), 2.0 * AT)
    return Instant(model.system, cut, model.start(cut.inputs[0]), AT)


def _pitch(model: FlexibleModel) -> float:
    """Second natural frequency of tower and jib in the jib's plane [Hz]."""
    return [mode.frequency_hz for mode in natural_modes(model, 15.0, 30.0) if mode.kind == "radial"][1]

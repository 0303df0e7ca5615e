"""How a case's run starts, perhaps from a saved end, and the case that a result was computed from."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cases.case import Case, computed_values
from towercrane.cases.kinds import kind_of
from towercrane.cases.models import model_of
from towercrane.cranes.registry import KINDS
from towercrane.cranes.tower.equations.constants import SLEWING
from towercrane.cranes.tower.file.case_tables import TowerCase
from towercrane.cranes.tower.file.plane import heading_of
from towercrane.schema.faults import CaseError, Fault
from towercrane.schema.provenance import split_provenance
from towercrane.schema.text import leaves
from towercrane.simulation.outcomes import FINISHED, INTERRUPTED
from towercrane.simulation.starts.end import leaps, lifted, other_side, other_states
from towercrane.simulation.starts.start import Start

if TYPE_CHECKING:
    from collections.abc import Mapping

    import xarray as xr
    from numpy.typing import NDArray

    from towercrane.motions.motion import Motion
    from towercrane.simulation.system import Model

    Floats = NDArray[np.float64]

GO_ON = FINISHED, INTERRUPTED
"""Outcomes of runs from whose end one can go on."""


def start_of(case: Case, model: Model | None = None, motions: Mapping[str, Motion] | None = None) -> Start:
    """How a case's run starts; from the end of another run only with the case's own model and motions.

    Raises
    ------
    CaseError
        If it cannot go on from there.
    """
    asked, found = case.start, []
    if asked.from_:
        return _saved_start(case, model, motions)
    for name in KINDS[case.kind].sways:
        found += [getattr(asked, name), getattr(asked, f"{name}_rate")]
    along, along_rate, across, across_rate = found
    # Without its own weight a crane is another model.
    state = "zero" if asked.state.startswith("zero") else asked.state
    return Start(state, along, across, along_rate, across_rate)


def _saved_start(case: Case, model: Model | None, motions: Mapping[str, Motion] | None) -> Start:
    """Start from the end of the run whose result the case names.

    The end of a run in the vertical plane of its jib is one in space too.

    Parameters
    ----------
    case : Case
    model : Model, optional
        The case's own.
    motions : mapping of str to Motion, optional

    Raises
    ------
    CaseError
        If the file is no such result, the crane or its modes are others, or a motion does not begin where that run
        ended.
    """

    def refuse(wanted: str, got: str, hint: str = "") -> CaseError:
        return CaseError([Fault(str(case.path), "start.from", wanted, got, hint)])

    named = case.start.from_
    if model is None or motions is None:
        raise refuse("a run of the case's own model", "another model of its crane", "its states are others")
    try:
        before, end, state = _ended(named)
    except (OSError, ValueError) as failure:
        # What HDF5 raises of a file that is none has no number.
        said = str(failure) if isinstance(failure, ValueError) else failure.strerror or "no HDF5 file"
        raise refuse(f"a result.nc of `towercrane run`, {named}", said) from failure
    if end["outcome"] not in GO_ON:
        raise refuse("a run that finished or was interrupted", f'one that ended as "{end["outcome"]}"')
    if changed := _changed(before.crane, case.crane):
        raise refuse("a run of this crane", changed)
    rises = end["axes"] < int(getattr(model, "axes", 3))
    if other := other_states(end, model_of(case, planar=True) if rises else model):
        raise refuse("a run in these modes and on this rope", f"one with {other}")
    if rises:
        heading = heading_of(before.tables(TowerCase)) or 0.0
        state = lifted(state, end, model, heading)
        end["drives"][model.channels[SLEWING]] = [heading, 0.0]
    if len(state) != model.system.size or not np.all(np.isfinite(state)):
        raise refuse(f"{model.system.size} finite states", f"{len(state)}", "another kind of rope?")
    if off := [f"{name} at {was}, not {now}" for name, was, now in leaps(end, model, motions)]:
        hint = "a motion's start, start_speed, rope.length"
        raise refuse(f"motions that begin as {named} ends", ", ".join(off), hint)
    if other_side(end, model, motions):
        hint = "move it a little"
        raise refuse("a trolley that is on one section of its jib", "one that stands where two meet", hint)
    return Start(saved=tuple(state.tolist()), time=float(end["time"]))


def _ended(named: str) -> tuple[Case, dict[str, Any], Floats]:
    """Case, end and state of a saved run.

    Raises
    ------
    OSError, ValueError
        If there is none.
    """
    from towercrane.results.files import load

    result = load(named)
    try:
        end = dict(json.loads(result.attrs["end"]))
        state = np.array(result.attrs["end_state"], dtype=float)
        numbers = [end["time"], end["axes"], *(number for pair in end["drives"].values() for number in pair)]
        end |= {"basis": np.array(end["basis"], dtype=float).tolist(), "outcome": str(result.attrs["outcome"])}
        whole = all(isinstance(number, int | float) for number in numbers) and {
            "between",
            "coordinates",
            "rope",
        } <= set(end)
    except (KeyError, TypeError, AttributeError, ValueError):
        whole = False
    if not whole:
        raise ValueError("one that does not hold its end, as older versions wrote it")
    return case_of(result), end, state


def _changed(before: Any, now: Any) -> str:
    """First value in which two cranes differ, but for their names; nothing where there is none."""
    there, here = (dict(leaves(crane.model_dump(mode="json", exclude={"name", "source"}))) for crane in (before, now))
    for key in {**here, **there}:
        if there.get(key) != here.get(key):
            return f"one with crane.{key} = {there.get(key)!r}, where this case has {here.get(key)!r}"
    return ""


def case_of(result: xr.Dataset) -> Case:
    """Case of a result of :func:`towercrane.runs.run.run_case`, without its motions.

    Raises
    ------
    ValueError
        If the result does not hold its case, or holds one that this version cannot read.
    """
    from pydantic import ValidationError

    if not isinstance(result.attrs.get("case_text"), str):
        raise ValueError("wanted a result that holds its case, as `towercrane run` writes it, got one without")
    try:
        written = json.loads(result.attrs["case_text"])
        tree, assumed, _ = split_provenance(written)
    except (ValueError, RecursionError):
        written = tree = {}
    if not isinstance(tree.get("crane"), dict):
        raise ValueError("wanted a result that holds its case as JSON, got one without its crane")
    kind, _ = kind_of(tree)
    tree.pop("kind", None)
    tree["crane"]["kind"] = kind
    if "sway_tangential" not in result and isinstance(tree.get("start"), dict):
        # What a run in the plane went on from says no more of it.
        tree["start"].pop("from", None)
    try:
        checked = KINDS[kind].tables.model_validate(tree)
    except ValidationError as error:
        first = ".".join(str(part) for part in error.errors()[0]["loc"])
        raise ValueError(f"the result's case cannot be read by this version, at {first}") from error
    # What no single value shows, such as a tower whose parts do not fit each other.
    for fault in (fault for check in KINDS[kind].checks for fault in check(tree)):
        raise ValueError(f"the result's case cannot be read by this version, at {fault.key}: {fault.got}")
    assumed += computed_values(kind, checked)
    changes = tuple(json.loads(result.attrs.get("changes", "[]")))
    name = result.attrs["case"]
    return Case(name, Path(name), checked.title or name, checked, {}, tuple(assumed), written, changes)

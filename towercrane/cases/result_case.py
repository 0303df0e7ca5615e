"""The case that a result was computed from, and the state that a run goes on from."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from towercrane.cases.case import Case, computed_values
from towercrane.cases.kinds import kind_of
from towercrane.cranes.registry import KINDS
from towercrane.schema.faults import CaseError, Fault
from towercrane.schema.provenance import split_provenance
from towercrane.schema.text import leaves
from towercrane.simulation.outcomes import FINISHED, INTERRUPTED
from towercrane.simulation.starts.end import leaps, other_side, other_states
from towercrane.simulation.starts.start import Start

if TYPE_CHECKING:
    from collections.abc import Mapping

    import xarray as xr

    from towercrane.motions.motion import Motion
    from towercrane.simulation.system import Model

GO_ON = FINISHED, INTERRUPTED
"""Outcomes of runs from whose end one can go on."""


def saved_start(case: Case, model: Model | None, motions: Mapping[str, Motion] | None) -> Start:
    """Start from the end of the run whose result the case names.

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
    from towercrane.results.files import load

    named = case.start.from_

    def refuse(wanted: str, got: str, hint: str = "") -> CaseError:
        return CaseError([Fault(str(case.path), "start.from", wanted, got, hint)])

    if model is None or motions is None:
        raise refuse("a run of the case's own model", "another model of its crane", "its states are others")
    try:
        result = load(_found(case, named))
        end, state, before = json.loads(result.attrs["end"]), result.attrs["end_state"].tolist(), case_of(result)
    except (OSError, ValueError, KeyError, AttributeError) as failure:
        older = isinstance(failure, KeyError | AttributeError)
        said = getattr(failure, "strerror", None) or str(failure)
        got = "one that does not hold its end, as older versions wrote it" if older else said
        raise refuse(f"a result.nc of `towercrane run`, {named}", got) from failure
    if result.attrs["outcome"] not in GO_ON:
        raise refuse("a run that finished or was interrupted", f'one that ended as "{result.attrs["outcome"]}"')
    if changed := _changed(before.crane, case.crane):
        raise refuse("a run of this crane", changed)
    if other := other_states(end, model):
        raise refuse("a run in these modes", f"one with {other}")
    if len(state) != model.system.size or not all(abs(value) < float("inf") for value in state):
        raise refuse(f"{model.system.size} finite states", f"{len(state)}", "another kind of rope?")
    if off := [f"{name} at {was}, not {now}" for name, was, now in leaps(end, model, motions)]:
        raise refuse(
            f"motions that begin as {named} ends", ", ".join(off), "a motion's start, start_speed, rope.length"
        )
    if other_side(end, model, motions):
        raise refuse(
            "a trolley that is on one section of its jib", "one that stands where two meet", "move it a little"
        )
    return Start(saved=tuple(state), time=float(end["time"]))


def _found(case: Case, named: str) -> Path:
    """A file named by a case, from the case's folder, or else from where the program runs."""
    beside = case.path.parent / named
    return beside if beside.exists() else Path(named)


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

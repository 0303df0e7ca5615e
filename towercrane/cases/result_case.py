"""The case that a result was computed from."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

from towercrane.cases.case import Case, computed_values
from towercrane.cases.kinds import kind_of
from towercrane.cranes.registry import KINDS
from towercrane.schema.provenance import split_provenance

if TYPE_CHECKING:
    import xarray as xr


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

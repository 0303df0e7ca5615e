"""What of a case's files a number rests on: values that no source gives, and what is written but not used."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from towercrane.cranes.registry import KINDS
from towercrane.schema.text import leaves

if TYPE_CHECKING:
    from collections.abc import Iterable

    from towercrane.cases.case import Case
    from towercrane.schema.provenance import Assumption


def rests_on(case: Case, *, exact_crane: bool = False, all_modes: bool = False) -> tuple[Assumption, ...]:
    """Assumptions that enter a case's equations of motion, without those of a check beside them.

    Parameters
    ----------
    case : Case
    exact_crane : bool
        Or the exact frequencies of the whole crane in the plane, whose counter-jib bends where its file says so.
    all_modes : bool
        Or models with modes of every kind that the crane has, whatever the case takes.
    """
    unused = _idle_keys(case, exact_crane=exact_crane, all_modes=all_modes)
    if exact_crane:
        # Its frequencies do not ask what the drives do.
        unused = (*unused, "motion.")
    return tuple(a for a in case.assumed if not a.key.startswith(unused))


def idle_in_file(case: Case) -> tuple[str, ...]:
    """Tables and keys of a crane's file that only other cases use."""
    unused = _idle_keys(case)
    keys = [key for key, _ in leaves({"crane": case.as_written["crane"]}) if key.startswith(unused)]
    found = (next(name for name in unused if key.startswith(name)).rstrip(".") for key in keys)
    return tuple(dict.fromkeys(found))


def left_out(case: Case) -> list[str]:
    """What a case's scene leaves out because nothing excites it, in sentences."""
    said = KINDS[case.kind].left_out
    return said(case.checked) if said else []


def _idle_keys(case: Case, *, exact_crane: bool = False, all_modes: bool = False) -> tuple[str, ...]:
    """Beginnings of keys that do not enter the equations of motion."""
    idle = KINDS[case.kind].idle
    return tuple(idle(case.checked, exact_crane=exact_crane, all_modes=all_modes)) if idle else ()


def as_attribute(assumed: Iterable[Assumption]) -> str:
    """Assumed values as an attribute of a data set."""
    return json.dumps([[a.key, str(a.value), a.why] for a in assumed])


def as_entries(assumed: Iterable[Assumption]) -> list[dict[str, str]]:
    """Assumed values as a report has them."""
    return [{"key": a.key, "value": str(a.value), "why": a.why} for a in assumed]


def as_notes(assumed: Iterable[Assumption]) -> list[tuple[str, str, str]]:
    """Assumed values as a picture has them."""
    return [(a.key, str(a.value), a.why) for a in assumed]

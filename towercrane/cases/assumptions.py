"""Values that no source gives: which of them a number rests on, and how files, reports and pictures name them."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from towercrane.cranes.tower.file.idle import idle_keys

if TYPE_CHECKING:
    from collections.abc import Iterable

    from towercrane.cases.case import Case
    from towercrane.schema.text import Assumption


def rests_on(case: Case, *, exact_crane: bool = False, all_modes: bool = False) -> tuple[Assumption, ...]:
    """Assumptions that enter a case's equations of motion.

    Parameters
    ----------
    case : Case
    exact_crane : bool
        Or the exact frequencies of the whole crane in the plane, whose counter-jib bends where its file says so.
    all_modes : bool
        Or models with modes of every kind that the crane has, whatever the case takes.
    """
    unused = tuple(idle_keys(case, exact_crane=exact_crane, all_modes=all_modes))
    return tuple(a for a in case.assumed if not a.key.startswith(unused))


def as_attribute(assumed: Iterable[Assumption]) -> str:
    """Assumed values as an attribute of a data set."""
    return json.dumps([[a.key, str(a.value), a.why] for a in assumed])


def as_entries(assumed: Iterable[Assumption]) -> list[dict[str, str]]:
    """Assumed values as a report has them."""
    return [{"key": a.key, "value": str(a.value), "why": a.why} for a in assumed]


def as_notes(assumed: Iterable[Assumption]) -> list[tuple[str, str, str]]:
    """Assumed values as a picture has them."""
    return [(a.key, str(a.value), a.why) for a in assumed]

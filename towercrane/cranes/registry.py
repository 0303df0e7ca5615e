"""Every kind of crane."""

from __future__ import annotations

from typing import TYPE_CHECKING

from towercrane.cranes.jib.kind import JIB
from towercrane.cranes.overhead.kind import OVERHEAD
from towercrane.cranes.slewing.kind import BASIC, ENHANCED, MULTI_MASS
from towercrane.cranes.tower.kind import TOWER

if TYPE_CHECKING:
    from towercrane.cranes.jib.tables import JibCase
    from towercrane.cranes.overhead.tables import OverheadCase
    from towercrane.cranes.slewing.tables import SlewingCase
    from towercrane.cranes.tower.file.case_tables import TowerCase

    AnyCase = TowerCase | SlewingCase | JibCase | OverheadCase

KINDS = {
    kind.name: kind
    for kind in (
        TOWER,
        MULTI_MASS,
        BASIC,
        ENHANCED,
        JIB,
        OVERHEAD,
    )
}
"""Kinds by name; the first is the kind where a crane file states none."""


def serving(use: str) -> tuple[str, ...]:
    """Names of the kinds that can be used so."""
    return tuple(name for name, kind in KINDS.items() if use in kind.serves)

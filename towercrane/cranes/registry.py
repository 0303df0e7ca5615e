"""Every kind of crane."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from importlib import import_module
from typing import TYPE_CHECKING

from towercrane.cranes.kind import Kind

if TYPE_CHECKING:
    from towercrane.cranes.jib.tables import JibCase
    from towercrane.cranes.overhead.tables import OverheadCase
    from towercrane.cranes.slewing.tables import SlewingCase
    from towercrane.cranes.tower.file.case_tables import TowerCase

    AnyCase = TowerCase | SlewingCase | JibCase | OverheadCase

FAMILIES = {
    "tower": "tower",
    "multi-mass": "slewing",
    "basic": "slewing",
    "enhanced": "slewing",
    "jib": "jib",
    "overhead": "overhead",
}
"""Folder whose ``kind.py`` declares each kind."""


class Kinds(Mapping[str, Kind]):
    """Kinds by name, each loaded when it is first asked for: a case is about one."""

    def __init__(self) -> None:
        self._loaded: dict[str, Kind] = {}

    def __getitem__(self, name: str) -> Kind:
        if name not in self._loaded:
            declared = vars(import_module(f"towercrane.cranes.{FAMILIES[name]}.kind")).values()
            self._loaded.update({kind.name: kind for kind in declared if isinstance(kind, Kind)})
        return self._loaded[name]

    def __iter__(self) -> Iterator[str]:
        return iter(FAMILIES)

    def __len__(self) -> int:
        return len(FAMILIES)

    def __contains__(self, name: object) -> bool:
        return name in FAMILIES


KINDS = Kinds()
"""Kinds by name; the first is the kind where a crane file states none."""


def serving(use: str) -> tuple[str, ...]:
    """Names of the kinds that can be used so."""
    return tuple(name for name, kind in KINDS.items() if use in kind.serves)

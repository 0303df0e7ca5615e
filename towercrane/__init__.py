"""How a tower crane vibrates and how its load swings.

``load_case`` reads a case file and ``run_case`` simulates it. ``tower_crane_model`` of a
``TowerCrane`` and a ``Load`` in a number of modes with
:func:`towercrane.simulation.simulate.simulate` and the motions of :mod:`towercrane.motions.profiles` do the same
without files.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from towercrane.results.versions import __version__ as __version__

if TYPE_CHECKING:
    from towercrane.cases.case import load_case
    from towercrane.cranes.tower.crane_model import tower_crane_model
    from towercrane.cranes.tower.model import FlexibleModel
    from towercrane.cranes.tower.modes.modal_crane import flexible_crane
    from towercrane.cranes.tower.modes.mode_counts import ModeCounts
    from towercrane.cranes.tower.modes.parameters import TowerCrane
    from towercrane.kernels.load import Load
    from towercrane.runs.run import run_case
    from towercrane.runs.sweep import sweep

__all__ = [
    "FlexibleModel",
    "Load",
    "ModeCounts",
    "TowerCrane",
    "flexible_crane",
    "load_case",
    "run_case",
    "sweep",
    "tower_crane_model",
]

_HOME = {
    "FlexibleModel": "cranes.tower.model",
    "Load": "kernels.load",
    "ModeCounts": "cranes.tower.modes.mode_counts",
    "TowerCrane": "cranes.tower.modes.parameters",
    "flexible_crane": "cranes.tower.modes.modal_crane",
    "load_case": "cases.case",
    "run_case": "runs.run",
    "sweep": "runs.sweep",
    "tower_crane_model": "cranes.tower.crane_model",
}


def __getattr__(name: str) -> Any:
    # Importing the package stays cheap: compiler and file formats load with the first name that needs them.
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})

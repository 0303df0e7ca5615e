"""Natural frequencies and mode shapes of beams, shafts, lattice columns and plane frames of two beams."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from modal.beam import Beam, EndBody
    from modal.elements import finite_element_frequencies
    from modal.frame import frame_frequencies
    from modal.lattice import LacedColumn
    from modal.roots import characteristic_roots
    from modal.shapes import Modes, cantilever_modes
    from modal.torsion import Shaft, TorsionModes, torsion_modes

__all__ = [
    "Beam",
    "EndBody",
    "LacedColumn",
    "Modes",
    "Shaft",
    "TorsionModes",
    "cantilever_modes",
    "characteristic_roots",
    "finite_element_frequencies",
    "frame_frequencies",
    "torsion_modes",
]

_HOME = {
    "Beam": "beam",
    "EndBody": "beam",
    "LacedColumn": "lattice",
    "Modes": "shapes",
    "cantilever_modes": "shapes",
    "characteristic_roots": "roots",
    "finite_element_frequencies": "elements",
    "frame_frequencies": "frame",
    "Shaft": "torsion",
    "TorsionModes": "torsion",
    "torsion_modes": "torsion",
}


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f"modal.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})

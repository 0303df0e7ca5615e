"""Natural frequencies and mode shapes of beams, shafts, lattice columns and plane frames."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from modal.beam import Beam, EndBody
    from modal.chain import Chain, Foundation, Pendulum
    from modal.crane_frame import CraneFrame, crane_structure
    from modal.lattice import LacedColumn
    from modal.lattice_comparison import LatticeAnswers, LatticeModel, compare_lattice_models
    from modal.roots import characteristic_roots
    from modal.segment import Segment
    from modal.shapes import Modes, cantilever_modes
    from modal.structure import Structure, Unstable, chain_frequencies, chain_structure
    from modal.structure_elements import (
        StructureElements,
        finite_element_frequencies,
        finite_element_structure_frequencies,
    )
    from modal.torsion import Shaft, TorsionModes, torsion_modes
    from modal.truss import ColumnTruss, Mechanism

__all__ = [
    "Beam",
    "Chain",
    "ColumnTruss",
    "CraneFrame",
    "EndBody",
    "Foundation",
    "LacedColumn",
    "LatticeAnswers",
    "LatticeModel",
    "Mechanism",
    "Modes",
    "Pendulum",
    "Segment",
    "Shaft",
    "Structure",
    "StructureElements",
    "TorsionModes",
    "Unstable",
    "cantilever_modes",
    "chain_frequencies",
    "chain_structure",
    "characteristic_roots",
    "compare_lattice_models",
    "crane_structure",
    "finite_element_frequencies",
    "finite_element_structure_frequencies",
    "torsion_modes",
]

_HOME = {
    "Beam": "beam",
    "Chain": "chain",
    "ColumnTruss": "truss",
    "CraneFrame": "crane_frame",
    "EndBody": "beam",
    "Foundation": "chain",
    "LacedColumn": "lattice",
    "LatticeAnswers": "lattice_comparison",
    "LatticeModel": "lattice_comparison",
    "Mechanism": "truss",
    "Modes": "shapes",
    "Pendulum": "chain",
    "Segment": "segment",
    "Structure": "structure",
    "StructureElements": "structure_elements",
    "Unstable": "structure",
    "cantilever_modes": "shapes",
    "chain_frequencies": "structure",
    "chain_structure": "structure",
    "characteristic_roots": "roots",
    "compare_lattice_models": "lattice_comparison",
    "crane_structure": "crane_frame",
    "finite_element_frequencies": "structure_elements",
    "finite_element_structure_frequencies": "structure_elements",
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

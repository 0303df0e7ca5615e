"""Natural frequencies and mode shapes of beams, shafts, plane frames, and of lattices in space."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from modal.beams.beam import Beam, EndBody
    from modal.beams.chain import Chain, Collar, Foundation, Pendulum
    from modal.beams.roots import characteristic_roots
    from modal.beams.segment import Segment
    from modal.beams.shapes import Modes, cantilever_modes
    from modal.beams.torsion import Shaft, TorsionModes, torsion_modes
    from modal.elements.space_beam import SpaceBeam
    from modal.elements.space_frame import SpaceFrame
    from modal.elements.structure_elements import (
        StructureElements,
        finite_element_frequencies,
        finite_element_structure_frequencies,
    )
    from modal.lattices.jib import JibLattice
    from modal.lattices.jib_truss import LatticeJib
    from modal.lattices.lattice import LacedColumn
    from modal.lattices.lattice_comparison import LatticeAnswers, LatticeModel, compare_lattice_models
    from modal.lattices.section import LatticeSection
    from modal.lattices.truss import ColumnTruss, Mechanism
    from modal.structures.crane_frame import CraneFrame, crane_structure
    from modal.structures.members import Unstable
    from modal.structures.structure import Structure, chain_frequencies, chain_structure

__all__ = [
    "Beam",
    "Chain",
    "Collar",
    "ColumnTruss",
    "CraneFrame",
    "EndBody",
    "Foundation",
    "JibLattice",
    "LacedColumn",
    "LatticeAnswers",
    "LatticeJib",
    "LatticeModel",
    "LatticeSection",
    "Mechanism",
    "Modes",
    "Pendulum",
    "Segment",
    "Shaft",
    "SpaceBeam",
    "SpaceFrame",
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
    "Beam": "beams.beam",
    "Chain": "beams.chain",
    "Collar": "beams.chain",
    "ColumnTruss": "lattices.truss",
    "CraneFrame": "structures.crane_frame",
    "EndBody": "beams.beam",
    "Foundation": "beams.chain",
    "JibLattice": "lattices.jib",
    "LacedColumn": "lattices.lattice",
    "LatticeJib": "lattices.jib_truss",
    "LatticeSection": "lattices.section",
    "SpaceBeam": "elements.space_beam",
    "SpaceFrame": "elements.space_frame",
    "LatticeAnswers": "lattices.lattice_comparison",
    "LatticeModel": "lattices.lattice_comparison",
    "Mechanism": "lattices.truss",
    "Modes": "beams.shapes",
    "Pendulum": "beams.chain",
    "Segment": "beams.segment",
    "Structure": "structures.structure",
    "StructureElements": "elements.structure_elements",
    "Unstable": "structures.members",
    "cantilever_modes": "beams.shapes",
    "chain_frequencies": "structures.structure",
    "chain_structure": "structures.structure",
    "characteristic_roots": "beams.roots",
    "compare_lattice_models": "lattices.lattice_comparison",
    "crane_structure": "structures.crane_frame",
    "finite_element_frequencies": "elements.structure_elements",
    "finite_element_structure_frequencies": "elements.structure_elements",
    "Shaft": "beams.torsion",
    "TorsionModes": "beams.torsion",
    "torsion_modes": "beams.torsion",
}


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f"modal.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})

"""Modules whose import compiles, by what is done with a tower crane."""

from __future__ import annotations

from typing import TYPE_CHECKING

from towercrane.cranes.tower.file.members import uniform_of
from towercrane.cranes.tower.file.plane import stays_in_plane

if TYPE_CHECKING:
    from towercrane.cranes.tower.file.case_tables import TowerCase

ROOTS = "modal.beams.roots"
STRUCTURE, SHAPES = "modal.structures.kernels.structure", "modal.structures.kernels.shapes"
STEPPER = "towercrane.simulation.stepper"
AT_REST = (ROOTS,)
LANES = "towercrane.simulation.lanes.advance"


def kernels(tables: TowerCase, use: str) -> tuple[str, ...]:
    """Modules for a use of a case."""
    # Those of a tower that is a chain of segments.
    chain = () if uniform_of(tables.crane) is not None else (STRUCTURE, SHAPES)
    uses = {
        "run": (*AT_REST, *chain, STEPPER),
        "lanes": (*AT_REST, *chain, LANES, STEPPER),
        "modes": (*AT_REST, STRUCTURE, SHAPES) if stays_in_plane(tables) else (*AT_REST, *chain),
        "map": (STRUCTURE, SHAPES),
        "lattice": (STRUCTURE,),
    }
    return uses[use]

"""Modules whose import compiles, by what is done with a tower crane."""

from __future__ import annotations

from typing import TYPE_CHECKING

from towercrane.cranes.tower.file.members import uniform_of

if TYPE_CHECKING:
    from towercrane.cranes.tower.file.case_tables import RadialCase, SpaceCase

ROOTS = "modal.beams.roots"
STRUCTURE, SHAPES = "modal.structures.kernels.structure", "modal.structures.kernels.shapes"
STEPPER = "towercrane.simulation.stepper"
RUN = ("towercrane.cranes.tower.kernels.rhs", ROOTS)
AT_REST = ("towercrane.cranes.tower.kernels.structure", ROOTS)
LANES = ("towercrane.cranes.tower.kernels.lane_rhs", "towercrane.simulation.lanes.advance")


def radial_kernels(tables: RadialCase, use: str) -> tuple[str, ...]:
    """Modules for a use of a radial case."""
    uses = {
        "run": (*RUN, *_chain(tables), STEPPER),
        "lanes": (*LANES, STEPPER),
        "modes": (*AT_REST, STRUCTURE, SHAPES),
        "map": (STRUCTURE, SHAPES),
        "lattice": (STRUCTURE,),
    }
    return uses[use]


def space_kernels(tables: SpaceCase, use: str) -> tuple[str, ...]:
    """Modules for a use of a case in space."""
    chain = _chain(tables)
    return {"run": (*RUN, *chain, STEPPER), "modes": (*AT_REST, *chain)}[use]


def _chain(tables: RadialCase | SpaceCase) -> tuple[str, ...]:
    """Those for a tower that is a chain of segments."""
    return () if uniform_of(tables.crane) is not None else (STRUCTURE, SHAPES)

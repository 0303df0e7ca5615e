"""Force and moment in named sections of tower and jib, by all that is beyond each."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from towercrane.cranes.parts.base import Reaction, length
from towercrane.kernels.algebra import cross
from towercrane.simulation.observed import About

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from towercrane.cranes.tower.outputs.cut_sums import Cuts, JibCut
    from towercrane.cranes.tower.outputs.sections import Sections
    from towercrane.cranes.tower.outputs.support import Support

TOWER: dict[str, tuple[Callable[[Reaction], Any], About]] = {
    "force_x": (lambda on: on.force[0], About("N", "force on section {} of the tower along x, by what is above")),
    "force_y": (lambda on: on.force[1], About("N", "force on section {} of the tower along y, by what is above")),
    "force_z": (lambda on: on.force[2], About("N", "force on section {} of the tower, upward: weight is negative")),
    "shear": (
        lambda on: length(on.force[:2]), About("N", "horizontal force on section {} of the tower", kink=True),
    ),
    "moment_x": (
        lambda on: on.moment[0], About("N m", "moment on section {} of the tower about x, positive: tips towards -y"),
    ),
    "moment_y": (
        lambda on: on.moment[1], About("N m", "moment on section {} of the tower about y, positive: tips towards +x"),
    ),
    "moment": (
        lambda on: length(on.moment[:2]), About("N m", "bending moment in section {} of the tower", kink=True),
    ),
    "torque": (lambda on: on.moment[2], About("N m", "moment on section {} of the tower about the vertical")),
}  # fmt: skip
"""Outputs of a section of the tower, along fixed axes, about where the deflected tower has it."""

JIB: dict[str, tuple[Callable[[Reaction], Any], About]] = {
    "axial_force": (lambda on: on.force[0], About("N", "force along the jib in section {}, positive: tension")),
    "shear": (lambda on: on.force[2], About("N", "force on section {} of the jib, upward: a load's is negative")),
    "shear_sideways": (
        lambda on: on.force[1], About("N", "force on section {} of the jib to its left, in the turning sense"),
    ),
    "moment": (lambda on: on.moment[1], About("N m", "moment in section {} of the jib, positive under a load")),
    "moment_sideways": (
        lambda on: -on.moment[2],
        About("N m", "moment in section {} of the jib, positive where it speeds the jib up"),
    ),
    "torque": (lambda on: on.moment[0], About("N m", "moment about the jib's axis in section {}")),
}  # fmt: skip
"""Outputs of a section of the jib, about where the deflected jib has it: along the axes of the head; of a jib that
pivots along its chord, and upward is across that."""

PLANE = ("force_x", "force_z", "shear", "moment_y", "moment", "axial_force")
"""Those that a scene in the plane of the fixed x axis has; in another plane the tower has both horizontal ones."""

BEFORE = "section_"


def cut_outputs(cuts: Cuts, axes: int, heading: float) -> dict[str, About]:
    """What the outputs of sections are."""
    found = {}
    for name, kind, (_, about) in _all(cuts):
        across = axes == 2 and (kind == "torque" or kind.endswith("_sideways"))
        aside = axes == 2 and not heading and kind.endswith(("_y", "_x")) and kind not in PLANE
        if not (across or aside):
            found[f"{BEFORE}{name}_{kind}"] = about._replace(long_name=about.long_name.format(name))
    return found


def read_cut(output: str, cuts: Cuts, bears: dict[str, Reaction]) -> Any:
    """An output of a section, of what each of them bears."""
    name, read = next((name, read) for name, kind, (read, _) in _all(cuts) if output == f"{BEFORE}{name}_{kind}")
    return read(bears[name])


def cut_loads(cuts: Cuts, support: Support, sections: Sections) -> dict[str, Reaction]:
    """What each section bears, by its name."""
    found = {cut.name: support.section(cut) for cut in cuts.tower}
    return found | {cut.name: jib_loads(sections, cut) for cut in cuts.jib}


def _all(cuts: Cuts) -> Iterator[tuple[str, str, tuple[Callable[[Reaction], Any], About]]]:
    for section in cuts.asked:
        for kind, own in (TOWER if section.of == "tower" else JIB).items():
            yield section.name, kind, own


def jib_loads(sections: Sections, cut: JibCut) -> Reaction:
    """Force and moment of what is beyond a section of the jib, the moment about its place."""
    force, moment = sections.beyond(cut)
    place = cut.position, *sections.at.deflection(cut.shapes, sections.at.state.coordinates)
    x, y, z = (own - shifted for own, shifted in zip(moment, cross(place, force), strict=True))
    return Reaction(force, (x, y, z))

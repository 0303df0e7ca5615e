"""Every kind of crane, and the tables of its cases."""

from __future__ import annotations

from towercrane.cranes.jib.tables import JibCase
from towercrane.cranes.slewing.tables import BasicCase, EnhancedCase, MultiMassCase, SlewingCase
from towercrane.cranes.tower.file.case_tables import RadialCase, SpaceCase

AnyCase = RadialCase | SpaceCase | SlewingCase | JibCase

KINDS: dict[str, type[RadialCase] | type[SpaceCase] | type[SlewingCase] | type[JibCase]] = {
    "radial": RadialCase,
    "multi-mass": MultiMassCase,
    "basic": BasicCase,
    "enhanced": EnhancedCase,
    "jib": JibCase,
    "space": SpaceCase,
}
"""Case table of each kind of crane; the first is the kind where a crane file states none."""

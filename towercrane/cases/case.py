"""Cases: from a TOML file to checked values in SI and to the objects of the model."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from towercrane.cases.shipped import case_folder, case_name, find_case, list_cases
from towercrane.schema.faults import CaseError, Fault
from towercrane.schema.text import Assumption, in_utf8, read_case, split_provenance

if TYPE_CHECKING:
    import os
    from collections.abc import Sequence

    from modal.beams.beam import Beam
    from modal.beams.chain import Chain
    from modal.lattices.lattice import LacedColumn
    from modal.lattices.truss import ColumnTruss
    from towercrane.cranes import registry as schema_cases
    from towercrane.cranes.slewing.parameters import SlewingParameters
    from towercrane.cranes.tower.file.tables import Crane
    from towercrane.cranes.tower.modes.parameters import TowerCrane
    from towercrane.kernels.payload import Load
    from towercrane.motions.motion import Motion
    from towercrane.motions.plans import Plan
    from towercrane.schema import fields as schema
    from towercrane.schema.targets import Asked

__all__ = ["Assumption", "Case", "CaseError", "Fault", "case_folder", "list_cases", "load_case"]


@dataclass(frozen=True, eq=False)
class Case:
    """A checked case; all numbers are SI floats, angles in radians.

    Parameters
    ----------
    name : str
        Name of a shipped case, such as "qtz5613/condition-3", or the file's name without its ending.
    path : Path
        Case file.
    title : str
        One line for people.
    checked : towercrane.cranes.registry.AnyCase
        All tables; the properties below are its parts.
    plans : dict of str to Plan
        What the drives are told, by channel: "rope" (its length), for a tower crane "trolley" (its position) [m], in
        space also "slewing" (the head's angle) or "shaft" (its drive's) [rad] and the wind's components [m/s]; for a
        slewing crane "shaft", for a jib crane "slew", "luff" and "fold" [rad].
    assumed : tuple of Assumption
        Values that no source gives, the crane's first.
    as_written : dict
        The case's text with its crane in place and overrides applied, as plain JSON-able data.
    changes : tuple of str
        The overrides, as given.
    """

    name: str
    path: Path
    title: str
    checked: schema_cases.AnyCase
    plans: dict[str, Plan]
    assumed: tuple[Assumption, ...]
    as_written: dict[str, Any]
    changes: tuple[str, ...] = ()

    @property
    def kind(self) -> str:
        """Kind of case: "radial", "space", "multi-mass", "basic", "enhanced" or "jib"."""
        return self.checked.crane.kind

    @property
    def crane(self) -> Any:
        """Crane; its tables depend on the kind, see :mod:`towercrane.cranes.slewing.tables` and
        :mod:`towercrane.cranes.tower.file.tables`."""
        return self.checked.crane

    @property
    def payload(self) -> schema.Payload:
        """Load on the rope."""
        return self.checked.payload

    @property
    def rope(self) -> schema.Rope:
        """Rope at the start."""
        return self.checked.rope

    @cached_property
    def motions(self) -> dict[str, Motion]:
        """What drives the crane, by channel; where a ramp is shaped for the model's frequencies, the model is asked.

        Raises
        ------
        CaseError
            If the model has no such frequencies, because it buckles.
        """
        from towercrane.cases.models import motions_of

        return motions_of(self)

    @property
    def model(self) -> schema_cases.Model:
        """What the model includes; for a crane in radial motion."""
        return self._radial.model

    @property
    def space(self) -> schema_cases.SpaceCase:
        """All tables of a case in space."""
        from towercrane.cranes.registry import SpaceCase

        if not isinstance(self.checked, SpaceCase):
            raise self._other_kind("space")
        return self.checked

    @property
    def start(self) -> schema_cases.Start | schema_cases.SlewingStart | schema_cases.JibStart:
        """Initial state."""
        return self.checked.start

    @property
    def run(self) -> schema.Run:
        """Span and output."""
        return self.checked.run

    @property
    def solver(self) -> schema.Solver:
        """Time integration."""
        return self.checked.solver

    @property
    def expect(self) -> schema.Expect | None:
        """What a run must come to, if the case says so."""
        return self.checked.expect

    @property
    def modes(self) -> schema_cases.ModesRequest:
        """What to show of the modes of a radial crane; trolley positions default to both ends of its way."""
        modes = self._radial.modes
        if modes.trolley_positions:
            return modes
        ends = tuple(dict.fromkeys(self.plans["trolley"].commanded.range()))
        return modes.model_copy(update={"trolley_positions": ends})

    @property
    def map(self) -> schema_cases.MapRequest:
        """Where the frequency map of a radial crane is taken, its defaults filled in."""
        asked, jib, load = self._radial.map, self._radial.crane.jib.length, self.payload.mass
        steps = asked.position_count - 1
        positions = asked.trolley_positions or tuple(jib * i / steps for i in range(steps + 1))
        masses = asked.payload_masses or (0.5 * load, load, 2.0 * load)
        return asked.model_copy(update={"trolley_positions": positions, "payload_masses": masses})

    @property
    def accuracy(self) -> Asked:
        """Errors that are asked for; for a tower crane."""
        return self.space.accuracy if self.kind == "space" else self._radial.accuracy

    @property
    def frequency_tolerance(self) -> float | None:
        """Relative error that is accepted of frequencies; for a crane in radial motion."""
        return self._radial.accuracy.frequency

    @property
    def rests_on(self) -> tuple[Assumption, ...]:
        """Assumptions that enter the equations of motion, without those of a check beside them."""
        from towercrane.cases.assumptions import rests_on

        return rests_on(self)

    @property
    def idle(self) -> tuple[str, ...]:
        """Tables and keys of a tower crane's file that only other cases use."""
        from towercrane.cranes.tower.file.idle import idle_in_file

        return idle_in_file(self)

    @cached_property
    def notices(self) -> tuple[str, ...]:
        """What its CSV tables do to a run that nobody would expect."""
        from towercrane.cases.table_notices import table_notices

        return table_notices(self)

    @property
    def _radial(self) -> schema_cases.RadialCase:
        from towercrane.cranes.registry import RadialCase

        if not isinstance(self.checked, RadialCase):
            raise self._other_kind("radial")
        return self.checked

    @property
    def _tower_crane(self) -> Crane:
        """The crane's tables of a case in the plane or in space."""
        from towercrane.cranes.tower.file.tables import Crane

        if not isinstance(self.crane, Crane):
            raise self._other_kind("radial", "space")
        return self.crane

    def _other_kind(self, *wanted: str) -> CaseError:
        words = " or ".join(f'"{kind}"' for kind in wanted)
        return CaseError([Fault(str(self.path), "crane.kind", f"a crane of kind {words}", f'"{self.kind}"')])

    @property
    def uses(self) -> tuple[str, ...]:
        """What its crane needs of :data:`towercrane.kernels.compilation.KERNELS`."""
        return (self.kind, *self.tower_uses)

    @property
    def tower_uses(self) -> tuple[str, ...]:
        """The part of it that is for the tower."""
        from modal.beams.beam import Beam
        from towercrane.cases.kinds import TOWER_CRANES
        from towercrane.cranes.tower.file.build import tower_of

        plain = self.kind not in TOWER_CRANES or isinstance(tower_of(self._tower_crane), Beam)
        return () if plain else ("chain",)

    def tower(self) -> Beam | Chain:
        """The tower: a beam where it is uniform and clamped, else a chain; without what the tolerance leaves out."""
        from towercrane.cranes.tower.file.build import tower_of
        from towercrane.cranes.tower.file.effects import kept_tower

        crane = self._tower_crane
        return tower_of(crane) if self.kind == "space" else kept_tower(self, crane)

    def tower_beam(self) -> Beam:
        """The tower as a uniform Euler beam, clamped at its foot.

        Raises
        ------
        CaseError
            If it is none.
        """
        from modal.beams.beam import Beam

        tower = self.tower()
        if isinstance(tower, Beam):
            return tower
        wanted = "a uniform clamped tower without shear strain, rotary inertia, bodies and foundation"
        got = f"a chain of {len(tower.segments)} segments" if len(tower.segments) > 1 else "a chain of one segment"
        raise CaseError([Fault(str(self.path), "crane.tower", wanted, got)])

    def jib_beam(self) -> Beam:
        """The jib as a uniform beam."""
        from modal.beams.beam import Beam

        jib = self._tower_crane.jib
        return Beam(jib.length, jib.mass_per_length, jib.youngs_modulus, jib.second_moment_of_area)

    def lattice(self) -> LacedColumn | None:
        """The members of a uniform tower; None where the crane file has none."""
        from towercrane.cranes.tower.file.build import laced_column

        tower = self._radial.crane.tower
        if tower.lattice is None or tower.youngs_modulus is None:
            return None
        return laced_column(tower.lattice, tower.youngs_modulus)

    def truss(self) -> ColumnTruss | None:
        """The lattices of the tower as a truss; None where a piece of it has none."""
        from towercrane.cranes.tower.file.build import tower_truss

        return tower_truss(self._radial.crane)

    def has_lattice(self) -> bool:
        """Whether the tower, or each of its segments, has its members given."""
        tower = self._radial.crane.tower
        return all(piece.lattice is not None for piece in tower.segments or (tower,))

    def radial_crane(self) -> TowerCrane:
        """The crane of the radial model."""
        return self.crane_on(self.tower())

    def crane_on(self, tower: Beam | Chain) -> TowerCrane:
        """The crane of the radial model on a tower that may differ from the case's."""
        from towercrane.cranes.tower.modes.parameters import TowerCrane

        crane = self._tower_crane
        return TowerCrane(
            name=crane.name,
            tower=tower,
            jib=self.jib_beam(),
            counter_jib_length=crane.counter_jib.length,
            counter_jib_mass_per_length=crane.counter_jib.mass_per_length,
            counterweight=crane.counter_jib.counterweight,
            trolley_mass=crane.trolley.mass,
            gravity=crane.gravity,
        )

    def space_crane(self) -> TowerCrane:
        """The crane in space: with its torsion, its jib's bending to the sides and its roll inertia where given."""
        from towercrane.cranes.tower.file.build import in_space

        return in_space(self.crane_on(self.tower()), self._tower_crane)

    def lumped_parameters(self) -> SlewingParameters:
        """Parameters of a slewing crane, of its kind's class; each is named by its table and its key."""
        from towercrane.cranes.slewing.parameters import PARAMETERS

        if self.kind not in PARAMETERS:
            raise self._other_kind(*PARAMETERS)
        return PARAMETERS[self.kind](**_flat(self.crane))

    def jib_parameters(self) -> dict[str, Any]:
        """Name, gravity, lengths, masses per length and inertia of a jib crane."""
        if self.kind != "jib":
            raise self._other_kind("jib")
        return {name.replace("_boom_", "_"): value for name, value in _flat(self.crane).items()}

    def load(self) -> Load:
        """The load and its rope's losses."""
        from towercrane.kernels.payload import AIR_DENSITY, Load

        payload = self.payload
        drag_area = payload.drag_area or 2.0 * payload.drag / AIR_DENSITY
        return Load(mass=payload.mass, rope_damping=payload.rope_damping, drag_area=drag_area)

    def trolley_motion(self) -> Motion:
        """Position of the trolley along the jib [m]."""
        if "trolley" not in self.plans:
            raise self._other_kind("radial", "space")
        return self.motions["trolley"]

    def rope_motion(self) -> Motion:
        """Length of the rope [m]."""
        return self.motions["rope"]


def load_case(path: str | os.PathLike[str], overrides: Sequence[str] = ()) -> Case:
    """Read and check a case.

    Parameters
    ----------
    path : path-like
        Case file, or the name of a shipped case.
    overrides : sequence of str
        ``key=value`` with a dotted key from the case's root; ``crane.`` reaches into the crane file.

    Raises
    ------
    CaseError
        With every fault of the case, its crane file, its CSV files and the overrides.
    """
    from pydantic import ValidationError

    from towercrane.cases.explain import explain
    from towercrane.cases.kinds import TOWER_CRANES, kind_of
    from towercrane.cases.motion_limits import channels, check_motions
    from towercrane.cases.plausibility import check_values, implausible
    from towercrane.cranes.registry import KINDS
    from towercrane.cranes.tower.file.checks import check_tower
    from towercrane.cranes.tower.file.space_checks import check_space

    found = find_case(Path(path))
    overrides = [in_utf8(override) for override in overrides]
    text = read_case(found, overrides)
    tree, assumed, faults = split_provenance(text.tree)
    kind, kind_faults = kind_of(tree)
    faults += kind_faults
    tree.pop("kind", None)
    crane_unread = not isinstance(text.tree.get("crane", {}), dict)
    if isinstance(tree.get("crane"), dict):
        tree["crane"]["kind"] = kind
    checked = None
    try:
        checked = KINDS[kind].model_validate(tree)
    except ValidationError as error:
        faults += [f for f in explain(error, kind) if not (crane_unread and f.key == "crane")]
    allowed = tree.get("allow_implausible", [])
    allowed = [k for k in allowed if isinstance(k, str)] if isinstance(allowed, list) else []
    faults += [*implausible(tree, allowed, kind), *check_values(tree)]
    faults += check_tower(tree) if kind in TOWER_CRANES else []
    faults += check_space(tree) if kind == "space" else []
    motion_faults, plans = check_motions(tree, found.parent, kind)
    located = [text.located(f) for f in dict.fromkeys([*text.faults, *faults, *motion_faults])]
    if located or checked is None or set(plans) != set(channels(tree, kind)):
        raise CaseError(located)
    name = case_name(found)
    return Case(name, found, checked.title or name, checked, plans, tuple(assumed), text.tree, tuple(overrides))


def _flat(crane: Any) -> dict[str, Any]:
    """A crane's values by table and key, joined by an underscore."""
    flat: dict[str, Any] = {}
    for name, value in crane.model_dump(exclude={"kind", "source"}).items():
        flat |= {f"{name}_{key}": inner for key, inner in value.items()} if isinstance(value, dict) else {name: value}
    return flat

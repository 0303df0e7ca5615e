"""Cases: from a TOML file to checked values in SI and to the objects of the model."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from towercrane.casefile import Assumption, is_file, read_case, read_toml, split_provenance
from towercrane.faults import CaseError, Fault, closest

if TYPE_CHECKING:
    from collections.abc import Sequence

    from modal.beam import Beam
    from modal.lattice import LacedColumn
    from towercrane import schema, schema_cases
    from towercrane.cranes.slewing_parameters import SlewingParameters
    from towercrane.cranes.tower_crane import TowerCrane
    from towercrane.motion import Motion
    from towercrane.payload import Load
    from towercrane.schema_accuracy import Accuracy

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
    checked : towercrane.schema_cases.AnyCase
        All tables; the properties below are its parts.
    motions : dict of str to Motion
        What drives the crane: "rope" (its length) and, in radial motion, "trolley" (its position) [m]; for a
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
    motions: dict[str, Motion]
    assumed: tuple[Assumption, ...]
    as_written: dict[str, Any]
    changes: tuple[str, ...] = ()

    @property
    def kind(self) -> str:
        """Kind of crane: "radial", "multi-mass", "basic", "enhanced" or "jib"."""
        return self.checked.crane.kind

    @property
    def crane(self) -> Any:
        """Crane; its tables depend on the kind, see :mod:`towercrane.schema_cranes`."""
        return self.checked.crane

    @property
    def payload(self) -> schema.Payload:
        """Load on the rope."""
        return self.checked.payload

    @property
    def rope(self) -> schema.Rope:
        """Rope at the start."""
        return self.checked.rope

    @property
    def model(self) -> schema_cases.Model:
        """What the model includes; for a crane in radial motion."""
        return self._radial.model

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
    def accuracy(self) -> Accuracy:
        """Error that is asked for; for a crane in radial motion."""
        return self._radial.accuracy

    @property
    def modes(self) -> schema_cases.ModesRequest:
        """What to show of the modes of a radial crane; trolley positions default to both ends of its way."""
        modes = self._radial.modes
        if modes.trolley_positions:
            return modes
        ends = tuple(dict.fromkeys(self.trolley_motion().range()))
        return modes.model_copy(update={"trolley_positions": ends})

    @property
    def _radial(self) -> schema_cases.RadialCase:
        from towercrane.schema_cases import RadialCase

        if not isinstance(self.checked, RadialCase):
            raise self._other_kind("radial")
        return self.checked

    def _other_kind(self, *wanted: str) -> CaseError:
        words = " or ".join(f'"{kind}"' for kind in wanted)
        return CaseError([Fault(str(self.path), "crane.kind", f"a crane of kind {words}", f'"{self.kind}"')])

    def tower_beam(self) -> Beam:
        """The tower as a uniform beam."""
        from modal.beam import Beam

        tower = self._radial.crane.tower
        return Beam(tower.height, tower.mass_per_length, tower.youngs_modulus, tower.second_moment_of_area)

    def jib_beam(self) -> Beam:
        """The jib as a uniform beam."""
        from modal.beam import Beam

        jib = self._radial.crane.jib
        return Beam(jib.length, jib.mass_per_length, jib.youngs_modulus, jib.second_moment_of_area)

    def lattice(self) -> LacedColumn | None:
        """The tower's members; None where the crane file has none."""
        from modal.lattice import LacedColumn

        tower = self._radial.crane.tower
        if tower.lattice is None:
            return None
        return LacedColumn(**dict(tower.lattice), youngs_modulus=tower.youngs_modulus)

    def radial_crane(self) -> TowerCrane:
        """The crane of the radial model."""
        from towercrane.cranes.tower_crane import TowerCrane

        crane = self._radial.crane
        return TowerCrane(
            name=crane.name,
            tower=self.tower_beam(),
            jib=self.jib_beam(),
            counter_jib_length=crane.counter_jib.length,
            counter_jib_mass_per_length=crane.counter_jib.mass_per_length,
            counterweight=crane.counter_jib.counterweight,
            trolley_mass=crane.trolley.mass,
            gravity=crane.gravity,
        )

    def lumped_parameters(self) -> SlewingParameters:
        """Parameters of a slewing crane, of its kind's class; each is named by its table and its key."""
        from towercrane.cranes.slewing_parameters import PARAMETERS

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
        from towercrane.payload import AIR_DENSITY, Load

        payload = self.payload
        drag_area = payload.drag_area or 2.0 * payload.drag / AIR_DENSITY
        return Load(mass=payload.mass, rope_damping=payload.rope_damping, drag_area=drag_area)

    def trolley_motion(self) -> Motion:
        """Position of the trolley along the jib [m]."""
        if "trolley" not in self.motions:
            raise self._other_kind("radial")
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

    from towercrane.explain import explain
    from towercrane.kinds import kind_of
    from towercrane.plausibility import check_values, implausible
    from towercrane.schema_cases import KINDS
    from towercrane.ways import channels, check_motions

    found = _find(Path(path))
    text = read_case(found, overrides)
    tree, assumed, faults = split_provenance(text.tree)
    kind, kind_faults = kind_of(tree)
    faults += kind_faults
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
    motion_faults, motions = check_motions(tree, found.parent, kind)
    located = [text.located(f) for f in dict.fromkeys([*text.faults, *faults, *motion_faults])]
    if located or checked is None or set(motions) != set(channels(kind)):
        raise CaseError(located)
    name = _name(found)
    return Case(name, found, checked.title or name, checked, motions, tuple(assumed), text.tree, tuple(overrides))


def case_folder() -> Path:
    """Folder of the shipped cases: inside the installed package, or beside it in a source checkout."""
    package = Path(__file__).parent
    installed = package / "_cases"
    return installed if installed.is_dir() else package.parent / "cases"


def list_cases() -> list[tuple[str, str]]:
    """Name and title of every shipped case."""
    cases = []
    for path in case_folder().rglob("*.toml"):
        content = read_toml(path)
        if "crane" in content:
            cases.append((_name(path), str(content.get("title", ""))))
    return sorted(cases)


def _find(path: Path) -> Path:
    """The case file that a path or a shipped case's name means."""
    shipped = case_folder() / path
    for candidate in (path, shipped, Path(f"{shipped}.toml")):
        if is_file(candidate):
            return candidate
    wanted = "a case file or the name of a shipped case"
    if os.path.isdir(path):
        inside = ", ".join(sorted(p.name for p in path.glob("*.toml")))
        raise CaseError([Fault(str(path), "", wanted, "a folder", f"it holds {inside}" if inside else "")])
    names = [name for name, _ in list_cases()]
    by_end = {name.rpartition("/")[2]: name for name in names}
    asked = path.as_posix().removesuffix(".toml")
    near = closest(asked, names) or by_end.get(closest(path.stem, by_end) or "")
    hint = f'closest shipped case: "{near}"' if near else f"shipped cases: {', '.join(names)}"
    raise CaseError([Fault(str(path), "", wanted, "no such file", hint)])


def _name(path: Path) -> str:
    folder = case_folder().resolve()
    full = path.resolve()
    return (full.relative_to(folder) if full.is_relative_to(folder) else Path(full.name)).with_suffix("").as_posix()


def _flat(crane: Any) -> dict[str, Any]:
    """A crane's values by table and key, joined by an underscore."""
    flat: dict[str, Any] = {}
    for name, value in crane.model_dump(exclude={"kind", "source"}).items():
        flat |= {f"{name}_{key}": inner for key, inner in value.items()} if isinstance(value, dict) else {name: value}
    return flat

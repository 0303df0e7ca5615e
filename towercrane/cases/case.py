"""Cases: from a TOML file to checked values in SI."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from towercrane.cases.shipped import case_folder, case_name, find_case, list_cases
from towercrane.schema.faults import CaseError, Fault
from towercrane.schema.provenance import Assumption, split_provenance
from towercrane.schema.text import in_utf8, read_case
from towercrane.schema.toml_files import is_file

if TYPE_CHECKING:
    import os
    from collections.abc import Iterator, Sequence

    from towercrane.cranes.registry import AnyCase
    from towercrane.motions.plans import Plan
    from towercrane.schema import fields

__all__ = ["Assumption", "Case", "CaseError", "Fault", "case_folder", "list_cases", "load_case"]

Tables = TypeVar("Tables")


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
        What the drives are told, by channel: "rope" (its length), for a tower crane "trolley" (its position) [m] or
        "luffing" (the angle of a jib that pivots) [rad], in space also "slewing" (the head's angle) or "shaft" (its
        drive's) [rad] and the wind's components [m/s]; for a slewing crane "shaft", for a jib crane "slew", "luff"
        and "fold" [rad]; for an overhead crane "bridge" and "trolley" [m].
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
    checked: AnyCase
    plans: dict[str, Plan]
    assumed: tuple[Assumption, ...]
    as_written: dict[str, Any]
    changes: tuple[str, ...] = ()

    @property
    def kind(self) -> str:
        """Name of its kind of crane, a key of :data:`towercrane.cranes.registry.KINDS`."""
        return self.checked.crane.kind

    @property
    def crane(self) -> Any:
        """Crane; its tables depend on the kind, see :mod:`towercrane.cranes.slewing.tables` and
        :mod:`towercrane.cranes.tower.file.tables`."""
        return self.checked.crane

    @property
    def payload(self) -> fields.Payload:
        """Load on the rope."""
        return self.checked.payload

    @property
    def rope(self) -> fields.Rope:
        """Rope at the start."""
        return self.checked.rope

    @property
    def start(self) -> Any:
        """Initial state."""
        return self.checked.start

    @property
    def run(self) -> fields.Run:
        """Span and output."""
        return self.checked.run

    @property
    def solver(self) -> fields.Solver:
        """Time integration."""
        return self.checked.solver

    @property
    def expect(self) -> fields.Expect | None:
        """What a run must come to, if the case says so."""
        return self.checked.expect

    def tables(self, *wanted: type[Tables]) -> Tables:
        """All tables of a case of one of these classes.

        Raises
        ------
        CaseError
            If it is a case of another kind of crane.
        """
        if isinstance(self.checked, wanted):
            return self.checked
        from towercrane.cranes.registry import KINDS

        words = " or ".join(f'"{kind}"' for kind, one in KINDS.items() if issubclass(one.tables, wanted))
        raise CaseError([Fault(str(self.path), "crane.kind", f"a crane of kind {words}", f'"{self.kind}"')])


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
    from towercrane.cases.kinds import EveryKey, kind_of
    from towercrane.cases.motion_limits import channels, check_motions
    from towercrane.cases.plausibility import check_values, implausible
    from towercrane.cranes.registry import KINDS

    found = find_case(Path(path))
    overrides = [in_utf8(override) for override in overrides]
    text = read_case(found, overrides, EveryKey())
    tree, assumed, faults = split_provenance(text.tree)
    kind, kind_faults = kind_of(tree)
    faults += kind_faults
    tree.pop("kind", None)
    crane_unread = not isinstance(text.tree.get("crane", {}), dict)
    if isinstance(tree.get("crane"), dict):
        tree["crane"]["kind"] = kind
    if isinstance(start := tree.get("start"), dict) and isinstance(start.get("from"), str):
        beside = found.parent / start["from"]
        start["from"] = str(beside) if is_file(beside) else start["from"]
    checked = None
    try:
        checked = KINDS[kind].tables.model_validate(tree)
    except ValidationError as error:
        faults += [f for f in explain(error, kind) if not (crane_unread and f.key == "crane")]
    allowed = tree.get("allow_implausible", [])
    allowed = [k for k in allowed if isinstance(k, str)] if isinstance(allowed, list) else []
    faults += [*implausible(tree, allowed, kind), *check_values(tree, kind)]
    for check in KINDS[kind].checks:
        faults += check(tree)
    motion_faults, plans = check_motions(tree, found.parent, kind, None if faults or text.faults else checked)
    located = [text.located(f) for f in dict.fromkeys([*text.faults, *faults, *motion_faults])]
    if located or checked is None or not set(channels(tree, kind)) <= set(plans):
        raise CaseError(located)
    name = case_name(found)
    assumed += computed_values(kind, checked)
    return Case(name, found, checked.title or name, checked, plans, tuple(assumed), text.tree, tuple(overrides))


def computed_values(kind: str, checked: AnyCase) -> Iterator[Assumption]:
    """Values that a case's tables do not state and that others of them give."""
    from towercrane.cranes.registry import KINDS

    computed = KINDS[kind].computed
    return computed(checked) if computed else iter(())

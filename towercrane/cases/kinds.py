"""Which kind of crane a case is about, and which keys each kind knows."""

from __future__ import annotations

from collections.abc import Set
from functools import cache, lru_cache
from typing import TYPE_CHECKING, Any

from towercrane.cranes.registry import KINDS
from towercrane.schema.faults import Fault, closest, shown
from towercrane.schema.fields import Quantity, Table, known_keys, tables
from towercrane.schema.text import leaves

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator


STATES_NONE = next(iter(KINDS))
"""Kind of a crane whose file states none."""

FORMER = ("radial", "space")
"""What tower cranes used to state: whether they move in a plane or in space."""


def kind_of(tree: dict[str, Any]) -> tuple[str, list[Fault]]:
    """Kind of a case's crane and what is wrong with its statement.

    The crane states it. Where the statement is missing, unknown or in a file that cannot be read, the kind that knows
    most of the written keys is taken, so that the rest of the case is still judged by rules that fit it.
    """
    crane = tree.get("crane")
    stated = crane.get("kind") if isinstance(crane, dict) else None
    faults = []
    if "kind" in tree:
        hint = "the crane's file states the kind" if tree["kind"] not in FORMER else _FOLLOWS
        faults.append(Fault("", "kind", "no such key in a case", shown(tree["kind"]), hint))
    if isinstance(stated, str) and stated in KINDS:
        return stated, faults
    likely = _likely(tree)
    wanted = _one_of(KINDS)
    if stated in FORMER:
        return STATES_NONE, [*faults, Fault("", "crane.kind", wanted, shown(stated), _FOLLOWS)]
    if stated is not None:
        near = closest(stated, KINDS) if isinstance(stated, str) else None
        hint = f'did you mean "{near}"?' if near else f'the keys are those of kind "{likely}"'
        return near or likely, [*faults, Fault("", "crane.kind", wanted, shown(stated), hint)]
    if not isinstance(crane, dict) or likely == STATES_NONE:
        return likely, faults
    hint = f'the keys are those of kind "{likely}"; a crane that states no kind is a "{STATES_NONE}" crane'
    return likely, [*faults, Fault("", "crane.kind", wanted, "nothing: the key is missing", hint)]


_FOLLOWS = (
    "leave it out: whether a tower crane moves in the plane of its jib or in space follows from what the case drives "
    "and from its wind"
)


def _one_of(kinds: Iterable[str]) -> str:
    return "one of " + ", ".join(f'"{kind}"' for kind in kinds)


class EveryKey(Set[str]):
    """Every dotted key that a case of some kind knows; what the first kinds know needs no other to be loaded."""

    def __contains__(self, key: object) -> bool:
        return any(key in _keys(kind) for kind in KINDS)

    def __iter__(self) -> Iterator[str]:
        return iter(frozenset().union(*(_keys(kind) for kind in KINDS)))

    def __len__(self) -> int:
        return sum(1 for _ in self)


def knows(kind: str, key: str) -> bool:
    """Whether a kind knows a dotted key."""
    return plain_key(key) in _keys(kind)


def known_leaves(tree: dict[str, Any], kind: str) -> dict[str, Any]:
    """Values of a case as written by those dotted keys that a kind knows."""
    return {key: value for key, value in leaves(tree) if knows(kind, key)}


def known_to(key: str) -> list[str]:
    """Kinds that know a dotted key."""
    return [kind for kind in KINDS if key in _keys(kind)]


def of_kinds(kinds: Iterable[str]) -> str:
    """Kinds in words."""
    *most, last = (f'"{kind}"' for kind in kinds)
    return f"cranes of kind {', '.join(most)}{' or ' if most else ''}{last}"


@lru_cache(4096)
def plain_key(key: str) -> str:
    """A dotted key without the numbers of list items."""
    return ".".join(part for part in key.split(".") if not part.isdecimal())


def unit_of(kind: str, key: str) -> str | None:
    """SI unit of a dotted key that this kind knows; None if its value is no quantity."""
    within: list[type[Table]] = [KINDS[kind].tables]
    *parents, last = plain_key(key).split(".")
    for name in parents:
        fields = [table.named()[name] for table in within if name in table.named()]
        within = [inner for field in fields for inner in tables(field.annotation)]
    metadata = [m for table in within if last in table.named() for m in table.named()[last].metadata]
    return next((m.unit for m in metadata if isinstance(m, Quantity)), None)


@cache
def _keys(kind: str) -> frozenset[str]:
    return frozenset(known_keys(KINDS[kind].tables))


def _likely(tree: dict[str, Any]) -> str:
    """The kind that knows most of the written keys; of equals the first that misses least of what a case needs."""
    written = {plain_key(key) for key, _ in leaves(tree)}
    if written <= _keys(STATES_NONE) and not _missing(KINDS[STATES_NONE].tables, tree):
        # No other kind knows more.
        return STATES_NONE
    return max(KINDS, key=lambda kind: (len(written & _keys(kind)), -_missing(KINDS[kind].tables, tree)))


def _missing(table: type[Table], tree: dict[str, Any]) -> int:
    """How many keys a table needs that are not written, those of its tables included."""
    count = 0
    for name, required, inner in _fields(table):
        if name not in tree:
            count += required
        elif isinstance(tree[name], dict) and len(inner) == 1:
            count += _missing(inner[0], tree[name])
    return count


@cache
def _fields(table: type[Table]) -> list[tuple[str, bool, tuple[type[Table], ...]]]:
    """Name of each key of a table, whether it is needed, and the tables that it admits."""
    return [(name, field.is_required(), tables(field.annotation)) for name, field in table.model_fields.items()]

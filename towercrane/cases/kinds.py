"""Which kind of crane a case is about, and which keys each kind knows."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

from towercrane.cranes.registry import KINDS
from towercrane.schema.faults import Fault, closest, shown
from towercrane.schema.fields import Quantity, Table, known_keys, tables
from towercrane.schema.text import leaves

if TYPE_CHECKING:
    from collections.abc import Iterable


def relatives(kind: str) -> tuple[str, ...]:
    """Kinds of case that the same crane file serves, itself among them."""
    return tuple(other.name for other in KINDS.values() if other.family == KINDS[kind].family)


STATED = tuple(kind for kind in KINDS if len(relatives(kind)) > 1)
"""Kinds that a case states, for its crane's file serves more than one."""


def kind_of(tree: dict[str, Any]) -> tuple[str, list[Fault]]:
    """Kind of a case's crane and what is wrong with its statement.

    The crane states it, and a case may where the same crane file serves several. Where the statement is missing,
    unknown or in a file that cannot be read, the kind that knows most of the written keys is taken, so that the rest
    of the case is still judged by rules that fit it.
    """
    crane = tree.get("crane")
    stated = crane.get("kind") if isinstance(crane, dict) else None
    if "kind" in tree:
        return _of_case(tree["kind"], stated, tree)
    if isinstance(stated, str) and stated in KINDS:
        return stated, []
    likely = _likely(tree)
    key, wanted = "crane.kind", _one_of(KINDS)
    if stated is not None:
        near = closest(stated, KINDS) if isinstance(stated, str) else None
        hint = f'did you mean "{near}"?' if near else f'the keys are those of kind "{likely}"'
        return near or likely, [Fault("", key, wanted, shown(stated), hint)]
    if not isinstance(crane, dict) or likely == next(iter(KINDS)):
        return likely, []
    if likely in STATED:
        hint = f'put kind = "{likely}" at the top of the case: it has keys of that kind'
        return likely, [Fault("", "kind", _one_of(STATED), "nothing: the key is missing", hint)]
    hint = f'the keys are those of kind "{likely}"; a crane that states no kind is "{next(iter(KINDS))}"'
    return likely, [Fault("", key, wanted, "nothing: the key is missing", hint)]


def _of_case(stated: object, crane: object, tree: dict[str, Any]) -> tuple[str, list[Fault]]:
    """Kind of a case that states one itself beside what its crane states."""
    if stated not in STATED:
        near = closest(stated, STATED) if isinstance(stated, str) else None
        near = next((kind.name for kind in KINDS.values() if stated in kind.words), near)
        hint = f'did you mean "{near}"?' if near else "cranes of other kinds state theirs in the crane file"
        return near or _likely(tree), [Fault("", "kind", _one_of(STATED), shown(stated), hint)]
    kind = str(stated)
    if crane is None or crane in relatives(kind):
        return kind, []
    got = f"{shown(crane)} beside a case of kind {shown(kind)}"
    return kind, [Fault("", "crane.kind", _one_of(relatives(kind)), got)]


def _one_of(kinds: Iterable[str]) -> str:
    return "one of " + ", ".join(f'"{kind}"' for kind in kinds)


def every_key() -> frozenset[str]:
    """Every dotted key that a case of some kind knows."""
    return frozenset().union(*(_keys(kind) for kind in KINDS))


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


def plain_key(key: str) -> str:
    """A dotted key without the numbers of list items."""
    return ".".join(part for part in key.split(".") if not part.isdecimal())


def unit_of(kind: str, key: str) -> str | None:
    """SI unit of a dotted key that this kind knows; None if its value is no quantity."""
    within: list[type[Table]] = [KINDS[kind].tables]
    *parents, last = plain_key(key).split(".")
    for name in parents:
        fields = [table.model_fields[name] for table in within if name in table.model_fields]
        within = [inner for field in fields for inner in tables(field.annotation)]
    metadata = [m for table in within if last in table.model_fields for m in table.model_fields[last].metadata]
    return next((m.unit for m in metadata if isinstance(m, Quantity)), None)


@cache
def _keys(kind: str) -> frozenset[str]:
    return frozenset(known_keys(KINDS[kind].tables))


def _likely(tree: dict[str, Any]) -> str:
    """The kind that knows most of the written keys; of equals the first."""
    written = {plain_key(key) for key, _ in leaves(tree)}
    return max(KINDS, key=lambda kind: len(written & _keys(kind)))

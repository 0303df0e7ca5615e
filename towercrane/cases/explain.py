"""Pydantic's findings on a case as faults that name the key, what belongs there and the likely slip."""

from __future__ import annotations

from types import UnionType
from typing import TYPE_CHECKING, Any, Literal, Union, get_args, get_origin

from towercrane.cases.kinds import known_to, of_kinds, plain_key
from towercrane.cranes.registry import KINDS
from towercrane.schema.faults import Fault, closest, now_called, shown
from towercrane.schema.fields import Quantity, Table, known_keys, tables

if TYPE_CHECKING:
    from pydantic import ValidationError
    from pydantic.fields import FieldInfo
    from pydantic_core import ErrorDetails

SHOWS_KEYS = 12
"""At most so many known keys are listed in one message."""


def explain(error: ValidationError, kind: str) -> list[Fault]:
    """One fault per slip; a misspelt key is not reported again as missing. The faults' file is left open."""
    details = error.errors(include_url=False)
    known = {_resolve(d["loc"], kind)[0]: d for d in details}
    faults, misspelt = [], set()
    for key, detail in known.items():
        if detail["type"] == "extra_forbidden":
            fault, meant = _unknown(key, detail, kind)
            faults.append(fault)
            misspelt.add(meant)
    for key, detail in known.items():
        if detail["type"] != "extra_forbidden" and not (detail["type"] == "missing" and key in misspelt):
            faults.append(_fault(key, detail, kind))
    return faults


def _resolve(loc: tuple[int | str, ...], kind: str) -> tuple[str, list[type[Table]], FieldInfo | None]:
    """Dotted key of a location, the tables it lies in and its field; tags of the motion shapes drop out."""
    parts: list[str] = []
    owners: list[type[Table]] = []
    inside: list[type[Table]] = [KINDS[kind].tables]
    field: FieldInfo | None = None
    for part in loc:
        tagged = [t for t in inside if len(inside) > 1 and part in get_args(_annotation(t, "shape"))]
        if tagged:
            inside = tagged
            continue
        parts.append(str(part))
        if isinstance(part, str):
            owners = inside
            field = next((t.named()[part] for t in owners if part in t.named()), None)
            inside = list(tables(field.annotation)) if field else []
    return ".".join(parts), owners, field


def _shapes_with(loc: tuple[int | str, ...], kind: str) -> list[str]:
    """Shapes of a motion that have the key of a location, which the shape that is stated has not."""
    if len(loc) < 3:
        return []
    *where, tag, name = loc
    owners = _resolve((*where, name), kind)[1]
    tags = {t: get_args(_annotation(t, "shape")) for t in owners}
    if not any(tag in own for own in tags.values()):
        return []
    return [str(shape) for t, own in tags.items() if name in t.named() for shape in own]


def _annotation(table: type[Table], name: str) -> Any:
    return table.model_fields[name].annotation if name in table.model_fields else None


def _unknown(key: str, detail: ErrorDetails, kind: str) -> tuple[Fault, str]:
    """Fault for a key that is not known, and the dotted key that was probably meant."""
    parent, _, name = key.rpartition(".")
    names = list(dict.fromkeys(n for t in _resolve(detail["loc"], kind)[1] for n in t.named()))
    elsewhere = known_to(plain_key(key))
    shapes = _shapes_with(detail["loc"], kind)
    meant = closest(name, names) if kind in elsewhere or not elsewhere else None
    if former := now_called(name, names):
        meant, hint = former, f'now called "{former}"'
    elif shapes:
        meant, hint = None, f"a key of shape = {' or '.join(shown(shape) for shape in shapes)}"
    elif meant:
        hint = f'closest known key: "{meant}"'
    elif elsewhere and kind not in elsewhere:
        hint = f'a key of {of_kinds(elsewhere)}; this crane is of kind "{kind}"'
    else:
        places = sorted({k for k in known_keys(KINDS[kind].tables) if k.rpartition(".")[2] == name})
        hint = f'"{name}" is known as {" or ".join(places)}' if places else ""
    listed = ", ".join(names[:SHOWS_KEYS]) + (", ..." if len(names) > SHOWS_KEYS else "")
    fault = Fault("", key, f"one of the keys {listed}", f'the unknown key "{name}"', hint)
    return fault, f"{parent}.{meant}" if parent else str(meant)


def _fault(key: str, detail: ErrorDetails, kind: str) -> Fault:
    slip, context = detail["type"], detail.get("ctx", {})
    field = _resolve(detail["loc"], kind)[2]
    got = shown(detail["input"])
    if slip == "quantity":
        return Fault("", key, context["wanted"], context["got"], context["hint"])
    if slip in ("union_tag_invalid", "union_tag_not_found"):
        shapes = [s.strip(" '") for s in context.get("expected_tags", _shapes(field)).split(",")]
        if slip == "union_tag_not_found":
            return Fault("", f"{key}.shape", _one_of(shapes), "nothing: the key is missing")
        near = closest(context["tag"], shapes)
        hint = f'did you mean "{near}"?' if near else ""
        return Fault("", f"{key}.shape", _one_of(shapes), shown(context["tag"]), hint)
    wanted = _wanted(key, field) or detail["msg"]
    if slip == "missing":
        return Fault("", key, wanted, "nothing: the key is missing")
    if slip == "too_long":
        return Fault("", key, f"{wanted}, {context['max_length']} at most", str(context["actual_length"]))
    hint = ""
    if slip == "literal_error" and field and isinstance(detail["input"], str):
        near = closest(detail["input"], _words(field.annotation))
        hint = f'did you mean "{near}"?' if near else ""
    return Fault("", key, wanted, got, hint)


def _wanted(key: str, field: FieldInfo | None) -> str:
    """What belongs in a field, in words."""
    if field is None:
        return ""
    for item in field.metadata:
        if isinstance(item, Quantity):
            return item.wanted
    annotation = field.annotation
    if words := _words(annotation):
        return _one_of(words)
    inner = list(tables(annotation))
    if get_origin(annotation) is tuple:
        if any("shape" in table.model_fields for table in inner):
            return "a list of tables, one per step"
        return f"tables [[{key}]]" if inner else _listed(get_args(annotation))
    if inner:
        required = [n for n, f in inner[0].model_fields.items() if f.is_required()]
        return f"a table [{key}]" + (f" with {', '.join(required)}" if required else "")
    if bounds := {k: getattr(m, k) for m in field.metadata for k in ("ge", "le") if hasattr(m, k)}:
        return f"a whole number from {bounds['ge']} to {bounds['le']}"
    return {bool: "true or false", str: "a text in quotes"}.get(annotation, "")  # type: ignore[arg-type]


def _listed(items: tuple[Any, ...]) -> str:
    """A list of words, of so many numbers of one quantity, or of any number."""
    if words := _words(items[0]):
        return f"a list of {_one_of(words)}"
    kinds = [item for each in items for item in getattr(each, "__metadata__", ()) if isinstance(item, Quantity)]
    if Ellipsis in items or not kinds:
        return "a list in brackets"
    return f"a list of {len(items)} in brackets, each {kinds[0].wanted}"


def _words(annotation: Any) -> tuple[str, ...]:
    """Words that a field may be, alone or beside None; nothing for a field of another sort."""
    if get_origin(annotation) is Literal:
        return get_args(annotation)
    if get_origin(annotation) in (Union, UnionType):
        return tuple(word for part in get_args(annotation) for word in _words(part))
    return ()


def _shapes(field: FieldInfo | None) -> str:
    found = [s for t in tables(field.annotation if field else None) for s in get_args(_annotation(t, "shape"))]
    return ",".join(found)


def _one_of(words: object) -> str:
    return "one of " + ", ".join(f'"{w}"' for w in words)  # type: ignore[attr-defined]

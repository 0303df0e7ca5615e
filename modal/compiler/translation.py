"""Python functions of numbers and arrays as instructions of LLVM, which `modal.compiler.native` compiles.

A function says the kinds of what it takes and gives in its annotations: ``float``, ``int``, ``bool``, ``None``,
tuples of those, named tuples, and what `modal.compiler.kinds` lists. It may assign, branch, loop and call such
functions; a variable keeps the kind of its first value, or is said to be a `Number`. Numbers are those of the
machine: no division fails, integers have 64 bits. Indices count from the front and are not checked. All arrays are
contiguous, and so is each part of one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, get_args, get_origin, get_type_hints

from llvmlite import ir

from modal.compiler import kinds as named
from modal.compiler.arithmetic import BIT, DOUBLE, VECTOR, WHOLE, Arithmetic, Untranslatable
from modal.compiler.expressions import Array
from modal.compiler.statements import Body

if TYPE_CHECKING:
    from collections.abc import Callable

SCALARS: dict[Any, Any] = {float: DOUBLE, int: WHOLE, bool: BIT}
ENTRIES = {"double": DOUBLE, "whole": WHOLE, "lanes": VECTOR, "procedure": ir.IntType(8).as_pointer()}


class Library:
    """Functions, and what they call, translated into one LLVM module, each once.

    Parameters
    ----------
    name : str
    functions : list of callable
        Those that are there for all under their own names; LLVM may do away with others.
    """

    def __init__(self, name: str, functions: list[Callable[..., Any]]) -> None:
        self.module = ir.Module(name)
        self._open = functions
        self._done: dict[Any, tuple[Any, Any]] = {}
        for python in functions:
            self.function(python, DOUBLE)

    def function(self, python: Callable[..., Any], number: Any) -> tuple[Any, Any]:
        """LLVM function of a Python function, and the kind of what it gives.

        Of one that takes doubles or lane vectors, the function of either.
        """
        kinds = kinds_of(python)
        # Functions of doubles alone are the same for all.
        key = python, number if any(_entry(kind) == "number" for kind in kinds.values()) else None
        if key not in self._done:
            gives = kinds.pop("return")
            taken = [part for kind in kinds.values() for part in parts_of(kind, number)]
            is_open = python in self._open
            name = python.__name__ if is_open else f"{python.__module__}.{python.__qualname__}.{number}"
            made = ir.Function(self.module, ir.FunctionType(_given_back(gives, number), taken), name)
            made.linkage = "external" if is_open else "internal"
            self._done[key] = made, gives
            try:
                Body(self, python, made, _arguments(kinds, list(made.args), number), gives, number)
            except Untranslatable as fault:
                raise Untranslatable(f"{python.__qualname__}: {fault}") from None
        return self._done[key]

    def call(self, where: Arithmetic, python: Callable[..., Any], values: list[Any]) -> Any:
        """What a function gives for values."""
        given = [part for value in values for part in _handed_over(value)]
        wide = VECTOR in [part.type.pointee if part.type.is_pointer else part.type for part in given]
        called, gives = self.function(python, VECTOR if wide else DOUBLE)
        kinds = called.function_type.args
        if len(given) != len(kinds):
            raise Untranslatable(f"{python.__qualname__}: wanted {len(kinds)} values, got {len(given)}")
        turned = [where.turned(value, kind) for value, kind in zip(given, kinds, strict=True)]
        found = where.builder.call(called, turned)
        if get_origin(gives) is not tuple:
            return found
        return tuple(where.builder.extract_value(found, index) for index in range(len(get_args(gives))))


def kinds_of(python: Callable[..., Any]) -> dict[str, Any]:
    """Kinds of what a function takes, by name, and gives, "return"."""
    hints = get_type_hints(python, python.__globals__ | vars(named), include_extras=True)
    return hints | {"return": None if hints["return"] is type(None) else hints["return"]}


def fields_of(kind: Any) -> dict[str, Any]:
    """Kinds of what a named tuple holds, by name; nothing of other kinds."""
    return get_type_hints(kind, None, vars(named), include_extras=True) if hasattr(kind, "_fields") else {}


def _entry(kind: Any) -> str:
    """What the entries of an array are, or a number or procedure of no fixed kind."""
    return str(get_args(kind)[1]) if get_origin(kind) is Annotated else ""


def parts_of(kind: Any, number: Any = DOUBLE) -> list[Any]:
    """LLVM types in which a kind is handed over."""
    if fields := fields_of(kind):
        return [part for own in fields.values() for part in parts_of(own, number)]
    if get_origin(kind) is Annotated:
        _, entry, axes = get_args(kind)
        held = number if entry == "number" else ENTRIES[entry]
        return [held.as_pointer(), *[WHOLE] * axes] if axes else [held]
    return [SCALARS[own] for own in get_args(kind) or (kind,)]


def _handed_over(value: Any) -> list[Any]:
    """Parts in which a value is handed over."""
    if isinstance(value, Array):
        return [value.pointer, *value.sizes]
    if isinstance(value, dict):
        return [part for own in value.values() for part in _handed_over(own)]
    return list(value) if isinstance(value, tuple) else [value]


def _given_back(kind: Any, number: Any) -> Any:
    """LLVM type in which a kind is given back."""
    if kind is None:
        return ir.VoidType()
    parts = parts_of(kind, number)
    return ir.LiteralStructType(parts) if get_origin(kind) is tuple else parts[0]


def _arguments(kinds: dict[str, Any], given: list[Any], number: Any) -> dict[str, Any]:
    """Values of arguments from what they are handed over in."""
    found: dict[str, Any] = {}
    for name, kind in kinds.items():
        if fields := fields_of(kind):
            found[name] = _arguments(fields, given, number)
            continue
        parts = tuple(given.pop(0) for _ in parts_of(kind, number))
        if get_origin(kind) is Annotated and len(parts) > 1:
            found[name] = Array(parts[0], parts[1:])
        else:
            found[name] = parts if get_origin(kind) is tuple else parts[0]
    return found

"""Python functions of numbers and arrays as instructions of LLVM, which `modal.compiler.native` compiles.

A function says the kinds of what it takes and gives in its annotations: ``float``, ``int``, ``bool``, ``None``,
tuples of those, and what `modal.compiler.kinds` lists. It may assign, branch, loop and call such functions; a
variable keeps the kind of its first value. Numbers are those of the machine: no division fails, integers have 64
bits. Indices count from the front and are not checked. All arrays are contiguous, and so is each part of one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, get_args, get_origin

from llvmlite import ir

from modal.compiler import kinds as named
from modal.compiler.expressions import BIT, DOUBLE, WHOLE, Array, Expressions, Untranslatable
from modal.compiler.statements import Body

if TYPE_CHECKING:
    from collections.abc import Callable

SCALARS: dict[Any, Any] = {float: DOUBLE, int: WHOLE, bool: BIT}
ENTRIES = {"double": DOUBLE, "whole": WHOLE}


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
            self.function(python)

    def function(self, python: Callable[..., Any]) -> tuple[Any, Any]:
        """LLVM function of a Python function, and the kind of what it gives."""
        if python not in self._done:
            kinds = kinds_of(python)
            gives, taken = kinds.pop("return"), [part for kind in kinds.values() for part in _parts(kind)]
            is_open = python in self._open
            name = python.__name__ if is_open else f"{python.__module__}.{python.__qualname__}"
            made = ir.Function(self.module, ir.FunctionType(_given_back(gives), taken), name)
            made.linkage = "external" if is_open else "internal"
            self._done[python] = made, gives
            Body(self, python, made, _arguments(kinds, list(made.args)), gives)
        return self._done[python]

    def call(self, where: Expressions, python: Callable[..., Any], values: list[Any]) -> Any:
        """What a function gives for values."""
        called, gives = self.function(python)
        given: list[Any] = []
        for value in values:
            parts = (value.pointer, *value.sizes) if isinstance(value, Array) else value
            given += parts if isinstance(parts, tuple) else (parts,)
        kinds = called.function_type.args
        if len(given) != len(kinds):
            raise Untranslatable(f"{python.__qualname__}: wanted {len(kinds)} values, got {len(given)}")
        turned = [where.turned(value, kind) for value, kind in zip(given, kinds, strict=True)]
        found = where.builder.call(called, turned)
        if not get_args(gives):
            return found
        return tuple(where.builder.extract_value(found, index) for index in range(len(get_args(gives))))

    def intrinsic(self, name: str, count: int = 1) -> Any:
        """LLVM's own function of so many numbers."""
        kind = ir.FunctionType(DOUBLE, [DOUBLE] * count)
        return self.module.declare_intrinsic(f"llvm.{name}", [DOUBLE], kind)

    def outside(self, name: str) -> Any:
        """A function of one number of the system's library."""
        found = self.module.globals.get(name)
        return found or ir.Function(self.module, ir.FunctionType(DOUBLE, [DOUBLE]), name)


def kinds_of(python: Callable[..., Any]) -> dict[str, Any]:
    """Kinds of what a function takes, by name, and gives, "return"."""
    names = python.__globals__ | vars(named)
    return {
        name: eval(kind, names) if isinstance(kind, str) else kind for name, kind in python.__annotations__.items()
    }


def _parts(kind: Any) -> list[Any]:
    """LLVM types in which a kind is handed over."""
    if get_origin(kind) is Annotated:
        _, entry, axes = get_args(kind)
        return [ENTRIES[entry].as_pointer(), *[WHOLE] * axes]
    return [SCALARS[own] for own in get_args(kind) or (kind,)]


def _given_back(kind: Any) -> Any:
    """LLVM type in which a kind is given back."""
    if kind is None:
        return ir.VoidType()
    return ir.LiteralStructType(_parts(kind)) if get_args(kind) else SCALARS[kind]


def _arguments(kinds: dict[str, Any], given: list[Any]) -> dict[str, Any]:
    """Values of arguments from what they are handed over in."""
    found: dict[str, Any] = {}
    for name, kind in kinds.items():
        parts = tuple(given.pop(0) for _ in _parts(kind))
        if get_origin(kind) is Annotated:
            found[name] = Array(parts[0], parts[1:])
        else:
            found[name] = parts if get_args(kind) else parts[0]
    return found

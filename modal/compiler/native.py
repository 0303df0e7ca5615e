"""Compiled functions: translated together, module by module, and kept on disk.

Their annotations say what each value is, and LLVM optimises what calls each other at once.
"""

from __future__ import annotations

import ctypes
import threading
from functools import partial
from typing import TYPE_CHECKING, Any, get_args

import numpy as np

from modal.compiler.folder import room_of, sources
from modal.compiler.machine_code import loaded

if TYPE_CHECKING:
    from collections.abc import Callable

    Given = Callable[[Any], tuple[Any, ...]]

_one_at_a_time = threading.RLock()

NUMBERS: dict[Any, Any] = {float: ctypes.c_double, int: ctypes.c_int64, bool: ctypes.c_bool, None: None}

ENTRIES = {"double": "float64", "whole": "int64", "number": "float64", "lanes": "float64"}


def native(name: str, *functions: Callable[..., Any]) -> tuple[Native, ...]:
    """Functions compiled together, see `modal.compiler.translation`, when one is first called from Python.

    They take numbers, arrays, named tuples of those and compiled procedures, and give a number or nothing.

    Parameters
    ----------
    name : str
        What their machine code is called on disk.
    functions : callable
        Those that Python calls; what they call in their turn is compiled with them.
    """
    together: list[Native] = []
    together += [Native(python, name, together) for python in functions]
    return tuple(together)


class Native:
    """A function that is called as compiled."""

    def __init__(self, python: Callable[..., Any], name: str, together: list[Native]) -> None:
        self.python, self.name, self.together = python, name, together
        self.entry: Any = None
        self.given: list[Given] = []

    def __call__(self, *arguments: Any) -> Any:
        """Call it; numbers are turned into its own kinds, arrays must be of them."""
        if self.entry is None:
            _load(self.name, self.together)
        values: list[Any] = []
        for convert, argument in zip(self.given, arguments, strict=True):
            values += convert(argument)
        return self.entry(*values)

    def connect(self, engine: Any, kinds: dict[str, Any]) -> None:
        """Let Python in."""
        types: list[Any] = []
        gives = kinds.pop("return")
        given = [_door(f"{self.python.__name__}: {name}", kind, types) for name, kind in kinds.items()]
        # The entry comes last: who finds one calls it.
        self.given, self.engine = given, engine
        address = engine.get_function_address(self.python.__name__)
        self.entry = ctypes.CFUNCTYPE(NUMBERS[gives], *types)(address)


def _load(name: str, together: list[Native]) -> None:
    """Machine code of functions into this process, once: another engine would take that from who is in it."""
    from modal.compiler.translation import Library, kinds_of

    with _one_at_a_time:
        if all(door.entry is not None for door in together):
            return
        functions = [door.python for door in together]
        rooms = dict.fromkeys(room_of(python.__code__.co_filename) for python in functions)
        stamp = sources("modal/compiler", *rooms)
        engine = loaded(name, stamp, lambda: Library(name, functions).module)
        for door in together:
            door.connect(engine, kinds_of(door.python))


def _door(name: str, kind: Any, types: list[Any]) -> Given:
    """What turns an argument into what is handed over; the types of that are added."""
    from modal.compiler.translation import fields_of

    if fields := fields_of(kind):
        return _record([_door(f"{name}.{own}", held, types) for own, held in fields.items()])
    if not get_args(kind):
        types.append(NUMBERS[kind])
        return partial(_number, kind)
    _, entry, axes = get_args(kind)
    if entry == "procedure":
        types.append(ctypes.c_void_p)
        return _address
    if not axes:
        types.append(ctypes.c_double)
        return partial(_number, float)
    types += [ctypes.c_void_p] + [ctypes.c_int64] * axes
    return array_door(name, ENTRIES[entry], axes + (entry == "lanes"), axes)


def _record(doors: list[Given]) -> Given:
    def given(record: Any) -> tuple[Any, ...]:
        return tuple(part for door, own in zip(doors, record, strict=True) for part in door(own))

    return given


def _number(kind: type, value: Any) -> tuple[Any]:
    return (kind(value),)


def _address(procedure: Any) -> tuple[int]:
    return (procedure.address,)


def array_door(name: str, entries: str, axes: int, lengths: int) -> Given:
    """What turns an array of so many axes into its place and its first lengths, or refuses another."""
    wanted = np.dtype(entries)

    def given(array: Any) -> tuple[int, ...]:
        flags = array.flags
        if array.dtype != wanted or array.ndim != axes or not flags.c_contiguous:
            raise TypeError(f"{name}: wanted {wanted} in order, {axes} axes, got {array.dtype} {array.shape}")
        # An array takes six times as long to say where it is.
        quick = array.size and flags.writeable
        place = ctypes.addressof(ctypes.c_char.from_buffer(array)) if quick else array.ctypes.data
        return place, *array.shape[:lengths]

    return given

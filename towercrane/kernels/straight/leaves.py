"""Numbers of a record of constants in one row, and the record with other things in their places.

Equations are given a frozen dataclass of constants. Its fields of type ``float`` and ``Floats`` are numbers that may
differ from run to run, those of type ``Table`` the table that is looked up as the run goes, and dataclasses in it and
tuples of them are taken apart in the same way. All else is known when the equations are written out: how many, which,
whether.
"""

from __future__ import annotations

from dataclasses import Field, fields, is_dataclass
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Record = TypeVar("Record")

NUMBERS = "float", float, "Floats"
"""Types of fields that are numbers, as modules with annotations evaluated later or at once have them."""

CHANGING = {"changes": True}
"""Metadata of a number that a switch changes during a run."""

NO_TABLE = np.empty((0, 0, 0))


def numbers_of(constants: Any) -> Floats:
    """All numbers of constants in the order of their fields, arrays row by row."""
    return np.concatenate([np.empty(0), *(np.ravel(value) for _, value in _numbers(constants))])


def table_of(constants: Any) -> Floats:
    """The table of constants, empty if they have none; shape (cells, rows, terms)."""
    return next(_tables(constants), NO_TABLE)


def _tables(constants: Any) -> Iterator[Floats]:
    if is_dataclass(constants):
        for field in fields(constants):
            value = getattr(constants, field.name)
            if field.type == "Table":
                yield np.asarray(value)
            else:
                yield from _tables(value)


def known_of(constants: Any) -> Any:
    """All of constants but the numbers: equal for those that the same equations serve.

    Raises
    ------
    TypeError
        If a number is in a field of another type: it would be taken for known.
    """
    if isinstance(constants, tuple):
        return tuple(map(known_of, constants))
    if isinstance(constants, float | np.ndarray):
        raise TypeError(f"wanted a field of type float or Floats for a number, got {constants!r} in another")
    if not is_dataclass(constants):
        return constants
    found: list[Any] = [type(constants)]
    for field in fields(constants):
        value = getattr(constants, field.name)
        if field.type in (*NUMBERS, "Table"):
            found.append(np.shape(value))
        else:
            found.append(known_of(value))
    return tuple(found)


def place_of(constants: Any, name: str) -> int:
    """Where a number of constants, by the name of its field, is among all."""
    place = 0
    for field, value in _numbers(constants):
        if field.name == name:
            return place
        place += np.size(value)
    raise KeyError(name)


def changing(constants: Any) -> tuple[int, ...]:
    """Places of the numbers that a switch changes."""
    return tuple(place_of(constants, field.name) for field, _ in _numbers(constants) if field.metadata.get("changes"))


def with_numbers(constants: Record, numbers: Any, table: Any) -> Record:
    """The same constants with other values, or operands, in place of numbers and table; they are not checked."""
    return _rebuilt(constants, iter(numbers), table)


def _numbers(constants: Any) -> Iterator[tuple[Field[Any], Any]]:
    if isinstance(constants, tuple):
        for part in constants:
            yield from _numbers(part)
    elif is_dataclass(constants):
        for field in fields(constants):
            value = getattr(constants, field.name)
            if field.type in NUMBERS:
                yield field, value
            else:
                yield from _numbers(value)


def _rebuilt(constants: Any, numbers: Iterator[Any], table: Any) -> Any:
    if isinstance(constants, tuple):
        return tuple(_rebuilt(part, numbers, table) for part in constants)
    if not is_dataclass(constants):
        return constants
    made = object.__new__(type(constants))
    for field in fields(constants):
        value = getattr(constants, field.name)
        if field.type in NUMBERS[:2]:
            value = next(numbers)
        elif field.type == "Floats":
            entries = np.empty(np.shape(value), dtype=object)
            for index in np.ndindex(*entries.shape):
                entries[index] = next(numbers)
            value = entries
        elif field.type == "Table":
            value = table
        else:
            value = _rebuilt(value, numbers, table)
        object.__setattr__(made, field.name, value)
    return made

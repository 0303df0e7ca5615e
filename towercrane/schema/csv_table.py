"""Tables of numbers in CSV files: a header line whose names carry units, then one line of numbers for each time.

One reader serves every table that a case names. What a message quotes of such a file are numbers, never its text.
"""

from __future__ import annotations

import csv
import math
import re
import stat
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from towercrane.schema.faults import CaseError, Fault
from towercrane.schema.units import COMMON, UnitError, to_si, wanted

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

MOST_BYTES = 8_000_000
"""Size of the largest file that is read."""

MOST_ROWS = 50_000
"""Lines of numbers of the longest table: ten a second for 83 minutes. The solver restarts at each."""

SHOWN_FAULTS = 5
"""At most so many faulty lines of one file are reported."""

IN_BRACKETS = re.compile(r"(.*?)\s*(?:\[([^\[\]]*)\]|\(([^()]*)\))")
"""A name with its unit in brackets."""

COUNTS = {2: "two", 3: "three", 4: "four"}

KINDS_IN_WORDS = {
    "s": "seconds",
    "m": "metres",
    "rad": "radians",
    "m/s": "metres per second",
    "m/s^2": "metres per second squared",
}
"""SI units of columns in words."""


@dataclass(frozen=True, slots=True)
class Column:
    """A column that a table must have.

    Parameters
    ----------
    name : str
        What messages call it.
    unit : str
        SI unit, in which numbers are where the header states none; a key of
        :data:`towercrane.schema.units.QUANTITIES`.
    words : tuple of str
        Names in a header that mean this column wherever it stands; others stand in their order.
    """

    name: str
    unit: str
    words: tuple[str, ...] = ()


TIME = Column("time", "s", ("time", "t"))
"""First column of every table."""


@dataclass(frozen=True, eq=False)
class CsvTable:
    """Numbers of a CSV file.

    Parameters
    ----------
    path : Path
    lines : tuple of int
        Line of the file that each row is from.
    written : ndarray, shape (rows, columns)
        Numbers as they stand in the file, in the order that was asked for.
    values : ndarray, shape (rows, columns)
        The same in SI.
    """

    path: Path
    lines: tuple[int, ...]
    written: Floats
    values: Floats

    def fault(self, row: int, wanted: str, got: str, hint: str = "") -> Fault:
        """Fault at a row."""
        return Fault(str(self.path), f"line {self.lines[row]}", wanted, got, hint)


def read_table(path: Path, columns: Sequence[Column]) -> CsvTable:
    """Table of a file, times first, which increase from 0.

    Empty lines and lines that begin with ``#`` are no part of it.

    Raises
    ------
    CaseError
        If the file is no regular file of at most `MOST_BYTES`, or is no such table; with `SHOWN_FAULTS` at most.
    """
    names = ", ".join(column.name for column in columns)
    what = f"a CSV file: a header line, then lines of {names}"
    text = _text(path, what)
    rows = [
        (number, line)
        for number, line in enumerate(text.splitlines(), start=1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    file, count = str(path), COUNTS[len(columns)]
    each = f"{count} columns, {count} finite numbers: {names}"
    if rows and len(_numbers(_cells(rows[0][1]))) == len(columns):
        raise CaseError([Fault(file, f"line {rows[0][0]}", "a header line", "numbers", f"{names} with units")])
    if len(rows) < 3:
        lines = max(len(rows) - 1, 0)
        raise CaseError([Fault(file, "", what, f"{lines} lines of numbers", "two or more are needed")])
    if len(rows) - 1 > MOST_ROWS:
        got, hint = f"{len(rows) - 1} lines", "take every tenth, or a part"
        raise CaseError([Fault(file, "", f"at most {MOST_ROWS} lines of numbers", got, hint)])
    found = _parsed([line for _, line in rows[1:]], len(columns))
    if found is None:
        slips = [(number, _slip(line, columns)) for number, line in rows[1:]]
        if faults := [Fault(file, f"line {number}", each, *slip) for number, slip in slips if slip]:
            raise CaseError(faults[:SHOWN_FAULTS])
        found = np.array([_numbers(_cells(line)) for _, line in rows[1:]])
    places, factors = _header(path, rows[0][0], _cells(rows[0][1]), columns, each)
    written = np.ascontiguousarray(found[:, places])
    table = CsvTable(path, tuple(number for number, _ in rows[1:]), written, written * factors)
    if late := _late(table):
        raise CaseError(late[:SHOWN_FAULTS])
    return table


def _text(path: Path, what: str) -> str:
    """Text of a regular file that is not too large; nothing else is opened, for a device or a pipe may never end."""
    got = hint = ""
    try:
        if stat.S_ISREG(path.stat().st_mode):
            with open(path, "rb") as file:
                content = file.read(MOST_BYTES + 1)
            if len(content) <= MOST_BYTES:
                return content.decode("utf-8-sig")
            what, got, hint = f"a file of at most {MOST_BYTES / 1e6:g} MB", "a larger one", "take every tenth line"
        else:
            what, got = f"{what}, in a regular file", "a folder, a device or a pipe"
    except UnicodeDecodeError:
        got, hint = "text that is not UTF-8", "save the file with the encoding UTF-8"
    except (OSError, ValueError):
        got, hint = "no readable file", "the path is relative to the case file"
    raise CaseError([Fault(str(path), "", what, got, hint)])


def _cells(line: str) -> list[str]:
    try:
        return [cell.strip() for cell in next(csv.reader([line], skipinitialspace=True))]
    except csv.Error:
        return []


def _numbers(cells: list[str]) -> list[float]:
    """The finite numbers among cells."""
    numbers = []
    for cell in cells:
        try:
            number = float(cell)
        except ValueError:
            continue
        if math.isfinite(number):
            numbers.append(number)
    return numbers


def _parsed(lines: list[str], columns: int) -> Floats | None:
    """Finite numbers of all lines; None if one has others or a slip, which :func:`_slip` looks for."""
    try:
        found = np.loadtxt(lines, delimiter=",", quotechar='"', comments=None, ndmin=2)
    except ValueError:
        return None
    return found if found.shape[1] == columns and np.all(np.isfinite(found)) else None


def _slip(line: str, columns: Sequence[Column]) -> tuple[str, str] | None:
    """What a line has instead of numbers in so many columns, and why perhaps; None for one that is right."""
    cells = _cells(line)
    hint = "columns are parted by commas, decimals by points" if ";" in line or "\t" in line else ""
    if len(cells) != len(columns):
        hint = "the decimal sign is a point, not a comma" if len(cells) == 2 * len(columns) else hint
        return f"{len(cells)} in this line", hint
    bad = next((k for k, cell in enumerate(cells, start=1) if not _numbers([cell])), 0)
    si = " and ".join(dict.fromkeys(KINDS_IN_WORDS[column.unit] for column in columns))
    hint = hint or f"numbers stand without units, which the header names: time [s], or that are {si}"
    return (f"none in column {bad}", hint) if bad else None


def _header(
    path: Path, number: int, cells: list[str], columns: Sequence[Column], each: str
) -> tuple[list[int], list[float]]:
    """Place of each column in the file and size of its unit in SI."""
    key = f"line {number}"
    if len(cells) != len(columns):
        raise CaseError([Fault(str(path), key, each, f"{len(cells)} in this line", "the header names each column")])
    split = [match.groups() if (match := IN_BRACKETS.fullmatch(cell)) else (cell, None, None) for cell in cells]
    names = [name.strip().lower() for name, _, _ in split]
    places = [[at for at, name in enumerate(names) if name in column.words] for column in columns]
    if twice := next((column.name for column, at in zip(columns, places, strict=True) if len(at) > 1), None):
        raise CaseError([Fault(str(path), key, each, f"{twice} twice", "each column stands once")])
    free = iter([at for at in range(len(cells)) if [at] not in places])
    order = [at[0] if at else next(free) for at in places]
    faults, factors = [], []
    for column, at in zip(columns, order, strict=True):
        name, square, round_ = split[at]
        unit = square if square is not None else round_
        try:
            factors.append(_size(name, unit, column.unit))
        except UnitError as error:
            asked = f"column {at + 1} ({column.name}): {wanted(column.unit)}"
            faults.append(Fault(str(path), key, asked.replace("such as", "its unit as in"), error.got, error.hint))
    if faults:
        raise CaseError(faults)
    return order, factors


def _size(name: str, unit: str | None, si: str) -> float:
    """Size in SI of a header's unit; without one numbers are SI, unless the name ends in what looks like another."""
    listed = f"known units: {', '.join(COMMON)}, and such as km/h or deg/s made of them"
    if unit is not None:
        try:
            return to_si(f"1 {unit}", si)
        except UnitError as error:
            got = "an unknown unit" if "unknown" in error.got or "cannot be read" in error.got else "another quantity"
            raise UnitError("", got if unit.strip() else "an empty unit", listed) from None
    last = re.split(r"[\s_/,.:-]+", name)[-1]
    if last != name and last in (*COMMON, "kmh", "kph", "mph", "degrees", "degree", "kn"):
        try:
            looks_si = to_si(f"1 {last}", si) == 1.0
        except UnitError as error:
            # A time t is no tonne; what is no unit at all and still says one is.
            looks_si = "unknown" not in error.got
        if not looks_si:
            raise UnitError("", "a name that ends in a unit without brackets", "write it as: time [s]") from None
    return 1.0


def _late(table: CsvTable) -> list[Fault]:
    """Rows whose time is not after the one before, or the first if it is not 0."""
    times = table.written[:, 0]
    faults = []
    if times[0] != 0.0:
        faults.append(
            table.fault(0, "a first time of 0", f"{times[0]:g}", "times count from the start of the motion")
        )
    for row in (np.flatnonzero(np.diff(times) <= 0.0) + 1).tolist():
        hint = f"times increase: here a time after {times[row - 1]:g} is due"
        faults.append(table.fault(row, "a time after the last", f"{times[row]:g}", hint))
    return faults

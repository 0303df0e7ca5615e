"""What is wrong with a case file, said so that its author can mend it."""

from __future__ import annotations

import difflib
import json
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable


FORMER = {
    "jib_modes": ("jib_vertical_modes",),
    "jib_damping_ratio": ("jib_vertical_damping_ratio",),
    "swing_angle": ("sway_radial", "sway_in_plane", "sway_along_runway"),
    "swing_angle_sideways": ("sway_tangential", "sway_lateral", "sway_along_bridge"),
    "tower_coordinate": ("tower_x_coordinate",),
    "jib_coordinate": ("jib_vertical_coordinate",),
    "rope_tension": ("hoist_rope_force",),
    "luffing_rope_tension": ("luffing_rope_force",),
}
"""What keys and outputs were called, and what they are called now, of one kind of crane or another."""

LONGEST_LINE = 1000
"""Letters of a line of a message; paths may be long, what somebody sets longer."""


@dataclass(frozen=True, slots=True)
class Fault:
    """One fault of an input file.

    Parameters
    ----------
    file : str
        File, or ``--set key=value``, that the fault is in.
    key : str
        Dotted key within that file, or the line; empty: the file as a whole.
    wanted, got : str
        What belongs there and what stands there.
    hint : str
        Likely cause or closest known key; empty if there is none.
    """

    file: str
    key: str
    wanted: str
    got: str
    hint: str = ""

    def __str__(self) -> str:
        lines = [f"{self.file}: {self.key}" if self.key else self.file]
        lines += [f"  wanted: {self.wanted}", f"  got:    {self.got}"]
        if self.hint:
            lines.append(f"  hint:   {self.hint}")
        shown_lines = (printable(line) for line in lines)
        return "\n".join(f"{line[:LONGEST_LINE]}..." if len(line) > LONGEST_LINE else line for line in shown_lines)


class CaseError(ValueError):
    """A case that cannot be used; lists every fault found.

    Parameters
    ----------
    faults : iterable of Fault
    """

    def __init__(self, faults: Iterable[Fault]) -> None:
        self.faults = list(faults)
        count = len(self.faults)
        heading = f"{count} fault{'' if count == 1 else 's'} in the input"
        super().__init__("\n\n".join([heading, *map(str, self.faults)]))


def closest(word: str, known: Iterable[str]) -> str | None:
    """The known word most like ``word``, or None if none is near; case does not matter."""
    by_lower = {k.lower(): k for k in known}
    found = difflib.get_close_matches(word.lower(), by_lower, n=1)
    return by_lower[found[0]] if found else None


def now_called(word: str, known: Iterable[str]) -> str | None:
    """The known word that a former name stands for, if it is one."""
    return next((name for name in known if name in FORMER.get(word, ())), None)


def did_you_mean(word: str, known: Iterable[str], otherwise: str = "") -> str:
    """Hint that names the new name of a former one, the closest known word, or ``otherwise`` if none is near."""
    known = list(known)
    if name := now_called(word, known):
        return f'now called "{name}"'
    near = closest(word, known)
    return f'did you mean "{near}"?' if near else otherwise


def printable(text: str) -> str:
    """Text in which everything that a terminal would obey, or no encoding can write, is spelled out."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)


def printable_lines(text: str) -> str:
    """Printable text that may have several lines."""
    return text if text.isprintable() else "\n".join(map(printable, text.split("\n")))


def shown(value: object) -> str:
    """A TOML value as its author would write it, shortened to one line."""
    if isinstance(value, dict):
        return f"a table with {', '.join(value)}" if value else "an empty table"
    if isinstance(value, list):
        return f"a list of {len(value)}" if value else "an empty list"
    if isinstance(value, str | bool):
        text = json.dumps(value, ensure_ascii=False)
    elif isinstance(value, float):
        text = repr(value)
    else:
        # Python refuses to print integers of more than 4300 digits.
        text = hex(value) if isinstance(value, int) and abs(value) > 10**40 else str(value)
    return text if len(text) <= 80 else text[:77] + "..."

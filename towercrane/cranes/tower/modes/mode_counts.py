"""Numbers of modes of a flexible crane."""

from __future__ import annotations

from dataclasses import dataclass

from modal.checks import whole_number


@dataclass(frozen=True, slots=True)
class ModeCounts:
    """Numbers of modes of each kind, zero for what is rigid.

    Parameters
    ----------
    tower : int
        Bending, in each direction: unlike numbers would make the tower stiffer one way than the other.
    torsion : int
        Of the tower.
    lateral, vertical : int
        Of the jib.
    counter_lateral, counter_vertical : int
        Of the counter-jib.

    Raises
    ------
    ValueError
        If one is no whole number of zero or more.
    """

    tower: int = 1
    torsion: int = 1
    lateral: int = 1
    vertical: int = 1
    counter_lateral: int = 0
    counter_vertical: int = 0

    def __post_init__(self) -> None:
        for name in self.__slots__:
            whole_number(f"ModeCounts.{name}", getattr(self, name))

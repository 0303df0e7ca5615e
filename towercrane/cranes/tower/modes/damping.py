"""Damping of a flexible crane's modes."""

from __future__ import annotations

from dataclasses import dataclass

from modal.checks import check_fields


@dataclass(frozen=True, slots=True)
class ModalDamping:
    """Damping of the modes of each kind as a fraction of critical.

    Parameters
    ----------
    tower, torsion, lateral, vertical, counter_lateral, counter_vertical : float
        Zero or more; of the jib to its sides and up and down, then of the counter-jib.

    Raises
    ------
    ValueError
        If one is negative or not finite.
    """

    tower: float = 0.0
    torsion: float = 0.0
    lateral: float = 0.0
    vertical: float = 0.0
    counter_lateral: float = 0.0
    counter_vertical: float = 0.0

    def __post_init__(self) -> None:
        check_fields(self, not_negative=self.__slots__)

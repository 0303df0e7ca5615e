"""Damping of a flexible crane's modes."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf


@dataclass(frozen=True, slots=True)
class ModalDamping:
    """Damping of the modes of each kind as a fraction of critical.

    Parameters
    ----------
    tower, torsion, lateral, vertical : float
        Zero or more.

    Raises
    ------
    ValueError
        If one is negative or not finite.
    """

    tower: float = 0.0
    torsion: float = 0.0
    lateral: float = 0.0
    vertical: float = 0.0

    def __post_init__(self) -> None:
        for name in self.__slots__:
            if not 0.0 <= getattr(self, name) < inf:
                raise ValueError(f"ModalDamping.{name}: wanted zero or more, got {getattr(self, name)!r}")

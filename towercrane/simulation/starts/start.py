"""What is asked of the start of a run."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from modal.checks import number_in

if TYPE_CHECKING:
    from collections.abc import Callable

STATES = "equilibrium", "quiet", "zero"
"""How the structure starts, see `Start`."""


@dataclass(frozen=True, slots=True)
class Start:
    """How a run starts.

    Parameters
    ----------
    state : {"equilibrium", "quiet", "zero"}
        The structure as it stands with its load hanging at rest in the mean wind; as it is at rest, and is not
        accelerated, while the load swings as stated; or undeformed, in still air.
    along, across : float, optional
        Sway of the load along and across the jib, as the crane's outputs have it [rad]; without, as it hangs.
    along_rate, across_rate : float
        Their rates, as a crane that turns sees them [rad/s].
    saved : tuple of float
        All states, as another run has left them; nothing else is then asked.
    time : float
        That had passed until then [s].

    Raises
    ------
    ValueError
        If the state is none of the three, or a number is not finite.
    """

    state: str = "equilibrium"
    along: float | None = None
    across: float | None = None
    along_rate: float = 0.0
    across_rate: float = 0.0
    saved: tuple[float, ...] = ()
    time: float = 0.0

    def __post_init__(self) -> None:
        if self.state not in STATES:
            raise ValueError(f"state: wanted {' or '.join(map(repr, STATES))}, got {self.state!r}")
        for name in ("along", "across", "along_rate", "across_rate"):
            if (value := getattr(self, name)) is not None:
                number_in(name, value, "a finite number")

    @property
    def swings(self) -> bool:
        """Whether a sway or a rate of it is stated."""
        stated = (self.along, self.across, self.along_rate or None, self.across_rate or None)
        return any(value is not None for value in stated)


HANGING = Start()
"""At rest, the load hanging in the mean wind."""


class Sways(NamedTuple):
    """What two angles of sway say of the rope: unit vector outward, to the left and up from both, and back."""

    direction: Callable[[Any, Any], tuple[Any, Any, Any]]
    angles: Callable[[Any, Any, Any], tuple[Any, Any]]


def _by_tangents(along: Any, across: Any) -> tuple[Any, Any, Any]:
    # Of a rope in one of both planes the other angle is zero, and the sum of squares is 1.
    outward, left = np.sin(along) * np.cos(across), np.cos(along) * np.sin(across)
    down = np.cos(along) * np.cos(across)
    norm = np.sqrt(outward * outward + left * left + down * down)
    return outward / norm, left / norm, -down / norm


SEEN_FROM_TWO_SIDES = Sways(_by_tangents, lambda outward, left, up: (np.arctan2(outward, -up), np.arctan2(left, -up)))
"""Each angle as it is seen from one side: atan2(along, down), atan2(across, down)."""

OUT_OF_PLANE = Sways(
    lambda along, across: (np.sin(along) * np.cos(across), np.sin(across), -np.cos(along) * np.cos(across)),
    lambda outward, left, up: (np.arctan2(outward, -up), np.arctan2(left, np.hypot(outward, up))),
)
"""The first as seen from the side, the second out of the jib's vertical plane: atan2(across, hypot(along, down))."""

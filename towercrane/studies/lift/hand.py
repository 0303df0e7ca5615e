"""What is known of a lift-off without a run: the formulas of a rope on a spring, and the classes of a standard."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping


class Class(NamedTuple):
    """phi_2 = least + slope v_h; the slope in s/m."""

    least: float
    slope: float

    def factor(self, speed: float) -> float:
        """At a hoisting speed [m/s]."""
        return self.least + self.slope * speed


HOISTING_CLASSES = {
    "HC1": Class(1.05, 0.17), "HC2": Class(1.10, 0.34), "HC3": Class(1.15, 0.51), "HC4": Class(1.20, 0.68),
}  # fmt: skip
"""phi_2,min and beta_2 of each hoisting class."""

STANDARD = "EN 13001-2:2014"
"""Where the classes come from."""

STIFF = 0.4
"""c_s k up to which the head follows the load, so that the crane's yielding counts."""


@dataclass(frozen=True)
class Classes:
    """Hoisting classes, ascending.

    Parameters
    ----------
    by_name : dict of str to Class
    standard : str
        Where they come from.

    Raises
    ------
    ValueError
        If there is none, or a value is out of its range.
    """

    by_name: Mapping[str, Class] = field(default_factory=lambda: HOISTING_CLASSES)
    standard: str = STANDARD

    def __post_init__(self) -> None:
        if not self.by_name:
            raise ValueError("classes: wanted one or more, got none")
        for name, (least, slope) in self.by_name.items():
            if not (1.0 <= least < 10.0 and 0.0 <= slope < 100.0):
                raise ValueError(
                    f"classes: wanted phi2min from 1 and beta2 from 0 s/m, got {name} = {least:g}, {slope:g}"
                )

    def covering(self, factor: float, speed: float) -> str:
        """The first class whose factor is not passed."""
        name = next((name for name, own in self.by_name.items() if factor <= own.factor(speed)), "")
        return name or f"beyond {list(self.by_name)[-1]}"


@dataclass(frozen=True)
class Yielding:
    """A rope on a crane that yields.

    Parameters
    ----------
    mass : float
        Of the load [kg].
    spring : float
        Of the rope, k [N/m].
    compliance : float
        How far what the rope hangs from goes down under the loaded crane's next newton, c_s [m/N].
    gravity : float
        [m/s^2]
    """

    mass: float
    spring: float
    compliance: float
    gravity: float

    @property
    def together(self) -> float:
        """k_eff of rope and crane in a row, 1 / k_eff = 1 / k + c_s [N/m]."""
        return 1.0 / (1.0 / self.spring + self.compliance)

    @property
    def sag(self) -> float:
        """By which the load's weight stretches the rope and bends the crane [m]."""
        return self.mass * self.gravity / self.together

    @property
    def recommended(self) -> str:
        """Which spring the formula is to be taken with.

        Further out the inertia of jib and head holds up the trolley at the rope's frequency, so that the rope alone
        counts. With k lift-off at a steady speed stayed below the formula wherever it was tried, with k_eff near the
        tower up to 1.13 times its phi - 1: observed, not proved.
        """
        return "k_eff" if self.compliance * self.spring < STIFF else "k"

    def factors(self, speed: float) -> dict[str, float]:
        """Dynamic factor 1 + v / g sqrt(k / m) with either spring."""
        springs = {"k": self.spring, "k_eff": self.together}
        return {name: 1.0 + speed / self.gravity * float(np.sqrt(own / self.mass)) for name, own in springs.items()}

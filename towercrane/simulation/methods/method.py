"""What is known of a solver's method: its order, how it carries a run on, and what its steps do to the energy.

A method that takes steps as long as its stability allows feeds a vibration or eats it, while its error estimate is
content. The figures that methods state were measured by ``towercrane bench --stability``: QTZ5613 with its trolley
parked at 23 m, 800 kg on 18 m of rope, ringing after its weights were switched on and swinging by 0.1 rad, for 600 s,
atol a hundredth of rtol; the worse of 1 + 1 and 2 + 3 modes. They are relative to the vibration's energy.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from math import inf, isnan, nan
from typing import TYPE_CHECKING, ClassVar

if TYPE_CHECKING:
    from collections.abc import Callable

    from towercrane.motions.motion import Phases
    from towercrane.simulation.trajectory import Floats, Progress, Run

DEFAULT = "dop853"
"""Name of the method that a run takes unless it is told otherwise."""

SPAN = 600.0
"""Span of the free vibration that the figures are for [s]."""

NAMED = 0.01
"""Relative change of the energy over the span from which a run says so."""

ATOL_SHARE = 1e-2
"""atol over rtol in the measurements."""


class EnergyDriftWarning(UserWarning):
    """The solver's tolerance lets the energy of a free vibration drift."""


def effective_tolerance(rtol: float, atol: float) -> float:
    """The rtol whose drift is to be expected from both tolerances.

    With rtol at 1e-8 an atol of 1e-5 to 1e-3 was found to change the energy about as much as that rtol does.
    """
    return max(rtol, atol)


@dataclass(frozen=True, eq=False, kw_only=True)
class Method(ABC):
    """A solver's method.

    Parameters
    ----------
    name : str
        Name in case files.
    order : int
        Order of the solution that is carried on; of a method that varies it the highest.
    energy_drift : tuple of (float, float)
        Tolerance and relative change of the energy over the span, loosest first; positive: the vibration is fed.
        None where it was not measured.
    loosest : float
        Tolerance beyond which the method is refused.

    Raises
    ------
    ValueError
        If the figures are not loosest first, or end where a run would still say so: there would be nothing to
        recommend.
    """

    name: str
    order: int
    energy_drift: tuple[tuple[float, float], ...] = ()
    loosest: float = inf

    compiled: ClassVar[bool] = False
    """Whether its steps are compiled, for one run and for many side by side; the others come back to Python."""

    follows_switches: ClassVar[bool] = False
    """Whether it restarts where equations switch, as at friction that sticks; others creep to a halt there."""

    crosses_phases: ClassVar[bool] = False
    """Whether it can also run on over the switch points of motions."""

    def __post_init__(self) -> None:
        tolerances = [tolerance for tolerance, _ in self.energy_drift]
        if tolerances != sorted(tolerances, reverse=True) or any(abs(c) >= NAMED for _, c in self.energy_drift[-1:]):
            raise ValueError(f"{self.name}: wanted energy_drift loosest first, down to less than {NAMED:.0%}")

    @abstractmethod
    def carry(self, run: Run, phases: Phases, sample_times: Floats, split: bool, progress: Progress | None) -> str:
        """Carry a run on through its phases, in place; how it ended.

        Parameters
        ----------
        run : Run
        phases, sample_times, split, progress
            As in :func:`towercrane.simulation.integrate.integrate`.
        """

    def longest_step(self, fastest: Callable[[], float] | None) -> float:
        """Longest step that feeds no vibration [s]; infinite where the method's own error estimate is trusted.

        Parameters
        ----------
        fastest : callable or None
            Angular frequency of the fastest vibration [rad/s], as in :class:`towercrane.simulation.system.System`.
        """
        return inf

    def energy_change(self, rtol: float, atol: float) -> float:
        """Relative change of a free vibration's energy in 600 s: the figure of the next looser tolerance measured.

        Not a number where none was.
        """
        reached = [row for row in self.energy_drift if row[0] >= effective_tolerance(rtol, atol) * (1.0 - 1e-9)]
        rows = reached[-1:] or self.energy_drift[:1]
        return rows[0][1] if rows else nan

    def refusal(self, rtol: float, atol: float) -> str:
        """Why the method is not offered at these tolerances; empty if it is."""
        if effective_tolerance(rtol, atol) <= self.loosest * (1.0 + 1e-9):
            return ""
        return (
            f"{self.name} feeds free vibration without bound beyond rtol or atol {self.loosest:g}; "
            f"{self._remedy(rtol, atol)}"
        )

    def notice(self, rtol: float, atol: float) -> str:
        """What these tolerances do to a free vibration, in a sentence; empty if it is less than one per cent."""
        change = self.energy_change(rtol, atol)
        if isnan(change):
            return f"what {self.name} does to the energy of free vibration was not measured"
        if abs(change) < NAMED:
            return ""
        verb = "gains" if change > 0.0 else "loses"
        tolerance = f"rtol {rtol:g}" if rtol >= atol else f"atol {atol:g}"
        crane = "2+3 modes, more with more" if change > 0.5 else "few modes"
        return (
            f"{self.name} at {tolerance} {verb} energy: {100.0 * change:+.3g} % in {SPAN:g} s of free vibration "
            f"with {crane}; {self._remedy(rtol, atol)}"
        )

    def _remedy(self, rtol: float, atol: float) -> str:
        good = next((tolerance for tolerance, change in self.energy_drift if abs(change) < NAMED), self.loosest)
        names = " and ".join(name for name, value in (("rtol", rtol), ("atol", atol)) if value > good)
        return f"use {names} {good:g}" + ("" if self.name == DEFAULT else f" or {DEFAULT}")

"""What the solver knows of a crane: its equations, their constants and its guards."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from towercrane.kernels.straight.leaves import known_of, numbers_of, place_of, table_of
from towercrane.kernels.straight.written import Written, written

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import NDArray

    from towercrane.motions.motion import Motion, Phases
    from towercrane.results.recording import Quantity

    Floats = NDArray[np.float64]
    Integers = NDArray[np.int64]


class Switch(Protocol):
    """Changes of a system's equations at guards: friction that sticks or slips, a corner in a stiffness.

    ``numbers`` and ``floors`` are the run's own copies and may be changed in place; ``guards_at`` evaluates the
    guards with them.
    """

    @property
    def changes_equations(self) -> bool:
        """Whether a run needs it; without, it only restarts the step control where the equations bend."""

    def begin(self, state: Floats, numbers: Floats, floors: Floats, guards_at: Callable[[], Floats]) -> None:
        """Set the equations that hold at the start of a phase."""

    def cross(
        self, guard: int, state: Floats, numbers: Floats, floors: Floats, guards_at: Callable[[], Floats]
    ) -> bool:
        """Set the equations that hold after a guard has reached its floor; False if the run ends there."""


class Crossings(Protocol):
    """Instants, known beforehand, at which a system's rates jump: a trolley that passes a joint of its rail."""

    def cut(self, phases: Phases) -> Phases:
        """The phases cut at these instants; their inputs may have rows more than there are channels."""

    def crosses(self, phases: Phases) -> bool:
        """Whether there are such instants in phases that are not cut."""

    def crossed(self, before: Floats, after: Floats) -> bool:
        """Whether one is between phases, cut, with these inputs."""

    def leap(self, state: Floats, before: Floats, time: float, after: Floats) -> Floats:
        """State right after it, from that at the end of a phase that took so long [s]."""


@dataclass(frozen=True, eq=False)
class System:
    """Ordinary differential equation y' = f(t, y) with constants, and guards that must not fall below their floors.

    Parameters
    ----------
    equations : callable
        ``equations(constants, t, y, inputs)`` gives the slopes and the guards, two sequences of numbers; t is the
        time since the phase began [s], ``inputs`` the polynomials of that phase, one row per channel.
    size : int
        Number of states.
    guards : tuple of str
        Name of the outcome when the guard of that index falls below its floor.
    floors : ndarray, shape (len(guards),)
        Minus infinity where a guard is only recorded.
    scale : ndarray, shape (size,)
        Absolute tolerance per unit of ``atol``; infinite where a state must not steer the step.
    constants : dataclass, optional
        Constants of the equations, see :mod:`towercrane.kernels.straight.leaves`.
    directions : ndarray of int, shape (ropes, 3)
        Unit vectors among the states, see :mod:`towercrane.simulation.directions`: where each begins, where its rate
        begins, and how many components it has. All slopes but that of the vector, which is its rate, must be the same
        whatever its length is and whatever of its rate is along it.
    switch : Switch, optional
        What a guard does instead of ending the run.
    fastest : callable, optional
        Highest angular frequency of its small motions [rad/s], if it is known.
    rope : int, optional
        Row of the inputs that is the length of a rope which stretches; ``fastest`` then takes the shortest [m].
    crossings : Crossings, optional
    """

    equations: Callable[..., tuple[Sequence[Any], Sequence[Any]]]
    size: int
    guards: tuple[str, ...]
    floors: Floats
    scale: Floats
    constants: Any = None
    directions: Integers = field(default_factory=lambda: np.empty((0, 3), dtype=np.int64))
    switch: Switch | None = None
    fastest: Callable[..., float] | None = None
    rope: int | None = None
    crossings: Crossings | None = None

    @cached_property
    def numbers(self) -> Floats:
        """Numbers of the constants."""
        return numbers_of(self.constants)

    @cached_property
    def table(self) -> Floats:
        """Table of the constants, empty if they have none."""
        return table_of(self.constants)

    def place_of(self, name: str) -> int:
        """Where a number of the constants is among all."""
        return place_of(self.constants, name)

    def fastest_in(self, phases: Phases) -> Callable[[], float] | None:
        """Highest angular frequency of its small motions in phases [rad/s], if it is known."""
        if self.fastest is None or self.rope is None:
            return self.fastest
        return partial(self.fastest, min(*phases.inputs[:, self.rope, 0], phases.after[self.rope, 0]))

    def alike(self, other: System) -> bool:
        """Whether the same equations, with other numbers, serve another system."""
        if self.size != other.size or self.equations is not other.equations:
            return False
        if self.table is not other.table and not np.array_equal(self.table, other.table):
            return False
        return bool(known_of(self.constants) == known_of(other.constants))

    @cached_property
    def _codes(self) -> dict[tuple[int, ...], tuple[Any, Floats]]:
        return {}

    def code(self, inputs: Floats) -> tuple[Any, Floats]:
        """Compiled right-hand side for inputs of this shape, and the numbers that it wants.

        What follows from constants alone stands behind the numbers.
        """
        shape = inputs.shape
        if shape not in self._codes:
            code = written_of([self], shape)
            self._codes[shape] = code.rhs(), code.numbers(self.numbers)
        return self._codes[shape]

    def slope(self, time: float, state: Floats, inputs: Floats) -> tuple[Floats, Floats]:
        """Right-hand side and guards at a time since the phase with these inputs began.

        Returns
        -------
        slope : ndarray, shape (size,)
        guards : ndarray, shape (len(guards),)
        """
        slope, guards = np.empty(self.size), np.empty(len(self.guards))
        rhs, numbers = self.code(inputs)
        rhs(time, np.ascontiguousarray(state), slope, inputs, numbers, self.table, guards)
        return slope, guards


def written_of(systems: Sequence[System], inputs: tuple[int, ...]) -> Written:
    """Equations of systems that are alike, written out for all of them.

    Parameters
    ----------
    systems : sequence of System
    inputs : tuple of int
        Shape of a phase's inputs.
    """
    first = systems[0]
    numbers = [system.numbers for system in systems]
    return written(first.equations, first.constants, numbers, first.size, (inputs[-2], inputs[-1]))


class NoEquilibrium(ArithmeticError):
    """The crane has no stable equilibrium to start from.

    Parameters
    ----------
    outcome : str
        Name of the outcome, one of the system's guards.
    message : str
        Why.
    """

    def __init__(self, outcome: str, message: str) -> None:
        super().__init__(message)
        self.outcome = outcome


class Model(Protocol):
    """What :func:`towercrane.simulation.simulate.simulate` asks of a crane."""

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of the motions that drive it, in the order of the inputs' rows."""

    @property
    def system(self) -> System:
        """Its equations."""

    def start(self, inputs: Floats, state: str = ...) -> Floats:
        """State at rest, "equilibrium" or "zero", or NoEquilibrium; see `towercrane.simulation.starts.begin`."""

    def observe(
        self, motions: dict[str, Motion], times: Floats, states: Floats, slopes: Floats, guards: Floats
    ) -> dict[str, Quantity]:
        """Outputs over time."""

    def provenance(self) -> dict[str, Any]:
        """What of the model belongs in a result's attributes."""


def check_start(state: str) -> None:
    """Refuse a way to start that no model knows.

    Raises
    ------
    ValueError
    """
    if state not in ("equilibrium", "zero"):
        raise ValueError(f"state: wanted 'equilibrium' or 'zero', got {state!r}")


def start_inputs(model: Model, motions: Mapping[str, Motion], inputs: Floats) -> Floats:
    """Polynomials of a phase as a state at rest knows them.

    A model may name ``value_channels`` that act by their value alone, such as the components of a wind: they are at
    the mean of their motion, whatever they are at that instant. A steady wind is its own mean; that of gusts is over
    their whole record, so that a run is the beginning of any longer one.

    Parameters
    ----------
    model : Model
    motions : mapping of str to Motion
    inputs : ndarray, shape (channels, k)
        Polynomials of the phase.
    """
    known = inputs.copy()
    for channel in getattr(model, "value_channels", ()):
        row = known[model.channels.index(channel)]
        row[0], row[1:] = motions[channel].mean, 0.0
    return known

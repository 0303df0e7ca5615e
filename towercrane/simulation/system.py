"""What the solver knows of a crane: a compiled right-hand side, its data and its guards."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from towercrane.kernels.straight.written import Known, Written, written

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import NDArray

    from towercrane.motions.motion import Motion
    from towercrane.results.recording import Quantity

    Floats = NDArray[np.float64]
    Integers = NDArray[np.int64]


MOST_WRITTEN = 60
"""States of the largest system whose equations are written out: compiling takes longer than it saves beyond."""


def rhs_signature() -> Any:
    """Numba signature of every right-hand side, so that one compiled integrator serves all models.

    ``rhs(t, y, dy, inputs, numbers, vectors, matrices, tables, work, guards)``: t is the time since the phase
    began [s]; inputs holds the polynomials of that phase, one row per channel; dy and guards are written;
    work is scratch. The other arrays are the model's constants, laid out as each model likes.
    """
    from numba import types

    one, two, three = types.float64[::1], types.float64[:, ::1], types.float64[:, :, ::1]
    return types.void(types.float64, one, one, two, one, two, three, three, two, one)


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


@dataclass(frozen=True, eq=False)
class System:
    """Ordinary differential equation y' = f(t, y) with constants, and guards that must not fall below their floors.

    Parameters
    ----------
    equations : callable
        Gives the compiled right-hand side, as in :func:`rhs_signature`; called when it is first wanted.
    size : int
        Number of states.
    guards : tuple of str
        Name of the outcome when the guard of that index falls below its floor.
    floors : ndarray, shape (len(guards),)
        Minus infinity where a guard is only recorded.
    scale : ndarray, shape (size,)
        Absolute tolerance per unit of ``atol``; infinite where a state must not steer the step.
    numbers, vectors, matrices, tables : ndarray
        Constants of the model, with 1, 2, 3 and 3 dimensions.
    work_shape : tuple of int
        Shape of the scratch array.
    known : Known, optional
        What is known of the data when the equations are written out for them; without, they are not.
    directions : ndarray of int, shape (ropes, 3)
        Unit vectors among the states, see :mod:`towercrane.simulation.directions`: where each begins, where its rate
        begins, and how many components it has. All slopes but that of the vector, which is its rate, must be the same
        whatever its length is and whatever of its rate is along it.
    switch : Switch, optional
        What a guard does instead of ending the run.
    fastest : callable, optional
        Highest angular frequency of its small motions [rad/s], if it is known.
    """

    equations: Callable[[], Any]
    size: int
    guards: tuple[str, ...]
    floors: Floats
    scale: Floats
    numbers: Floats
    vectors: Floats
    matrices: Floats
    tables: Floats
    work_shape: tuple[int, int]
    known: Known | None = None
    directions: Integers = field(default_factory=lambda: np.empty((0, 3), dtype=np.int64))
    switch: Switch | None = None
    fastest: Callable[[], float] | None = None

    @property
    def constants(self) -> tuple[Floats, Floats, Floats, Floats]:
        """The model's constants in the order of the equations' arguments."""
        return self.numbers, self.vectors, self.matrices, self.tables

    @property
    def data(self) -> dict[str, Floats]:
        """The model's constants by name."""
        return {"numbers": self.numbers, "vectors": self.vectors, "matrices": self.matrices, "tables": self.tables}

    @cached_property
    def _codes(self) -> dict[tuple[int, ...], tuple[Any, tuple[Floats, Floats, Floats, Floats]]]:
        return {}

    def code(self, inputs: Floats) -> tuple[Any, tuple[Floats, Floats, Floats, Floats]]:
        """Compiled right-hand side for inputs of this shape, and the constants that it wants.

        Where equations are written out, what follows from constants alone stands behind the numbers.
        """
        shape = inputs.shape
        if shape not in self._codes:
            equations, others = self.equations(), (self.vectors, self.matrices, self.tables)
            if self.known is None or self.size > MOST_WRITTEN:
                # Equations in Python serve as well, only slowly.
                if not getattr(equations, "signatures", True):
                    equations.compile(rhs_signature())
                self._codes[shape] = equations, (self.numbers, *others)
            else:
                code = written_of([self], shape)
                self._codes[shape] = code.rhs(rhs_signature()), (code.numbers(self.data), *others)
        return self._codes[shape]

    def slope(self, time: float, state: Floats, inputs: Floats) -> tuple[Floats, Floats]:
        """Right-hand side and guards at a time since the phase with these inputs began.

        Returns
        -------
        slope : ndarray, shape (size,)
        guards : ndarray, shape (len(guards),)
        """
        slope, guards = np.empty(self.size), np.empty(len(self.guards))
        work = np.zeros(self.work_shape)
        rhs, constants = self.code(inputs)
        rhs(time, np.ascontiguousarray(state), slope, inputs, *constants, work, guards)
        return slope, guards


def written_of(systems: Sequence[System], inputs: tuple[int, ...]) -> Written:
    """Equations of systems of one kind and size, written out for all of them.

    Parameters
    ----------
    systems : sequence of System
    inputs : tuple of int
        Shape of a phase's inputs.
    """
    first = systems[0]
    sizes, data = (first.size, len(first.guards)), [system.data for system in systems]
    return written(
        first.equations().py_func, sizes, first.known or Known(), data, (inputs[-2], inputs[-1]), first.work_shape
    )


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

    def start(self, inputs: Floats, state: str, swing_angle: float) -> Floats:
        """State at the start, or NoEquilibrium."""

    def observe(
        self, motions: dict[str, Motion], times: Floats, states: Floats, guards: Floats
    ) -> dict[str, Quantity]:
        """Outputs over time."""

    def provenance(self) -> dict[str, Any]:
        """What of the model belongs in a result's attributes."""


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


def plain_system(rhs: Any, size: int, numbers: tuple[float, ...] = ()) -> System:
    """System without guards or scratch, for equations that are not cranes."""
    return System(
        equations=lambda: rhs,
        size=size,
        guards=(),
        floors=np.empty(0),
        scale=np.ones(size),
        numbers=np.array(numbers, dtype=float),
        vectors=np.empty((0, 0)),
        matrices=np.empty((0, 0, 0)),
        tables=np.empty((0, 0, 0)),
        work_shape=(0, 0),
    )

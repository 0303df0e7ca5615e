"""Outputs of cranes: plain functions of an instant of a run, like the equations, for rows of runs and for lanes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from towercrane.kernels.polynomial import polynomial
from towercrane.kernels.straight.leaves import numbers_of, table_of, with_numbers
from towercrane.results.recording import Quantity

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import NDArray

    from towercrane.kernels.algebra import Row
    from towercrane.motions.motion import Motion
    from towercrane.simulation.system import System

    Floats = NDArray[np.float64]


class Instant(NamedTuple):
    """What is known at an instant of a run.

    Parameters
    ----------
    state, slopes, guards : sequence of numbers
        The state, its derivative, and the guards there.
    drives : sequence of tuples of 3 numbers
        Value, rate and acceleration of each of the model's channels.
    """

    state: Row
    slopes: Row
    guards: Row
    drives: Row


class About(NamedTuple):
    """What an output is: units, a long name, and what its components are along, if it is a vector of so many.

    A resultant has a kink where what it is of is nothing: there no linear model has it.
    """

    units: str
    long_name: str
    dims: tuple[str, ...] = ()
    size: int = 1
    kink: bool = False


class Observed(Protocol):
    """A model whose outputs are a plain function.

    ``outputs(seen, instant)`` gives a number, or for a vector a sequence of them, by the name of each of ``about``;
    ``seen`` is a dataclass of constants (see :mod:`towercrane.kernels.straight.leaves`) with those of the equations
    as its field ``crane``.
    """

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of the motions that drive it."""

    @property
    def system(self) -> System:
        """Its equations."""

    @property
    def outputs(self) -> Callable[[Any, Instant], Mapping[str, Any]]:
        """The function."""

    @property
    def seen(self) -> Any:
        """Its constants."""

    @property
    def about(self) -> Mapping[str, About]:
        """What the outputs are, by name."""


def observe(
    model: Observed, motions: Mapping[str, Motion], times: Floats, states: Floats, slopes: Floats, guards: Floats,
    names: Sequence[str] | None = None,
) -> dict[str, Quantity]:  # fmt: skip
    """Outputs over time.

    Parameters
    ----------
    model : Observed
    motions : mapping of str to Motion
        One for each of the model's channels.
    times, states, slopes, guards : ndarray, shapes (p,), (p, size), (p, size) and (p, guards)
    names : sequence of str, optional
        Those that are wanted; all by default.
    """
    drives = [motions[channel].derivatives(times) for channel in model.channels]
    state, slope, guard = (np.ascontiguousarray(rows.T) for rows in (states, slopes, guards))
    with np.errstate(all="ignore"):
        found = model.outputs(model.seen, Instant(state, slope, guard, drives))
    quantities = {}
    for name in names if names is not None else model.about:
        about, values = model.about[name], found[name]
        rows = np.empty((len(times), about.size))
        for component, own in enumerate(values if about.dims else [values]):
            rows[:, component] = own
        shown = rows if about.dims else rows[:, 0]
        quantities[name] = Quantity(("time", *about.dims), shown, about.units, about.long_name)
    return quantities


def observed_rows(
    models: Sequence[Observed], names: tuple[str, ...], states: Floats, slopes: Floats, guards: Floats, drives: Floats
) -> Floats:
    """Numbers that models show, alike but for their constants, each in a row of its own.

    Parameters
    ----------
    models : sequence of p Observed
    names : tuple of str
        Of single numbers.
    states, slopes, guards : ndarray, shapes (p, size), (p, size) and (p, guards)
    drives : ndarray, shape (p, channels, 3)
        Value, rate and acceleration of each channel.

    Returns
    -------
    ndarray, shape (p, names)
    """
    first, numbers = models[0], np.array([numbers_of(model.seen) for model in models]).T
    seen = with_numbers(first.seen, numbers, table_of(first.seen))
    with np.errstate(all="ignore"):
        found = first.outputs(seen, Instant(states.T, slopes.T, guards.T, drives.transpose(1, 2, 0)))
    return np.stack([np.broadcast_to(found[name], len(models)) for name in names], axis=1)


def scalars(model: Observed) -> tuple[str, ...]:
    """Names of the outputs that are single numbers."""
    return tuple(name for name, about in model.about.items() if not about.dims)


@dataclass(frozen=True)
class Looked:
    """Outputs, single numbers, of states on the way; with the guards there."""

    equations: Callable[..., tuple[Sequence[Any], Sequence[Any]]]
    outputs: Callable[[Any, Instant], Mapping[str, Any]]
    names: tuple[str, ...]
    channels: int

    def __call__(self, seen: Any, t: Any, y: Any, inputs: Any) -> tuple[list[Any], Sequence[Any]]:
        """As equations have it."""
        slopes, guards = self.equations(seen.crane, t, y, inputs)
        drives = [polynomial(channel, t) for channel in inputs[: self.channels]]
        found = self.outputs(seen, Instant(y, slopes, guards, drives))
        return [found[name] for name in self.names], guards

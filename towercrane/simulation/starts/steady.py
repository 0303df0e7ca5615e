"""States at rest as a turning head sees them: steady rotations, and a structure that is quiet while its load swings.

A scene that is turned about the vertical goes on alike. So a state y turns steadily at the rate W where y' = W G(y),
with G its derivative per angle of a turn, see :class:`towercrane.simulation.starts.turning.Turning`: rates are W G of
places, and the slopes of rates less W G of them vanish. That is so for every crane, whatever its coordinates are.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.simulation.differences import jacobian
from towercrane.simulation.equilibrium import SETTLED
from towercrane.simulation.outcomes import UNSTABLE
from towercrane.simulation.system import NoEquilibrium

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from towercrane.simulation.starts.turning import Turning
    from towercrane.simulation.system import Model

    Floats = NDArray[np.float64]

SPEEDS = 8
"""Equal steps from rest to the rate of a steady rotation."""

MOST_STEPS, STEP, FAR = 20, 1e-5, 1e3
"""Steps of Newton's method, of its differences and at most of itself, per scale."""

BALANCED = 1e-9
"""Acceleration that is left over, relative to the terms that cancel in it."""

GROWING = 1e-6
"""Rate at which departures grow, relative to the fastest of their motions, that is none."""


@dataclass(frozen=True, eq=False)
class Frame:
    """Axes that turn with the head, whose drives are held but for the one that turns it.

    Parameters
    ----------
    turning : Turning, optional
        Without, nothing turns.
    spin : float
        [rad/s]
    inputs : ndarray, shape (channels, k)
        Polynomials of the channels at rest.
    """

    turning: Turning | None
    spin: float
    inputs: Floats

    @classmethod
    def of(cls, model: Model, inputs: Floats) -> Frame:
        """Axes that turn as a model's head does with these polynomials."""
        turning: Turning | None = getattr(model, "turning", None)
        held = np.array(inputs)
        held[:, 1:] = 0.0
        return cls(turning, 0.0 if turning is None else float(inputs[turning.channel, 1]), held)

    def at(self, spin: float) -> Frame:
        """The same at another rate."""
        return Frame(self.turning, spin, self.inputs)

    def per_time(self, state: Floats) -> Floats:
        """Slope of a state that turns with the axes."""
        return np.zeros_like(state) if self.turning is None else self.spin * self.turning.per_angle(state)

    def carried(self, state: Floats) -> Floats:
        """The state with the rates that rest in these axes means."""
        half, found = len(state) // 2, np.array(state)
        if self.spin:
            found[half : 2 * half] = self.per_time(state)[:half]
        return found

    @cached_property
    def turned_inputs(self) -> Floats:
        """Polynomials of the channels, the head turning."""
        inputs = np.array(self.inputs)
        if self.turning is not None:
            inputs[self.turning.channel, 1] = self.spin
        return inputs

    def slope(self, model: Model, state: Floats) -> Floats:
        """Slope of a state as seen in these axes."""
        return np.asarray(model.system.slope(0.0, state, self.turned_inputs)[0] - self.per_time(state))

    def guards(self, model: Model, state: Floats) -> Floats:
        """Guards in a state."""
        return np.asarray(model.system.slope(0.0, state, self.turned_inputs)[1])


def steady_rotation(model: Model, state: Floats, frame: Frame) -> Floats:
    """State that turns steadily with its head, followed from rest.

    Parameters
    ----------
    model : Model
    state : ndarray
        At rest.
    frame : Frame

    Raises
    ------
    NoEquilibrium
        If there is none, it is not stable, or one of the model's guards has fallen.
    """
    turned = f"at {frame.spin * 30.0 / np.pi:.4g} rpm"
    by_value = [model.channels.index(name) for name in getattr(model, "value_channels", ())]
    if np.any(frame.inputs[by_value, 0]):
        raise NoEquilibrium(UNSTABLE, f"in a wind nothing turns steadily, as it would {turned}")
    for step in range(1, SPEEDS + 1):
        now = frame.at(frame.spin * step / SPEEDS)
        state = _at_rest(model, state, now, _basis(model, state), f"no steady rotation {turned}: ")
    guards = frame.guards(model, state)
    fallen = np.flatnonzero(guards < np.maximum(model.system.floors, np.where(np.arange(len(guards)), -np.inf, 0.0)))
    if len(fallen):
        raise NoEquilibrium(model.system.guards[fallen[0]], f"in steady rotation {turned}")
    values = np.linalg.eigvals(_small_motions(model, state, frame))
    if values.real.max() > GROWING * abs(values).max():
        growth = float(values.real.max())
        raise NoEquilibrium(UNSTABLE, f"the steady rotation {turned} is left at a rate of {growth:.3g} 1/s")
    return state


def quiet(model: Model, state: Floats, frame: Frame) -> Floats:
    """State in which the load swings as it does, and the structure is at rest and is not accelerated.

    An elastic rope has the tension with which it does not go on stretching.

    Raises
    ------
    NoEquilibrium
        If there is none.
    """
    why = "no structure is quiet under this swing: "
    if model.system.rope is not None:
        return _quiet_on_elastic_rope(model, state, frame, why)
    places = len(state) // 2
    swinging = [first + k for first, _, count in model.system.directions for k in range(count)]
    free = [place for place in range(places) if place not in swinging]
    return _at_rest(model, state, frame, np.eye(places)[:, free], why)


def _quiet_on_elastic_rope(model: Model, state: Floats, frame: Frame, why: str) -> Floats:
    """The same of a load whose place is among the states: coordinates and the rope's reach are sought."""
    asked: Any = model
    n, half = asked.rope, len(state) // 2
    load, moving = slice(n, n + asked.axes), slice(half + n, half + n + asked.axes)
    own = asked.suspended(state, frame.turned_inputs)
    along, parting = state[load] - np.array(own.place), state[moving] - np.array(own.velocity)
    reach = float(np.linalg.norm(along))
    direction = along / reach
    turn = (parting - direction * (direction @ parting)) / reach

    def moved(change: Floats) -> Floats:
        found = np.array(state)
        found[:n] += change[:-1]
        found[half : half + n] = frame.per_time(found)[:n]
        crane, far = asked.suspended(found, frame.turned_inputs), reach + change[-1]
        found[load] = np.array(crane.place) + far * direction
        found[moving] = np.array(crane.velocity) + far * turn
        return found

    def residual(changes: Floats) -> Floats:
        left = []
        for change in changes.T:
            there = moved(change)
            crane = asked.suspended(there, frame.turned_inputs)
            slope = model.system.slope(0.0, there, frame.turned_inputs)[0]
            rates = slope[half : half + n]
            thrown = np.array(crane.bias) + np.reshape(crane.jacobian, (asked.axes, n)) @ rates
            parted = direction @ (slope[moving] - thrown) + (reach + change[-1]) * turn @ turn
            left.append(np.append(rates - frame.per_time(there)[half : half + n], parted))
        return np.array(left).T

    scale = np.append(_scale(model, half)[:n], 1.0)
    found = moved(_newton(residual, np.append(abs(state[:n]), reach), scale, why))
    # What the winch lets out, or another drive moves, goes on.
    found[moving] += state[moving] - moved(np.zeros(n + 1))[moving]
    return found


def _at_rest(model: Model, state: Floats, frame: Frame, basis: Floats, why: str) -> Floats:
    """State near one whose places, along a basis, rest in the frame, with the rates of all other places kept."""
    half = len(state) // 2
    mine = np.any(basis != 0.0, axis=1)

    def moved(change: Floats) -> Floats:
        found = np.array(state)
        found[:half] += basis @ change
        found = _restored(model, found)
        found[half : 2 * half] = np.where(mine, frame.per_time(found)[:half], state[half : 2 * half])
        return found

    def residual(changes: Floats) -> Floats:
        slopes = np.array([frame.slope(model, moved(change)) for change in changes.T])
        return np.asarray(basis.T @ slopes[:, half : 2 * half].T)

    scale = np.max(abs(basis) * _scale(model, half)[:, None], axis=0)
    return moved(_newton(residual, abs(basis.T @ state[:half]), scale, why))


def _newton(residual: Callable[[Floats], Floats], reference: Floats, scale: Floats, why: str) -> Floats:
    """Change from nothing at which what is left vanishes.

    Parameters
    ----------
    residual : callable
        Of changes in columns, shape (n, p) to shape (n, p).
    reference, scale : ndarray, shape (n,)
        Size of what changes, and a large change of it.

    Raises
    ------
    NoEquilibrium
        If there is none near.
    """
    count, before = len(scale), np.inf
    change, steps = np.zeros(count), np.diag(STEP * scale)
    for _ in range(MOST_STEPS if count else 0):
        found = residual(change[:, None] + np.hstack([steps, -steps, np.zeros((count, 1))]))
        matrix, left = (found[:, :count] - found[:, count:-1]) / (2.0 * STEP * scale), found[:, -1]
        try:
            step = np.linalg.solve(matrix, -left)
        except np.linalg.LinAlgError:
            break
        change = change + step
        size = float(np.max(abs(step) / scale))
        if not size < FAR:
            break
        if size < 1e-13 or 0.5 * before < size < SETTLED:
            if np.all(abs(residual(change[:, None])[:, 0]) <= BALANCED * (abs(matrix) @ (reference + scale))):
                return change
            break
        before = size
    if not count:
        return change
    raise NoEquilibrium(UNSTABLE, f"{why}the search did not settle")


def _scale(model: Model, half: int) -> Floats:
    """Size of each place."""
    scale = model.system.scale[:half]
    return np.where(np.isfinite(scale), scale, 1.0)


def _small_motions(model: Model, state: Floats, frame: Frame) -> Floats:
    """Matrix of small departures from a state at rest in a frame."""
    half, basis = len(state) // 2, _basis(model, state)
    wide = np.zeros((len(state), 2 * basis.shape[1]))
    wide[:half, : basis.shape[1]] = wide[half : 2 * half, basis.shape[1] :] = basis
    seen = wide.copy()
    for first, moved, count in model.system.directions:
        rope, rate = slice(first, first + count), slice(moved, moved + count)
        # The rate of a unit vector stays at right angles to it.
        wide[rate] -= np.outer(state[rope], state[rate]) @ wide[rope]
    scale = np.ones(wide.shape[1])

    def slope(departures: Floats) -> Floats:
        return np.asarray(seen.T @ np.array([frame.slope(model, state + wide @ own) for own in departures.T]).T)

    return jacobian(slope, np.zeros(wide.shape[1]), scale)[0]


def _basis(model: Model, state: Floats) -> Floats:
    """Directions in which places can depart: of a unit vector, those at right angles to it; shape (places, k)."""
    basis, kept = np.eye(len(state) // 2), np.ones(len(state) // 2, dtype=bool)
    for first, _, count in model.system.directions:
        rope = slice(first, first + count)
        # What is left of the unit vectors at right angles to the rope: their plane has one direction less.
        basis[rope, rope] = np.linalg.svd(state[None, rope])[2].T
        kept[first] = False
    return basis[:, kept]


def _restored(model: Model, state: Floats) -> Floats:
    """The state with unit vectors of length one."""
    found: Any = np.array(state)
    for first, _, count in model.system.directions:
        found[first : first + count] /= np.linalg.norm(found[first : first + count])
    return np.asarray(found)

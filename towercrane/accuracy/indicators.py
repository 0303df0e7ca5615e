"""What a coarser model of a scene gets wrong, from small motions at a few instants; nothing is integrated.

At every node of a scene the crane's modes are found in the coordinates of the richest model and, by Ritz's method,
in those of any coarser one: with modes left out, slowed by a cap, without the weight's softening. Jumps of the
drives' accelerations and of their derivatives, and a start away from equilibrium, ring each mode; between the nodes
amplitudes follow the adiabatic invariant. Two models then differ in their static deflection, in the amplitude of
every mode and, as time goes on, in its phase.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from towercrane.accuracy.instants import SWING, TENSION
from towercrane.cranes.tower.modes.frequency_cap import added_mass

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from towercrane.accuracy.instants import Nodes
    from towercrane.accuracy.setting import Setting

    Floats = NDArray[np.float64]
    Complex = NDArray[np.complex128]

COHERENT = 6.0
"""Events within this phase of a mode after each other ring it together [rad]; those apart add as if by chance."""

SAMPLES = 600
"""Instants at which peaks are looked for."""


@dataclass(frozen=True, eq=False)
class Vibration:
    """k modes of a model at every node, and what rings them.

    Parameters
    ----------
    nodes : Nodes
    own, fading : ndarray, shape (P, k)
        Angular frequencies [rad/s], and rates of decay [1/s].
    shapes : ndarray, shape (P, n, k)
        Of unit modal mass, in the richest model's coordinates.
    local : ndarray, shape (P, outputs, k)
        Outputs per modal amplitude.
    dead, pushed : ndarray, shapes (P, outputs) and (P, outputs, 2)
        Outputs under all weights, and over the drives' accelerations.
    rings : ndarray of complex, shape (E, k)
        Change of each mode's amplitude at every event.
    """

    nodes: Nodes
    own: Floats
    fading: Floats
    shapes: Floats
    local: Floats
    dead: Floats
    pushed: Floats
    rings: Complex

    @cached_property
    def frequencies(self) -> Floats:
        """Angular, shape (N, k) [rad/s]."""
        return self.own[self.nodes.place]

    @cached_property
    def weights(self) -> Floats:
        """Outputs per modal amplitude, shape (N, outputs, k)."""
        return self.local[self.nodes.place]

    @cached_property
    def static(self) -> Floats:
        """Outputs under all weights and the drives' accelerations, shape (N, outputs)."""
        place = self.nodes.place
        return np.asarray(self.dead[place] + (self.pushed[place] @ self.nodes.drives[:, :, None])[:, :, 0])

    @cached_property
    def phase(self) -> Floats:
        """Phase of every mode since the start, shape (N, k) [rad]."""
        return _integral(self.nodes.times, self.frequencies)

    def ringing(self, at: NDArray[np.int64]) -> Complex:
        """Outputs at nodes by each event in each mode, as if no phase had passed; shape (nodes, outputs, k, E)."""
        events, omega = self.nodes.events, self.frequencies
        lost = _integral(self.nodes.times, self.fading[self.nodes.place])
        past = (events <= at[:, None])[:, :, None]
        fade = np.exp(np.where(past, lost[events] - lost[at, None], -np.inf))
        amplitude = np.sqrt(omega[events] / omega[at, None]) * fade * self.rings
        return np.asarray(self.weights[at][..., None] * amplitude.transpose(0, 2, 1)[:, None])

    @cached_property
    def carried(self) -> Complex:
        """Outputs in each mode at every node, as of the phase at the start; shape (N, outputs, k)."""
        start = np.exp(-1j * self.phase[self.nodes.events]).T
        return np.asarray((self.ringing(np.arange(len(self.nodes.times))) * start).sum(axis=3))

    @property
    def pendulum(self) -> int:
        """The mode in which the load swings."""
        return int(abs(self.shapes[0, -1]).argmax())

    @cached_property
    def yielding(self) -> Floats:
        """How far the load's place yields to an upright force at twice the swing's frequency [m/N], shape (P,)."""
        rise = (self.nodes.rise[:, None] @ self.shapes)[:, 0]
        stiff = self.own**2 - 4.0 * self.own[:, [self.pendulum]] ** 2
        return np.asarray(np.delete(rise**2 / stiff, self.pendulum, axis=1).sum(axis=1))

    @cached_property
    def left(self) -> Complex:
        """`ringing` at the decisive nodes."""
        return self.ringing(self.nodes.decisive)

    @cached_property
    def squares(self) -> Floats:
        """Squared amplitudes of `left`, each mode's events combined; shape (decisive nodes, outputs, k)."""
        return _combined(self.left, self.phase[self.nodes.events])

    @cached_property
    def peaks(self) -> Floats:
        """Expected largest magnitude of every output, shape (outputs,)."""
        known = self.nodes.times
        times = np.linspace(0.0, known[-1], SAMPLES)
        node = np.minimum(np.searchsorted(known, times, side="right") - 1, len(known) - 2)
        share = ((times - known[node]) / (known[node + 1] - known[node]))[:, None]
        turned = np.exp(1j * (self.phase[node] + share * (self.phase[node + 1] - self.phase[node])))
        rung = (self.carried[node] @ turned[:, :, None])[:, :, 0].real
        places = np.stack([self.nodes.place[node], self.nodes.place[node + 1]])
        shares = np.stack([1.0 - share, share])
        values = (shares * self.dead[places]).sum(axis=0) + rung
        for follows, motion in self._followed(times):
            values += ((shares[..., None] * follows[places]).sum(axis=0) @ motion[:, :, None])[:, :, 0]
        return np.asarray(abs(values).max(axis=0))

    def _followed(self, times: Floats) -> Iterator[tuple[Floats, Floats]]:
        """How outputs follow drives that move smoothly, as pairs: outputs over a motion at every place, and motions.

        What is not steady has derivatives; every second one is followed by the modes over one more squared frequency.
        """
        nodes, derivatives = self.nodes, self.nodes.derivatives(times)
        yield self.pushed, derivatives[:, :, 2]
        force = np.concatenate([nodes.push, nodes.moved[:, None]], axis=1) @ self.shapes
        for order in range(2, derivatives.shape[2] - 2, 2):
            moving = np.concatenate([derivatives[:, :, order + 2], derivatives[:, :1, order]], axis=1)
            if moving.any():
                sign = (-1.0) ** (order // 2)
                yield sign * (self.local * self.own[:, None] ** (-order - 2.0)) @ force.transpose(0, 2, 1), moving


def vibration(nodes: Nodes, setting: Setting) -> Vibration:
    """Modes of a model that keeps some of the richest one's coordinates.

    Raises
    ------
    numpy.linalg.LinAlgError
        If the weight leaves the tower no stiffness.
    """
    scene, (places, n) = nodes.scene, nodes.rise.shape
    jib = nodes.richest.tower_modes + np.arange(setting.jib_vertical_modes)
    kept = np.concatenate([np.arange(setting.tower_modes), jib, [n - 1]])
    stiffness = (nodes.stiffness - nodes.softening * setting.weight_softening)[np.ix_(kept[:-1], kept[:-1])]
    mass = nodes.mass[:, kept[:, None], kept] + np.diag(_added(nodes, setting)[kept])
    # The reciprocal problem keeps the low modes exact to rounding, however stiff the highest is.
    inverse = np.zeros((places, len(kept), len(kept)))
    inverse[:, :-1, :-1] = np.linalg.inv(np.linalg.cholesky(stiffness))
    inverse[:, -1, -1] = nodes.pendulum**-0.5
    upper = inverse.transpose(0, 2, 1)
    reciprocal, vectors = np.linalg.eigh(inverse @ mass @ upper)
    omega = 1.0 / np.sqrt(reciprocal[:, ::-1])
    small = upper @ vectors[:, :, ::-1] * omega[:, None]
    alike = (small[:-1] * (mass[1:] @ small[1:])).sum(axis=1)
    small[1:] *= np.cumprod(np.where(alike < 0.0, -1.0, 1.0), axis=0)[:, None]
    shapes = np.zeros((places, n, len(kept)))
    shapes[:, kept] = small
    readings = nodes.readings[:, :, kept]
    weights = readings @ small
    weights[:, TENSION] *= -(omega**2)

    at = nodes.place[nodes.events]
    forces = np.concatenate([nodes.weight[:, None], nodes.push], axis=1)[:, :, kept].transpose(0, 2, 1)
    held = readings @ (upper @ (inverse @ forces))
    held[:, TENSION] = (scene.load.mass * scene.crane.gravity, 0.0, 0.0)
    orders = np.arange(nodes.jumps.shape[1])
    turns = (-1j) ** orders[:, None] * omega[at, None] ** -(orders[:, None] + 2.0)
    rings = -(nodes.jumps[:, :, kept] @ small[at] * turns).sum(axis=1)
    first = at[0]
    swung = np.sin(scene.start.along or 0.0) / nodes.readings[first, SWING, -1]
    rings[0] += nodes.mass[first, -1, kept] @ small[first] * swung
    if scene.start.state == "zero":
        rings[0] -= nodes.weight[first, kept] @ small[first] / omega[first] ** 2
    decay = 0.5 * nodes.damping[kept] @ small**2
    return Vibration(nodes, omega, decay, shapes, weights, held[:, :, 0], held[:, :, 1:], rings)


def drift(rich: Vibration, poor: Vibration) -> tuple[Floats, Floats]:
    """How far the outputs of two models are apart.

    Returns
    -------
    static, ringing : ndarray, shape (outputs,)
        Largest difference of the static parts; largest amplitude of the vibrating difference, expected where the
        phases of its parts are not known.
    """
    nodes = rich.nodes
    overlap = abs((rich.shapes.transpose(0, 2, 1) @ (nodes.mass @ poor.shapes)).sum(axis=0))
    partner = overlap.argmax(axis=0)
    mutual = overlap.argmax(axis=1)[partner] == np.arange(len(partner))
    mine, other = partner[mutual], np.flatnonzero(mutual)
    at = nodes.decisive
    slip = poor.phase[:, other] - rich.phase[:, mine] + _slip_by_swing(rich, poor)[:, None] * (mine == rich.pendulum)
    turned = np.clip(slip[at, None] - slip[nodes.events], -np.pi, np.pi).transpose(0, 2, 1)[:, None]
    gap = rich.left[:, :, mine] - poor.left[:, :, other] * np.exp(1j * turned)
    squared = _combined(gap, rich.phase[nodes.events][:, mine]).sum(axis=2)
    squared += np.delete(rich.squares, mine, axis=2).sum(axis=2) + poor.squares[:, :, ~mutual].sum(axis=2)
    return abs(rich.static - poor.static).max(axis=0), np.sqrt(squared.max(axis=0))


def _slip_by_swing(rich: Vibration, poor: Vibration) -> Floats:
    """Phase by which the swings of two models part because their cranes yield differently, shape (N,) [rad].

    A swing of amplitude a pulls by m g a^2 cos(2 w t) less than the load's weight. What the load hangs from yields by
    c per force and follows, and Mathieu's equation has the swing slower by the part a^2 c m g / L: Nayfeh & Mook,
    Nonlinear Oscillations (1979), ch. 5.
    """
    nodes, scene = rich.nodes, rich.nodes.scene
    # While drives accelerate smoothly, what rings is nearly cancelled by what follows them.
    swing = np.minimum(abs(rich.carried[:, SWING, rich.pendulum]), rich.peaks[SWING])
    rate = scene.load.mass * scene.crane.gravity * nodes.readings[:, SWING, -1] * (rich.yielding - poor.yielding)
    slower = swing**2 * rate[nodes.place] * rich.frequencies[:, rich.pendulum]
    return _integral(nodes.times, slower[:, None])[:, 0]


def _combined(parts: Complex, phase: Floats) -> Floats:
    """Sum of squares over groups of events; parts (nodes, outputs, k, E) and phases (E, k)."""
    far = np.diff(phase, axis=0) > COHERENT
    found = np.asarray((parts.real**2 + parts.imag**2).sum(axis=3))
    # Where every event is a group of its own, no phase matters.
    near = ~far.all(axis=0)
    if near.any():
        rotated = parts[:, :, near] * np.exp(-1j * phase[:, near].T)
        group = np.cumsum(np.vstack([np.zeros_like(far[:1]), far])[:, near], axis=0).T
        numbers = range(int(group.max()) + 1)
        found[:, :, near] = sum(abs((rotated * (group == number)).sum(axis=3)) ** 2 for number in numbers)
    return found


def _added(nodes: Nodes, setting: Setting) -> Floats:
    """Mass that the setting's cap adds to each coordinate."""
    order = np.concatenate([np.arange(nodes.richest.tower_modes), np.arange(nodes.richest.jib_vertical_modes), [0]])
    return added_mass(nodes.frequencies, order, setting.cap)


def _integral(times: Floats, values: Floats) -> Floats:
    """Integral over time from the first node to each, trapezoidal."""
    steps = 0.5 * np.diff(times)[:, None] * (values[1:] + values[:-1])
    return np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(steps, axis=0)])

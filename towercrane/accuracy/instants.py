"""A scene at a few instants: small motions about where the drives are then, and what the drives do to them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial.polynomial import polyder, polyval

from towercrane.accuracy.setting import Setting
from towercrane.cranes.tower.equations.matrices import geometric_stiffness
from towercrane.cranes.tower.targets import FORETOLD
from towercrane.motions.motion import phases

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.accuracy.scene import Scene
    from towercrane.cranes.tower.model import FlexibleModel
    from towercrane.motions.motion import Phases

    Floats = NDArray[np.float64]

RICHEST = Setting(tower_modes=10, jib_vertical_modes=14, planar=True)
"""What coarser models are compared with: a short tower that is soft in shear on soft ground wants many modes."""

BEYOND = {"tower_modes": 2, "jib_vertical_modes": 4}
"""Modes that the richest model has more than a model whose numbers of modes are stated."""

OUTPUTS = tuple(FORETOLD)
"""Outputs whose error is estimated, in the order of all arrays here."""

SWING, TENSION = 2, 3

INSIDE = (0.05, 0.25, 0.5, 0.75)
"""Nodes within a phase in which something moves or vibration decays, as fractions of it."""


@dataclass(frozen=True, eq=False)
class Nodes:
    """Small motions at N instants, at P different places, in the n coordinates of the richest model.

    The last coordinate is the load's sway from the point it hangs from [m]; the motions are about the undeformed
    crane, as in a linear frame.

    Parameters
    ----------
    scene : Scene
        In the jib's plane.
    richest : Setting
        Its numbers of modes.
    motions : Phases
        Of trolley and rope.
    times : ndarray, shape (N,)
        [s]
    place : ndarray of int, shape (N,)
        Which of the places each node is at.
    mass, rise : ndarray, shapes (P, n, n) and (P, n)
        Mass matrix; vertical motion of the point that the load hangs from.
    stiffness, softening : ndarray, shape (n, n)
        Without the load's pendulum; what the weight takes from it.
    pendulum : ndarray, shape (P,)
        Stiffness of the load's sway [N/m].
    weight : ndarray, shape (P, n)
        Generalised force of all weights.
    drives : ndarray, shape (N, 2)
        Accelerations of trolley and rope [m/s^2].
    push : ndarray, shape (P, 2, n)
        Generalised force over each of them.
    moved : ndarray, shape (P, n)
        Generalised force over the trolley's way.
    readings : ndarray, shape (P, outputs, n)
        Outputs per coordinate; the tension's per acceleration.
    events : ndarray of int, shape (E,)
        Nodes at which the drives' motions switch.
    jumps : ndarray, shape (E, orders, n)
        Jumps of the force and of its derivatives there.
    frequencies, damping : ndarray, shape (n,)
        Of each coordinate by itself [rad/s]; viscous damping.
    """

    scene: Scene
    richest: Setting
    motions: Phases
    times: Floats
    place: NDArray[np.int64]
    mass: Floats
    rise: Floats
    stiffness: Floats
    softening: Floats
    pendulum: Floats
    weight: Floats
    drives: Floats
    push: Floats
    moved: Floats
    readings: Floats
    events: NDArray[np.int64]
    jumps: Floats
    frequencies: Floats
    damping: Floats

    @property
    def decisive(self) -> NDArray[np.int64]:
        """Nodes at which two models can be farthest apart: switches and the end, or any where vibration decays."""
        if self.damping.any():
            return np.arange(len(self.times))
        return np.append(self.events, len(self.times) - 1)

    def derivatives(self, times: Floats) -> Floats:
        """Trolley's way, rope's length and all their derivatives and two more; shape (times, 2, orders)."""
        cut = self.motions
        phase = np.clip(np.searchsorted(cut.times, times, side="right") - 1, 0, len(cut.inputs) - 1)
        return derivatives_of(cut.inputs[phase], (times - cut.times[phase])[:, None])[:, 0]


def nodes_of(scene: Scene, richest: Setting = RICHEST) -> Nodes:
    """Nodes at the switch points of a scene's motions and between them.

    Parameters
    ----------
    scene : Scene
    richest : Setting, optional
        With the numbers of modes that coarser models are compared with.
    """
    cut = phases((scene.motions["trolley"], scene.motions["rope"]), scene.duration)
    times, states, events, changes = _instants(scene, cut)
    visited, place = np.unique(states[:, :, 0].round(12), axis=0, return_inverse=True)
    trolley, rope, place = *visited.T, place.ravel()
    model = scene.model(richest)
    crane, load = model.crane, scene.load.mass
    a, n = crane.tower.count, model.coordinates + 1
    tip, slope, hung = crane.tower(crane.tower_height), crane.top_slope, load + crane.trolley_mass

    rise, steep, reading = np.zeros((len(visited), n)), np.zeros((len(visited), n)), np.zeros((len(visited), 4, n))
    rise[:, :a], rise[:, a:-1] = -trolley[:, None] * slope, crane.vertical(trolley).T
    steep[:, :a], steep[:, a:-1] = -slope, crane.vertical(trolley, 1).T
    out, sway = np.zeros(n), np.zeros(n)
    out[:a], sway[-1] = tip, 1.0
    own = _own_mass(model)
    mass = own + hung * (np.outer(out, out) + rise[:, :, None] * rise[:, None, :])
    mass += load * (np.outer(out, sway) + np.outer(sway, out) + np.outer(sway, sway))
    stiffness, softening = np.zeros((n, n)), np.zeros((n, n))
    stiffness[:a, :a], softening[:a, :a] = crane.tower.stiffness_matrix(), geometric_stiffness(model)
    stiffness[range(a, n - 1), range(a, n - 1)] = crane.vertical.angular_frequencies**2

    reading[:, 0, :a] = tip
    reading[:, 1, a:-1] = crane.vertical(crane.jib_length)
    reading[:, SWING, -1] = 1.0 / rope
    reading[:, TENSION] = load * rise
    dead = np.zeros(n)
    if scene.self_weight:
        dead[:a], dead[a:-1] = crane.slewing.moment * slope, -crane.slewing.first
    weight = crane.gravity * (dead - hung * rise)

    # A trolley that is sped up pushes along the jib as it hangs, and takes its weight along.
    hanging = np.linalg.solve(stiffness[:-1, :-1], weight[place[0], :-1])
    along = -hung * (out + (steep[:, :-1] @ hanging)[:, None] * rise) - load * sway
    push = np.stack([along, load * rise], axis=1)
    moved = -crane.gravity * hung * steep
    jumps = np.einsum("eco,ecn->eon", changes[:, :, 2:], push[place[events]])
    jumps[:, 2:] += np.einsum("eo,en->eon", changes[:, 0, 2:-2], moved[place[events]])
    # A load that is let go from a swing pulls less than its weight.
    jumps[0, 0] += load * crane.gravity * np.sin(scene.start.along or 0.0) ** 2 * rise[place[0]]
    ratios = np.repeat([scene.damping.tower, scene.damping.vertical], [a, n - 1 - a])
    frequencies = np.append(model.angular_frequencies, 0.0)
    return Nodes(
        scene,
        richest,
        cut,
        times,
        place,
        mass,
        rise,
        stiffness,
        softening,
        load * crane.gravity / rope,
        weight,
        states[:, :, 2],
        push,
        moved,
        reading,
        events,
        jumps,
        frequencies,
        2.0 * np.append(ratios, 0.0) * frequencies,
    )


def _instants(scene: Scene, cut: Phases) -> tuple[Floats, Floats, NDArray[np.int64], Floats]:
    """Times of the nodes, derivatives of the drives there, which nodes are switch points, jumps at these."""
    since = np.diff(cut.times)[:, None] * (0.0, *INSIDE, 1.0)
    states = derivatives_of(cut.inputs, since)
    damped = scene.damping.tower > 0.0 or scene.damping.vertical > 0.0
    known = np.ones(since.shape, dtype=bool)
    moving = np.any(cut.inputs[:, :, 1:], axis=(1, 2))
    known[:, 1:-1] = damped | moving[:, None]
    # The end of a phase is the start of the next, which jumps.
    known[:-1, -1] = False
    counts = known.sum(axis=1)
    events = np.cumsum(counts) - counts
    before = np.concatenate([np.zeros_like(states[:1, 0]), states[:-1, -1]])
    return (cut.times[:-1, None] + since)[known], states[known], events, states[:, 0] - before


def derivatives_of(pieces: Floats, since: Floats) -> Floats:
    """Derivatives of polynomials (p, channels, k), two orders beyond the last; shape (p, s, channels, k + 2)."""
    orders = [polyder(pieces, order, axis=2) for order in range(pieces.shape[2] + 2)]
    return np.stack([polyval(since[:, :, None], order.transpose(2, 0, 1)[:, :, None], False) for order in orders], -1)


def _own_mass(model: FlexibleModel) -> Floats:
    """Mass matrix without trolley and load."""
    crane, a, n = model.crane, model.crane.tower.count, model.coordinates + 1
    tip, slope, sums = crane.tower(crane.tower_height), crane.top_slope, crane.slewing
    mass = np.zeros((n, n))
    mass[:a, :a] = crane.tower.mass_matrix() + sums.mass * np.outer(tip, tip) + sums.pitch * np.outer(slope, slope)
    mass[a:-1, a:-1] = sums.products + sums.turned_products
    mass[a:-1, :a] = -np.outer(sums.second + sums.turned, slope)
    mass[:a, a:-1] = mass[a:-1, :a].T
    return mass

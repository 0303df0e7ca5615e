"""Small motions of a flexible crane with its load: matrices, natural frequencies, and what kind each mode is of."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.tower.equations.actions.collars import meet
from towercrane.cranes.tower.equations.coordinates import SIDEWAYS, UPRIGHT
from towercrane.kernels.algebra import vibrations
from towercrane.simulation.differences import jacobian

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from towercrane.cranes.tower.equations.flexible import Equations

    Floats = NDArray[np.float64]

MOTION_KINDS = (
    "radial",
    "lateral",
    "torsion",
    "radial sway",
    "lateral sway",
    "rope",
    "radial sling",
    "lateral sling",
)
"""What moves in a mode: tower and jib in the jib's vertical plane, tower and jib across it, torsion with slewing, the
rope along and across the jib, the rope that stretches, and slings along and across the jib."""


@dataclass(frozen=True, eq=False)
class NaturalMode:
    """One small motion about the equilibrium.

    Parameters
    ----------
    angular_frequency : float
        [rad/s]
    kind : str
        The one of `MOTION_KINDS` that holds most of the mode's energy.
    shares : dict of str to float
        Share of each kind in the elastic and potential energy; they add up to 1.
    shape : ndarray, shape (coordinates + 2,)
        Coordinates, the stretch of a rope that does, then the load's way from the point it hangs from, along the
        fixed axes x and y [m]; under a hook the hook's, then of each body below from the one above.
    """

    angular_frequency: float
    kind: str
    shares: dict[str, float]
    shape: Floats

    @property
    def frequency_hz(self) -> float:
        """Natural frequency [Hz]."""
        return self.angular_frequency / (2.0 * np.pi)


def linear_matrices(model: Equations, drives: ArrayLike, *, about: Floats | None = None) -> tuple[Floats, Floats]:
    """Mass and stiffness of small motions with the drives held.

    Parameters
    ----------
    model : Equations
    drives : array_like, shape (channels,) or (channels, 1)
        Value of each of the model's channels.
    about : ndarray, shape (coordinates,), optional
        Coordinates at equilibrium. Without, the motions are about the undeformed crane, as in a linear frame.

    Returns
    -------
    mass, stiffness : ndarray, shape (coordinates + axes - 1, coordinates + axes - 1)
        The last coordinates are the load's horizontal way from the point it hangs from [m], under a hook the hook's
        and then of each body below from the one above; before them, where the rope stretches, its stretch [m].
    """
    inputs = np.zeros((len(model.channels), 3))
    inputs[:, 0] = np.ravel(np.asarray(drives, dtype=float))
    n, sways, load = model.coordinates, model.axes - 1, model.load.now(inputs[model.constants.release])
    there = np.zeros(n) if about is None else about
    at_rest = model.at_rest(there, inputs)
    columns = np.array(at_rest.jacobian, dtype=float).reshape(model.axes, n)
    length, elasticity = model.rope_at_rest(there, inputs), model.load.elasticity
    # What each coordinate moves the load: along its axes, then down the rope, then to its sides.
    own = np.zeros((model.axes, sways if elasticity is None else model.axes))
    own[:sways, -sways:] = np.eye(sways)
    if elasticity is not None:
        own[-1, 0] = -1.0
    moved = np.hstack([columns, own, *[np.zeros((model.axes, sways))] * len(load.slings)])
    mass, stiffness = np.zeros((2, moved.shape[1], moved.shape[1]))
    for k, body in enumerate(load.bodies):
        below = slice(n + own.shape[1] + (k - 1) * sways, n + own.shape[1] + k * sways)
        if k:
            moved[:sways, below] = np.eye(sways)
            held = model.load.under(k).whole_mass * model.crane.gravity / load.slings[k - 1].length
            stiffness[below, below] = held * np.eye(sways)
        mass += body.mass * moved.T @ moved
    mass[:n, :n] += at_rest.mass_matrix()
    weight = load.whole_mass * model.crane.gravity
    if elasticity is not None:
        wound = float(inputs[1, 0])
        stiffness[n, n] = elasticity.spring(wound)
        length += weight / stiffness[n, n]
    if about is None:
        stiffness[:n, :n] = model.constants.stiffness
    elif n:
        slope, _ = jacobian(lambda q: -model.static_forces(q, inputs), about, model.system.scale[:n])
        stiffness[:n, :n] = 0.5 * (slope + slope.T) + model.contact(about, inputs)[1]
    rope = slice(n + own.shape[1] - sways, n + own.shape[1])
    stiffness[rope, rope] = weight / length * np.eye(sways)
    return mass, stiffness


def reciprocal_modes(model: Equations, mass: Floats, stiffness: Floats) -> tuple[Floats, Floats]:
    """Angular frequencies, ascending [rad/s], and shapes of unit elastic energy in the columns.

    Raises
    ------
    NoEquilibrium
        If the stiffness is not positive definite.
    """
    if np.linalg.eigvalsh(stiffness).min() <= 0.0:
        raise model.gives_way()
    # The reciprocal problem keeps the low modes exact to rounding, however stiff the highest is.
    reciprocal, vectors = vibrations(mass, stiffness)
    return 1.0 / np.sqrt(reciprocal[::-1]), vectors[:, ::-1]


def plane_modes(model: Equations, place: float, rope_length: float, gone: float = 0.0) -> tuple[Floats, int]:
    """Small motions in the jib's plane about the undeformed crane, as a linear frame has them.

    The second-order effect of the static deflection is not in them.

    Parameters
    ----------
    model : Equations
        That stays in the plane.
    place, rope_length, gone : float
        As in :func:`natural_modes`.

    Returns
    -------
    frequencies : ndarray, shape (coordinates + 1,)
        Angular frequencies, ascending [rad/s]; with slings one more for each.
    swing : int
        Index of the mode in which the rope swings most: the one with the largest share of its elastic and potential
        energy in the pendulum.

    Raises
    ------
    NoEquilibrium
        If the weight's softening leaves the tower no stiffness.
    """
    mass, stiffness = plane_matrices(model, place, rope_length, gone)
    frequencies, vectors = reciprocal_modes(model, mass, stiffness)
    rope = -len(model.load.bodies)
    return frequencies, int(np.argmax(stiffness[rope, rope] * vectors[rope] ** 2))


def plane_matrices(model: Equations, place: float, rope_length: float, gone: float = 0.0) -> tuple[Floats, Floats]:
    """Mass and stiffness of small motions in the plane, see `plane_modes`; shapes (coordinates + 1, coordinates + 1).

    The last coordinate is the load's horizontal way from the point it hangs from [m].
    """
    drives = np.zeros(len(model.channels))
    drives[:2] = place, rope_length
    if model.load.release is not None:
        drives[model.constants.release] = gone
    if model.crane.luffing is None and model.crane.tied is None:
        return linear_matrices(model, drives)
    # A jib that pivots or hangs on ties stands in no state but that of equilibrium.
    return linear_matrices(model, drives, about=model.equilibrium(np.column_stack([drives, 0.0 * drives])))


def natural_modes(
    model: Equations, place: float, rope_length: float, slewing_angle: float = 0.0, gone: float = 0.0
) -> list[NaturalMode]:
    """Small motions about the equilibrium in still air, drives held; ascending by frequency.

    Parameters
    ----------
    model : Equations
        With a load in space.
    place : float
        Position of the trolley [m], or angle that the winch would give a straight jib on a stiff rope [rad].
    rope_length : float
        As the hoist winch has it [m].
    slewing_angle : float
        Of the head, or of the drive's shaft [rad].
    gone : float
        Part of what lets go of the load that is gone; some of it hangs.

    Raises
    ------
    NoEquilibrium
        If there is no stable equilibrium.
    ValueError
        If the load is confined to a plane.
    """
    if model.axes != 3:
        raise ValueError("FlexibleModel.axes: wanted 3, a load in space, got 2")
    drives = _standing(model, place, rope_length, slewing_angle, gone)
    q = model.equilibrium(drives)
    mass, stiffness = linear_matrices(model, drives[:, 0], about=q)
    frequencies, shapes = reciprocal_modes(model, mass, stiffness)
    heading = 0.0 if model.slewing == "fixed" else slewing_angle
    frame = _head_frame(model, heading)
    turned = frame @ stiffness @ frame.T
    found = []
    for frequency, shape in zip(frequencies, shapes.T, strict=True):
        energy = (frame @ shape) * (turned @ frame @ shape)
        total = energy.sum()
        shares = {kind: float(energy[rows].sum() / total) for kind, rows in _rows(model).items()}
        found.append(NaturalMode(float(frequency), max(shares, key=lambda kind: shares[kind]), shares, shape))
    return found


def leans_on(model: Equations, place: float, rope_length: float, slewing_angle: float = 0.0) -> list[int]:
    """Collars with play that the tower presses on at rest, by their number, the lowest is 1; arguments and errors as
    :func:`natural_modes` has them."""
    drives = _standing(model, place, rope_length, slewing_angle)
    held = [(value, 0.0, 0.0) for value in drives[:, 0]]
    found = meet(model.constants, model.equilibrium(drives), held)
    numbers = () if model.constants.play is None else model.constants.play.numbers
    return [number + 1 for number, met in zip(numbers, found, strict=True) if met.beyond > 0.0]


def unloaded_frequencies(model: Equations, place: float, rope_length: float, slewing_angle: float = 0.0) -> Floats:
    """Angular frequencies of a crane whose load has let go, ascending [rad/s]; arguments and errors as above."""
    if model.axes == 2:
        matrices = plane_matrices(model, place, rope_length, 1.0)
    else:
        drives = _standing(model, place, rope_length, slewing_angle, 1.0)
        matrices = linear_matrices(model, drives[:, 0], about=model.equilibrium(drives))
    mass, stiffness = (matrix[: model.coordinates, : model.coordinates] for matrix in matrices)
    return reciprocal_modes(model, mass, stiffness)[0] if model.coordinates else np.empty(0)


def _standing(model: Equations, place: float, rope_length: float, slewing_angle: float, gone: float = 0.0) -> Floats:
    """Inputs of drives that stand, without wind; shape (channels, 3)."""
    values = {"rope": rope_length, "slewing": slewing_angle, "shaft": slewing_angle, "release": gone}
    values |= dict.fromkeys(("trolley", "luffing"), place)
    inputs = np.zeros((len(model.channels), 3))
    inputs[:, 0] = [values.get(channel, 0.0) for channel in model.channels]
    return inputs


def _head_frame(model: Equations, heading: float) -> Floats:
    """Orthogonal matrix that turns what is given along x and y into along and across the jib."""
    n, parts = model.coordinates, model.parts
    rope, links = n + (model.load.elasticity is not None), len(model.load.bodies)
    frame = np.eye(rope + 2 * links)
    pairs = [(rope + 2 * k, rope + 2 * k + 1) for k in range(links)]
    if model.counts["tower_y"]:
        pairs += zip(
            range(*parts["tower_x"].indices(n)),
            range(*parts["tower_y"].indices(n)),
            strict=True,
        )
    c, s = np.cos(heading), np.sin(heading)
    for x, y in pairs:
        frame[np.ix_([x, y], [x, y])] = [[c, s], [-s, c]]
    return frame


def _rows(model: Equations) -> dict[str, list[int]]:
    n = model.coordinates
    rope = n + (model.load.elasticity is not None)
    at = {kind: list(range(*rows.indices(n))) for kind, rows in model.parts.items()}
    groups = (
        *([row for kind in kinds for row in at.get(kind, [])] for kinds in (UPRIGHT, SIDEWAYS)),
        at["torsion"] + at["slewing"],
        [rope],
        [rope + 1],
        list(range(n, rope)),
        *(list(range(rope + 2 + side, rope + 2 * len(model.load.bodies), 2)) for side in range(2)),
    )
    return dict(zip(MOTION_KINDS, groups, strict=True))

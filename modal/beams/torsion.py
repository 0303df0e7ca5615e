"""Shaft clamped at one end, a rigid body at the other, steps and springs on the way: natural modes of torsion."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import pi, sqrt
from typing import TYPE_CHECKING

import numpy as np

from modal.checks import SMALLEST, check_fields, check_positive, number_in, whole_number

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Shaft:
    """Shaft in torsion, uniform or in steps.

    Parameters
    ----------
    length : float
        Length [m].
    inertia_per_length : float
        Moment of inertia about the axis per unit length, from the foot on [kg m].
    torsional_stiffness : float
        Torque per twist per length, G J, from the foot on [N m^2].
    springs : tuple of (float, float)
        Springs that hold it on its way: position [m] and torque per twist [N m/rad], positions ascending.
    steps : tuple of (float, float, float)
        Where it changes: position [m], and inertia per length [kg m] and torsional stiffness [N m^2] from there on,
        positions ascending.

    Raises
    ------
    ValueError
        If a value is not a positive finite number, or springs or steps are off the shaft or not in order.
    """

    length: float
    inertia_per_length: float
    torsional_stiffness: float
    springs: tuple[tuple[float, float], ...] = ()
    steps: tuple[tuple[float, float, float], ...] = ()

    def __post_init__(self) -> None:
        check_fields(self, positive=("length", "inertia_per_length", "torsional_stiffness"))
        below = 0.0
        for position, stiffness in self.springs:
            wanted = f"more than {below!r} and up to {self.length!r} m, ascending"
            number_in("Shaft.springs", position, wanted, least=below + SMALLEST, most=self.length)
            if not position > below:
                raise ValueError(f"Shaft.springs: wanted {wanted}, got {position!r}")
            number_in("Shaft.springs", stiffness, "stiffnesses of zero or more", least=0.0)
            below = position
        below = 0.0
        for position, *values in self.steps:
            wanted = f"more than {below!r} and less than {self.length!r} m, ascending"
            if not below < number_in("Shaft.steps", position, wanted) < self.length:
                raise ValueError(f"Shaft.steps: wanted {wanted}, got {position!r}")
            for value in values:
                check_positive("Shaft.steps", value)
            below = position

    @property
    def inertia(self) -> float:
        """Moment of inertia about the axis [kg m^2]."""
        return float(self.pieces[0] @ np.diff(self.nodes))

    @property
    def nodes(self) -> Floats:
        """Foot, springs and steps on the way and end [m]; a spring at the end makes no node of its own."""
        inside = {at for at, *_ in (*self.springs, *self.steps) if at < self.length}
        return np.array([0.0, *sorted(inside), self.length])

    @property
    def pieces(self) -> tuple[Floats, Floats]:
        """Inertia per length [kg m] and torsional stiffness [N m^2] from each node to the next."""
        starts = [0.0, *(at for at, *_ in self.steps)]
        values = np.array([(self.inertia_per_length, self.torsional_stiffness), *(step[1:] for step in self.steps)])
        there = values[np.searchsorted(starts, self.nodes[:-1], side="right") - 1]
        return there[:, 0], there[:, 1]

    @property
    def paces(self) -> Floats:
        """How fast the angle of a wave grows along each piece over how fast it does from the foot on [1]."""
        inertias, stiffnesses = self.pieces
        return np.asarray(np.sqrt(inertias / stiffnesses / (self.inertia_per_length / self.torsional_stiffness)))


@dataclass(frozen=True, eq=False)
class TorsionModes:
    """Natural modes of torsion, phi_i = A_ip sin(y_i c_p (z - z_p) / L + a_ip) between the nodes z_p, clamped at 0.

    The paces c_p are those of the shaft, one where it is uniform.

    Made by `torsion_modes`. They are orthonormal in the inertia of shaft and body together, so phi is in
    (kg m^2)^-1/2.

    Parameters
    ----------
    shaft : Shaft
    end_inertia : float
        Of the body at position L [kg m^2].
    roots : ndarray, shape (n,)
        y_i, ascending [rad].
    amplitudes, phases : ndarray, shape (n, pieces)
        A_ip [(kg m^2)^-1/2] and a_ip [rad].
    """

    shaft: Shaft
    end_inertia: float
    roots: Floats
    amplitudes: Floats
    phases: Floats

    @property
    def count(self) -> int:
        """Number of modes, n."""
        return int(self.roots.size)

    @property
    def angular_frequencies(self) -> Floats:
        """Natural angular frequencies [rad/s], shape (n,)."""
        return self.roots / self.shaft.length * sqrt(self.shaft.torsional_stiffness / self.shaft.inertia_per_length)

    def __call__(self, position: ArrayLike) -> Floats:
        """Twist at positions along the shaft [(kg m^2)^-1/2], shape (n, *shape of position)."""
        z, nodes = np.asarray(position, dtype=float), self.shaft.nodes
        piece = np.clip(np.searchsorted(nodes, z, side="right") - 1, 0, len(nodes) - 2)
        part = self.shaft.paces[piece] * (z - nodes[piece]) / self.shaft.length
        angles = np.multiply.outer(self.roots, part) + self.phases[:, piece]
        return self.amplitudes[:, piece] * np.sin(angles)

    @cached_property
    def _middles(self) -> tuple[Floats, Floats]:
        """Angles at the middle of each piece and half of what it turns them, shape (n, pieces) each."""
        half = _halves(self.shaft, self.roots)
        return self.phases + half, half

    def mass_matrix(self) -> Floats:
        """Inertia of the shaft alone, int j phi_i phi_j dz [1], shape (n, n)."""
        total, (middles, halves) = np.zeros((self.count, self.count)), self._middles
        inertias = self.shaft.pieces[0] * np.diff(self.shaft.nodes)
        for inertia, middle, half, size in zip(inertias, middles.T, halves.T, self.amplitudes.T, strict=True):
            # numpy's sinc is sin(pi x) / (pi x).
            apart, together = (
                np.cos(of.outer(middle, middle)) * np.sinc(of.outer(half, half) / pi) for of in (np.subtract, np.add)
            )
            total += 0.5 * inertia * (apart - together) * np.outer(size, size)
        return total

    def mass_moment(self) -> Floats:
        """First sum int j phi dz [(kg m^2)^1/2], shape (n,)."""
        middles, halves = self._middles
        waves = np.sin(middles) * np.sinc(halves / pi) * self.amplitudes
        return waves @ (self.shaft.pieces[0] * np.diff(self.shaft.nodes))

    def with_stiffness(self, factor: float) -> TorsionModes:
        """As many modes of the same shaft so many times as stiff, on the same springs."""
        steps = tuple((at, inertia, factor * stiffness) for at, inertia, stiffness in self.shaft.steps)
        stiffer = replace(self.shaft, torsional_stiffness=factor * self.shaft.torsional_stiffness, steps=steps)
        return torsion_modes(stiffer, self.count, self.end_inertia)


def torsion_modes(shaft: Shaft, count: int, end_inertia: float = 0.0) -> TorsionModes:
    """Natural modes of torsion of a shaft with a rigid body at its end.

    Parameters
    ----------
    shaft : Shaft
    count : int
        Number of modes, zero or more.
    end_inertia : float
        Moment of inertia of the body about the axis [kg m^2], zero or more.

    Raises
    ------
    ValueError
        If the count or the inertia is negative or not finite.

    Notes
    -----
    With y = w L sqrt(j / GJ) of the foot, the angle of (twist, torque L / (GJ y z)) grows along a piece by y c per
    length L, c = sqrt(j / GJ) and z = sqrt(j GJ) relative to the foot's. A spring k turns it back within its
    half-plane, ``cot -> cot + k L / (GJ y z)``; a step to another z turns it within its quarter. With
    a = end_inertia / (j L) the roots are where it ends at ``arccot((a y - k L / (GJ y)) / z) + i pi``, k that of a
    spring at the end: one for each i.
    """
    whole_number("count", count)
    number_in("end_inertia", end_inertia, "zero or more", least=0.0)
    roots = np.array([_root(shaft, i, end_inertia) for i in range(count)])
    amplitudes, phases = np.ones((2, count, len(shaft.nodes) - 1))
    for i, root in enumerate(roots):
        phases[i], steps, _ = _pieces(shaft, root)
        amplitudes[i] = np.cumprod(steps)
    # Squares over pieces, int sin^2 = (1 - cos(2 middle) sinc(2 half)) / 2 per length, and the body's share.
    half, inertias = _halves(shaft, roots), shaft.pieces[0] * np.diff(shaft.nodes)
    squares = 0.5 * (1.0 - np.cos(2.0 * (phases + half)) * np.sinc(2.0 * half / pi)) * amplitudes**2 @ inertias
    end = amplitudes[:, -1] * np.sin(phases[:, -1] + 2.0 * half[:, -1])
    # Signs turn the end to the positive side.
    norms = np.sign(end) / np.sqrt(squares + end_inertia * end**2)
    amplitudes = amplitudes * norms[:, None]
    for array in (roots, amplitudes, phases):
        array.setflags(write=False)
    return TorsionModes(shaft, end_inertia, roots, amplitudes, phases)


def _halves(shaft: Shaft, roots: Floats) -> Floats:
    """Half of what each piece turns the angle of each mode by, shape (n, pieces)."""
    return np.asarray(0.5 * np.multiply.outer(roots, shaft.paces * np.diff(shaft.nodes)) / shaft.length)


def _pieces(shaft: Shaft, y: float) -> tuple[list[float], list[float], float]:
    """Angle at which each piece begins, its amplitude over that of the one before, and the angle at the end."""
    spans, springs = shaft.paces * np.diff(shaft.nodes) / shaft.length, dict(shaft.springs)
    torques = _torques(shaft)
    starts, steps, end = [0.0], [1.0], y * float(spans[0])
    for k, (node, span) in enumerate(zip(shaft.nodes[1:-1].tolist(), spans[1:].tolist(), strict=True)):
        # A spring turns the angle back, a step either way, between the same multiples of pi.
        turns = pi * np.floor(end / pi)
        twist, torque = np.sin(end - turns), np.cos(end - turns)
        torque += springs.get(node, 0.0) * shaft.length / (shaft.torsional_stiffness * y * torques[k]) * twist
        torque *= torques[k] / torques[k + 1]
        starts.append(float(turns + np.arctan2(twist, torque)))
        steps.append(float(np.hypot(twist, torque)))
        end = starts[-1] + y * span
    return starts, steps, end


def _torques(shaft: Shaft) -> Floats:
    """Torque of a wave over its twist and frequency along each piece over that from the foot on [1]."""
    inertias, stiffnesses = shaft.pieces
    return np.asarray(np.sqrt(inertias * stiffnesses / (shaft.inertia_per_length * shaft.torsional_stiffness)))


def _root(shaft: Shaft, index: int, end_inertia: float) -> float:
    """Root of that number, from 0."""
    # Here, since most cranes keep no torsion: scipy.optimize takes a quarter of a second to import.
    from scipy.optimize import brentq

    ratio = end_inertia / (shaft.inertia_per_length * shaft.length)
    last = sum(stiffness for at, stiffness in shaft.springs if at == shaft.length)
    holding, torque = last * shaft.length / shaft.torsional_stiffness, float(_torques(shaft)[-1])
    turn = float(shaft.paces @ np.diff(shaft.nodes)) / shaft.length

    def excess(y: float) -> float:
        # The end is where its inertia, less its spring, asks for the torque that arrives.
        return _pieces(shaft, y)[2] - float(np.arctan2(torque, ratio * y - holding / y)) - index * pi

    # A step may turn the angle forth by less than a quarter, as a spring turns it back by less than a half.
    low = max((index - 0.5 * len(shaft.steps)) * pi / turn, 1e-300)
    high = (index + 0.75 + len(shaft.springs) + len(shaft.steps)) * pi / turn
    return float(brentq(excess, low, high, xtol=1e-300, rtol=1e-15))

"""Minimal coordinates of a crane's state about an operating point.

The rope's unit vector n and its rate p have more components than freedom. They give way to sway coordinates s on
the plane that touches the unit sphere at the operating point: n = E s + sqrt(1 - s.s) n0 with the tangent unit
vectors E, so s = E' n and s'' = E' p' hold without approximation, and s is the sway angle to first order. On an
elastic rope the state has the load's place instead, whose departures are coordinates as they are. Slings have sways
of their own.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from towercrane.linear.statespace import RATE, Signal

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from towercrane.simulation.system import Model

    Floats = NDArray[np.float64]
    Turning = tuple[Literal["coordinate", "channel"], int]

SWAY, FIXED_SWAY = ("sway_outward", "sway_sideways"), ("sway_x", "sway_y")
"""Names of the sways in axes that turn with the crane, or of one that does not turn, and in fixed ones."""

PLACE, FIXED_PLACE = ("load_outward", "load_sideways", "load_up"), ("load_x", "load_y", "load_z")
"""Names of the load's departures on an elastic rope, in the same axes."""

SLING = "sling_"
"""What comes before the names of the sways of a sling, and of those of further ones a number."""

TURNING = ("platform_angle", "slewing_angle", "slewing", "slew")
"""Coordinates and channels that are the angle of a crane's jib about the vertical."""


@dataclass(frozen=True, eq=False)
class Chart:
    """Minimal state (q, s, q', s') beside a model's state (q, n, q', p, work): s is sways, or a load's departure.

    Parameters
    ----------
    names : tuple of Signal
        Names and units of the minimal state.
    scale, at : ndarray, shape (size,)
        A large change of each entry, and the operating point.
    directions : tuple of ndarray, shape (axes,)
        The rope, or the load's place, at the operating point, seen from the turning frame if there is one; slings.
    bases : tuple of ndarray, shape (axes, axes - 1) or (axes, axes)
        Tangent unit vectors of each; of an elastic rope the axes.
    turning : tuple, optional
        The coordinate or channel that the frame turns with, by index.
    pairs : tuple of pairs of int
        Coordinates that are components of horizontal vectors along fixed axes, and are seen from the frame too.
    """

    names: tuple[Signal, ...]
    scale: Floats
    at: Floats
    directions: tuple[Floats, ...]
    bases: tuple[Floats, ...]
    turning: Turning | None
    pairs: tuple[tuple[int, int], ...] = ()

    @classmethod
    def about(cls, model: Model, state: Floats, drives: Floats, turning: str | None) -> Chart:
        """Chart of a model about its state.

        Parameters
        ----------
        drives : ndarray, shape (3, channels)
            Values, rates and accelerations of the channels.
        turning : str, optional
            Name of the angle about the vertical that the frame turns with.

        Raises
        ------
        ValueError
            If there is no such angle, or the model's names do not fit its coordinates.
        """
        axes = int(getattr(model, "axes", 3))
        slings = len(getattr(getattr(model, "load", None), "slings", ()))
        n, free = (model.system.size - 1) // 2 - axes * (1 + slings), axes - 1 if model.system.rope is None else axes
        fixed, own = (FIXED_SWAY, SWAY) if free < axes else (FIXED_PLACE, PLACE)
        named: dict[str, str] = dict(getattr(model, "state_names", {f"coordinate_{i + 1}": "" for i in range(n)}))
        if len(named) == n:
            turns = turning is None and any(name in TURNING for name in (*named, *model.channels))
            of_load, unit = fixed if turns else own, "rad" if free < axes else "m"
            named |= dict.fromkeys([*of_load[: axes - 1], *of_load[2:]][:free], unit)
        if len(named) != n + free:
            raise ValueError(f"state_names: wanted {n} coordinates, with sways {n + free}, got {len(named)}")
        below = [name.removeprefix("load_") for name in list(named)[n : n + axes - 1]]
        for k in range(slings):
            number = "" if slings == 1 else f"{k + 1}_"
            named |= {f"{SLING}{number}sway_{name.removeprefix('sway_')}": "rad" for name in below}
        pairs: tuple[tuple[int, int], ...] = ()
        angle = None if turning is None else _find(turning, list(named)[:n], model.channels, axes)
        names = [Signal(*item) for item in named.items()]
        rates = [Signal(f"{name}{RATE}", per_second(units)) for name, units in names]
        scale, half, sways = model.system.scale, len(state) // 2, np.ones(free + slings * (axes - 1))
        scale = np.concatenate([scale[:n], sways, scale[half : half + n], sways])
        q, ropes, rate, swings = _parts(state, n, axes)
        if angle is not None:
            phi, spin, _ = _turn(angle, q, rate, rate, drives)
            ropes = [_rotation(phi).T @ own for own in ropes]
            swings = [_rotation(phi).T @ swing - _cross(spin, own) for swing, own in zip(swings, ropes, strict=True)]
            # At rest the axes of the coordinates serve, and their names say which those are.
            group = getattr(model, "turning", None) if spin else None
            pairs = tuple(pair for pair in group.vectors if max(pair) < n) if group is not None else ()
            for pair in map(list, pairs):
                moved, still = _flat(_rotation(phi).T, rate[pair]), _flat(_rotation(phi).T, q[pair])
                q[pair], rate[pair] = still, moved - _cross(spin, still)[:2]
        loose = free == axes
        units = [*ropes[:loose], *(own / np.linalg.norm(own) for own in ropes[loose:])]
        bases = [*[np.eye(axes)] * loose, *map(_tangents, units[loose:])]
        moving = [basis.T @ swing for basis, swing in zip(bases, swings, strict=True)]
        at = np.concatenate([q, 0.0 * sways, rate, *moving])
        scale = np.where(np.isfinite(scale), scale, 1.0)
        return cls((*names, *rates), scale, at, tuple(units), tuple(bases), angle, pairs)

    @property
    def direction(self) -> Floats:
        """That of the rope."""
        return self.directions[0]

    def full(self, minimal: Floats, drives: Floats) -> Floats:
        """State of the model; its work is zero."""
        q, ropes, rate, swings = self._ropes(minimal)
        if self.turning is not None:
            phi, spin, _ = _turn(self.turning, q, rate, rate, drives)
            swings = [_rotation(phi) @ (swing + _cross(spin, own)) for swing, own in zip(swings, ropes, strict=True)]
            ropes = [_rotation(phi) @ own for own in ropes]
            q, rate = np.array(q), np.array(rate)
            for pair in map(list, self.pairs):
                own, moved = q[pair], rate[pair] + _cross(spin, q[pair])[:2]
                q[pair], rate[pair] = _flat(_rotation(phi), own), _flat(_rotation(phi), moved)
        return np.concatenate([q, *ropes, rate, *swings, [0.0]])

    def slope(self, minimal: Floats, slope: Floats, drives: Floats) -> Floats:
        """Slope of the minimal state from that of the model's state."""
        q, ropes, rate, swings = self._ropes(minimal)
        velocity, _, acceleration, pulls = _parts(slope, len(q), len(self.direction))
        if self.turning is not None:
            phi, spin, spin_up = _turn(self.turning, q, rate, acceleration, drives)
            for k, (own, swing) in enumerate(zip(ropes, swings, strict=True)):
                pull = _rotation(phi).T @ pulls[k] - _cross(spin_up, own)
                pulls[k] = pull - _cross(spin, 2.0 * swing + _cross(spin, own))
            for pair in map(list, self.pairs):
                place, moved = q[pair], rate[pair]
                thrown = _cross(spin, 2.0 * moved + _cross(spin, place)[:2])[:2] + _cross(spin_up, place)[:2]
                velocity[pair], acceleration[pair] = moved, _flat(_rotation(phi).T, acceleration[pair]) - thrown
        sways, swayed = (
            [basis.T @ own for basis, own in zip(self.bases, found, strict=True)] for found in (swings, pulls)
        )
        return np.concatenate([velocity, *sways, acceleration, *swayed])

    def _ropes(self, minimal: Floats) -> tuple[Floats, list[Floats], Floats, list[Floats]]:
        """Coordinates, rope and slings, rates and theirs, those of ropes as the turning frame sees them."""
        half, ends = len(minimal) // 2, np.cumsum([basis.shape[1] for basis in self.bases])
        n, ropes, swings = half - ends[-1], [], []
        q, rate = minimal[:n], minimal[half : half + n]
        for still, basis, end in zip(self.directions, self.bases, ends, strict=True):
            place = slice(n + end - basis.shape[1], n + end)
            s, s_rate = minimal[:half][place], minimal[half:][place]
            if basis.shape[1] == len(still):
                ropes.append(still + s)
                swings.append(s_rate)
                continue
            along = np.sqrt(1.0 - s @ s)
            ropes.append(along * still + basis @ s)
            swings.append(basis @ s_rate - (s @ s_rate) / along * still)
        return q, ropes, rate, swings


def _parts(state: Floats, n: int, axes: int) -> tuple[Floats, list[Floats], Floats, list[Floats]]:
    """Coordinates of a state, vectors along rope and slings, rates of both."""
    half = len(state) // 2
    places, rates = np.array(state[:half]), np.array(state[half : 2 * half])
    return places[:n], list(places[n:].reshape(-1, axes)), rates[:n], list(rates[n:].reshape(-1, axes))


def per_second(units: str) -> str:
    """Units of a rate; none where a quantity's are not known."""
    return f"{units}/s" if units else ""


def _find(name: str, coordinates: Sequence[str], channels: tuple[str, ...], axes: int) -> Turning:
    if axes != 3:
        raise ValueError("turning: wanted a load that swings in space, got one in a plane")
    if name in coordinates:
        return "coordinate", coordinates.index(name)
    if name in channels:
        return "channel", channels.index(name)
    raise ValueError(f"turning: wanted one of {', '.join([*coordinates, *channels])}, got {name!r}")


def _turn(turning: Turning, q: Floats, rate: Floats, acceleration: Floats, drives: Floats) -> Floats:
    """Angle, rate and acceleration of the turning frame."""
    what, index = turning
    return np.array([q[index], rate[index], acceleration[index]]) if what == "coordinate" else drives[:, index]


def _rotation(angle: float) -> Floats:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def _cross(spin: float, vector: Floats) -> Floats:
    """Product of a rate about the vertical and a vector."""
    return spin * np.array([-vector[1], vector[0], 0.0])


def _flat(rotation: Floats, vector: Floats) -> Floats:
    """A horizontal vector, rotated."""
    return np.asarray(rotation[:2, :2] @ vector)


def _tangents(direction: Floats) -> Floats:
    """Outward and sideways, carried along by the shortest turn from hanging to ``direction``."""
    if len(direction) == 2:
        return np.array([[-direction[1]], [direction[0]]])
    across, drop = direction[:2], 1.0 - direction[2]
    if drop < 1e-12:
        return np.array([[-1.0, 0.0], [0.0, 1.0], [0.0, 0.0]])
    return np.vstack([np.eye(2) - np.outer(across, across) / drop, across])

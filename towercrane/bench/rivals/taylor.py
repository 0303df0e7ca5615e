"""The radial equations for heyoka, an integrator by Taylor series that compiles the expressions it is given."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from modal.beams.shapes import Modes
from towercrane.bench.scenes.plain import Balance, derivatives

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.bench.scenes.prepared import Scene
    from towercrane.cranes.tower.model import FlexibleModel

    Floats = NDArray[np.float64]


@cache
def compiled(scene: Scene, tolerance: float) -> Any:
    """The scene's integrator; its parameters are the coefficients of the phase's motions."""
    import heyoka

    assert scene.plain is not None
    used = _used(scene)
    names = [f"y{i}" for i in range(len(scene.plain.start))]
    states = np.array(heyoka.make_vars(*names), dtype=object)
    channels, first = [], 0
    for count in used:
        channels.append(np.array([heyoka.par[first + i] for i in range(count)], dtype=object))
        first += count
    slopes = expressions(scene.plain.model, states, channels)
    pairs = list(zip(states, slopes, strict=True))
    return heyoka.taylor_adaptive(pairs, state=scene.plain.start, pars=[0.0] * first, tol=tolerance)


def coefficients(scene: Scene, inputs: Floats) -> list[float]:
    """Parameters of a phase."""
    return [float(c) for row, count in zip(inputs, _used(scene), strict=False) for c in row[:count]]


def _used(scene: Scene) -> tuple[int, int]:
    """Number of coefficients of trolley and rope that are not zero throughout."""
    trolley, rope = (int(np.max(np.nonzero(scene.cut.inputs[:, i].any(axis=0))[0])) + 1 for i in range(2))
    return trolley, rope


def expressions(model: FlexibleModel, y: Any, channels: list[Any]) -> list[Any]:
    """Slopes of (q, theta, q', theta') as heyoka's expressions of these and of time."""
    import heyoka

    balance, n = Balance(model), model.coordinates
    trolley, hoist = ([_horner(c) for c in derivatives(channel)] for channel in channels)
    shapes = np.zeros((3, n), dtype=object)
    jib = model.crane.vertical
    assert isinstance(jib, Modes), "the benchmark's jib is uniform"
    shapes[:, model.counts["tower_x"] :] = _shapes(jib, trolley[0])
    gamma, theta = balance.slope @ y[:n], y[n]
    tilt, swing = ((heyoka.sin(angle), heyoka.cos(angle)) for angle in (gamma, theta))
    return [*y[n + 1 :], *_solution(*balance(y, tilt, swing, trolley, hoist, shapes))]


def _horner(coefficients: Any) -> Any:
    """Polynomial of time."""
    import heyoka

    value = 0.0
    for c in reversed(coefficients):
        value = value * heyoka.time + c
    return value


def _shapes(modes: Modes, x: Any) -> Any:
    """Mode shapes at x with two derivatives, from the cosines, sines and exponentials they are made of."""
    import heyoka

    found = []
    for root, (a, b, d, e) in zip(modes.roots.tolist(), modes.coefficients.tolist(), strict=True):
        k = root / modes.length
        cosine, sine = heyoka.cos(k * x), heyoka.sin(k * x)
        falling, rising = d * heyoka.exp(-k * x), e * heyoka.exp(k * x - root)
        found.append(
            [
                a * cosine + b * sine + falling + rising,
                k * (b * cosine - a * sine - falling + rising),
                k**2 * (-a * cosine - b * sine + falling + rising),
            ]
        )
    return np.array(found, dtype=object).T


def _solution(matrix: Any, right: Any) -> Any:
    """Solution of a symmetric positive definite system in expressions, by elimination without pivots."""
    a, b = matrix.copy(), right.copy()
    for k in range(len(b)):
        for i in range(k + 1, len(b)):
            factor = a[k, i] / a[k, k]
            a[i, i:] = a[i, i:] - factor * a[k, i:]
            b[i] = b[i] - factor * b[k]
    for k in reversed(range(len(b))):
        for j in range(k + 1, len(b)):
            b[k] = b[k] - a[k, j] * b[j]
        b[k] = b[k] / a[k, k]
    return b

"""Inertia and weight of points that move in any direction in the axes of a turning head.

A point is at s = s0 + sum psi_i q_i. In the sums of :class:`towercrane.cranes.tower.modes.tied.head.FieldSums`
D_i = int psi_i s^T, and vec(D)_a = -eps_akl D_kl makes of it int s x psi_i.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from towercrane.cranes.tower.equations.body import Body
from towercrane.kernels.algebra import Row, Vector, cross, dot, form

if TYPE_CHECKING:
    from towercrane.cranes.tower.equations.head import Head
    from towercrane.cranes.tower.equations.projection import Momenta
    from towercrane.cranes.tower.modes.tied.head import FieldSums

AXES = range(3)

Tensor = list[list[Any]]


class Moved(NamedTuple):
    """Points that move so: as one body, with the force on each coordinate and its coupling with the head; rate of
    the first moments."""

    body: Body
    forces: list[Any]
    rows: list[Momenta]
    rate: Vector


def move_fields(own: FieldSums, head: Head, felt: Vector, q: Row, rates: Row) -> Moved:
    """Points on a head that moves so; felt is the acceleration against gravity of the tower's top."""
    spin, spin_bias, places = head.spin, head.spin_bias, range(len(own.momentum))
    square = dot(spin, spin)
    met = [_sum(own.products[i], q, own.moved[i]) for i in places]
    first = tuple(own.first[k] + dot(own.momentum[:, k], q) for k in AXES)
    rate = _vector(dot(own.momentum[:, k], rates) for k in AXES)
    inertia = _inertia(own, q, met)
    passed = _sum(met, rates)
    spun = _vector(dot(own.spun[:, k], rates) for k in AXES)

    rows, forces = [], []
    for i in places:
        arm, turned = moment_of(met[i]), own.spun[i]
        row = _vector(a + b for a, b in zip(arm, turned, strict=True))
        twice = dot(spin, moment_of(_sum(own.products[i], rates)))
        inward = dot(spin, [dot(along, spin) for along in met[i]]) - square * trace(met[i])
        forces.append(-(dot(spin_bias, row) + inward + 2.0 * twice + dot(own.momentum[i], felt)))
        rows.append((_vector(own.momentum[i]), row))

    s = _vector(first)
    momentum = _vector(dot(row, spin) for row in inertia)
    momentum = _vector(a + b for a, b in zip(momentum, spun, strict=True))
    swept, twice_swept = cross(spin, cross(spin, s)), cross(spin, rate)
    force = _vector(
        -(al + w + 2.0 * two + own.mass * g)
        for al, w, two, g in zip(cross(spin_bias, s), swept, twice_swept, felt, strict=True)
    )
    turning, gyric, weight = trace(passed), cross(spin, momentum), cross(s, felt)
    moment = _vector(
        -(dot(inertia[k], spin_bias) + gyric[k] + weight[k] + 2.0 * (spin[k] * turning - dot(passed[k], spin)))
        for k in AXES
    )
    tensor = tuple(inertia[k][m] for k in AXES for m in range(k, 3))
    return Moved(Body(own.mass, s, tensor, force, moment), forces, rows, rate)


def kinetic_energy(own: FieldSums, head: Head, q: Row, rates: Row) -> Any:
    """Energy of points on a head that moves so [J], but for sections that turn about their own axes together."""
    spin, top = head.spin, head.top
    met = [_sum(own.products[i], q, own.moved[i]) for i in range(len(own.momentum))]
    first, rate, spun = (
        _vector(start[k] + dot(per[:, k], values) for k in AXES)
        for start, per, values in (
            (own.first, own.momentum, q), ((0.0, 0.0, 0.0), own.momentum, rates), ((0.0, 0.0, 0.0), own.spun, rates)
        )
    )  # fmt: skip
    inertia, swept = _inertia(own, q, met), cross(spin, first)
    turned = (a + b for a, b in zip(moment_of(_sum(met, rates)), spun, strict=True))
    bent = dot(rates, [dot([trace(other) for other in row], rates) for row in own.products])
    straight = own.mass * dot(top, top) + form(spin, inertia, spin) + bent
    return 0.5 * straight + dot(top, [a + b for a, b in zip(swept, rate, strict=True)]) + dot(spin, list(turned))


def moment_of(sums: Tensor) -> Vector:
    """int s x psi of int psi s^T."""
    (_, xy, xz), (yx, _, yz), (zx, zy, _) = sums
    return zy - yz, xz - zx, yx - xy


def trace(sums: Tensor) -> Any:
    """Sum of the diagonal."""
    return sums[0][0] + sums[1][1] + sums[2][2]


def _inertia(own: FieldSums, q: Row, met: list[Tensor]) -> Tensor:
    """Tensor of inertia: that at s0, and tr Z - Z with what the coordinates add to Z = int s s^T."""
    added = [[dot([d[k][m] for d in met], q) + dot(own.moved[:, m, k], q) for m in AXES] for k in AXES]
    total = trace(added)
    return [[own.inertia[k][m] - added[k][m] + (total if k == m else 0.0) for m in AXES] for k in AXES]


def _sum(tensors: Any, factors: Row, first: Any = None) -> Tensor:
    """A tensor and others times factors."""
    more = [[dot([own[k][m] for own in tensors], factors) for m in AXES] for k in AXES]
    return more if first is None else [[first[k][m] + more[k][m] for m in AXES] for k in AXES]


def _vector(values: Any) -> Vector:
    x, y, z = values
    return x, y, z

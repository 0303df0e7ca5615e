"""Finite elements of a beam: Hermite without shear strain, Timoshenko of fourth degree with it, by scikit-fem."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from modal.checks import whole_number

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from modal.beams.chain import ShearTheory
    from modal.structures.members import Member

    Floats = NDArray[np.float64]

MOST_ELEMENTS = 256

DEFLECTION_DEGREE = 4
"""Degree of the deflection in a Timoshenko element; the rotation has one less, so that a section without shear strain
is within reach (twice smooth quartics) and nothing locks, however stiff in shear."""

QUADRATURE_ORDER = 12
"""Exact for two quartics and the fourth power of a linear breadth."""


def round_off_floor(elements: int) -> float:
    """Relative error of the lowest frequency that rounding alone brings about, as an order of magnitude [1].

    The stiffness matrix of n Hermite elements has a condition number of some 25 n^4; rounding its entries
    moves the lowest eigenvalue accordingly.

    Parameters
    ----------
    elements : int
        Number of elements.

    Returns
    -------
    float
        ``0.1 eps n^4``; met within a factor of two at worst, while the error can be far less by luck.
    """
    return 0.1 * float(np.finfo(float).eps) * float(elements) ** 4


def require_elements(name: str, elements: int, allow_round_off: bool = False) -> None:
    """Refuse a number of elements below one, or one so large that rounding outweighs the discretisation.

    Raises
    ------
    ValueError
        With the argument's name, the limit and the floor.
    """
    whole_number(name, elements, 1)
    if elements > MOST_ELEMENTS and not allow_round_off:
        raise ValueError(
            f"{name}: wanted at most {MOST_ELEMENTS}, got {elements!r}: rounding alone would put a relative "
            f"error of about {round_off_floor(elements):.0e} on the lowest frequency, more with every element"
        )


@dataclass(frozen=True, eq=False)
class Elements:
    """Elements, all with shear strain or all without.

    Parameters
    ----------
    members : sequence of Member, length n
        Each is one element.
    shear : bool
        Whether the members strain in shear.
    shear_theory : {"haringx", "engesser"}
        See `modal.beams.chain.Chain`.

    Notes
    -----
    scikit-fem assembles every element on a unit mesh of its own: its Hermite basis is made of powers of the
    coordinate, which far from the origin cost a digit for every doubling of the distance in elements.
    Unknowns of an element are (v, theta) at the near and at the far end, then those inside it.
    """

    members: Sequence[Member]
    shear: bool
    shear_theory: ShearTheory

    def __post_init__(self) -> None:
        if self._moved and not self.shear:
            raise ValueError("members: wanted shear strain where mass moves beyond the axis, got none")

    @property
    def inner(self) -> int:
        """Unknowns inside an element."""
        if not self.shear:
            return 0
        return 2 * DEFLECTION_DEGREE - 3 + (DEFLECTION_DEGREE + 1) * self._moved

    @cached_property
    def _moved(self) -> bool:
        """Whether the mass moves beyond the axis; the force on it is then a third field, which may jump."""
        return any(member.segment.mass_flexibility > 0.0 for member in self.members)

    @cached_property
    def _length(self) -> Floats:
        """Lengths, shape (n, 1) [m]."""
        return self._column(lambda member: member.segment.length)

    @cached_property
    def _basis(self) -> Any:
        from skfem import Basis, ElementDG, ElementLineHermite, ElementLinePp, MeshLine
        from skfem.element import ElementComposite

        n = len(self.members)
        mesh = MeshLine(np.tile([0.0, 1.0], n)[np.newaxis], np.arange(2 * n).reshape(n, 2).T)
        element = ElementLineHermite()
        if self.shear:
            fields = [ElementLinePp(DEFLECTION_DEGREE), ElementLinePp(DEFLECTION_DEGREE - 1)]
            if self._moved:
                fields.append(ElementDG(ElementLinePp(DEFLECTION_DEGREE)))
            element = ElementComposite(*fields)
        return Basis(mesh, element, intorder=QUADRATURE_ORDER)

    @cached_property
    def _depth(self) -> Floats:
        """Distances of the quadrature points from the near ends, shape (n, q) [m]."""
        local = np.asarray(self._basis.global_coordinates()[0])
        return local * self._length

    def _column(self, values: Callable[[Member], float]) -> Floats:
        return np.array([values(member) for member in self.members])[:, np.newaxis]

    def _property(self, name: str) -> Floats:
        """A property of the section at the quadrature points, shape (n, q)."""
        return np.array([m.segment.section(name, z) for m, z in zip(self.members, self._depth, strict=True)])

    @cached_property
    def _incline(self) -> Floats:
        """What couples bending and shear, of inclined chords and of parallel diagonals, shape (n, q) [1/m]."""
        change = self._column(lambda m: (m.segment.end_ratio - 1.0) * m.segment.inclined_chords)
        return change / (self._length + change * self._depth) + self._column(lambda m: m.segment.coupling)

    @cached_property
    def _compression(self) -> Floats:
        """Axial force at the quadrature points, shape (n, q) [N]."""
        ratio = self._column(lambda member: member.segment.end_ratio)
        power = 1.0 + self._column(lambda member: member.segment.mass_power)
        # The breadth^mass_power from there to the far end; expm1 keeps the digits of a slight taper or a thin end.
        left = self._length - self._depth
        slight = np.where(ratio == 1.0, 1.0, 1.0 - ratio)
        growth = np.expm1(power * np.log1p(slight * left / (self._length * ratio)))
        tapered = self._length * ratio**power / (slight * power) * growth
        beyond = self._column(lambda member: member.segment.mass_per_length) * np.where(ratio == 1.0, left, tapered)
        force = self._column(lambda member: member.compression) + self._column(lambda m: m.gravity) * beyond
        return np.asarray(force)

    def _matrices(self, form: Callable[..., Any]) -> Floats:
        """Element matrices of a form on unit elements, with rotations counted per length, shape (n, k, k)."""
        from skfem import BilinearForm

        found = np.asarray(BilinearForm(form).coo_data(self._basis).tolocal())
        if not self.shear:
            # The slope of a unit element is its rotation times its length.
            scale = np.ones((len(self.members), 4))
            scale[:, 1::2] = self._length
            found = found * scale[:, :, np.newaxis] * scale[:, np.newaxis, :]
        return found

    def stiffness(self) -> Floats:
        """Stiffness in bending and shear, shape (n, k, k)."""
        from skfem.helpers import dd

        h = self._length
        bending = self._property("bending_stiffness")
        if not self.shear:
            return self._matrices(lambda u, v, _: bending / h**3 * dd(u)[0, 0] * dd(v)[0, 0])
        stiffness = self._property("shear_stiffness")
        incline, moved = self._incline, self._property("mass_flexibility")

        def energy(u: Any, theta: Any, v: Any, tau: Any, _: Any) -> Any:
            strain, other = u.grad[0] / h - theta, v.grad[0] / h - tau
            curvature, second = theta.grad[0] / h - incline * strain, tau.grad[0] / h - incline * other
            return bending * h * curvature * second + stiffness * h * strain * other

        if not self._moved:
            return self._matrices(energy)
        # A force that moves no mass is held at zero.
        held = np.where(moved > 0.0, moved, 1.0)
        return self._matrices(lambda u, t, q, v, s, p, w: energy(u, t, v, s, w) + h * held * q * p)

    def geometric(self) -> Floats:
        """What unit load takes from the stiffness, shape (n, k, k): Haringx or Engesser."""
        h, P = self._length, self._compression
        if not self.shear:
            return self._matrices(lambda u, v, _: P / h * u.grad[0] * v.grad[0])

        def taken(u: Any, theta: Any, v: Any, tau: Any, _: Any) -> Any:
            if self.shear_theory == "engesser":
                return P / h * u.grad[0] * v.grad[0] + 0.0 * theta * tau
            return P * (theta * v.grad[0] + u.grad[0] * tau - h * theta * tau)

        if not self._moved:
            return self._matrices(taken)
        return self._matrices(lambda u, t, q, v, s, p, w: taken(u, t, v, s, w) + 0.0 * q * p)

    def mass(self) -> Floats:
        """Mass with rotary inertia, shape (n, k, k)."""
        h = self._length
        mass, rotary = self._property("mass_per_length"), self._property("rotary_inertia")
        if not self.shear:
            return self._matrices(lambda u, v, _: mass * h * u * v + rotary / h * u.grad[0] * v.grad[0])
        if not self._moved:
            return self._matrices(lambda u, theta, v, tau, _: h * (mass * u * v + rotary * theta * tau))
        moved = self._property("mass_flexibility")
        return self._matrices(
            lambda u, t, q, v, s, p, _: h * (mass * (u + moved * q) * (v + moved * p) + rotary * t * s)
        )

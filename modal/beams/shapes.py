"""Mode shapes of a clamped uniform beam with a rigid body at its end, normalised with that body."""

from __future__ import annotations

from dataclasses import dataclass
from math import isinf, pi, sqrt
from typing import TYPE_CHECKING

import numpy as np

from modal.beams.basis import clamped_pair, evaluate, shares
from modal.beams.beam import Beam, EndBody
from modal.beams.integrals import product_integrals, shape_integrals
from modal.checks import whole_number

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


@dataclass(frozen=True, eq=False)
class Modes:
    """Natural modes phi_i of a beam clamped at position 0 with a rigid body at position L.

    Made by `cantilever_modes`. The shapes are orthonormal in the mass of beam and body together,
    ``int m phi_i phi_j dx + M w_i w_j + J_G phi_i'(L) phi_j'(L) = delta_ij`` with the deflection
    ``w = phi(L) + H phi'(L)`` of the body's centre of mass, so phi is in kg^-1/2.

    Parameters
    ----------
    beam : Beam
        The beam.
    end_body : EndBody
        The body at its end.
    roots : ndarray, shape (n,)
        Characteristic roots beta L, ascending [rad].
    coefficients : ndarray, shape (n, 4)
        Shapes in the basis of `modal.beams.basis` [kg^-1/2].
    """

    beam: Beam
    end_body: EndBody
    roots: NDArray[np.float64]
    coefficients: NDArray[np.float64]

    @property
    def count(self) -> int:
        """Number of modes, n."""
        return int(self.roots.size)

    @property
    def length(self) -> float:
        """Length of the beam [m]."""
        return self.beam.length

    @property
    def angular_frequencies(self) -> NDArray[np.float64]:
        """Natural angular frequencies [rad/s], shape (n,)."""
        beam = self.beam
        return self.roots**2 * sqrt(beam.bending_stiffness / beam.mass_per_length) / beam.length**2

    @property
    def frequencies_hz(self) -> NDArray[np.float64]:
        """Natural frequencies [Hz], shape (n,)."""
        return self.angular_frequencies / (2.0 * pi)

    def __call__(self, position: ArrayLike, derivative: int = 0) -> NDArray[np.float64]:
        """Shapes or their derivatives at positions along the beam.

        Parameters
        ----------
        position : array_like
            Distance from the clamped end, 0 to L [m].
        derivative : int
            Order of the derivative with respect to position, zero or more.

        Returns
        -------
        ndarray, shape (n, *shape of position)
            Values [kg^-1/2 m^-derivative].

        Raises
        ------
        ValueError
            If a position is off the beam or not a number, or the order is negative or no integer.
        """
        where = np.asarray(position, dtype=float)
        length = self.beam.length
        # A position that was added up from parts may pass the end by rounding.
        slack = 1e-12 * length
        on_beam = (where >= -slack) & (where <= length + slack)
        if not on_beam.all():
            raise ValueError(f"position: wanted 0 to {length!r} m, got {where[~on_beam].flat[0]!r}")
        if derivative != int(derivative) or derivative < 0:
            raise ValueError(f"derivative: wanted an integer, zero or more, got {derivative!r}")
        values = evaluate(self.roots, self.coefficients, where.ravel() / length, int(derivative))
        return values.reshape(self.count, *where.shape) / length**derivative

    def rotation(self, position: ArrayLike) -> NDArray[np.float64]:
        """Rotation of the section at positions along the beam: the slope, as there is no shear strain."""
        return self(position, 1)

    def mass_matrix(self) -> NDArray[np.float64]:
        """Mass of the beam alone, ``int m phi_i phi_j dx`` [1], shape (n, n)."""
        return self.beam.mass * product_integrals(self.roots, self.coefficients, 0)

    def mass_moments(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """First moments ``int m phi dx`` [kg^1/2] and ``int m x phi dx`` [kg^1/2 m], of shape (n,) each."""
        zeroth = self.beam.mass * shape_integrals(self.roots, self.coefficients)
        first = self.beam.mass * self.beam.length * shape_integrals(self.roots, self.coefficients, "from_root")
        return zeroth, first

    def rotary_moments(self) -> NDArray[np.float64]:
        """Moment of momentum of the sections' own rotary inertia [kg^1/2 m], shape (n,): none here."""
        return np.zeros(self.count)

    def rotary_matrix(self) -> NDArray[np.float64]:
        """What the sections' own rotary inertia adds to the mass matrix [1], shape (n, n): nothing here."""
        return np.zeros((self.count, self.count))

    def deflection_integrals(self) -> NDArray[np.float64]:
        """Integrals ``int phi dx`` [m kg^-1/2], shape (n,)."""
        return self.beam.length * shape_integrals(self.roots, self.coefficients)

    def slope_matrix(self) -> NDArray[np.float64]:
        """Products of slopes, ``int phi_i' phi_j' dx`` [1/(kg m)], shape (n, n).

        Times an axial force it is the geometric stiffness of a weight on the end.
        """
        return product_integrals(self.roots, self.coefficients, 1) / self.beam.length

    def weight_matrix(self) -> NDArray[np.float64]:
        """What an upright beam's own weight takes from its stiffness under unit gravity [1/m], shape (n, n).

        That is ``int m (L - x) phi_i' phi_j' dx``.
        """
        return self.beam.mass_per_length * product_integrals(self.roots, self.coefficients, 1, "from_end")

    def stiffness_matrix(self) -> NDArray[np.float64]:
        """Stiffness ``int E I phi_i'' phi_j'' dx`` [1/s^2], shape (n, n).

        It is diag(omega^2) but for rounding, whatever the end body.
        """
        stiffness = self.beam.bending_stiffness / self.beam.length**3
        return stiffness * product_integrals(self.roots, self.coefficients, 2)


def cantilever_modes(beam: Beam, count: int, end_body: EndBody = EndBody()) -> Modes:  # noqa: B008  frozen
    """Natural modes of a uniform beam clamped at position 0, with a rigid body at position L.

    Parameters
    ----------
    beam : Beam
        The beam.
    count : int
        Number of modes; with 0 every result is an empty array of its shape.
    end_body : EndBody
        The body at the end; infinite mass or inertia fixes the motion of its centre of mass or its rotation.

    Returns
    -------
    Modes
        Frequencies and shapes. Signs make the end deflect to the positive side, or where it cannot, turn to
        the positive side, or where it cannot either, curve to it.

    Raises
    ------
    ValueError
        If the count is negative, or a ratio of body to beam is out of range.

    Notes
    -----
    End conditions, in z = x / L and x^4 = m omega^2 L^4 / (E I): ``phi''' = -a x^4 (phi + h phi')`` and
    ``phi'' + h phi''' = j x^4 phi'`` at z = 1 (Gao et al. 2023, Eq. 26, extended by the offset h); the
    normalisation is their Eq. A3 with the body included, without which the modes are not orthogonal.
    """
    from modal.beams.roots import characteristic_roots

    if whole_number("count", count) == 0:
        return Modes(beam, end_body, _read_only(np.empty(0)), _read_only(np.empty((0, 4))))
    a = end_body.mass / beam.mass
    j = end_body.rotary_inertia / (beam.mass * beam.length**2)
    h = end_body.offset / beam.length
    roots = characteristic_roots(a, j, count, offset_ratio=h)
    functions = _end_functions(roots)
    coefficients = _null_vectors(roots, functions, a, j, h)
    slope, body_deflection, sign = _end_motion(roots, _end_derivatives(roots, functions, coefficients), a, j, h)
    inertia = np.diag(product_integrals(roots, coefficients, 0)).copy()
    # A body that cannot move has no kinetic energy, however large its mass.
    inertia += 0.0 if isinf(a) else a * body_deflection**2
    inertia += 0.0 if isinf(j) else j * slope**2
    coefficients *= (sign / np.sqrt(beam.mass * inertia))[:, None]
    return Modes(beam, end_body, _read_only(roots), _read_only(coefficients))


def _end_functions(roots: NDArray[np.float64]) -> NDArray[np.float64]:
    """Derivatives 0 to 3 at z = 1 of the four functions of each root's basis, shape (4, n, 4)."""
    many, each = np.repeat(roots, 4), np.tile(np.eye(4), (roots.size, 1))
    values = [evaluate(many, each, np.ones(1), order) for order in range(4)]
    return np.reshape(values, (4, roots.size, 4))


def _end_derivatives(
    roots: NDArray[np.float64], functions: NDArray[np.float64], coefficients: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Derivatives 0 to 3 at z = 1 of shapes, of order k divided by x^k; shape (4, n)."""
    return np.asarray((functions * coefficients).sum(axis=2) / roots ** np.arange(4)[:, None])


def _null_vectors(
    roots: NDArray[np.float64], functions: NDArray[np.float64], a: float, j: float, h: float
) -> NDArray[np.float64]:
    """Coefficients that satisfy both end conditions, of arbitrary size and sign, shape (n, 4)."""
    a_body, a_beam = shares(a)
    j_body, j_beam = shares(j)
    one, zero, x = np.ones_like(roots), np.zeros_like(roots), roots
    rows = np.empty((roots.size, 2, 2))
    sizes = np.empty((roots.size, 2, 2))
    for column, pair in enumerate(((one, zero), (zero, one))):
        d_0, d_1, d_2, d_3 = _end_derivatives(roots, functions, clamped_pair(roots, *pair))
        force = np.stack([a_beam * d_3, a_body * x * d_0, a_body * x * h * x * d_1])
        moment = np.stack([j_beam * d_2, j_beam * h * x * d_3, -j_body * x**3 * d_1])
        rows[:, 0, column], sizes[:, 0, column] = force.sum(axis=0), np.abs(force).sum(axis=0)
        rows[:, 1, column], sizes[:, 1, column] = moment.sum(axis=0), np.abs(moment).sum(axis=0)
    # Scaled by what their terms amount to, a row that is all rounding does not outweigh a sound one.
    rows /= sizes.max(axis=2, keepdims=True)
    null = np.linalg.svd(rows)[2][:, 1, :]
    return clamped_pair(roots, null[:, 0], null[:, 1])


def _end_motion(
    roots: NDArray[np.float64], end: NDArray[np.float64], a: float, j: float, h: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Slope of the end with respect to z, deflection of the body's centre of mass, and sign; (n,) each.

    A heavy body hardly moves, and what is left of its motion in the shape is mostly rounding; it follows to
    full accuracy from the force and moment the beam exerts on it.
    """
    a_body, a_beam = shares(a)
    j_body, j_beam = shares(j)
    x = roots
    d_0, d_1, d_2, d_3 = end
    with np.errstate(divide="ignore", invalid="ignore"):
        turned = np.where(j_body * x**3 > j_beam, j_beam * (d_2 + h * x * d_3) / (j_body * x**3), d_1)
        body_deflection = np.where(a_body * x > a_beam, -a_beam * d_3 / (a_body * x), d_0 + h * x * d_1)
    slope = x * turned
    deflection = body_deflection - h * slope
    sign = np.sign(np.where(deflection != 0.0, deflection, np.where(slope != 0.0, slope, d_2)))
    return slope, body_deflection, sign


def _read_only(array: NDArray[np.float64]) -> NDArray[np.float64]:
    array.setflags(write=False)
    return array

"""Hermite finite elements for the clamped beam with an end body: an independent check of the exact roots."""

from __future__ import annotations

from math import isinf
from typing import TYPE_CHECKING, Any

import numpy as np

from modal.beam import Beam, EndBody

if TYPE_CHECKING:
    from numpy.typing import NDArray

MOST_ELEMENTS = 256


def finite_element_frequencies(
    beam: Beam,
    count: int,
    end_body: EndBody = EndBody(),  # noqa: B008  frozen
    *,
    elements: int = 32,
    allow_round_off: bool = False,
) -> NDArray[np.float64]:
    """Natural angular frequencies of a clamped beam with an end body, by scikit-fem's Hermite elements.

    Parameters
    ----------
    beam : Beam
        The beam, clamped at position 0.
    count : int
        Number of frequencies, less than the number of free displacements and rotations (two per element).
    end_body : EndBody
        The body at position L; an infinite mass or inertia holds its centre of mass or its rotation.
    elements : int
        Number of elements of equal length.
    allow_round_off : bool
        Accept more than 256 elements, although rounding then outweighs the discretisation.

    Returns
    -------
    ndarray, shape (count,)
        Angular frequencies in ascending order [rad/s].

    Raises
    ------
    ValueError
        If there are too many elements for the round-off floor, or too few for the count.

    Notes
    -----
    The frequencies lie above the exact ones, by a relative error of fourth order in the element length. A
    second error grows with the fourth power of the number of elements, see `round_off_floor`: with a heavy
    body the lowest frequency is best at some 30 elements.
    """
    if count < 0:
        raise ValueError(f"count: wanted zero or more, got {count!r}")
    require_elements("elements", elements, allow_round_off)
    stiffness, mass = hermite_matrices(np.linspace(0.0, 1.0, elements + 1))
    # At the end node the motion of the body's centre of mass replaces that of the end, so that the body's
    # matrix is diagonal and what an infinite entry holds is a single unknown.
    h = end_body.offset / beam.length
    motion = np.eye(2 * elements + 2)
    motion[-2, -1] = -h
    body = (end_body.mass / beam.mass, end_body.rotary_inertia / (beam.mass * beam.length**2))
    stiffness, mass = motion.T @ stiffness @ motion, motion.T @ mass @ motion
    free = np.arange(2, 2 * elements + 2)
    for unknown, inertia in zip((-2, -1), body, strict=True):
        if isinf(inertia):
            free = free[free != 2 * elements + 2 + unknown]
        else:
            mass[unknown, unknown] += inertia
    squared = lowest_eigenvalues(stiffness[np.ix_(free, free)], mass[np.ix_(free, free)], count)
    unit = beam.bending_stiffness / (beam.mass * beam.length**3)
    return np.sqrt(squared * unit)


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
    if elements < 1:
        raise ValueError(f"{name}: wanted one or more, got {elements!r}")
    if elements > MOST_ELEMENTS and not allow_round_off:
        raise ValueError(
            f"{name}: wanted at most {MOST_ELEMENTS}, got {elements!r}: rounding alone would put a relative "
            f"error of about {round_off_floor(elements):.0e} on the lowest frequency, more with every element"
        )


def hermite_matrices(nodes: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Stiffness and mass matrix of an unsupported beam of unit stiffness and unit mass per length.

    Parameters
    ----------
    nodes : ndarray, shape (n + 1,)
        Ascending positions of the nodes.

    Returns
    -------
    tuple of ndarray, shape (2 n + 2, 2 n + 2) each
        Unknowns are deflection and slope of each node in turn.
    """
    from skfem import Basis, BilinearForm, ElementLineHermite, MeshLine
    from skfem.helpers import dd, ddot

    def bending(u: Any, v: Any, _: Any) -> Any:
        return ddot(dd(u), dd(v))

    def inertia(u: Any, v: Any, _: Any) -> Any:
        return u * v

    # Order six integrates the product of two cubics exactly.
    basis = Basis(MeshLine(nodes), ElementLineHermite(), intorder=6)
    order = basis.nodal_dofs.T.ravel()
    stiffness, mass = (BilinearForm(form).assemble(basis).toarray() for form in (bending, inertia))
    return stiffness[np.ix_(order, order)], mass[np.ix_(order, order)]


def lowest_eigenvalues(stiffness: NDArray[np.float64], mass: NDArray[np.float64], count: int) -> NDArray[np.float64]:
    """Lowest eigenvalues of a stiffness and a mass matrix, by shift and invert about zero.

    Parameters
    ----------
    stiffness, mass : ndarray, shape (n, n)
        Symmetric positive definite matrices.
    count : int
        Number of eigenvalues, less than n.

    Returns
    -------
    ndarray, shape (count,)
        Eigenvalues in ascending order, in units of stiffness over mass.

    Raises
    ------
    ValueError
        If the count is not less than n.
    """
    from scipy.sparse import csc_array
    from scipy.sparse.linalg import eigsh

    size = len(stiffness)
    if count == 0:
        return np.empty(0)
    if count >= size:
        raise ValueError(f"count: wanted less than the {size} free unknowns of the mesh, got {count!r}")
    # The inverse makes the lowest eigenvalues the largest and keeps them accurate, where a factorisation of
    # the mass matrix would drown them in the rounding of the highest. A fixed start makes results repeatable.
    values = eigsh(
        csc_array(stiffness),
        count,
        csc_array(mass),
        sigma=0.0,
        v0=np.ones(size),
        return_eigenvectors=False,
    )
    return np.sort(np.asarray(values, dtype=float))

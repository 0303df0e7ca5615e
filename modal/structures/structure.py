"""Plane structure of segments and rigid bodies: exact natural frequencies and critical loads."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from modal.checks import check_not_negative, whole_number
from modal.structures.members import FewModes, Members

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from modal.beams.chain import Chain

    Floats = NDArray[np.float64]


@dataclass(eq=False)
class Structure(Members):
    """Segments and bodies on common unknowns, and how they vibrate, buckle and yield.

    Made by `chain_structure` or `modal.structures.crane_frame.crane_structure`; its parameters are those of
    `modal.structures.members.Members`.
    """

    def count_below(self, angular_frequency: float) -> int:
        """Number of natural frequencies below one [rad/s], each with its multiplicity."""
        from modal.structures.assembly import assembly
        from modal.structures.refinement import refined

        check_not_negative("angular_frequency", angular_frequency)
        if angular_frequency >= self.mass_frequency:
            raise FewModes(
                f"angular_frequency: wanted less than {self.mass_frequency:.6g} rad/s, where masses vibrate on their "
                f"own flexibility, got {angular_frequency:.6g}"
            )
        return assembly(refined(self, angular_frequency), angular_frequency).count(angular_frequency)

    def angular_frequencies(self, count: int) -> Floats:
        """Lowest natural angular frequencies [rad/s], ascending, each as often as it is one; shape (count,).

        Against 60-digit arithmetic the relative error is 1e-15 as a rule, however the structure is cut, and however
        soft its springs are. A frequency at a relative distance d from a fixed-end one of some part of a member loses
        more, about 1e-16 / d: the worst of 60 modes of a cantilever has 5e-11. So does the slow mode of a structure
        on a body whose ``mass offset^2`` is 1/d times all other inertia.

        Raises
        ------
        ValueError
            If the count is no whole number, zero or more, or more than there are below the frequency of masses on
            their own flexibility, or the structure can move without strain.
        Unstable
            If the structure buckles under its weights and loads.
        """
        from modal.structures.search import lowest_frequencies

        return lowest_frequencies(self, whole_number("count", count))

    def buckling_factor(self) -> float:
        """Factor on all weights and axial loads at which the structure buckles [1]; ``inf``: it never does.

        Raises
        ------
        ValueError
            If the structure can move without strain.
        """
        from modal.structures.search import buckling_factor

        return buckling_factor(self)

    def stiffness(self) -> Floats:
        """Static stiffness on the unknowns under all weights and loads [N/m, N, N m], shape (n, n)."""
        from modal.structures.assembly import assembly
        from modal.structures.refinement import refined

        return assembly(refined(self, 0.0), 0.0, whole=True).stiffness(len(self.unknowns))

    def displacements(self, forces: Floats) -> Floats:
        """Static displacements of the unknowns [m, rad] under forces and moments on them [N, N m].

        Parameters
        ----------
        forces : ndarray, shape (n,) or (n, k)
            One load case, or k in columns.

        Raises
        ------
        ValueError
            If the structure can move without strain.
        Unstable
            If the structure buckles under its weights and loads.
        """
        from modal.structures.assembly import assembly
        from modal.structures.refinement import refined
        from modal.structures.search import require_stable

        require_stable(self)
        return assembly(refined(self, 0.0), 0.0, whole=True).displacements(forces)


def chain_structure(chain: Chain) -> Structure:
    """A chain as a structure.

    The unknowns are deflection and rotation of every node that can move, from the foot up, then the load's motion.
    """
    structure = Structure((), shear_theory=chain.shear_theory)
    end = structure.add_chain(chain, structure.add_foundation(chain.foundation))
    if chain.pendulum is not None:
        load = structure.add_unknown("m")
        structure.add_pendulum(chain.pendulum.stiffness, chain.pendulum.mass, end[0], load)
    return structure


def chain_frequencies(chain: Chain, count: int) -> Floats:
    """Lowest natural angular frequencies of a chain [rad/s], exact but for rounding; shape (count,).

    Raises
    ------
    ValueError
        If the count is negative.
    Unstable
        If the chain buckles under its weights and loads.
    """
    return chain_structure(chain).angular_frequencies(count)

"""Laced column as the pin-jointed space truss that it is drawn as: deflections and frequencies of bending."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from modal.beams.beam import EndBody
from modal.checks import check_fields, whole_number
from modal.elements.sparse import factorised, lowest_modes

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from modal.lattices.lattice import LacedColumn

    Floats = NDArray[np.float64]

CORNERS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
"""Legs of a column in half leg spacings, each a quarter turn from the last."""


SAME_SPACING = 0.01
"""Relative; leg spacings of one column on another that differ by less count as rounded."""


class Mechanism(ValueError):
    """The truss can move without strain in any member."""


@dataclass(frozen=True, eq=False)
class ColumnTruss:
    """Pin-jointed truss of a laced column that stands on four pinned feet.

    Each face, seen from outside, is laced alike, so that the truss is the same after a quarter turn: it bends alike
    in every vertical plane, and bending moves neither its torsion nor the shape of its cross-section. Members are
    straight bars between the legs' nodes, one node of each leg at every panel point.

    Parameters
    ----------
    column : LacedColumn
        Its legs' own second moment of area does not enter.
    height : float
        Height [m], a whole number of panels.
    mass_per_length : float, optional
        Mass per height [kg/m], shared alike by the nodes of a panel; without one, the members' own by
        `LacedColumn.density`, half of each at either end.
    top_ratio : float
        Leg spacing at the top over that at the foot [1]; the panels keep their height.
    above : ColumnTruss, optional
        A column that stands on this one's top, leg on leg; it brings its own mass.

    Raises
    ------
    ValueError
        If the height is not a whole number of panels, there is neither a mass per length nor a density, or the column
        above has another leg spacing.
    Mechanism
        If the truss can move without strain, as one of zigzag lacing without horizontals can.

    Notes
    -----
    Opposite faces laced as each other's shadow, as EN 1993-1-1, 6.4.2.2 has it, make the diagonals of the square the
    principal planes of bending and split each bending frequency in two that are up to 1 % apart.
    """

    column: LacedColumn
    height: float
    mass_per_length: float | None = None
    top_ratio: float = 1.0
    above: ColumnTruss | None = None

    def __post_init__(self) -> None:
        check_fields(self, positive=("height", "top_ratio"))
        panels = self.height / self.column.panel_height
        if not (0.5 < panels < float("inf") and abs(panels - round(panels)) < 1e-6 * panels):
            raise ValueError(
                f"ColumnTruss.height: wanted a whole number of panels of {self.column.panel_height!r} m, "
                f"got {self.height!r} m, which is {panels:.6g}"
            )
        if self.mass_per_length is None and self.column.density == 0.0:
            raise ValueError("ColumnTruss.mass_per_length: wanted a number, as the column has no density, got None")
        if self.mass_per_length is not None:
            check_fields(self, positive=("mass_per_length",))
        if self.above is not None:
            own, other = self.column.leg_spacing * self.top_ratio, self.above.column.leg_spacing
            if abs(own - other) > SAME_SPACING * own:
                raise ValueError(f"ColumnTruss.above: wanted legs {own:.6g} m apart as below, got {other:.6g} m")
        if factorised(self.stiffness[12:, 12:]) is None:
            lacks = " without horizontals" if self.column.horizontal_area == 0.0 else ""
            raise Mechanism(
                f"column: wanted a truss that pins hold together, got {self.column.lacing} lacing{lacks}, "
                "whose nodes can move without strain"
            )

    @property
    def panels(self) -> int:
        """Number of panels."""
        return self._own_panels + (self.above.panels if self.above else 0)

    @property
    def _own_panels(self) -> int:
        return round(self.height / self.column.panel_height)

    @property
    def top_spacing(self) -> float:
        """Leg spacing at the top of all [m]."""
        return self.above.top_spacing if self.above else self.column.leg_spacing * self.top_ratio

    @cached_property
    def nodes(self) -> Floats:
        """Positions [m], shape (4 (panels + 1), 3): four a level, from the feet up."""
        part = np.linspace(0.0, 1.0, self._own_panels + 1)[:, np.newaxis, np.newaxis]
        plan = 0.5 * self.column.leg_spacing * (1.0 + (self.top_ratio - 1.0) * part) * CORNERS
        level = np.broadcast_to(part * self.height, (self._own_panels + 1, 4, 1))
        own = np.concatenate([plan, level], axis=2).reshape(-1, 3)
        if self.above is None:
            return own
        return np.concatenate([own, self.above.nodes[4:] + np.array([0.0, 0.0, self.height])])

    @cached_property
    def members(self) -> tuple[NDArray[np.int64], Floats, Floats]:
        """Nodes at both ends, shape (m, 2), areas [m^2] and moduli [Pa] of all members, shape (m,)."""
        pairs, areas = self.own_members
        moduli = np.full(len(areas), self.column.youngs_modulus)
        if self.above is None:
            return pairs, areas, moduli
        further, more, other = self.above.members
        return (
            np.concatenate([pairs, further + 4 * self._own_panels]),
            np.concatenate([areas, more]),
            np.concatenate([moduli, other]),
        )

    @cached_property
    def own_members(self) -> tuple[NDArray[np.int64], Floats]:
        """Nodes at both ends and areas [m^2] of the members without those of a column above."""
        column = self.column
        leg, level = np.arange(4), 4 * np.arange(self._own_panels)[:, np.newaxis]
        following = (leg + 1) % 4
        rises = [(leg, following)]
        if column.lacing == "X":
            rises.append((following, leg))
        ends = [(level + leg, level + 4 + leg)]
        for low, high in rises:
            # A zigzag comes back in every other panel.
            back = (level % 8 == 4) & (column.lacing == "zigzag")
            ends.append((level + np.where(back, high, low), level + 4 + np.where(back, low, high)))
        areas = [column.leg_area] + [column.diagonal_area] * len(rises)
        if column.horizontal_area > 0.0:
            ends.append((level + 4 + leg, level + 4 + following))
            areas.append(column.horizontal_area)
        if column.plan_bracing_area > 0.0:
            ends.append((level + 4 + leg[:2], level + 4 + leg[2:]))
            areas.append(column.plan_bracing_area)
        pairs = [np.stack(np.broadcast_arrays(*pair), axis=-1).reshape(-1, 2) for pair in ends]
        return np.concatenate(pairs), np.repeat(areas, [len(pair) for pair in pairs])

    @cached_property
    def stiffness(self) -> Any:
        """Stiffness of all nodes, feet included [N/m], sparse, shape (3 n, 3 n)."""
        from scipy.sparse import csr_array, dia_array

        (pairs, areas, moduli), nodes = self.members, self.nodes
        along = nodes[pairs[:, 1]] - nodes[pairs[:, 0]]
        lengths = np.linalg.norm(along, axis=1)
        along /= lengths[:, np.newaxis]
        unknowns = (3 * pairs[:, :, np.newaxis] + np.arange(3)).reshape(-1, 6)
        starts = np.arange(0, 6 * len(pairs) + 1, 6)
        # What each member lengthens by.
        stretch = csr_array((np.hstack([-along, along]).ravel(), unknowns.ravel(), starts), (len(pairs), nodes.size))
        springs = moduli * areas / lengths
        return stretch.T @ dia_array((springs[np.newaxis], [0]), shape=(len(pairs),) * 2) @ stretch

    @cached_property
    def node_masses(self) -> Floats:
        """Masses lumped at the nodes, feet included [kg]."""
        if self.mass_per_length is not None:
            shares = np.ones(self._own_panels + 1)
            shares[[0, -1]] = 0.5
            own = np.repeat(shares * self.mass_per_length * self.column.panel_height / 4.0, 4)
        else:
            pairs, areas = self.own_members
            lengths = np.linalg.norm(self.nodes[pairs[:, 1]] - self.nodes[pairs[:, 0]], axis=1)
            halves = 0.5 * self.column.density * areas * lengths
            count = 4 * self._own_panels + 4
            own = np.asarray(np.bincount(pairs.ravel(), np.repeat(halves, 2), count), dtype=float)
        if self.above is None:
            return own
        shared = own[-4:] + self.above.node_masses[:4]
        return np.concatenate([own[:-4], shared, self.above.node_masses[4:]])

    def tip(self, force: float = 0.0, moment: float = 0.0) -> tuple[float, float]:
        """Sideways deflection [m] and rotation [rad] of the top under a force [N] and a moment [N m] on it.

        The top four nodes move as a rigid plane; the moment counts positive where it deflects along with the force.
        """
        stiffness, _ = self._bending(EndBody())
        load = np.zeros(stiffness.shape[0], dtype=complex)
        load[-2:] = force, moment
        found = self._solver(stiffness)(load).real
        return float(found[-2]), float(found[-1])

    def bending_frequencies(self, count: int, body: EndBody | None = None) -> Floats:
        """Lowest natural angular frequencies of bending in one plane [rad/s], ascending, shape (count,).

        Parameters
        ----------
        count : int
            Number of frequencies.
        body : EndBody, optional
            Rigid slewing part, to which the top four nodes are tied as a rigid plane; without one they are free.

        Raises
        ------
        ValueError
            If the count is negative or more than there are, or the body is infinite.

        Notes
        -----
        A mode counts as bending where more than half of its kinetic energy is in levels that move as rigid planes;
        X lacing without horizontals has others, in which the levels change their shape.
        """
        if body is not None and not (body.mass < float("inf") and body.rotary_inertia < float("inf")):
            raise ValueError(f"body: wanted finite mass and inertia, got {body!r}")
        if whole_number("count", count) == 0:
            return np.empty(0)
        stiffness, mass = self._bending(body)
        solve, size = self._solver(stiffness), stiffness.shape[0]
        searched = min(count, size - 1)
        while True:
            values, modes = lowest_modes(stiffness, mass, searched, solve)
            levels = modes[: 3 * (self.panels - (body is not None))].reshape(-1, 3, searched)
            distortion = 0.5 * np.abs(levels[:, 0] + 1j * levels[:, 1]) ** 2
            # Twice the mass of one leg's node stands for all four, see `_bending`; modes are of unit mass.
            bending = values[2.0 * self.node_masses[4::4][: len(levels)] @ distortion < 0.5]
            if len(bending) >= count:
                return np.asarray(np.sqrt(bending[:count]))
            if searched == size - 1:
                raise ValueError(f"count: wanted at most the {len(bending)} bending modes found, got {count!r}")
            searched = min(2 * searched, size - 1)

    def _bending(self, body: EndBody | None) -> tuple[Any, Any]:
        """Stiffness and mass of bending in the plane of x, Hermitian and sparse.

        Bending in the plane of x and, a quarter of a period later, of y makes each leg do what the one before does,
        turned by a quarter and a quarter later: one leg's motion (x, y, z) stands for all four. Under a rigid body
        its deflection and its rotation, both real, stand for the top.
        """
        from scipy.sparse import block_diag, csc_array, dia_array, eye_array, kron

        turned = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
        level = np.vstack([1j**leg * np.linalg.matrix_power(turned, leg) for leg in range(4)])
        motion = kron(eye_array(self.panels), level)
        if body is not None:
            x, y = 0.5 * self.top_spacing * CORNERS.T
            zero, one = np.zeros(4), np.ones(4)
            top = np.array([[one, 1j * one, zero], [zero, zero, -(x + 1j * y)]]).transpose(2, 1, 0).reshape(12, 2)
            motion = block_diag([kron(eye_array(self.panels - 1), level), top])
        # Half, as both planes move.
        masses = dia_array((np.repeat(0.5 * self.node_masses[4:], 3)[np.newaxis], [0]), shape=(12 * self.panels,) * 2)
        stiffness = csc_array(motion.conj().T @ (0.5 * self.stiffness[12:, 12:]) @ motion)
        mass = csc_array(motion.conj().T @ masses @ motion)
        if body is not None:
            first = body.mass * body.offset
            rigid = [[body.mass, first], [first, body.rotary_inertia + first * body.offset]]
            mass = csc_array(mass + block_diag([csc_array((mass.shape[0] - 2,) * 2), np.array(rigid)]))
        return stiffness, mass

    def _solver(self, stiffness: Any) -> Callable[[Floats], NDArray[np.complex128]]:
        solve = factorised(stiffness)
        if solve is None:
            raise Mechanism("column: wanted a truss that resists bending, got one that moves without strain")
        return solve

"""Where a flexible crane is and how it moves, over the times of a run; and its energy."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.tower.kernels import layout
from towercrane.cranes.tower.outputs.head_motions import HeadMotion, head_motion

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.tower.equations.flexible import Equations
    from towercrane.cranes.tower.modes.mass_sums import MassSums
    from towercrane.motions.motion import Motion

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class FlexibleMotion:
    """States of a run as positions and velocities; arrays have a row for each of p times.

    Parameters
    ----------
    model : Equations
    motions : dict of str to Motion
        One for each of the model's channels.
    times, states : ndarray, shapes (p,) and (p, size)
    """

    model: Equations
    motions: dict[str, Motion]
    times: Floats
    states: Floats

    @property
    def coordinates(self) -> Floats:
        """Structural coordinates, shape (p, n)."""
        return self.states[:, : self.model.coordinates]

    @property
    def rates(self) -> Floats:
        """Their rates, shape (p, n)."""
        first = self.model.coordinates + self.model.axes
        return self.states[:, first : first + self.model.coordinates]

    @cached_property
    def rope(self) -> Floats:
        """Direction of the rope in fixed axes, shape (p, 3)."""
        return self._in_space(self.model.coordinates)

    @cached_property
    def swing(self) -> Floats:
        """Rate of the rope's direction [1/s], shape (p, 3)."""
        return self._in_space(2 * self.model.coordinates + self.model.axes)

    def _in_space(self, first: int) -> Floats:
        vector = np.zeros((len(self.times), 3))
        vector[:, [0, 1, 2] if self.model.axes == 3 else [0, 2]] = self.states[:, first : first + self.model.axes]
        vector[:, :2] = self.from_plane(vector[:, :2])
        return vector

    def from_plane(self, vectors: Floats) -> Floats:
        """Horizontal vectors along and across the plane that the load swings in, along the fixed axes; (p, 2)."""
        if self.model.heading == 0.0:
            return vectors
        c, s = np.cos(self.model.heading), np.sin(self.model.heading)
        return np.asarray(vectors @ np.array([[c, s], [-s, c]]))

    def of_tower(self, weights: Floats, values: Floats) -> Floats:
        """Sums of the tower's ``values`` (p, n) of coordinates with weights, along the fixed axes x and y; (p, 2)."""
        total = np.zeros((len(self.times), 2))
        for axis, kind in enumerate(("tower_x", "tower_y")):
            if self.model.counts[kind]:
                total[:, axis] = values[:, self.model.parts[kind]] @ weights
        return self.from_plane(total)

    @property
    def amplitudes(self) -> dict[str, Floats]:
        """Coordinates of each kind of mode, the tower's along the fixed axes; shapes (p, modes)."""
        model, kinds = self.model, [kind for kind, count in self.model.counts.items() if count and kind != "slewing"]
        found = {kind: self.coordinates[:, model.parts[kind]] for kind in kinds}
        if model.axes == 2 and "tower_x" in found:
            along = found.pop("tower_x")
            c, s = np.cos(model.heading), np.sin(model.heading)
            found = {"tower_x": c * along, "tower_y": s * along, **found}
        return found

    def drive(self, channel: str, derivative: int = 0) -> Floats:
        """Value or derivative of a channel, zero if the model has none of that name; shape (p,)."""
        motion = self.motions.get(channel) if channel in self.model.channels else None
        return np.zeros(len(self.times)) if motion is None else np.asarray(motion(self.times, derivative))

    @cached_property
    def trolley(self) -> tuple[Floats, Floats]:
        """Position of the trolley along the jib and its rate."""
        return np.clip(self.drive("trolley"), 0.0, self.model.crane.jib_length), self.drive("trolley", 1)

    def along(self, row: int, kinds: tuple[str, ...], values: Floats) -> Floats:
        """Sum of a row of the model's vectors with those kinds of ``values`` (p, n); shape (p,)."""
        weights = self.model.system.vectors[row]
        total = np.zeros(len(self.times))
        for kind in kinds:
            part = self.model.parts[kind]
            total += values[:, part] @ weights[part]
        return total

    def top(self, values: Floats) -> tuple[Floats, Floats]:
        """Translation of the tower's top along x and y, and its tilt vector, of coordinates or their derivatives."""
        tower = ("tower_x", "tower_y")
        u_x, u_y, tilt_x, tilt_y = (
            self.along(row, tower, values) for row in (layout.SLIDE_X, layout.SLIDE_Y, layout.TILT_X, layout.TILT_Y)
        )
        return self.from_plane(np.stack([u_x, u_y], axis=1)), self.from_plane(np.stack([tilt_x, tilt_y], axis=1))

    @cached_property
    def twist(self) -> Floats:
        """Twist of the tower's top [rad]."""
        return self.along(layout.TURN, ("torsion",), self.coordinates)

    @cached_property
    def slewing(self) -> tuple[Floats, Floats]:
        """Slewing angle relative to the tower's top, and its rate."""
        if self.model.slewing == "fixed":
            return np.full(len(self.times), self.model.heading), np.zeros(len(self.times))
        if self.model.drive is None:
            return self.drive("slewing"), self.drive("slewing", 1)
        at = self.model.parts["slewing"].start
        return self.coordinates[:, at], self.rates[:, at]

    @property
    def heading(self) -> Floats:
        """Angle of the jib's root from the x axis [rad]."""
        return self.twist + self.slewing[0]

    @cached_property
    def head(self) -> HeadMotion:
        """Orientation and motion of the head."""
        (_, tilt), (velocity, tilting) = self.top(self.coordinates), self.top(self.rates)
        turning = self.along(layout.TURN, ("torsion",), self.rates) + self.slewing[1]
        acceleration = self.drive("slewing", 2)
        return head_motion(tilt, tilting, self.heading, turning, acceleration, velocity)

    @property
    def axes(self) -> Floats:
        """Axes of the head as columns: along the jib, to its left, up; shape (p, 3, 3)."""
        return self.head.rotation

    @property
    def spin(self) -> Floats:
        """Angular velocity of the head in its own axes [rad/s], shape (p, 3)."""
        return self.head.spin

    def to_fixed(self, vectors: Floats) -> Floats:
        """From the head's axes to the fixed ones; shapes (p, 3)."""
        return np.asarray(np.einsum("tij,tj->ti", self.axes, vectors))

    def to_head(self, vectors: Floats) -> Floats:
        """From the fixed axes to the head's; shapes (p, 3)."""
        return np.asarray(np.einsum("tji,tj->ti", self.axes, vectors))

    @cached_property
    def shapes(self) -> tuple[Floats, Floats]:
        """Shapes of the jib at the trolley, to the left and up, and their slopes; shapes (jib modes, p)."""
        return self.shapes_at_trolley(0), self.shapes_at_trolley(1)

    def shapes_at_trolley(self, derivative: int) -> Floats:
        """Derivative of the jib's shapes at the trolley, shape (jib modes, p)."""
        return self.model.crane.jib_shapes(self.trolley[0], derivative)

    def deflection(self, shapes: Floats, values: Floats) -> Floats:
        """Sums of the jib's shapes (jib modes, p or 1) with coordinates or rates, left and up; shape (p, 2)."""
        first, middle = self.model.parts["jib_lateral"].start, self.model.parts["jib_vertical"].start
        products = shapes.T * values[:, first:]
        return np.stack(
            [products[:, : middle - first].sum(axis=1), products[:, middle - first :].sum(axis=1)], axis=1
        )

    @cached_property
    def suspension(self) -> tuple[Floats, Floats]:
        """Place of the trolley in the head's axes, and its rate there; shapes (p, 3)."""
        (x, xd), (shapes, slopes) = self.trolley, self.shapes
        across = self.deflection(shapes, self.coordinates)
        rate = self.deflection(shapes, self.rates) + xd[:, None] * self.deflection(slopes, self.coordinates)
        return np.column_stack([x, across]), np.column_stack([xd, rate])

    @cached_property
    def trolley_in_space(self) -> tuple[Floats, Floats]:
        """Position from the undeformed tower top and velocity of the trolley; shapes (p, 3)."""
        place, rate = self.suspension
        u, velocity = self.top(self.coordinates)[0], self.top(self.rates)[0]
        position, speed = self.to_fixed(place), self.to_fixed(rate + np.cross(self.spin, place))
        position[:, :2] += u
        speed[:, :2] += velocity
        return position, speed

    @cached_property
    def load_in_space(self) -> tuple[Floats, Floats]:
        """Position from the undeformed tower top and velocity of the load; shapes (p, 3)."""
        place, speed = self.trolley_in_space
        length, hauling = self.drive("rope"), self.drive("rope", 1)
        return (
            place + length[:, None] * self.rope,
            speed + hauling[:, None] * self.rope + length[:, None] * self.swing,
        )

    def jib_sum(self, weights: Floats, values: Floats) -> Floats:
        """Sums over the jib's modes to the left and up, beside a zero along it; shape (p, 3)."""
        total = np.zeros((len(self.times), 3))
        first = self.model.parts["jib_lateral"].start
        for axis, kind in ((1, "jib_lateral"), (2, "jib_vertical")):
            part = self.model.parts[kind]
            total[:, axis] = values[:, part] @ weights[part.start - first : part.stop - first]
        return total

    def products(self, sums: MassSums, left: Floats, right: Floats) -> Floats:
        """Sums of m s_i s_j over the deflections of two motions; shape (p, 2, 2), left and up."""
        parts, first = self.model.parts, self.model.parts["jib_lateral"].start
        total = np.zeros((len(self.times), 2, 2))
        for i, a in enumerate(("jib_lateral", "jib_vertical")):
            for j, b in enumerate(("jib_lateral", "jib_vertical")):
                rows, columns = (slice(parts[k].start - first, parts[k].stop - first) for k in (a, b))
                total[:, i, j] = np.einsum(
                    "ti,ij,tj->t", left[:, parts[a]], sums.products[rows, columns], right[:, parts[b]]
                )
        return total

    def inertia(self, sums: MassSums) -> Floats:
        """Inertia of a deflected distribution of mass about the tower's top in the head's axes; shape (p, 3, 3)."""
        q = self.products(sums, self.coordinates, self.coordinates)
        b = self.jib_sum(sums.second, self.coordinates)
        inertia = np.zeros((len(self.times), 3, 3))
        inertia[:, 0, 0] = sums.roll + q[:, 0, 0] + q[:, 1, 1]
        inertia[:, 1, 1], inertia[:, 2, 2] = sums.pitch + q[:, 1, 1], sums.yaw + q[:, 0, 0]
        inertia[:, 0, 1] = inertia[:, 1, 0] = -b[:, 1]
        inertia[:, 0, 2] = inertia[:, 2, 0] = -b[:, 2]
        inertia[:, 1, 2] = inertia[:, 2, 1] = -q[:, 0, 1]
        return inertia

    def first_moment(self, sums: MassSums) -> Floats:
        """Sum of m s in the head's axes; shape (p, 3)."""
        moment = self.jib_sum(sums.first, self.coordinates)
        moment[:, 0] = sums.moment
        return moment

"""A run of a coarse model in the coordinates of a richer one: where it moves, what pulls at it, what rings it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from towercrane.accuracy.instants import derivatives_of
from towercrane.motions.motion import phases
from towercrane.simulation.starts.begin import begin
from towercrane.simulation.system import start_inputs

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.accuracy.scene import Scene
    from towercrane.cranes.tower.model import FlexibleModel
    from towercrane.simulation.run import Run

    Floats = NDArray[np.float64]

SPACING = 0.05
"""Time between two states of a run that are looked at, about [s]."""

WINDOWS = 4
"""Parts of a run, in each of which trolley and rope stand where they are in its middle."""

PULLS = 48
"""Instants at which what pulls at the crane is asked for."""


@dataclass(frozen=True, eq=False)
class Path:
    """A run seen from its crane's head.

    Vectors have the richer model's coordinates, then the load's way from the point it hangs from [m]. What is given
    along x and y, of the tower and of the load, is along the jib and across it.

    Parameters
    ----------
    scene : Scene
    run : Run
    model : FlexibleModel
        The richer one.
    """

    scene: Scene
    run: Run
    model: FlexibleModel

    @cached_property
    def rows(self) -> NDArray[np.int64]:
        """Of the run's looks, at even steps."""
        times = self.run.times
        stride = max(1, round(SPACING / (times[1] - times[0]))) if len(times) > 1 else 1
        return np.arange(0, len(times), stride)

    @cached_property
    def times(self) -> Floats:
        """Shape (rows,) [s]."""
        return self.run.times[self.rows]

    @cached_property
    def starts(self) -> NDArray[np.int64]:
        """First row of each window; shape (windows,)."""
        return np.arange(WINDOWS) * len(self.rows) // WINDOWS

    @cached_property
    def spans(self) -> Floats:
        """Duration of each window [s]."""
        return np.diff(np.append(self.times[self.starts], self.times[-1]))

    @cached_property
    def drives(self) -> Floats:
        """Value of each channel in each window, the head and the air at rest; shape (windows, channels)."""
        middle = 0.5 * self.spans + self.times[self.starts]
        values = {name: self.scene.motions[name](middle) for name in ("trolley", "rope")}
        return np.stack([values.get(name, np.zeros(WINDOWS)) for name in self.model.channels], axis=1)

    def window(self, rows: NDArray[np.int64]) -> NDArray[np.int64]:
        """In which windows rows are."""
        return np.searchsorted(self.starts, rows, side="right") - 1

    @cached_property
    def shared(self) -> NDArray[np.int64]:
        """Which entries of a vector the coarse model has too."""
        coarse, parts = self.run.model, self.model.parts
        counts: dict[str, int] = coarse.counts  # type: ignore[attr-defined]
        structure = [parts[kind].start + np.arange(count) for kind, count in counts.items()]
        return np.concatenate([*structure, self.model.coordinates + np.arange(self.model.axes - 1)]).astype(int)

    @cached_property
    def displacements(self) -> Floats:
        """Where the crane and its load are; a slewing angle counts from its drive's shaft; shape (rows, vector)."""
        found = np.zeros((len(self.rows), self.model.coordinates + self.model.axes - 1))
        for kind, part in self.model.parts.items():
            name = f"{kind}_coordinate"
            if name in self.run:
                values = self._values(name)
                if kind == "tower_x" and self.model.heading:
                    c, s = np.cos(self.model.heading), np.sin(self.model.heading)
                    values = c * values + s * self._values("tower_y_coordinate")
                found[:, part.start : part.start + values.shape[1]] = values
            elif kind == "slewing" and self.model.drive is not None:
                found[:, part] = (self._values("slewing_angle") - self._values("shaft_angle"))[:, None]
        found[:, self.model.coordinates :] = self._values("rope_length")[:, None] * self.rope[:, :-1]
        return self._from_head(found, self._slewing)

    @cached_property
    def rope(self) -> Floats:
        """Direction of the rope in fixed axes; shape (rows, axes)."""
        along = np.tan(self._values("sway_radial"))
        if self.model.axes == 2:
            return np.stack([along, -np.ones_like(along)], axis=1) / np.sqrt(1.0 + along**2)[:, None]
        across = np.tan(self._values("sway_tangential"))
        heading = self._slewing + self._values("tower_tip_twist")
        c, s = np.cos(heading), np.sin(heading)
        fixed = np.stack([along * c - across * s, along * s + across * c, -np.ones_like(along)], axis=1)
        return np.asarray(fixed / np.sqrt(1.0 + along**2 + across**2)[:, None])

    @cached_property
    def bent(self) -> Floats:
        """Coordinates under all weights at rest in each window; shape (windows, coordinates)."""
        n, found = self.model.coordinates, np.zeros((WINDOWS, self.model.coordinates))
        held = np.setdiff1d(np.arange(n), np.arange(n)[self.model.parts["slewing"]])
        stiffness = self.model.constants.stiffness[np.ix_(held, held)]
        for window, values in enumerate(self.drives):
            weight = self.model.static_forces(np.zeros((n, 1)), values[:, None])[:, 0]
            found[window, held] = np.linalg.solve(stiffness, weight[held])
        return found

    @cached_property
    def pulls(self) -> tuple[NDArray[np.int64], Floats]:
        """Rows, and the acceleration that the crane, bent by weights alone, would take there: by wind, drives and
        the rope as it hangs in the run; shapes (pulls,) and (pulls, vector)."""
        rows = np.unique(np.linspace(0, len(self.rows) - 1, PULLS).astype(int))
        rates, bent = np.gradient(self.rope, self.times, axis=0), self.bent[self.window(rows)]
        # The tower's coordinates along the jib and across it, along x and y.
        bent = self._from_head(np.pad(bent, ((0, 0), (0, self.model.axes - 1))), -self._slewing[rows])
        found = []
        for row, coordinates, inputs in zip(rows, bent, self._inputs(rows), strict=True):
            state = self._still(coordinates, self.rope[row], rates[row])
            if self.model.drive is not None:
                at = self.model.parts["slewing"].start
                state[at] = self._slewing[row]
                state[self.model.coordinates + self.model.axes + at] = self._values("slewing_speed")[row]
            found.append(self._accelerations(state, inputs))
        return rows, self._from_head(np.array(found), self._slewing[rows])

    @cached_property
    def jumps(self) -> tuple[Floats, Floats]:
        """Times at which the drives' motions switch, and jumps of their derivatives there.

        Shapes (switches,) and (switches, channels, orders). At the start all that the drives do is a jump.
        """
        moves = tuple(self.scene.motions[name] for name in self._driven)
        cut = phases(moves, float(self.times[-1]))
        known = derivatives_of(cut.inputs, np.diff(cut.times)[:, None] * (0.0, 1.0))
        before = np.concatenate([np.zeros_like(known[:1, 1]), known[:-1, 1]])
        return cut.times[:-1], known[:, 0] - before

    @cached_property
    def pushes(self) -> Floats:
        """Acceleration of a vector over each drive's; shape (windows, channels, vector)."""
        found = []
        for values, bent in zip(self.drives, self.bent, strict=True):
            state = self._still(bent, -np.eye(self.model.axes)[-1], np.zeros(self.model.axes))
            inputs = np.column_stack([values, np.zeros((len(values), 2))])
            before = self._accelerations(state, inputs)
            for channel, _ in enumerate(self._driven):
                pushed = inputs.copy()
                pushed[channel, 2] = 0.5
                found.append(self._accelerations(state, pushed) - before)
        return np.reshape(found, (len(self.drives), len(self._driven), -1))

    @cached_property
    def release(self) -> Floats:
        """Acceleration of a vector when the crane is let go as the run begins, before the drives move."""
        now = self._inputs(np.zeros(1, dtype=int))[0]
        now[:, 1:] = 0.0
        calm = start_inputs(self.model, self.scene.motions, now)
        state = begin(self.model, calm, self.scene.start)
        return np.asarray(self._from_head(self._accelerations(state, now)[None], self._slewing[:1])[0])

    @property
    def _driven(self) -> tuple[str, ...]:
        """Channels that move something."""
        return tuple(name for name in self.model.channels if name not in self.model.value_channels)

    @cached_property
    def _slewing(self) -> Floats:
        """Angle of the head on the tower's top [rad]."""
        return self._values("slewing_angle") if self.model.axes == 3 else np.zeros(len(self.rows))

    def _values(self, name: str) -> Floats:
        return self.run[name].values[self.rows]

    def _inputs(self, rows: NDArray[np.int64]) -> Floats:
        """Polynomials of the channels at some rows, shape (p, channels, 3)."""
        motions = [self.scene.motions[name] for name in self.model.channels]
        values = [[m(self.times[rows]), m(self.times[rows], 1), 0.5 * m(self.times[rows], 2)] for m in motions]
        return np.ascontiguousarray(np.array(values).transpose(2, 0, 1))

    def _still(self, coordinates: Floats, rope: Floats, rate: Floats) -> Floats:
        """State of a crane at rest with a rope that moves."""
        n, axes, y = self.model.coordinates, self.model.axes, np.zeros(self.model.size)
        y[:n] = coordinates[:n]
        y[n : n + axes], y[2 * n + axes : 2 * (n + axes)] = rope, rate
        return y

    def _accelerations(self, state: Floats, inputs: Floats) -> Floats:
        """Of a vector, in fixed axes; shape (vector,)."""
        n, axes = self.model.coordinates, self.model.axes
        slope = self.model.system.slope(0.0, state, inputs)[0][n + axes :]
        return np.concatenate([slope[:n], inputs[1, 0] * slope[n : n + axes - 1]])

    def _from_head(self, vectors: Floats, heading: Floats) -> Floats:
        """Vectors (p, vector) in fixed axes, as seen from a head that is turned so (p,)."""
        if self.model.axes == 2:
            return vectors
        found, c, s = vectors.copy(), np.cos(heading)[:, None], np.sin(heading)[:, None]
        n, parts = self.model.coordinates, self.model.parts
        for x, y in ((parts["tower_x"], parts["tower_y"]), (slice(n, n + 1), slice(n + 1, n + 2))):
            found[:, x], found[:, y] = vectors[:, x] * c + vectors[:, y] * s, vectors[:, y] * c - vectors[:, x] * s
        return found

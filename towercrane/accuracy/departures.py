"""How far models of a scene are apart, from small motions about what a run of a coarse one of them does.

In the middle of each window of the run the crane's modes are found in the coordinates of a rich model and, by Ritz's
method, in those of any coarser one. How far each mode swings is read off the run; modes that the run does not have
ring as far as the jumps of the drives make them. Two models then differ in the shape of every mode, in its phase, the
more the longer a run lasts, and in their deflection under what pulls at the crane. No model is run for it.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from towercrane.accuracy.path import Path
from towercrane.accuracy.readings import ROUNDING, components, held, readings
from towercrane.cranes.parts.coupling import coupling_torque
from towercrane.cranes.tower.equations.coordinates import UPRIGHT
from towercrane.cranes.tower.equations.matrices import geometric_stiffness
from towercrane.cranes.tower.equations.small_motions import linear_matrices
from towercrane.simulation.outcomes import TOWER_BUCKLED
from towercrane.simulation.system import NoEquilibrium

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from towercrane.accuracy.scene import Scene
    from towercrane.accuracy.setting import Setting
    from towercrane.simulation.run import Run

    Floats = NDArray[np.float64]
    Complex = NDArray[np.complex128]
    Places = NDArray[np.int64]

KIND_OF = {
    "tower_x": "tower_modes",
    "tower_y": "tower_modes",
    "torsion": "torsion_modes",
    "jib_lateral": "jib_lateral_modes",
    "jib_vertical": "jib_vertical_modes",
    "counter_jib_lateral": "counter_jib_lateral_modes",
    "counter_jib_vertical": "counter_jib_vertical_modes",
}
"""Kind of modes of each kind of coordinates."""

LAST = {
    "tower_modes": 2, "torsion_modes": 1, "jib_lateral_modes": 2, "jib_vertical_modes": 2,
    "counter_jib_lateral_modes": 1, "counter_jib_vertical_modes": 1,
}  # fmt: skip
"""Modes of the rich model whose effect stands for that of all beyond it."""


class Departures:
    """Departures of the models of one scene from each other.

    Parameters
    ----------
    scene : Scene
    run : Run
        Of a coarse model.
    rich : Setting
        Of the model that others are compared with.

    Raises
    ------
    NoEquilibrium
        If the weight leaves the tower no stiffness.
    """

    def __init__(self, scene: Scene, run: Run, rich: Setting) -> None:
        self.scene, self.rich, self.model = scene, rich, scene.model(rich)
        self.path = Path(scene, run, self.model)
        matrices = [linear_matrices(self.model, drives) for drives in self.path.drives]
        self.mass, self.stiffness = (np.array(found) for found in zip(*matrices, strict=True))
        if self.model.drive is not None:
            at = self.model.parts["slewing"].start
            self.stiffness[:, at, at] += self._coupling(abs(self.path.displacements[:, at]).max())
        self.all = np.arange(self.mass.shape[1])
        self._components, self._forces = components(scene.outputs)
        self._readings = readings(self.model, scene.outputs, self.path.drives)
        self._held = held(self.model, scene.outputs, self.path.drives, self._readings)
        self._known: dict[tuple[int, ...], tuple[Complex, Floats]] = {}
        try:
            self.frequencies, self.shapes = self._modes(self.all, self.stiffness)
        except np.linalg.LinAlgError:
            raise NoEquilibrium(TOWER_BUCKLED, self.model.buckling_message()) from None

    def between(self, one: Mapping[str, int], other: Mapping[str, int]) -> Floats:
        """Largest differences of the outputs of models with so many modes: as they ring, and as they are bent.

        Shape (2, outputs).
        """
        return self._between(self._known_of(one), self._known_of(other))

    def beyond(self, counts: Mapping[str, int]) -> Floats:
        """What all modes beyond so many would change, also those beyond the rich model's; shape (2, outputs)."""
        return self.between(counts, self.rich.counts) + self._lacking

    def softening(self) -> Floats:
        """What the weight's softening of the tower would change, shape (2, outputs).

        Raises
        ------
        NoEquilibrium
            If it leaves the tower no stiffness.
        """
        stiffness = self.stiffness.copy()
        for kind in ("tower_x", "tower_y"):
            if self.model.counts[kind]:
                part = self.model.parts[kind]
                stiffness[:, part, part] -= geometric_stiffness(self.model)
        try:
            return self._between(self._of(self.all, stiffness), self._known_of(self.rich.counts))
        except np.linalg.LinAlgError:
            raise NoEquilibrium(TOWER_BUCKLED, self.model.buckling_message()) from None

    def fastest(self, counts: Mapping[str, int]) -> tuple[int, float]:
        """Number of coordinates of a model, and its fastest mode's frequency by itself [Hz]."""
        own = self.model.angular_frequencies[self._kept(counts)[: 1 - self.model.axes]]
        return len(own), float(own.max(initial=0.0)) / (2.0 * np.pi)

    @property
    def looked(self) -> int:
        """Models that were looked at."""
        return len(self._known)

    @cached_property
    def _lacking(self) -> Floats:
        """What the rich model itself may lack: as much as its last modes bring; shape (2, outputs)."""
        less = {kind: max(count - LAST[kind], 0) for kind, count in self.rich.counts.items()}
        return self.between(less, self.rich.counts)

    def _between(self, one: tuple[Complex, Floats], other: tuple[Complex, Floats]) -> Floats:
        rung = (abs(one[0] - other[0]) ** 2 @ self._squares)[:, :, 0]
        bent = (one[1] - other[1]) ** 2
        parts = self._components.values()
        return np.sqrt([[found[:, part].sum(axis=1).max() for part in parts] for found in (rung, bent)])

    def _known_of(self, counts: Mapping[str, int]) -> tuple[Complex, Floats]:
        key = tuple(counts[kind] for kind in LAST)
        if key not in self._known:
            self._known[key] = self._of(self._kept(counts), self.stiffness)
        return self._known[key]

    def _of(self, kept: Places, stiffness: Floats) -> tuple[Complex, Floats]:
        """A model's outputs per amplitude of each rich mode, with the phase it has got, and under each pull.

        Shapes (windows, components, rich modes) and (pulls, components). A rich mode that the model has not is zero.
        """
        frequencies, shapes = self._modes(kept, stiffness)
        overlap = self.shapes.transpose(0, 2, 1) @ self.mass @ shapes
        size = abs(overlap).sum(axis=0)
        partner = size.argmax(axis=0)
        other = np.flatnonzero(size.argmax(axis=1)[partner] == np.arange(len(partner)))
        mine = partner[other]
        slip = np.clip(self._slip(frequencies[:, other] - self.frequencies[:, mine], mine), -np.pi, np.pi)
        turn = np.sign(overlap[:, mine, other]) * np.exp(1j * slip)
        found = np.zeros(self._seen.shape, dtype=complex)
        faster = np.where(self._forces[:, None], frequencies[:, None, other] ** 2, 1.0)
        found[:, :, mine] = (self._seen @ overlap[:, :, other]) * faster * turn[:, None]
        still, bent = kept[: 1 - self.model.axes], np.zeros((len(self._pull), len(self._forces)))
        # The crane's own stiffness is the same in every window.
        places = np.linalg.solve(stiffness[0][np.ix_(still, still)], self._pull[:, still].T).T
        rows = self.path.window(self.path.pulls[0])
        for window, read in enumerate(self._held):
            bent[rows == window] = places[rows == window] @ read[:, still].T
        return found, bent

    def _slip(self, rates: Floats, modes: Places) -> Floats:
        """Phase that is gained at these rates, as far as what rang is not forgotten; shapes (windows, modes)."""
        found, slip = np.zeros_like(rates), np.zeros(rates.shape[1])
        for window, span in enumerate(self.path.spans):
            fading = np.maximum(self._fading[window, modes], 1e-12)
            kept = np.exp(-fading * span)
            slip = slip * kept - rates[window] * np.expm1(-fading * span) / fading
            found[window] = slip
        return found

    def _kept(self, counts: Mapping[str, int]) -> Places:
        """Coordinates of the rich model that a model with so many modes has."""
        parts = self.model.parts
        numbers = {k: counts[KIND_OF[k]] if k in KIND_OF else p.stop - p.start for k, p in parts.items()}
        found = [p.start + np.arange(min(numbers[k], p.stop - p.start)) for k, p in parts.items()]
        return np.concatenate([*found, self.model.coordinates + np.arange(self.model.axes - 1)]).astype(int)

    def _modes(self, kept: Places, stiffness: Floats) -> tuple[Floats, Floats]:
        """Angular frequencies and shapes of unit modal mass; shapes (windows, k) and (windows, vector, k).

        Those that move the crane in its jib's plane come first, so that their order is the same in every window.
        """
        # The reciprocal problem keeps the low modes exact to rounding, however stiff the highest is.
        inverse = np.linalg.inv(np.linalg.cholesky(stiffness[:, kept[:, None], kept]))
        upper = inverse.transpose(0, 2, 1)
        mass = self.mass[:, kept[:, None], kept]
        reciprocal, vectors = np.linalg.eigh(inverse @ mass @ upper)
        frequencies = 1.0 / np.sqrt(reciprocal[:, ::-1])
        small = (upper @ vectors[:, :, ::-1]) * frequencies[:, None]
        inside = (small * (mass @ small))[:, self._in_plane[kept]].sum(axis=1)
        order = np.argsort(inside < 0.5, axis=1, kind="stable")
        shapes = np.zeros((len(mass), len(self.all), len(kept)))
        shapes[:, kept] = np.take_along_axis(small, order[:, None], axis=2)
        return np.take_along_axis(frequencies, order, axis=1), shapes

    @cached_property
    def _in_plane(self) -> NDArray[np.bool_]:
        """Which coordinates move in the jib's plane."""
        found = np.zeros(len(self.all), dtype=bool)
        for kind in self.model.parts.keys() & UPRIGHT:
            found[self.model.parts[kind]] = True
        found[self.model.coordinates] = True
        return found

    def _coupling(self, twist: float) -> float:
        """Stiffness of the drive's coupling at its largest twist, from zero to there [N m/rad]."""
        drive = self.model.drive
        assert drive is not None
        return float(coupling_torque(twist, drive.soft, drive.stiff, drive.corner) / twist) if twist else drive.soft

    @cached_property
    def _fading(self) -> Floats:
        """Rates of decay of the rich modes [1/s], shape (windows, modes)."""
        lost = np.zeros(len(self.all))
        lost[: self.model.coordinates] = self.model.constants.damping
        if self.model.drive is not None:
            lost[self.model.parts["slewing"]] = self.model.drive.damping
        return 0.5 * lost @ self.shapes**2

    @cached_property
    def _pull(self) -> Floats:
        """Force on the crane, its load as in the run; shape (pulls, vector)."""
        rows, accelerations = self.path.pulls
        n, found = self.model.coordinates, np.zeros((len(rows), len(self.all)))
        for number, window in enumerate(self.path.window(rows)):
            mass = self.mass[window]
            force = mass @ accelerations[number]
            # What the load takes of the force by swinging freely does not pull at the crane.
            found[number, :n] = force[:n] - mass[:n, n:] @ np.linalg.solve(mass[n:, n:], force[n:])
            found[number, :n] += self.stiffness[window, :n, :n] @ self.path.bent[window]
        if self.model.drive is not None:
            found[:, self.model.parts["slewing"]] = 0.0
        return found

    @cached_property
    def _squares(self) -> Floats:
        """Squared largest amplitude of each rich mode, of the run's own or by jolts; shape (windows, modes, 1)."""
        path = self.path
        own, shapes = self._modes(path.shared, self.stiffness)
        overlap = abs(self.shapes.transpose(0, 2, 1) @ self.mass @ shapes).sum(axis=0)
        found, partner = np.zeros_like(self.frequencies), overlap.argmax(axis=0)
        step = path.times[1] - path.times[0]
        # Second differences are of what rings, not of what slowly follows the drives.
        bends = np.diff(path.displacements, 2, axis=0)
        for window, first in enumerate(path.starts):
            last = path.starts[window + 1] if window + 1 < len(path.starts) else len(path.times)
            modal = bends[max(first - 2, 0) : last] @ self.mass[window] @ shapes[window]
            seen = 4.0 * np.sin(0.5 * np.minimum(own[window] * step, np.pi)) ** 2
            np.maximum.at(found[window], partner, abs(modal).max(axis=0, initial=0.0) / seen)
        return np.maximum(found**2, self._rung)[:, :, None]

    @cached_property
    def _rung(self) -> Floats:
        """Squared amplitude to which the start and the drives ring each rich mode, shape (windows, modes)."""
        times, jumps = self.path.jumps
        orders = np.arange(jumps.shape[2] - 2)
        pushes = self.path.pushes @ self.mass @ self.shapes
        release = self.path.release @ self.mass[0] @ self.shapes[0]
        for push in (pushes, release):
            push[abs(push) < ROUNDING * abs(push).max(initial=0.0)] = 0.0
        windows = np.searchsorted(self.path.times[self.path.starts], times, side="right") - 1
        squares, last = np.zeros_like(self.frequencies), 0.0
        ringing = -release.astype(complex) / self.frequencies[0] ** 2
        ends = np.append(times[1:], self.path.times[-1])
        for window, time, until, jump in zip(windows, times, ends, jumps, strict=True):
            omega = self.frequencies[window]
            ringing = ringing * np.exp((1j * omega - self._fading[window]) * (time - last))
            turns = (-1j) ** orders[:, None] * omega ** -(orders[:, None] + 2.0)
            ringing = ringing - (jump[:, 2:].T[:, :, None] * pushes[window] * turns[:, None]).sum(axis=(0, 1))
            # Within a fast ramp most of it follows the drives.
            alone = omega * (until - time) > np.pi
            squares[window] = np.maximum(squares[window], np.where(alone, abs(ringing) ** 2, 0.0))
            last = time
        for window in range(1, len(squares)):
            lost = np.exp(-2.0 * self._fading[window] * self.path.spans[window - 1])
            squares[window] = np.maximum(squares[window], squares[window - 1] * lost)
        return squares

    @cached_property
    def _seen(self) -> Floats:
        """Outputs per amplitude of each rich mode, of forces over its squared frequency; shape as `_readings`."""
        inertia = np.where(self._forces[:, None], self.frequencies[:, None] ** -2.0, 1.0)
        return np.asarray(self._readings @ self.shapes * inertia)

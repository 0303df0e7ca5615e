"""Errors of a scene's settings that small motions foretell; nothing is run for them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from towercrane.accuracy.estimate import Estimate
from towercrane.accuracy.indicators import drift, vibration
from towercrane.accuracy.instants import BEYOND, OUTPUTS, RICHEST, SWING, TENSION, nodes_of
from towercrane.accuracy.setting import Setting
from towercrane.simulation.system import NoEquilibrium

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.accuracy.indicators import Vibration
    from towercrane.accuracy.scene import Scene

    Floats = NDArray[np.float64]

MEASURED = Setting().method
"""The method whose errors were measured."""

SAFETY = np.array([3.2, 3.2, 3.2, 3.2])
"""Factor on what the indicators expect of vibration, per output: what the drawn scenes of the benchmark needed."""

LAST = 4
"""Tower modes of the richest model whose effect stands for that of all beyond it."""

STATIC_SAFETY = 1.1
"""Factor on the static part, which is all but exact."""

STEPPING = 5.0
"""Largest error of dop853 over rtol and over the output's peak, for outputs that are positions; commonly a tenth."""

STEPS_PER_CYCLE = 3.0
"""Steps of dop853 in a cycle of the fastest mode."""

FASTEST = 0.3
"""Modes above this part of the highest frequency lose up to rtol of their amplitude in every step."""

WIDE, LEANING = 0.5, 0.1
"""Swing [rad], and deflection of the tower over its height, beyond which small motions say little."""

GROWTH = 0.3
"""Exponent of a parametric resonance's growth over a run, beyond which nothing is promised."""


class Indicators:
    """Estimates for settings of one scene.

    Parameters
    ----------
    scene : Scene
    tower_modes, jib_vertical_modes : int
        Most that a setting will have; the richest model always has more.
    """

    def __init__(self, scene: Scene, tower_modes: int = 0, jib_vertical_modes: int = 0) -> None:
        stated = Setting(tower_modes=tower_modes, jib_vertical_modes=jib_vertical_modes, planar=True)
        more = stated.with_more(BEYOND).counts
        most = {kind: max(count, more[kind]) for kind, count in RICHEST.counts.items()}
        self.scene, self.richest = scene, RICHEST.with_counts(most)
        self.nodes = nodes_of(scene, self.richest)
        self._rich: dict[bool, Vibration] = {}
        self._lacking: dict[bool, Floats] = {}
        self._last: tuple[tuple[object, ...], Vibration, Floats] | None = None

    def rich(self, weight_softening: bool) -> Vibration:
        """The richest model, with or without the weight's softening.

        Raises
        ------
        NoEquilibrium
            If the weight leaves the tower no stiffness.
        """
        if weight_softening not in self._rich:
            try:
                found = vibration(self.nodes, replace(self.richest, weight_softening=weight_softening))
            except np.linalg.LinAlgError:
                message = self.scene.model(self.richest).buckling_message()
                raise NoEquilibrium("tower buckled", message) from None
            self._rich[weight_softening] = found
        return self._rich[weight_softening]

    def lacking(self, weight_softening: bool) -> Floats:
        """What the richest model itself may lack: as much as its last tower modes bring; shape (outputs,).

        Tower modes converge slowly where shear and the ground yield: their flexibility falls with the count alone.
        """
        if weight_softening not in self._lacking:
            less = replace(
                self.richest, tower_modes=self.richest.tower_modes - LAST, weight_softening=weight_softening
            )
            change = drift(self.rich(weight_softening), vibration(self.nodes, less))
            self._lacking[weight_softening] = np.asarray(sum(change))
        return self._lacking[weight_softening]

    def truncation(self, setting: Setting) -> Floats:
        """Largest error of every output by what the model leaves out, with its safety; shape (outputs,)."""
        return self._compared(setting)[1]

    def of(self, setting: Setting) -> Vibration:
        """Modes of a setting's model."""
        return self._compared(setting)[0]

    def _compared(self, setting: Setting) -> tuple[Vibration, Floats]:
        """Modes of a setting's model, and its truncation; the last ones asked for are kept."""
        key = (*setting.counts.values(), setting.cap, setting.weight_softening)
        if self._last is None or self._last[0] != key:
            rich, poor = self.rich(setting.weight_softening), vibration(self.nodes, setting)
            static, ringing = drift(rich, poor)
            lost = SAFETY * ringing + STATIC_SAFETY * static + self.lacking(setting.weight_softening)
            swing = rich.peaks[SWING]
            # A pendulum is slower by a sixteenth of its squared swing: an error in that becomes one in its phase.
            lost[SWING] *= 1.0 + 0.125 * swing**2 * rich.phase[-1, rich.pendulum]
            # The rope's force follows the square of the swing.
            lost[TENSION] += 3.0 * self.scene.load.mass * self.scene.crane.gravity * swing * lost[SWING]
            self._last = key, poor, lost
        return self._last[1:]

    def per_rtol(self, setting: Setting) -> Floats:
        """Largest error of the solver over its rtol and over the output's peak, shape (outputs,).

        The tension sees accelerations: an error in the position of the fastest mode, as a part of the jib's
        deflection, times its squared frequency over gravity.
        """
        found = np.full(len(OUTPUTS), STEPPING)
        if setting.method != MEASURED:
            return np.full(len(OUTPUTS), np.inf)
        fastest = self.of(setting).frequencies.max()
        deflection = self.rich(setting.weight_softening).peaks[1]
        found[TENSION] = max(STEPPING, fastest**2 * deflection / self.scene.crane.gravity)
        return found

    def damped(self, setting: Setting) -> Floats:
        """What the solver takes from the fastest modes, in the outputs' units; shape (outputs,)."""
        found = self.of(setting)
        fast = found.frequencies.max(axis=0)
        steps = STEPS_PER_CYCLE * self.scene.duration * fast.max() / (2.0 * np.pi)
        ringing = abs(found.left[:, :, fast > FASTEST * fast.max()]).sum(axis=(2, 3)).max(axis=0)
        return np.asarray(ringing * min(1.0, steps * setting.rtol))

    def estimate(self, setting: Setting) -> Estimate:
        """Expected error of a setting."""
        lost = self.truncation(setting) + self.damped(setting)
        return Estimate(lost, self.per_rtol(setting) * setting.rtol)

    def softening(self) -> Floats:
        """What the weight's softening changes, in the outputs' units; shape (outputs,)."""
        return np.asarray(sum(drift(self.rich(True), self.rich(False))))

    def doubts(self, weight_softening: bool) -> tuple[str, ...]:
        """Why small motions cannot tell the error of this scene."""
        rich = self.rich(weight_softening)
        swing, found = rich.peaks[SWING], []
        if swing > WIDE:
            found.append(f"the load swings {swing:.2g} rad: small motions say little about it")
        crane = self.scene.crane
        leaning = rich.peaks[0] / crane.tower.length
        if leaning > LEANING:
            found.append(f"the tower bends by {leaning:.0%} of its height: small motions say little about its head")
        weight = self.scene.load.mass * crane.gravity
        pumping = abs(rich.ringing(np.arange(len(self.nodes.times)))[:, TENSION]).sum(axis=2) / weight + swing**2
        pendulum = rich.pendulum
        own = rich.frequencies[:, [pendulum]]
        # Mathieu's equation: a point that shakes at nearly twice the swing's frequency makes it grow.
        off = abs(rich.frequencies / (2.0 * own) - 1.0)
        rate = 0.25 * own * np.maximum(pumping - 4.0 * off, 0.0)
        rate[:, pendulum] = 0.0
        growth = np.diff(self.nodes.times) @ np.maximum(rate[1:], rate[:-1])
        if growth.max() > GROWTH:
            tuned = rich.frequencies[0, growth.argmax()] / (2.0 * np.pi)
            found.append(
                f"the structure at {tuned:.3f} Hz vibrates near twice the swing's {own[0, 0] / (2 * np.pi):.3f} Hz "
                f"and may pump it: small errors can grow {np.exp(min(growth.max(), 50.0)):.2g} times"
            )
        return tuple(found)

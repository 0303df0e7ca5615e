"""A scene in space: a crane, its load, what drives it and how it starts; all but the choice of the model."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from towercrane.accuracy.scene import Scene
from towercrane.cases.models import motions_of
from towercrane.cranes.tower.file.build import space_parts
from towercrane.cranes.tower.file.case_tables import SpaceCase
from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.cranes.tower.modes.modal_crane import ModeCounts
from towercrane.cranes.tower.space import KINDS, described, model_in_space
from towercrane.cranes.tower.targets import SPACE

if TYPE_CHECKING:
    from collections.abc import Mapping

    from towercrane.cases.case import Case
    from towercrane.cranes.parts.wind import WindAreas
    from towercrane.cranes.slewing.description import Drive
    from towercrane.cranes.tower.model import FlexibleModel
    from towercrane.simulation.run import Run


@dataclass(frozen=True)
class SpaceSetting:
    """Model and solver of one run in space.

    Parameters
    ----------
    tower_modes, torsion_modes, jib_lateral_modes, jib_vertical_modes : int
        0 for rigid; those of the tower count in both directions.
    planar : bool
        Whether all stays in the jib's vertical plane, along x.
    weight_softening : bool
    method : str
    rtol, atol : float
        As in :func:`towercrane.simulation.integrate.integrate`.
    """

    tower_modes: int = 0
    torsion_modes: int = 0
    jib_lateral_modes: int = 0
    jib_vertical_modes: int = 0
    planar: bool = False
    weight_softening: bool = True
    method: str = "dop853"
    rtol: float = 1e-8
    atol: float = 1e-10

    @property
    def counts(self) -> dict[str, int]:
        """Number of modes by kind."""
        return {kind: getattr(self, kind) for kind in KINDS}

    def with_counts(self, counts: Mapping[str, int]) -> SpaceSetting:
        """The same with other numbers of modes of some kinds."""
        changes: dict[str, Any] = dict(counts)
        return replace(self, **changes)

    def tightened(self, factor: float) -> SpaceSetting:
        """The same with tolerances times a factor below 1, as far down as they make sense."""
        return replace(self, rtol=max(factor * self.rtol, 1e-12), atol=max(factor * self.atol, 1e-14))


@dataclass(frozen=True, eq=False)
class SpaceScene(Scene[SpaceSetting]):
    """What happens to a crane in space.

    Parameters
    ----------
    crane, load, motions, duration, output_step, state, swing_angle, self_weight, rope_as_rod
        As of :class:`towercrane.accuracy.scene.Scene`; the motions also "slewing" or "shaft" [rad] and the wind's
        [m/s].
    damping : ModalDamping
    drive : Drive, optional
        What turns the head in place of the motion "slewing".
    drive_inertia : float
        [kg m^2]
    areas : WindAreas, optional
        What the wind meets; without it there is none.
    """

    damping: ModalDamping = field(default_factory=ModalDamping)
    drive: Drive | None = None
    drive_inertia: float = 0.0
    areas: WindAreas | None = None

    @property
    def outputs(self) -> dict[str, str]:
        """Outputs whose error can be asked for, and their units."""
        return SPACE

    @property
    def planar(self) -> bool:
        """Whether nothing drives the crane or the load out of the plane in which it starts, along x."""
        if self.drive is not None or self.areas is not None:
            return False
        return self.motions["slewing"].range() == (0.0, 0.0)

    @property
    def described(self) -> tuple[str, ...]:
        """Kinds of modes for which the crane has data."""
        return described(self.crane)

    def model(self, setting: SpaceSetting) -> FlexibleModel:
        """The crane in the setting's coordinates."""
        return model_in_space(
            self.crane,
            self.load,
            ModeCounts(*setting.counts.values()),
            planar=setting.planar,
            drive=self.drive,
            drive_inertia=self.drive_inertia,
            areas=self.areas,
            damping=self.damping,
            weight_softening=setting.weight_softening,
            self_weight=self.self_weight,
            rope_as_rod=self.rope_as_rod,
        )


def space_scene_of(case: Case, run: Run | None = None) -> SpaceScene:
    """The scene of a case in space, with the motions of a run of it where there is one."""
    tables = case.tables(SpaceCase)
    return SpaceScene(
        motions=motions_of(case) if run is None else run.motions,
        duration=tables.run.duration,
        output_step=tables.run.output_step,
        state="equilibrium" if tables.start.state == "equilibrium" else "zero",
        swing_angle=tables.start.swing_angle,
        **space_parts(tables),
    )


def space_setting_of(case: Case) -> SpaceSetting:
    """The setting that a case in space states."""
    tables = case.tables(SpaceCase)
    model, solver = tables.model, tables.solver
    plain = SpaceSetting(
        weight_softening=model.weight_softening, method=solver.method, rtol=solver.rtol, atol=solver.atol
    )
    return plain.with_counts({kind: getattr(model, kind) for kind in KINDS})

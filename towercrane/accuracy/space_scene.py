"""A scene in space: a crane, its load, what drives it and how it starts; all but the choice of the model."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from towercrane.accuracy.scene import Scene
from towercrane.cranes.tower.model import FlexibleModel
from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.results.measures import SPACE

if TYPE_CHECKING:
    from collections.abc import Mapping

    from towercrane.cases.case import Case
    from towercrane.cranes.parts.wind import WindAreas
    from towercrane.cranes.slewing.description import Drive
    from towercrane.motions.motion import Motion

KINDS = {
    "tower_modes": "bending of the tower",
    "torsion_modes": "torsion of the tower",
    "jib_lateral_modes": "bending of the jib to its sides",
    "jib_vertical_modes": "bending of the jib up and down",
}
"""Kinds of modes, by the field that counts them."""

IN_PLANE = ("tower_modes", "jib_vertical_modes")
"""Kinds that move in the jib's vertical plane."""


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
        missing = {"torsion_modes": self.crane.shaft is None, "jib_lateral_modes": self.crane.jib_lateral is None}
        return tuple(kind for kind in KINDS if not missing.get(kind, False))

    def model(self, setting: SpaceSetting) -> FlexibleModel:
        """The crane in the setting's coordinates."""
        from towercrane.cranes.tower.modes.modal_crane import ModeCounts, flexible_crane

        modes = ModeCounts(*setting.counts.values())
        return FlexibleModel(
            flexible_crane(self.crane, modes, self.areas, planes=1 if setting.planar else 2),
            self.load,
            slewing="fixed" if setting.planar else self.drive or "prescribed",
            drive_inertia=self.drive_inertia,
            damping=self.damping,
            weight_softening=setting.weight_softening,
            self_weight=self.self_weight,
            rope_as_rod=self.rope_as_rod,
            wind=self.areas is not None,
            axes=2 if setting.planar else 3,
        )


def space_scene_of(case: Case, motions: dict[str, Motion] | None = None) -> SpaceScene:
    """The scene of a case in space, with its own motions or others."""
    from towercrane.cranes.parts.wind import WindAreas
    from towercrane.cranes.slewing.description import Drive

    space, crane = case.space, case.space.crane
    model = space.model
    drive = None
    if crane.drive is not None and space.motion.shaft is not None:
        coupling, friction = crane.drive, crane.friction
        drive = Drive(
            "slewing", coupling.soft_stiffness, coupling.stiff_stiffness, coupling.corner, coupling.damping,
            friction.law, friction.torque, friction.rate,
        )  # fmt: skip
    return SpaceScene(
        crane=case.space_crane(),
        load=case.load(),
        motions=case.motions if motions is None else motions,
        duration=case.run.duration,
        output_step=case.run.output_step,
        state="equilibrium" if space.start.state == "equilibrium" else "zero",
        swing_angle=space.start.swing_angle,
        self_weight=space.start.state != "zero-no-self-weight",
        rope_as_rod=case.rope.slack == "rod",
        damping=ModalDamping(
            model.tower_damping_ratio,
            model.torsion_damping_ratio,
            model.jib_lateral_damping_ratio,
            model.jib_vertical_damping_ratio,
        ),
        drive=drive,
        drive_inertia=crane.drive.inertia if drive is not None and crane.drive is not None else 0.0,
        areas=WindAreas(**dict(crane.wind_areas)) if space.wind is not None else None,
    )


def space_setting_of(case: Case) -> SpaceSetting:
    """The setting that a case in space states."""
    model, solver = case.space.model, case.solver
    plain = SpaceSetting(
        weight_softening=model.weight_softening, method=solver.method, rtol=solver.rtol, atol=solver.atol
    )
    return plain.with_counts({kind: getattr(model, kind) for kind in KINDS})

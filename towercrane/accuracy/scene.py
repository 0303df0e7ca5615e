"""Scenes: a crane, its load, what drives it and how it starts; all but the choice of the model. The radial one."""

from __future__ import annotations

import warnings
from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Generic, Protocol, TypeVar

import numpy as np

from towercrane.cases.models import motions_of
from towercrane.cranes.parts.load import load_of
from towercrane.cranes.tower.file.build import radial_crane
from towercrane.cranes.tower.file.case_tables import RadialCase
from towercrane.cranes.tower.file.effects import softened
from towercrane.cranes.tower.planar import RadialModel
from towercrane.cranes.tower.targets import RADIAL
from towercrane.simulation.methods.method import EnergyDriftWarning
from towercrane.simulation.simulate import looks_per_row, record

if TYPE_CHECKING:
    from towercrane.cases.case import Case
    from towercrane.cranes.tower.modes.parameters import TowerCrane
    from towercrane.kernels.payload import Load
    from towercrane.motions.motion import Motion
    from towercrane.simulation.run import Run
    from towercrane.simulation.system import Model
    from towercrane.simulation.trajectory import Progress


class Solved(Protocol):
    """What a setting says of the solver, see :func:`towercrane.simulation.integrate.integrate`."""

    @property
    def method(self) -> str:
        """Its name."""

    @property
    def rtol(self) -> float:
        """Relative tolerance."""

    @property
    def atol(self) -> float:
        """Absolute tolerance."""


AnySetting = TypeVar("AnySetting", bound=Solved)


@dataclass(frozen=True, eq=False)
class Scene(ABC, Generic[AnySetting]):
    """What happens to a crane.

    Parameters
    ----------
    crane : TowerCrane
    load : Load
    motions : dict of str to Motion
        "trolley" and "rope" [m].
    duration : float
        [s]
    output_step : float
        [s]
    state : {"equilibrium", "zero"}
    swing_angle : float
        At the start [rad].
    self_weight, rope_as_rod : bool
        As in :class:`towercrane.cranes.tower.model.FlexibleModel`.
    """

    crane: TowerCrane
    load: Load
    motions: dict[str, Motion]
    duration: float
    output_step: float = 0.05
    state: str = "equilibrium"
    swing_angle: float = 0.0
    self_weight: bool = True
    rope_as_rod: bool = False

    @property
    @abstractmethod
    def outputs(self) -> dict[str, str]:
        """Outputs whose error can be asked for, and their units."""

    @abstractmethod
    def model(self, setting: AnySetting) -> Model:
        """The crane in the setting's coordinates."""

    def run(self, setting: AnySetting, *, progress: Progress | None = None) -> Run:
        """Simulate the scene, see :func:`towercrane.simulation.simulate.record`."""
        with warnings.catch_warnings():
            # What a loose tolerance damps is in the estimate.
            warnings.simplefilter("ignore", EnergyDriftWarning)
            return record(
                self.model(setting),
                self.motions,
                self.duration,
                output_step=self.output_step,
                looks=looks_per_row(self.duration, self.output_step),
                state=self.state,
                swing_angle=self.swing_angle,
                method=setting.method,
                rtol=setting.rtol,
                atol=setting.atol,
                progress=progress,
            )


@dataclass(frozen=True)
class Setting:
    """Model and solver of one run.

    Parameters
    ----------
    tower_modes, jib_modes : int
        0 for rigid.
    cap : float
        Highest frequency of a mode after the member's second [Hz], see
        :class:`towercrane.cranes.tower.model.FlexibleModel`.
    weight_softening : bool
    method : str
    rtol, atol : float
        As in :func:`towercrane.simulation.integrate.integrate`.
    """

    tower_modes: int
    jib_modes: int
    cap: float = np.inf
    weight_softening: bool = True
    method: str = "dop853"
    rtol: float = 1e-8
    atol: float = 1e-10


@dataclass(frozen=True, eq=False)
class RadialScene(Scene[Setting]):
    """What happens to a crane in radial motion.

    Parameters
    ----------
    crane, load, motions, duration, output_step, state, swing_angle, self_weight, rope_as_rod
        As of :class:`Scene`.
    tower_damping_ratio, jib_damping_ratio : float
        As in :class:`towercrane.cranes.tower.planar.RadialModel`.
    """

    tower_damping_ratio: float = 0.0
    jib_damping_ratio: float = 0.0

    @property
    def outputs(self) -> dict[str, str]:
        """Outputs whose error can be asked for, and their units."""
        return RADIAL

    def model(self, setting: Setting) -> RadialModel:
        """The crane in the setting's coordinates."""
        return RadialModel(
            self.crane,
            self.load,
            setting.tower_modes,
            setting.jib_modes,
            weight_softening=setting.weight_softening,
            tower_damping_ratio=self.tower_damping_ratio,
            jib_damping_ratio=self.jib_damping_ratio,
            self_weight=self.self_weight,
            rope_as_rod=self.rope_as_rod,
            cap=setting.cap,
        )


def scene_of(case: Case, run: Run | None = None) -> RadialScene:
    """The scene of a radial case, of what was built for a run of it where there is one."""
    tables = case.tables(RadialCase)
    model: Any = run and run.model
    return RadialScene(
        crane=radial_crane(tables) if model is None else model.crane,
        load=load_of(tables.payload) if model is None else model.load,
        motions=motions_of(case) if run is None else run.motions,
        duration=tables.run.duration,
        output_step=tables.run.output_step,
        state="equilibrium" if tables.start.state == "equilibrium" else "zero",
        swing_angle=tables.start.swing_angle,
        tower_damping_ratio=tables.model.tower_damping_ratio,
        jib_damping_ratio=tables.model.jib_damping_ratio,
        self_weight=tables.start.state != "zero-no-self-weight",
        rope_as_rod=tables.rope.slack == "rod",
    )


def setting_of(case: Case) -> Setting:
    """The setting that a radial case states."""
    tables = case.tables(RadialCase)
    model, solver = tables.model, tables.solver
    setting = Setting(model.tower_modes, model.jib_modes, weight_softening=softened(tables))
    return replace(setting, method=solver.method, rtol=solver.rtol, atol=solver.atol)


def provenance(setting: Solved) -> dict[str, Any]:
    """A setting for JSON; no cap is null."""
    return {key: None if value == np.inf else value for key, value in vars(setting).items()}

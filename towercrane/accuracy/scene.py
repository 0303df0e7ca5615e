"""Scenes: a crane, its load, what drives it and how it starts; all but the choice of the model."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from towercrane.accuracy.setting import Setting
from towercrane.cases.models import motions_of
from towercrane.cases.result_case import start_of
from towercrane.cranes.tower.crane_model import described, moving, tower_crane_model
from towercrane.cranes.tower.file.build import asked_modes, described_scene
from towercrane.cranes.tower.file.case_tables import TowerCase
from towercrane.cranes.tower.file.effects import softened
from towercrane.cranes.tower.file.plane import heading_of, stays_in_plane
from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.cranes.tower.modes.mode_counts import ModeCounts
from towercrane.cranes.tower.targets import ALL, FORETOLD, absent, lacking
from towercrane.simulation.methods.method import EnergyDriftWarning
from towercrane.simulation.simulate import looks_per_row, record
from towercrane.simulation.starts.start import HANGING, Start

if TYPE_CHECKING:
    from collections.abc import Iterable

    from towercrane.cases.case import Case
    from towercrane.cranes.parts.wind import WindAreas, WindNodes
    from towercrane.cranes.slewing.description import Drive
    from towercrane.cranes.tower.model import FlexibleModel
    from towercrane.cranes.tower.modes.parameters import TowerCrane
    from towercrane.cranes.tower.outputs.cut_sums import Section
    from towercrane.kernels.load import Load
    from towercrane.motions.motion import Motion
    from towercrane.simulation.run import Run
    from towercrane.simulation.trajectory import Progress


@dataclass(frozen=True, eq=False)
class Scene:
    """What happens to a tower crane.

    Parameters
    ----------
    crane : TowerCrane
    load : Load
    motions : dict of str to Motion
        "trolley" and "rope" [m]; where it leaves the plane also "slewing" or "shaft" [rad]; those of ground and
        floors [m], the wind's [m/s].
    duration : float
        [s]
    output_step : float
        [s]
    start : Start
    planar : bool
        Whether nothing drives crane and load out of the plane in which the jib stands.
    heading : float
        Angle of that plane from the fixed x axis [rad].
    damping : ModalDamping
    self_weight, rope_as_rod : bool
        As in :class:`towercrane.cranes.tower.model.FlexibleModel`.
    drive, drive_inertia, areas, nodes, ground, floors, sections
        As of :func:`towercrane.cranes.tower.crane_model.tower_crane_model`.
    """

    crane: TowerCrane
    load: Load
    motions: dict[str, Motion]
    duration: float
    output_step: float = 0.05
    start: Start = HANGING
    planar: bool = False
    heading: float = 0.0
    damping: ModalDamping = field(default_factory=ModalDamping)
    self_weight: bool = True
    rope_as_rod: bool = False
    drive: Drive | None = None
    drive_inertia: float = 0.0
    areas: WindAreas | None = None
    nodes: WindNodes | None = None
    ground: bool = False
    floors: int = 0
    sections: tuple[Section, ...] = ()

    @property
    def outputs(self) -> dict[str, str]:
        """Outputs whose error can be measured, and their units."""
        bars = self.crane.tie_bars
        ties = (0, 0) if bars is None else (len(bars.jib), len(bars.counter_jib))
        none = lacking(self.crane.luffing is not None, *ties)
        still = absent(self.heading) if self.planar else ()
        return {name: unit for name, unit in ALL.items() if name not in none and name not in still}

    @property
    def laddered(self) -> bool:
        """Whether runs of ever richer models alone tell errors.

        Small motions about an undeformed crane are none of one that hangs on ties or whose jib pivots, and do not
        tell when a tower meets a collar with play.
        """
        return self.crane.luffing is not None or self.crane.tie_bars is not None or bool(self.crane.gapped)

    @property
    def described(self) -> tuple[str, ...]:
        """Kinds of modes for which the crane has data."""
        return described(self.crane)

    def foretells(self, outputs: Iterable[str]) -> bool:
        """Whether small motions foretell the error of these outputs, so that nothing is run to choose a setting.

        They know bending of tower and jib, and loads that are let go: where the counter-jib bends too, or the load
        moves at the start, a run is asked.
        """
        bends = self.crane.counter_jib is not None
        let_go = self.start.state != "quiet" and not self.start.along_rate
        told = self.planar and not self.laddered and not bends and self.areas is None and not self.ground and let_go
        return told and set(outputs) <= set(FORETOLD)

    def model(self, setting: Setting) -> FlexibleModel:
        """The crane in the setting's coordinates."""
        return tower_crane_model(
            self.crane,
            self.load,
            ModeCounts(*setting.counts.values()),
            planar=setting.planar,
            heading=self.heading,
            drive=self.drive,
            drive_inertia=self.drive_inertia,
            areas=self.areas,
            nodes=self.nodes,
            ground=self.ground,
            floors=self.floors,
            sections=self.sections,
            damping=self.damping,
            weight_softening=setting.weight_softening,
            self_weight=self.self_weight,
            rope_as_rod=self.rope_as_rod,
            cap=setting.cap,
        )

    def run(self, setting: Setting, *, progress: Progress | None = None) -> Run:
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
                start=self.start,
                method=setting.method,
                rtol=setting.rtol,
                atol=setting.atol,
                progress=progress,
            )


def scene_of(case: Case, run: Run | None = None) -> Scene:
    """The scene of a tower crane's case, of what was built for a run of it where there is one."""
    tables = case.tables(TowerCase)
    model: Any = run and run.model
    heading = heading_of(tables)
    return Scene(
        motions=motions_of(case) if run is None else run.motions,
        duration=tables.run.duration,
        output_step=tables.run.output_step,
        start=start_of(case),
        planar=heading is not None,
        heading=heading or 0.0,
        **described_scene(tables, None if model is None else model.crane.written),
    )


def setting_of(case: Case) -> Setting:
    """The setting that a case states; in the plane it has no modes that leave it."""
    tables = case.tables(TowerCase)
    planar, solver = stays_in_plane(tables), tables.solver
    plain = Setting(planar=planar, method=solver.method, rtol=solver.rtol, atol=solver.atol)
    asked = asked_modes(tables)
    counts = {kind: asked[kind] for kind in moving(planar)}
    return replace(plain.with_counts(counts), weight_softening=softened(tables))

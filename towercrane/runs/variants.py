"""The runs of a sweep, each built as a single run builds it: its checked case, its model and its motions."""

from __future__ import annotations

import dataclasses
import itertools
import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.accuracy.promise import targets_of
from towercrane.cases.case import load_case
from towercrane.cases.models import model_of, motions_of
from towercrane.cranes.registry import KINDS
from towercrane.motions.motion import phases
from towercrane.schema.faults import CaseError
from towercrane.simulation.methods.registry import METHODS

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping, Sequence

    from towercrane.cases.case import Case
    from towercrane.cranes.kind import Lane
    from towercrane.simulation.lanes.crane import LaneCrane, LaneRun

    Value = float | int | str

LOAD, ROPE = "payload.mass", "rope.length"
"""Keys of which a plain case needs no reading for every value, see :meth:`Variants.plain`."""


@dataclass(frozen=True, eq=False)
class Variant:
    """One run of a sweep.

    Parameters
    ----------
    case : Case
        Its case; of runs that differ in load and rope alone the same one may stand for all.
    lane : LaneRun, optional
        Its model and motions, where it can run in vector lanes.
    shared : Lane, optional
        What it shares with others there.
    """

    case: Case
    lane: LaneRun | None = None
    shared: Lane | None = None

    @property
    def company(self) -> tuple[Any, ...]:
        """What runs that share lanes have in common."""
        assert self.lane is not None, "only runs in lanes have company"
        assert self.shared is not None
        run, solver, system = self.case.run, self.case.solver, self.lane.model.system
        steps = run.duration, run.output_step, solver.method, solver.rtol, solver.atol
        return (self.shared.crane, *steps, system.size, system.tables.shape, system.tables.tobytes())


class Variants:
    """The runs of a sweep by number.

    A key that varies may change anything: modes, shaped ramps, what a tolerance leaves out, what is checked. So every
    run is read and built from its own case. Only what equal data give is shared.

    Parameters
    ----------
    case : Case
    values : mapping of str to sequence
        For every key as many values as there are runs.
    """

    def __init__(self, case: Case, values: Mapping[str, Sequence[Value]]) -> None:
        self._case, self._values = case, values
        self._quick = [key for key in (LOAD, ROPE) if key in values]
        self._slow = [key for key in values if key not in self._quick]
        self._members: dict[tuple[Value, ...], list[int]] = {}
        for run in range(len(self)):
            self._members.setdefault(self._combination(run), []).append(run)
        self._plain: dict[tuple[Value, ...], Variant | None] = {}
        self._models: dict[str, Any] = {}

    def __len__(self) -> int:
        return len(next(iter(self._values.values())))

    def __getitem__(self, run: int) -> Variant:
        """A run's case and model.

        Raises
        ------
        CaseError
            If it is one that a single run refuses.
        """
        combination = self._combination(run)
        if combination not in self._plain:
            self._plain[combination] = self._plain_one(self._members[combination])
        plain = self._plain[combination]
        return self._read(self._changes(run, self._values)) if plain is None else self._altered(plain, run)

    def case_of(self, run: int) -> Case:
        """A run's own case, read anew."""
        return load_case(self._case.path, [*self._case.changes, *self._changes(run, self._values)])

    def _combination(self, run: int) -> tuple[Value, ...]:
        return tuple(self._values[key][run] for key in self._slow)

    def _changes(self, run: int, keys: Mapping[str, Any] | Sequence[str]) -> list[str]:
        return [change(key, self._values[key][run]) for key in keys]

    def _read(self, changes: list[str]) -> Variant:
        case = load_case(self._case.path, [*self._case.changes, *changes])
        shared = lane_of(case)
        return Variant(case, self._lane(case, shared.crane), shared) if shared else Variant(case)

    def _lane(self, case: Case, crane: LaneCrane) -> LaneRun:
        from towercrane.simulation.lanes.crane import LaneRun

        model: Any = model_of(case)
        motions = motions_of(case, model)
        model = self._models.setdefault(crane.alike(model), model).with_load(model.load)
        cut = phases(tuple(motions[channel] for channel in model.channels), case.run.duration)
        state = "equilibrium" if case.start.state == "equilibrium" else "zero"
        return LaneRun(model, cut, state, case.start.swing_angle)

    def _plain_one(self, runs: list[int]) -> Variant | None:
        """A run that differs from these in its load and its resting rope alone; None if they differ in more.

        Loads and lengths that a case allows lie between two bounds: where the corners of a box are allowed, so is
        all within.
        """
        if not self._quick or len(runs) <= 2 ** len(self._quick):
            return None
        columns = (np.array([self._values[key][run] for run in runs], dtype=float) for key in self._quick)
        bounds = [(float(column.min()), float(column.max())) for column in columns]
        fixed, found = self._changes(runs[0], self._slow), None
        for corner in itertools.product(*bounds):
            settings = [change(key, value) for key, value in zip(self._quick, corner, strict=True)]
            try:
                found = self._read([*fixed, *settings])
            except CaseError:
                return None
            shaped = any(plan.needs_model for plan in found.case.plans.values())
            if found.shared is None or not found.shared.plain or shaped:
                return None
        return found

    def _altered(self, plain: Variant, run: int) -> Variant:
        """The plain variant with a run's own load and rope."""
        lane = plain.lane
        assert lane is not None, "what is plain runs in lanes"
        model, cut = lane.model, lane.phases
        if LOAD in self._quick:
            model = model.with_load(dataclasses.replace(model.load, mass=float(self._values[LOAD][run])))
        if ROPE in self._quick:
            cut = cut.moved(model.channels.index("rope"), float(self._values[ROPE][run]))
        return dataclasses.replace(plain, lane=dataclasses.replace(lane, model=model, phases=cut))


def varied_case(path: str | os.PathLike[str], changes: Sequence[str], varied: Sequence[str]) -> Case:
    """The case whose values vary; what it lacks by itself it may take from the first run.

    Parameters
    ----------
    path : path-like
        What :func:`towercrane.load_case` takes.
    changes : sequence of str
        Its own overrides.
    varied : sequence of str
        Overrides of the first run.

    Raises
    ------
    CaseError
        If neither the case nor its first run can be read.
    """
    try:
        return load_case(path, changes)
    except CaseError:
        return dataclasses.replace(load_case(path, [*changes, *varied]), changes=tuple(changes))


def change(key: str, value: Value) -> str:
    """Override that sets a key."""
    return f"{key}={value if isinstance(value, str) else json.dumps(value)}"


def lane_of(case: Case) -> Lane | None:
    """How a run can share lanes; one that chooses its own model and tolerance for an error cannot."""
    lane = KINDS[case.kind].lane
    if lane is None or not METHODS[case.solver.method].compiled or targets_of(case):
        return None
    return lane(case.checked)

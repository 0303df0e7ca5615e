"""The runs of a sweep, each built as a single run builds it: its checked case, its model and its motions."""

from __future__ import annotations

import dataclasses
import itertools
import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cases.case import load_case
from towercrane.cases.models import model_of, motions_of, targets_of
from towercrane.cases.result_case import start_of
from towercrane.cases.wind_file import rises_until
from towercrane.cranes.registry import KINDS
from towercrane.kernels.straight.leaves import known_of
from towercrane.motions.motion import phases
from towercrane.schema.faults import CaseError
from towercrane.simulation.methods.registry import METHODS

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping, Sequence

    from towercrane.cases.case import Case
    from towercrane.simulation.lanes.run import LaneRun

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
    run : LaneRun, optional
        Its model and motions as lanes take them; none where a run chooses its own for an error that is asked for.
    """

    case: Case
    run: LaneRun | None = None

    @property
    def fits_lanes(self) -> bool:
        """Whether it can run in vector lanes."""
        return self.run is not None and METHODS[self.case.solver.method].compiled

    @property
    def company(self) -> tuple[Any, ...]:
        """What runs that share lanes have in common."""
        assert self.run is not None, "only runs in lanes have company"
        run, solver, model = self.case.run, self.case.solver, self.run.model
        looks = run.duration, run.output_step, rises_until(self.case.checked)
        system, steps = model.system, (*looks, solver.method, solver.rtol, solver.atol)
        equations = system.equations, system.size, known_of(system.constants), system.table.tobytes()
        return (*steps, *equations, known_of(model.seen))


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
        # A run that chooses its own model and tolerance for an error builds what it needs.
        return Variant(case) if targets_of(case) else Variant(case, self._run(case))

    def _run(self, case: Case) -> LaneRun:
        from towercrane.simulation.lanes.run import LaneRun

        model: Any = model_of(case)
        motions, made_of = motions_of(case, model), KINDS[case.kind].made_of
        if made_of is not None:
            model = self._models.setdefault(made_of(model), model).with_load(model.load)
        cut = phases(tuple(motions[channel] for channel in model.channels), case.run.duration)
        by_value = getattr(model, "value_channels", ())
        means = {model.channels.index(channel): motions[channel].mean for channel in by_value}
        run = LaneRun(model, cut, start_of(case, model, motions), means)
        return dataclasses.replace(run, model=model.standing(run.start_inputs))

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
            plain = KINDS[found.case.kind].plain
            if not found.fits_lanes or shaped or plain is None or not plain(found.case.checked):
                return None
        return found

    def _altered(self, plain: Variant, run: int) -> Variant:
        """The plain variant with a run's own load and rope."""
        lane = plain.run
        assert lane is not None, "what is plain runs in lanes"
        model: Any = lane.model
        cut = lane.phases
        if LOAD in self._quick:
            model = model.with_load(dataclasses.replace(model.load, mass=float(self._values[LOAD][run])))
        if ROPE in self._quick:
            cut = cut.moved(model.channels.index("rope"), float(self._values[ROPE][run]))
        return dataclasses.replace(plain, run=dataclasses.replace(lane, model=model, phases=cut))


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

"""What holds for a run in a lane at the start of a phase and after a guard: equations switch, rates jump."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.kernels.straight.leaves import changing
from towercrane.motions.motion import SAME_INSTANT
from towercrane.simulation.guards import MOST_RETAKES, MOST_STALLED
from towercrane.simulation.lanes.queue import (
    ASKS,
    BEGIN,
    BEGINS,
    CROSSED,
    FIRST_GUARD,
    FULL,
    NOTHING,
    PHASE,
    RETAKEN,
    RUN,
    STALLED,
    TIME,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from towercrane.kernels.straight.written import Written
    from towercrane.simulation.lanes.queue import Answers, Lanes, Queue
    from towercrane.simulation.lanes.run import LaneRun

    Floats = NDArray[np.float64]


def retakes(run: LaneRun) -> int:
    """How often a step of a run is taken anew up to a guard: where one ends the run, nothing goes on from there."""
    return 0 if run.model.system.switch is None else MOST_RETAKES


def asks(run: LaneRun) -> bool:
    """Whether a run has such events."""
    return run.model.system.switch is not None or run.model.system.crossings is not None


class Events:
    """Events of the runs in some lanes; :meth:`towercrane.simulation.methods.runge_kutta.RungeKutta.carry` has those
    of a single one.

    Parameters
    ----------
    runs : sequence of LaneRun
    queue, answers, lanes
        See :mod:`towercrane.simulation.lanes.queue`.
    code : Written
        Equations of the runs.
    """

    def __init__(self, runs: Sequence[LaneRun], queue: Queue, answers: Answers, lanes: Lanes, code: Written) -> None:
        self.runs, self.queue, self.answers, self.lanes = runs, queue, answers, lanes
        self.rhs = code.rhs()
        count = lanes.places.shape[1]
        self.last, self.stalled = np.zeros(count), np.zeros(count, dtype=int)
        model = runs[0].model
        # What a switch changes of the equations' numbers is among those of the outputs too.
        self.changed = list(zip(changing(model.system.constants), changing(model.seen), strict=True))

    def attend(self) -> None:
        """Answer all lanes that ask."""
        places = self.lanes.places
        for lane in np.flatnonzero((places[RUN] >= 0) & (places[ASKS] != NOTHING)).tolist():
            if places[ASKS, lane] == BEGINS:
                self._begin(lane)
            elif not self._cross(lane):
                self._end(lane)
            places[ASKS, lane] = NOTHING

    def _begin(self, lane: int) -> None:
        lanes, queue = self.lanes, self.queue
        run, phase = (int(lanes.places[row, lane]) for row in (RUN, PHASE))
        system = self.runs[run].model.system
        self.last[lane], self.stalled[lane] = 0.0, 0
        if phase and system.crossings is not None:
            before, after = queue.inputs[run, phase - 1], queue.inputs[run, phase]
            if system.crossings.crossed(before, after):
                span = float(queue.phase_times[run, phase] - queue.phase_times[run, phase - 1])
                lanes.y[:, lane] = system.crossings.leap(lanes.y[:, lane].copy(), before, span, after)
        self._set(lane, guard=-1)

    def _cross(self, lane: int) -> bool:
        lanes = self.lanes
        now = float(lanes.clock[TIME, lane])
        self.stalled[lane] = self.stalled[lane] + 1 if now - self.last[lane] < SAME_INSTANT else 0
        self.last[lane] = now
        lanes.clock[FULL, lane], lanes.places[RETAKEN, lane] = 0.0, 0
        return self.stalled[lane] <= MOST_STALLED and self._set(lane, int(lanes.places[CROSSED, lane]))

    def _set(self, lane: int, guard: int) -> bool:
        """Let a switch set what holds, after a guard or without one; False if the run ends there."""
        lanes = self.lanes
        switch = self.runs[lanes.places[RUN, lane]].model.system.switch
        if switch is None:
            return guard < 0
        y, numbers, floors = (own[:, lane].copy() for own in (lanes.y, lanes.numbers, lanes.floors))
        inputs, time = np.ascontiguousarray(lanes.inputs[..., lane]), float(lanes.clock[TIME, lane])
        slope, guards = np.empty(len(y)), np.empty(len(floors))

        def guards_at() -> Floats:
            self.rhs(time, y, slope, inputs, numbers, self.queue.tables, guards)
            return guards

        goes_on = True
        if guard < 0:
            switch.begin(y, numbers, floors, guards_at)
        else:
            goes_on = switch.cross(guard, y, numbers, floors, guards_at)
        for place, seen in self.changed:
            lanes.seen[seen, lane] = numbers[place]
        lanes.y[:, lane], lanes.numbers[:, lane], lanes.floors[:, lane] = y, numbers, floors
        return goes_on

    def _end(self, lane: int) -> None:
        lanes, answers = self.lanes, self.answers
        run, guard = int(lanes.places[RUN, lane]), int(lanes.places[CROSSED, lane])
        answers.outcomes[run] = STALLED if self.stalled[lane] > MOST_STALLED else FIRST_GUARD + guard
        answers.end_times[run] = lanes.clock[BEGIN, lane] + lanes.clock[TIME, lane]
        answers.end_states[run] = lanes.y[:, lane]
        lanes.places[RUN, lane] = -1

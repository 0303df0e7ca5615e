"""Looks inside the steps of many runs side by side: samples, and guards that have fallen."""

from __future__ import annotations

from modal.compiler.kinds import LaneRow, LaneTable, Number, Row, Stack, Table, Whole
from modal.compiler.lanes import LANES
from towercrane.simulation.guards import CLOSE, LATE, NARROWEST, ROUGHLY, SOON, is_near
from towercrane.simulation.lanes.queue import (
    ACCEPTED,
    ACCEPTED_STEP,
    BEGIN,
    CROSSED,
    END,
    FRACTION,
    FULL,
    HIGH,
    LARGEST,
    LARGEST_TIME,
    LOW,
    MOMENT,
    REJECTED,
    RETAKEN,
    RUN,
    SAMPLE,
    SAMPLES_END,
    SMALLEST,
    SMALLEST_TIME,
    STEP,
    STOP,
    SUSPECT,
    TIME,
    TRIAL,
    WRITTEN,
)


def fallen(guards: Table, floors: Table, lane: int) -> int:
    """Index of a lane's first guard below its floor, or -1."""
    for g in range(guards.shape[0]):
        if guards[g, lane] < floors[g, lane]:
            return g
    return -1


def near(lowest: Table, highest: Table, floors: Table, part: float, lane: int) -> bool:
    """Whether one of a lane's guards is closer to its floor than that part of its range in a step."""
    found = False
    for g in range(floors.shape[0]):
        found = found or is_near(lowest[g, lane], highest[g, lane], floors[g, lane], part)
    return found


def wants_sample(places: Whole, clock: Table, sample_times: Row, lane: int) -> bool:
    """Whether a lane's accepted step reaches its next sample; if so, where in the step that is."""
    clock[FRACTION, lane] = 0.0
    sample = places[SAMPLE, lane]
    if clock[ACCEPTED_STEP, lane] == 0.0 or sample >= places[SAMPLES_END, lane]:
        return False
    moment = min(sample_times[sample] - clock[BEGIN, lane], clock[END, lane])
    if moment > clock[STOP, lane]:
        return False
    clock[FRACTION, lane] = (moment - clock[TIME, lane]) / clock[TRIAL, lane]
    clock[MOMENT, lane] = moment
    return True


def wanted_samples(places: Whole, clock: Table, sample_times: Row) -> int:
    """Lanes whose steps reach another sample, as bits."""
    wanted = 0
    for lane in range(LANES):
        if wants_sample(places, clock, sample_times, lane):
            wanted |= 1 << lane
    return wanted


def record(
    lane_values: Table, wanted: int, places: Whole, counts: Whole, sample_times: Row, extremes: Stack, series: Stack
) -> None:
    """Keep the wanted lanes' outputs where they are extremes of their runs so far; go to the next samples.

    ``lane_values`` has a row per output.
    """
    for lane in range(LANES):
        if not wanted >> lane & 1:
            continue
        run, sample = places[RUN, lane], places[SAMPLE, lane]
        places[SAMPLE, lane] += 1
        counts[run, WRITTEN] += 1
        time = sample_times[sample]
        for output in range(extremes.shape[1]):
            value = lane_values[output, lane]
            if value > extremes[run, output, LARGEST]:
                extremes[run, output, LARGEST] = value
                extremes[run, output, LARGEST_TIME] = time
            if value < extremes[run, output, SMALLEST]:
                extremes[run, output, SMALLEST] = value
                extremes[run, output, SMALLEST_TIME] = time
            if series.shape[0]:
                series[run, sample, output] = value


def dense_states(y: LaneRow, dense: Table, k: LaneTable, h: Number, x: Number, out: LaneRow) -> None:
    """State of every lane at its own fraction x of its step h; all of lane vectors but ``dense``."""
    for m in range(y.size):
        out[m] = 0.0
    for i in range(dense.shape[0]):
        used = False
        for d in range(dense.shape[1]):
            used = used or dense[i, d] != 0.0
        if used:
            weight: Number = 0.0
            for d in range(dense.shape[1] - 1, -1, -1):
                weight = (weight + dense[i, d]) * x
            for m in range(y.size):
                out[m] += weight * k[i, m]
    for m in range(y.size):
        out[m] = y[m] + h * out[m]


def look_along(places: Whole, clock: Table, look: int, few: int) -> int:
    """Lanes with a guard near its floor that look at this of a few points of their steps, as bits."""
    looking = 0
    for lane in range(LANES):
        if look <= few and clock[ACCEPTED_STEP, lane] and places[SUSPECT, lane]:
            looking |= 1 << lane
        clock[FRACTION, lane] = look / few
        clock[MOMENT, lane] = clock[TIME, lane] + clock[FRACTION, lane] * clock[TRIAL, lane]
    return looking


def keep_close(places: Whole, lowest: Table, highest: Table, floors: Table) -> None:
    """Suspect only lanes with a guard that has come close to its floor."""
    for lane in range(LANES):
        if places[SUSPECT, lane]:
            places[SUSPECT, lane] = near(lowest, highest, floors, CLOSE, lane)


def anew(places: Whole, clock: Table, retakes: int, lane: int) -> bool:
    """Whether a lane's step is taken anew up to the guard that fell, as in a single run."""
    inside = SOON < clock[HIGH, lane] < LATE
    return bool(places[CROSSED, lane] >= 0 and places[RETAKEN, lane] < retakes and inside)


def look_for_falls(places: Whole, clock: Table, looks: int, retakes: int) -> int:
    """Lanes that have to look once more for the fall of a guard close to its floor, as bits, and where in steps.

    The bracket is empty before the first look. It moves along the step, and is halved once a guard has fallen at
    its upper end.
    """
    looking = 0
    for lane in range(LANES):
        clock[FRACTION, lane] = 0.0
        if clock[ACCEPTED_STEP, lane] == 0.0 or not places[SUSPECT, lane]:
            continue
        if places[CROSSED, lane] < 0:
            part = round(clock[HIGH, lane] * looks) + 1
            if part > looks:
                continue
            clock[FRACTION, lane] = part / looks
        elif clock[HIGH, lane] - clock[LOW, lane] > (
            ROUGHLY * clock[HIGH, lane] if anew(places, clock, retakes, lane) else NARROWEST
        ):
            clock[FRACTION, lane] = 0.5 * (clock[LOW, lane] + clock[HIGH, lane])
        else:
            continue
        clock[MOMENT, lane] = clock[TIME, lane] + clock[FRACTION, lane] * clock[TRIAL, lane]
        looking |= 1 << lane
    return looking


def note_looks(looking: int, places: Whole, clock: Table, guards: Table, floors: Table, looks: int) -> None:
    """Narrow or move the brackets of the looking lanes by what their guards were."""
    for lane in range(LANES):
        if not looking >> lane & 1:
            continue
        guard, at = fallen(guards, floors, lane), clock[FRACTION, lane]
        if guard >= 0:
            if places[CROSSED, lane] < 0:
                clock[LOW, lane] = (round(at * looks) - 1.0) / looks
            clock[HIGH, lane] = at
            places[CROSSED, lane] = guard
        elif places[CROSSED, lane] < 0:
            clock[HIGH, lane] = at
        else:
            clock[LOW, lane] = at


def cut_steps(places: Whole, clock: Table, states: Table, new: Table, counts: Whole, retakes: int) -> None:
    """Let the steps in which a guard fell end there, in these states, or be taken anew up to there."""
    for lane in range(LANES):
        if clock[ACCEPTED_STEP, lane] and places[SUSPECT, lane] and anew(places, clock, retakes, lane):
            run = places[RUN, lane]
            counts[run, ACCEPTED] -= 1
            counts[run, REJECTED] += 1
            clock[FULL, lane] = max(clock[FULL, lane], clock[TRIAL, lane])
            clock[STEP, lane] = clock[HIGH, lane] * clock[TRIAL, lane]
            clock[ACCEPTED_STEP, lane] = 0.0
            places[RETAKEN, lane] += 1
        elif clock[ACCEPTED_STEP, lane] and places[CROSSED, lane] >= 0:
            clock[STOP, lane] = clock[TIME, lane] + clock[HIGH, lane] * clock[TRIAL, lane]
            for m in range(new.shape[0]):
                new[m, lane] = states[m, lane]

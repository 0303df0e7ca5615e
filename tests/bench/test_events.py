"""Random short runs of every kind, full of events: a sample of what the benchmark runs by the thousand."""

from dataclasses import replace

import numpy as np
import pytest

from towercrane.bench.runs import events
from towercrane.bench.scenes import drawn_events
from towercrane.motions.motion import rest


@pytest.fixture(scope="module")
def sample():
    return list(drawn_events.event_scenes(42, 3))


def test_each_run_ends_as_a_second_method_says_and_keeps_its_energy(sample):
    found = [(scene, events.judged(scene)) for scene in sample]
    assert [record["why"] for _, record in found if record["why"]] == []
    assert {record["outcome"] for _, record in found} == {"finished", "slack rope"}
    assert {scene.kind for scene in sample} == set(drawn_events.SCENE_KINDS)
    assert max(record["gap"] for _, record in found) < 1e-5
    assert max(record["difference"] for _, record in found) < 1e-4


@pytest.mark.parametrize("number", [21, 112, 274])
def test_what_lies_behind_a_guard_does_not_reach_the_step_that_ends_there(number):
    """A platform that sticks while the shaft turns beyond the coupling's corner: nothing moves but the work."""
    scene = list(drawn_events.event_scenes(number + 1, 7))[number]
    run = events._run(scene, "dopri5", 1e-9)
    energy = run["total_energy"].values
    assert run.attrs["outcome"] == "finished"
    assert abs(energy - energy[0] - run["input_work"].values).max() < 1e-7 * np.ptp(energy)


def test_rows_switches_and_ends_meet(sample):
    for scene in sample:
        for time in (scene.duration, *(t for m in scene.motions.values() for t in m.switch_times)):
            assert time / drawn_events.TICK == pytest.approx(round(time / drawn_events.TICK), abs=1e-9)


def test_what_goes_wrong_is_named(sample, monkeypatch):
    scene = next(s for s in sample if s.kind == "radial" and events.judged(s)["outcome"] == "finished")
    other = replace(scene, motions=scene.motions | {"rope": rest(1.3 * float(scene.motions["rope"](0.0)))})
    run = events._run
    monkeypatch.setattr(events, "_run", lambda s, method, rtol: run(other if method == "dopri5" else s, method, rtol))
    assert events.judged(scene)["why"].endswith("off dopri5")
    monkeypatch.setattr(events, "LARGEST_GAP", 0.0)
    assert events.judged(scene)["why"].startswith("energy off by")


def test_the_table_has_a_row_for_each_kind(monkeypatch):
    monkeypatch.setattr(events, "QUICK_RUNS", 7)
    subject = events.event_runs(quick=True)
    assert [row[:2] for row in subject["rows"]] == [[kind, "1"] for kind in drawn_events.SCENE_KINDS]
    assert subject["records"] == []

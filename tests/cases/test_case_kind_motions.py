"""The door for slewing and jib cranes: motions, in angles where they turn."""

import json
import math
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from samples.case_files import MULTI, PLAN, RADIAL, copy_case, only_fault

from towercrane.cases.case import load_case
from towercrane.cases.models import motions_of
from towercrane.motions.motion import phases
from towercrane.motions.profiles import smooth_ramps, speed_trapezoid, trapezoid


@pytest.fixture
def copied(tmp_path):
    return partial(copy_case, tmp_path)


# Motions


@pytest.mark.parametrize("speed", [0.738, -0.738])
@pytest.mark.parametrize("hold", [8.0, 0.0])
def test_a_speed_trapezoid_is_the_trapezoid_with_that_way(speed, hold):
    motion = speed_trapezoid(1.0, speed, 0.71, hold)
    same = trapezoid(1.0, 1.0 + speed * (0.71 + hold), abs(speed), abs(speed) / 0.71)
    times = np.linspace(-1.0, 12.0, 500)
    assert motion(times) == pytest.approx(same(times), abs=1e-14)
    assert motion(times, 1) == pytest.approx(same(times, 1), abs=1e-14)


@pytest.mark.parametrize("hold", [6.0, 0.0])
def test_smooth_ramps_follow_the_quintic_step(hold):
    motion = smooth_ramps(2.0, -0.5, 4.0, hold)
    times = np.linspace(0.0, 15.0, 301)

    def step(x):
        x = np.clip(x, 0.0, 1.0)
        return x**3 * (10 - 15 * x + 6 * x**2)

    assert motion(times, 1) == pytest.approx(-0.5 * (step(times / 4) - step((times - 4 - hold) / 4)), abs=1e-13)
    assert motion.end == pytest.approx(2.0 - 0.5 * (4 + hold), rel=1e-15)
    assert motion.range() == pytest.approx((motion.end, 2.0))
    assert motion.range(2) == pytest.approx((-0.5 * 1.875 / 4, 0.5 * 1.875 / 4))
    assert phases((motion,), 20.0).inputs.shape[2] == 7


@pytest.mark.parametrize(("ramp", "hold"), [(0.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (math.nan, 1.0)])
def test_ramps_refuse_impossible_times(ramp, hold):
    for build in (speed_trapezoid, smooth_ramps):
        with pytest.raises(ValueError, match=r"(ramp|hold): wanted"):
            build(0.0, 1.0, ramp, hold)


SHAPES = {
    "rest": ({"start": "90 deg"}, (math.pi / 2, math.pi / 2)),
    "trapezoid": ({"end": "1 rev", "speed": "7 rpm", "acceleration": 0.1}, (0.0, 2 * math.pi)),
    "s-curve": ({"end": "-90 deg", "speed": "6 deg/s", "acceleration": 0.1, "jerk": 1}, (-math.pi / 2, 0.0)),
    "speed-trapezoid": ({"speed": "-6 rpm", "ramp": "1 s", "hold": "9 s"}, (-2 * math.pi, 0.0)),
    "smooth": ({"speed": "6 rpm", "ramp": "1 s", "hold": "9 s", "start": 1, "delay": 3}, (1.0, 1.0 + 2 * math.pi)),
    "sequence": ({"start": "10 deg", "steps": [
        {"shape": "trapezoid", "end": "60 deg", "speed": 0.1, "acceleration": 0.1},
        {"shape": "rest", "duration": 3},
        {"shape": "smooth", "speed": "-0.1 rad/s", "ramp": 1, "hold": 0},
    ]}, (math.radians(10), math.radians(60))),
}  # fmt: skip


def toml(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{k} = {toml(v)}" for k, v in value.items()) + " }"
    return f"[{', '.join(map(toml, value))}]" if isinstance(value, list) else json.dumps(value)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(("case", "joint"), [(MULTI, "shaft"), (PLAN, "slew")])
def test_joints_take_every_shape_in_angles(case, joint, shape):
    keys, extent = SHAPES[shape]
    motion = motions_of(load_case(case, [f"motion.{joint}={toml({'shape': shape} | keys)}"]))[joint]
    assert motion.range() == pytest.approx(extent)


def test_a_table_of_angles(copied, tmp_path):
    path = copied(PLAN)
    setting = 'motion.slew={ shape = "table", file = "turn.csv" }'
    (tmp_path / "turn.csv").write_text("t,angle\n0,1\n10,2\n20,2.5\n")
    assert motions_of(load_case(path, [setting]))["slew"].end == pytest.approx(2.5)
    (tmp_path / "turn.csv").write_text("t,angle\n0,0\n10,90\n")
    fault = only_fault(path, setting)
    assert (fault.key, fault.wanted) == ("motion.slew.file", "speeds up to 5 rad/s")
    assert "radians?" in fault.hint
    (tmp_path / "turn.csv").write_text("t,angle\n0,0\n10,x\n")
    fault = only_fault(path, setting)
    assert (Path(fault.file).name, fault.key) == ("turn.csv", "line 3")
    assert "seconds and radians" in fault.hint


@pytest.mark.parametrize("case", [MULTI, PLAN])
def test_hoisting_takes_the_new_shapes(case):
    hoist = 'motion.hoist={ shape = "smooth", speed = "-6 m/min", ramp = 1, hold = 4 }'
    rope = motions_of(load_case(case, [hoist]))["rope"]
    assert float(rope(0.0)) - rope.end == pytest.approx(0.5)
    too_far = hoist.replace("hold = 4", "hold = 400")
    assert "above 0" in only_fault(case, too_far).wanted


def test_trolleys_take_the_new_shapes():
    move = 'motion.trolley={ shape = "speed-trapezoid", start = 5, speed = 0.5, ramp = 2, hold = 10 }'
    assert motions_of(load_case(RADIAL, [move]))["trolley"].end == pytest.approx(11.0)
    assert "a motion from 5 to 66 m" in only_fault(RADIAL, move.replace("hold = 10", "hold = 120")).got

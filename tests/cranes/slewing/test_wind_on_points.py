"""Wind on cranes of point masses: forces by hand, rest in it, work of a crane that turns in it."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from towercrane.cases.case import load_case
from towercrane.cranes.slewing.equations import Body, Motion, drag_on
from towercrane.runs.run import record_case

STANDS = ['motion.shaft={shape="rest", start="40 deg"}', "run.duration=1 s"]
BLOWN = ["wind.speed=15 m/s", "wind.direction=60 deg", "wind.upward=1 m/s"]
AREAS = ["crane.drag.jib_tip=3 kg/m", "payload.drag=1.2 kg/m"]


def run(kind, *changes):
    return record_case(load_case(f"slewing/{kind}/example-1", [*BLOWN, *AREAS, *changes]))


@pytest.mark.parametrize(("kind", "profile"), [("multi-mass", "power"), ("enhanced", "uniform"), ("basic", "log")])
def test_a_crane_rests_in_the_wind_and_its_base_feels_all_of_it(kind, profile):
    found = run(kind, *STANDS, f"wind.profile={profile}")
    for name in ("sway_radial", "sway_tangential", "platform_angle"):
        assert np.ptp(found[name].values) < 1e-9
    crane = found.model.crane
    tip = crane.points[crane.suspension].height[""]
    heights = np.maximum([tip, tip - 2.0], 2.0)
    share = {
        "uniform": np.ones(2), "power": (heights / 10.0) ** 0.2, "log": np.log(heights / 0.05) / np.log(200.0)
    }[profile]  # fmt: skip
    winds = np.array([[7.5 * own, 15.0 * np.sqrt(0.75) * own, 1.0] for own in share])
    force = np.array([3.0, 1.2]) @ (np.linalg.norm(winds, axis=1)[:, None] * winds)
    weight = 9.81 * (50.5 + sum(point.mass for point in crane.points.values()))
    seen = [found[f"base_force_{axis}"].values[-1] for axis in "xyz"]
    assert_allclose(seen, force - (0.0, 0.0, weight), rtol=1e-9)
    # About the tower's axis: on the load where it hangs, and where its rope hangs from.
    load = found["payload_position"].values[-1]
    air = 1.2 * np.linalg.norm(winds[1]) * winds[1]
    pull = air - (0.0, 0.0, 9.81 * 50.5)
    from_there = load - found["rope_length"].values[-1] * pull / np.linalg.norm(pull)
    _, _, torque = np.cross(load, air) + np.cross(from_there, force - air)
    assert found["base_torque"].values[-1] == pytest.approx(torque, rel=1e-7)
    assert_allclose(found["wind_y"].values, winds[-1, 1], rtol=1e-12)


def test_the_air_pulls_on_what_moves_through_it():
    rng = np.random.default_rng(2)
    velocity, wind = rng.normal(size=(2, 3)) * 5.0
    turn = rng.uniform(0.0, 6.0)
    unit = np.cos(turn), np.sin(turn)
    body = Body(1.0, np.full(3, 0.7), (), np.zeros(1))
    found = drag_on(body, Motion(velocity, np.zeros(3), [], unit), wind)
    through = velocity - wind
    assert_allclose(found, -0.7 * np.linalg.norm(through) * through, rtol=1e-13)


def test_what_a_wind_gives_a_crane_that_turns_in_it_is_accounted_for():
    found = run("basic", "run.duration=4 s", "solver.rtol=1e-10", "solver.atol=1e-12")
    gained = found["total_energy"].values - found["total_energy"].values[0]
    assert abs(gained - found["input_work"].values).max() < 1e-8 * np.ptp(gained)

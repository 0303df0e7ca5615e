"""Whether a tower crane stays in its jib's plane follows from its scene, not from a statement of its kind."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.case_files import RADIAL, copy_case, only_fault

from towercrane import load_case, run_case
from towercrane.cranes.tower.file.build import tower_model
from towercrane.cranes.tower.file.plane import stays_in_plane

SIDE = ["wind.speed=10 m/s", "wind.direction=90 deg"]
TIGHT = ["run.duration=6 s", "solver.rtol=1e-11", "solver.atol=1e-13", "motion.slewing.shape=rest"]
SPEED = "speed=0.05 rad/s", "acceleration=0.01 rad/s^2"
STILL = '{shape = "smooth", speed = "0 rad/s", ramp = "2 s", hold = "8 s"}'
GOES = '{shape = "minimum-jerk", end = "9 deg", duration = "30 s", delay = "%d s"}'
ALONG = ["wind.speed=12 m/s", "wind.direction=180 deg", "wind.upward=2 m/s", "payload.drag_area=2 m^2"]


def turn(shape, *keys):
    return [f"motion.slewing.{key}" for key in (f"shape={shape}", *keys)]


def steps(*written):
    listed = ", ".join(step for step in written if step.startswith("{"))
    keys = [key for key in written if not key.startswith("{")]
    return turn("sequence", f"steps=[{listed}]", *keys)


@pytest.mark.parametrize("kind", ["radial", "space"])
def test_a_former_kind_is_one_message_wherever_it_is_written(kind, tmp_path):
    for where, key in (
        (("title =", f'kind = "{kind}"\ntitle ='), "kind"),
        (('source = "Gao', f'kind = "{kind}"\nsource = "Gao'), "kind"),
    ):
        fault = only_fault(copy_case(tmp_path, RADIAL, where))
        assert (fault.key, fault.got) == (key, f'"{kind}"')
        assert "in the plane of its jib or in space follows from" in fault.hint
    for override in (f"kind={kind}", f"crane.kind={kind}"):
        assert "follows from" in only_fault(RADIAL, override).hint


@pytest.mark.parametrize(("former", "now"), [
    (["model.jib_modes=2"], "jib_vertical_modes"),
    (["model.jib_damping_ratio=0.01"], "jib_vertical_damping_ratio"),
    (["accuracy.target=1e-3", 'accuracy.outputs=["hoist_rope_force", "swing_angle"]'], "sway_radial"),
    (['accuracy.target={swing_angle_sideways = "1 deg"}'], "sway_tangential"),
])  # fmt: skip
def test_renamed_keys_and_outputs_say_what_they_are_called_now(former, now):
    assert only_fault(RADIAL, *former).hint == f'now called "{now}"'


@pytest.mark.parametrize(("changes", "planar"), [
    ([], True),
    (["motion.slewing.shape=rest"], True),
    (["motion.slewing.shape=rest", "motion.slewing.start=10 deg"], True),
    (["motion.shaft.shape=rest", "motion.shaft.start=10 deg"], True),
    (["motion.slewing.shape=rest", "motion.slewing.start=360 deg", "wind.speed=10 m/s"], True),
    (["motion.slewing.shape=rest", "motion.slewing.start=90 deg", *SIDE], True),
    (["motion.slewing.shape=rest", "motion.slewing.start=90 deg", *ALONG], False),
    (turn("trapezoid", "end=10 deg", *SPEED), False),
    (turn("trapezoid", "end=10 deg", *SPEED, "delay=119.9 s"), False),
    (turn("trapezoid", "end=10 deg", *SPEED, "delay=120 s"), True),
    (turn("trapezoid", "start=10 deg", "end=10 deg", *SPEED), True),
    (turn("trapezoid", "start=10 deg", "end=0 deg", *SPEED), False),
    (turn("zvd", "end=0 deg", *SPEED), True),
    (turn("zvd", "end=1 deg", *SPEED, "delay=500 s"), True),
    (turn("minimum-jerk", "end=0 deg", "duration=9 s"), True),
    (turn("smooth", "speed=0 rad/s", "ramp=1 s", "hold=2 s"), True),
    (turn("speed-trapezoid", "speed=-0.01 rad/s", "ramp=1 s", "hold=2 s"), False),
    (steps('{shape = "rest", duration = "2 s"}'), True),
    (steps(STILL, GOES % 50, "delay=58 s"), True),
    (steps(STILL, GOES % 49, "delay=58 s"), False),
    (["wind.speed=10 m/s"], True),
    (ALONG, True),
    (SIDE, False),
    (["wind.speed=0 m/s", "wind.direction=90 deg", "wind.upward=3 m/s"], True),
    (["wind.series=gusts.csv"], False),
])  # fmt: skip
def test_a_scene_is_planar_unless_something_turns_or_blows_across_within_its_run(changes, planar):
    case = load_case(RADIAL, changes)
    assert stays_in_plane(case.checked) is planar
    turns = case.plans.get("slewing", case.plans.get("shaft"))
    if planar and turns:
        assert np.ptp(turns.commanded(np.linspace(0.0, case.run.duration, 9999))) == 0.0


def test_a_planar_scene_has_no_tangential_sway_to_promise():
    fault = only_fault(RADIAL, "accuracy.target=1e-3", 'accuracy.outputs=["sway_tangential"]')
    assert fault.key == "accuracy.outputs"
    assert "stays in the jib's plane" in fault.hint


@pytest.mark.parametrize("wind", [[], ALONG])
def test_a_planar_run_is_the_run_in_space_whose_head_rests(wind):
    case = load_case(RADIAL, [*TIGHT, *wind])
    plane = run_case(case)
    space = run_case(case, model=tower_model(case.checked, planar=False))
    for name in plane.data_vars:
        scale = abs(plane[name].values).max()
        assert_allclose(space[name].values, plane[name].values, rtol=0.0, atol=1e-9 * scale, err_msg=name)
    for name in set(space.data_vars) - set(plane.data_vars) - {"payload_in_crane_axes"}:
        assert np.abs(space[name].values).max() < 1e-9, name

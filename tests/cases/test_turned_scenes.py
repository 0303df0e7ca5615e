"""A head that stands turned with nothing across its jib: the crane in the plane, seen from fixed axes."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.case_files import RADIAL, only_fault

from towercrane import load_case, run_case
from towercrane.accuracy.scene import scene_of
from towercrane.cases.assumptions import left_out
from towercrane.cases.models import motions_of
from towercrane.cranes.tower.file.build import tower_model
from towercrane.cranes.tower.file.plane import heading_of
from towercrane.linear.linearise import linearise

TURN = np.deg2rad(130.0)
TIGHT = ["run.duration=6 s", "solver.rtol=1e-11", "solver.atol=1e-13", "run.output_step=0.1 s"]
STANDS = ["motion.slewing.shape=rest", "motion.slewing.start=130 deg"]
WIND = ["wind.speed=12 m/s", "wind.direction=310 deg", "wind.upward=2 m/s", "payload.drag_area=2 m^2",
        "crane.wind_areas.tower=1 m", "crane.wind_areas.jib=0.5 m", "crane.wind_areas.counter_jib=0.4 m",
        "crane.wind_areas.counterweight=3 m^2"]  # fmt: skip


@pytest.mark.parametrize("wind", [[], WIND])
def test_a_run_at_a_turned_head_is_the_run_in_space(wind):
    case = load_case(RADIAL, [*TIGHT, *STANDS, *wind])
    model = tower_model(case.checked)
    assert (model.axes, model.counts["tower_y"], model.heading) == (2, 0, TURN)
    plane = run_case(case)
    space = run_case(case, model=tower_model(case.checked, planar=False))
    assert set(plane.data_vars) >= {"base_moment_x", "slewing_angle", "payload_in_crane_axes", "tower_y_coordinate"}
    for name in plane.data_vars:
        scale = abs(plane[name].values).max()
        assert_allclose(space[name].values, plane[name].values, rtol=0.0, atol=1e-9 * scale, err_msg=name)
    for name in set(space.data_vars) - set(plane.data_vars):
        assert np.abs(space[name].values).max() < 1e-9 * max(1.0, np.abs(space["base_moment_x"].values).max()), name


def test_a_linear_model_at_a_turned_head_has_the_wind_along_fixed_axes():
    case = load_case(RADIAL, [*STANDS, *WIND])
    assert heading_of(case.checked) == TURN
    linear = linearise(tower_model(case.checked), motions_of(case), outputs=[])
    inputs = [signal.name for signal in linear.inputs]
    east, north = (linear.b[:, inputs.index(name)] for name in ("wind_x", "wind_y"))
    assert_allclose(north * np.cos(TURN), east * np.sin(TURN), rtol=0.0, atol=1e-9 * abs(east).max())


def test_moments_about_both_fixed_axes_can_be_promised_of_a_turned_head():
    outputs = [scene_of(load_case(RADIAL, changes)).outputs for changes in (STANDS, [])]
    assert set(outputs[0]) - set(outputs[1]) == {"base_moment_x"}
    fault = only_fault(RADIAL, *STANDS, "accuracy.target=1e-3", 'accuracy.outputs=["base_moment_x", "base_torque"]')
    assert (fault.key, fault.got) == ("accuracy.outputs", '"base_torque"')


def test_a_load_in_space_has_no_plane_to_be_turned():
    space = tower_model(load_case(RADIAL).checked, planar=False)
    with pytest.raises(ValueError, match=r"FlexibleModel\.heading: wanted 0 for a load in space, got 1"):
        replace(space, heading=1.0)


def test_a_wind_in_the_plane_says_what_a_linear_model_does_not_know_of_it():
    calm, windy, across = (
        left_out(load_case(name, options))
        for name, options in (
            ("qtz5613/condition-3", []),
            ("qtz5613/condition-3", ["wind.speed=9 m/s"]),
            ("qtz5613/condition-3", ["wind.speed=9 m/s", "wind.direction=90 deg"]),
        )
    )
    assert "linear model's wind across the jib" in windy[0]
    assert windy[0].startswith(calm[0])
    assert "linear" not in calm[0]
    assert across == []

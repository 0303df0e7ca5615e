"""Extremes between looks and on both sides of switches, and the loads for design that are made of them."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples import qtz5613, space_crane
from samples.overhead_crane import SMALL

from towercrane.cranes.overhead.equations import BRIDGE_FORCE
from towercrane.cranes.overhead.model import OverheadModel
from towercrane.kernels.load import Load
from towercrane.motions.motion import rest
from towercrane.motions.profiles import trapezoid
from towercrane.runs.extremes import extremes_of
from towercrane.runs.loads import loads_of, tipped
from towercrane.simulation.simulate import record

G = 9.81
SLEWED = {"trolley": rest(30.0), "rope": rest(12.0), "slewing": trapezoid(0.3, 0.5, 0.06, 0.02)}


@pytest.fixture(scope="module")
def coarse():
    """A crane in space looked at ten times in 4 s."""
    return record(space_crane.model(1, 1, 1, 1, load=1500.0), SLEWED, 4.0, output_step=0.4)


@pytest.fixture(scope="module")
def fine():
    return record(space_crane.model(1, 1, 1, 1, load=1500.0), SLEWED, 4.0, output_step=1e-3, rtol=1e-10, atol=1e-12)


def test_extremes_are_those_of_a_run_that_is_looked_at_closely(coarse, fine):
    found = extremes_of(coarse)
    for name in ("base_moment_x", "overturning_moment", "slewing_torque", "jib_root_moment_sideways", "base_shear"):
        values, size = fine[name].values, np.ptp(fine[name].values)
        # Between its rows a run curves by less than this.
        bend = np.max(abs(np.diff(values, 2)))
        for extreme, closest in ((found.highest[name], values.max()), (found.lowest[name], values.min())):
            assert abs(extreme.value - closest) < bend + 1e-7 * size, name
            assert abs(extreme.value - np.interp(extreme.time, fine.times, values)) < bend + 1e-7 * size, name
    # Looks alone miss that.
    missed = coarse["base_torque"].values.min() - found.lowest["base_torque"].value
    assert missed > 5e-3 * np.ptp(fine["base_torque"].values)


def test_what_acts_beside_an_extreme_is_of_its_time(coarse, fine):
    loads = loads_of(coarse, extremes_of(coarse))
    for load in (loads["overturning_moment"], loads["base_torque"]):
        for which in ("maximum", "minimum"):
            for name, value in load[which]["beside"].items():
                there = np.interp(load[which]["time_s"], fine.times, fine[name].values)
                assert abs(value - there) < 1e-4 * np.ptp(fine[name].values), name
    most = loads["overturning_moment"]["maximum"]
    beside = most["beside"]
    assert_allclose(np.hypot(beside["base_moment_x"], beside["base_moment_y"]), most["value"], rtol=1e-6)
    tips = most["value"] * np.array([np.cos(most["direction_rad"]), np.sin(most["direction_rad"])])
    assert_allclose(tips, [beside["base_moment_y"], -beside["base_moment_x"]], rtol=1e-6)


def test_both_limits_of_a_switch_are_looked_at():
    """A bridge that brakes: its drive pushes hardest right after the switch or right before it."""
    model = OverheadModel(SMALL, Load(1500.0))
    motions = {"bridge": trapezoid(2.0, 12.0, 1.3, 0.7), "trolley": rest(4.0), "rope": rest(6.0)}
    run = record(model, motions, 6.0, output_step=0.5)
    switch = 1.3 / 0.7
    found = extremes_of(run)
    sides = {}
    # A run to the switch alone, its last state under the drives of either side.
    end = record(model, motions, switch, output_step=switch / 4.0).states[-1]
    for side, acceleration in (("before", 0.7), ("after", 0.0)):
        bridge = [float(motions["bridge"](switch)), 1.3, 0.5 * acceleration]
        _, guards = model.system.slope(0.0, end, np.array([bridge, [4.0, 0.0, 0.0], [6.0, 0.0, 0.0]]))
        sides[side] = float(guards[BRIDGE_FORCE])
    assert sides["before"] - sides["after"] > 500.0
    assert_allclose(found.highest["bridge_force"].value, max(sides.values()), rtol=1e-7)
    assert abs(found.highest["bridge_force"].time - switch) < 1e-8
    assert run["bridge_force"].values.max() < sides["before"] - 1.0


def test_dynamic_factor_of_a_rigid_crane_is_that_of_its_hoist():
    model = qtz5613.model(0, 0, load=800.0)
    motions = {"trolley": rest(30.0), "rope": trapezoid(18.0, 12.0, 0.6, 0.3)}
    run = record(model, motions, 14.0, output_step=0.5)
    loads = loads_of(run, extremes_of(run))
    force = loads["hoist_rope_force"]
    assert_allclose(
        [force["maximum"]["value"], force["minimum"]["value"]], 800.0 * np.array([G + 0.3, G - 0.3]), rtol=1e-7
    )
    assert_allclose([force["static"], force["dynamic_factor"]], [800.0 * G, 1.0 + 0.3 / G], rtol=1e-7)
    crane = qtz5613.CRANE
    turning = crane.jib.mass_per_length * 55.6 + crane.counter_jib_mass_per_length * 12.3 + crane.counterweight
    weight = turning + crane.trolley_mass + 800.0 + 350.0 * 23.8
    down = loads["base_force_z"]
    assert_allclose(down["static"], -G * weight, rtol=1e-12)
    assert down["largest"] == "minimum"
    assert_allclose(down["dynamic_factor"], 1.0 + 800.0 * 0.3 / (G * weight), rtol=1e-9)
    moment = 123.8 * 55.6**2 / 2 - 159.3 * 12.3**2 / 2 - 15130.0 * 12.3 + (350.0 + 800.0) * 30.0
    assert_allclose(loads["overturning_moment"]["static"], G * abs(moment), rtol=1e-9)
    most = loads["overturning_moment"]
    assert_allclose(most["maximum"]["value"], abs(G * moment + 800.0 * 0.3 * 30.0 * np.sign(moment)), rtol=1e-7)
    assert_allclose(
        most["overturning_first"] if "overturning_first" in most else most["maximum"]["direction_rad"], 0.0
    )
    assert loads["base_shear"]["dynamic_factor"] is None
    assert "trolley_force" not in loads


def test_what_turns_about_plus_y_tips_towards_plus_x():
    assert tipped(0.0, 2.0) == 0.0
    assert tipped(-2.0, 0.0) == pytest.approx(np.pi / 2)
    assert abs(tipped(0.0, -2.0)) == pytest.approx(np.pi)


def test_a_crane_without_a_rest_has_no_static_loads():
    """A tower that its weight buckles stands nowhere; its run has one look, and loads nevertheless."""
    model = qtz5613.model(1, 1, load=5e6, weight_softening=True)
    run = record(model, {"trolley": rest(50.0), "rope": rest(12.0)}, 1.0)
    assert run.attrs["outcome"] != "finished"
    loads = loads_of(run, extremes_of(run))
    assert loads["hoist_rope_force"]["static"] is None
    assert loads["hoist_rope_force"]["dynamic_factor"] is None

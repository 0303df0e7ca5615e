"""Runs of a crane whose jib pivots, in wind: rest, balance of energy, turbulence, what its base feels."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from towercrane.cases.case import load_case
from towercrane.runs.run import record_case

AREAS = ["crane.wind_areas.jib=0.5 m", "crane.wind_areas.tower=0.8 m", "payload.drag_area=2 m^2"]
STANDS = [
    'motion.luffing={shape="rest", start="50 deg"}', 'motion.slewing={shape="rest"}', 'motion.hoist={shape="rest"}',
    "model.tower_modes=1", "model.jib_lateral_modes=1", "model.jib_vertical_modes=1", "model.torsion_modes=1",
]  # fmt: skip


def run(*changes):
    return record_case(load_case("luffing/manoeuvre", [*AREAS, *STANDS, *changes]))


@pytest.mark.parametrize("direction", [0.0, 90.0])
def test_a_luffed_jib_rests_in_the_wind_and_its_base_feels_all_of_it(direction):
    found = run("wind.speed=15 m/s", f"wind.direction={direction} deg", "run.duration=1 s")
    assert found.model.axes == (2 if direction == 0.0 else 3)
    assert np.ptp(found["tower_tip_displacement"].values) < 1e-8
    assert np.ptp(found["luffing_angle"].values) < 1e-9
    crane, angle = found.model.crane, found["luffing_angle"].values[-1]
    tilt = found["tower_tip_tilt"].values[-1] if direction == 0.0 else 0.0
    # Along the head the wind presses the jib across its chord, c sin^2; to its side by all of its square.
    slope = np.sin(angle - tilt)
    jib = 0.5 * crane.jib_length * (slope**3 if direction == 0.0 else 1.0)
    wanted = 0.6125 * 225.0 * (jib + 0.8 * crane.tower_height + 2.0)
    axis = "x" if direction == 0.0 else "y"
    assert found[f"base_force_{axis}"].values[-1] == pytest.approx(wanted, rel=1e-8 if direction == 0.0 else 2e-3)
    assert_allclose(found[f"wind_{axis}"].values, 15.0, rtol=1e-12)


def test_what_turbulence_gives_a_luffed_jib_is_accounted_for():
    wind = ["wind.speed=14 m/s", "wind.direction=60 deg", "wind.profile=power"]
    turbulence = ["spectrum=von-karman", "intensity=0.2", "seed=4", "ramp=2 s"]
    found = run(*wind, *(f"wind.turbulence.{key}" for key in turbulence), "run.duration=6 s")
    assert found.attrs["outcome"] == "finished"
    assert found.model.wind == 9
    gained = found["total_energy"].values - found["total_energy"].values[0]
    assert np.ptp(gained) > 10.0
    assert abs(gained - found["input_work"].values).max() < 1e-6 * np.ptp(gained)

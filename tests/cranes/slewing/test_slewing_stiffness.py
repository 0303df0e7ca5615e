"""Slewing cranes that are stiff: the coupling's hard stop, a platform of hardly any inertia, stiff springs."""

from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.balance import imbalance
from samples.lab_crane import MULTI_MASS, crane, motions, run

from towercrane.cranes.slewing import equations


@pytest.mark.parametrize(("rtol", "error"), [(1e-6, 5e-2), (1e-8, 5e-3), (1e-11, 1e-6)])
def test_hard_stop_of_the_coupling(rtol, error):
    # The 206 contacts magnify errors by chance: between tolerances that differ by a third they scatter a hundredfold,
    # around 4e-3 at 1e-6 and 3e-5 at 1e-8.
    trajectory, outputs, met = run(crane(drive_stiff_stiffness=7.5e6), motions(), 5.0, rtol=rtol)
    assert trajectory.outcome == "finished"
    assert abs(np.degrees(outputs["sway_radial"][-1]) - 11.444332) < error
    contacts = [guard for guard in met if guard in (equations.INSIDE, equations.OUTSIDE)]
    # Never twice the same way through the corner: no crossing is lost.
    assert all(a != b for a, b in pairwise(contacts))
    assert len(contacts) == 206


def test_hard_stop_by_another_solver():
    trajectory, outputs, _ = run(
        crane(drive_stiff_stiffness=7.5e6), motions(), 5.0, rtol=1e-10, method="scipy-lsoda", step=0.5
    )
    assert trajectory.outcome == "finished"
    assert_allclose(np.degrees(outputs["sway_radial"][-1]), 11.44433, atol=2e-5)


@pytest.mark.parametrize(("stiff", "error"), [(750.0, 1e-8), (7.5e6, 1e-6)])
def test_corner_that_is_only_touched(stiff, error):
    # The shaft's speed is raised until the twist is just seen to reach the corner; on either side the run is the
    # same. A touch that falls between the stages of a step is not seen: against the hard stop that costs a few 1e-7.
    def winding(speed):
        model = crane(drive_soft_stiffness=400.0, drive_stiff_stiffness=stiff, friction_law="none")
        return run(model, motions(hold=2.0, speed=speed), 4.0, rtol=1e-9)

    low, high = 0.05, 0.738
    assert not winding(low)[2]
    assert winding(high)[2]
    while (middle := 0.5 * (low + high)) not in (low, high):
        low, high = (low, middle) if winding(middle)[2] else (middle, high)
    below, above = winding(low), winding(high)
    assert below[0].outcome == above[0].outcome == "finished"
    assert len(below[2]) == 0
    assert len(above[2]) in (1, 2)
    n = 8 + 3
    assert_allclose(above[0].states[:, :n], below[0].states[:, :n], rtol=0, atol=error)


def test_corner_is_watched_only_where_the_stiffness_bends():
    straight = run(crane(drive_soft_stiffness=750.0), motions(), 5.0)
    assert straight[2] == []


# --- everything else that is stiff ------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("inertia", "sway", "platform", "methods"),
    [
        (6.0, 15.890460, 3.5529586, ("dop853", "scipy-lsoda", "scipy-radau")),
        (0.06, 15.887425, 3.5593490, ("dop853", "scipy-lsoda", "scipy-radau")),
        (6e-4, 15.887500, 3.5594092, ("scipy-lsoda", "scipy-radau")),
    ],
)
def test_platform_of_hardly_any_inertia(inertia, sway, platform, methods):
    for method in methods:
        trajectory, outputs, _ = run(crane(inertia_platform=inertia), motions(), 5.0, method=method, rtol=1e-7)
        assert trajectory.outcome == "finished"
        assert_allclose(np.degrees(outputs["sway_radial"][-1]), sway, atol=5e-6)
        assert_allclose(outputs["platform_angle"][-1], platform, atol=5e-7)


def test_platform_of_hardly_any_inertia_that_sticks():
    # Without inertia of its own the platform follows its coupling; friction is set-valued, not stiff.
    found = []
    for inertia in (6e-2, 6e-3, 6e-4):
        model = crane(inertia_platform=inertia, friction_law="stick-slip")
        trajectory, outputs, _ = run(model, motions(), 3.0)
        assert trajectory.outcome == "finished"
        assert imbalance(outputs) < 1e-6
        found.append(outputs["platform_angle"][-1])
    gaps = abs(np.diff(found))
    assert gaps[1] < 0.2 * gaps[0] + 1e-7


def test_all_springs_a_thousand_times_stiffer():
    names = [n for n in vars(MULTI_MASS) if n.startswith("stiffness")] + [
        "drive_soft_stiffness",
        "drive_stiff_stiffness",
    ]
    model = crane(**{name: 1e3 * getattr(MULTI_MASS, name) for name in names})
    runs = [run(model, motions(), 5.0, rtol=rtol) for rtol in (1e-5, 1e-9)]
    for trajectory, outputs, _ in runs:
        assert trajectory.outcome == "finished"
        assert np.max(abs(outputs["sway_radial"] - runs[-1][1]["sway_radial"])) < 1e-4
    implicit = run(model, motions(), 1.0, rtol=1e-6, method="scipy-radau")
    assert implicit[0].outcome == "finished"
    assert_allclose(implicit[1]["sway_radial"], runs[-1][1]["sway_radial"][:21], atol=1e-5)

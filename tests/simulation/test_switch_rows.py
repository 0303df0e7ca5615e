"""Rows that fall on switches: every output of every kind of crane is the same limit, from the right."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.every_kind import KINDS, lumped

from towercrane.motions.motion import phases
from towercrane.simulation.integrate import evaluate
from towercrane.simulation.lanes.many import integrate_many
from towercrane.simulation.lanes.run import LaneRun
from towercrane.simulation.starts.start import Start

END = 4.0
"""After the last switch of all motions [s]."""

BESIDE = 1e-5
"""Distance of the samples from which a limit is extrapolated [s]."""


def limits(outputs: dict, name: str, side: int) -> np.ndarray:
    """Cubic extrapolation to the switch from four rows on one side of it."""
    first, second, third, fourth = outputs[name][side * np.arange(1, 5)]
    return 4.0 * first - 6.0 * second + 4.0 * third - fourth


@pytest.mark.parametrize("kind", KINDS)
def test_a_row_on_a_switch_is_the_right_limit_of_every_output_wherever_the_run_ends(kind):
    scene = KINDS[kind]()
    switches = np.unique(np.concatenate([[0.0], *(m.switch_times for m in scene.motions.values())]))
    _, whole = scene.run(np.linspace(0.0, END, 81), END)
    scales = {name: np.ptp(values, axis=0).max() for name, values in whole.items()}
    jumps = dict.fromkeys(scales, 0.0)
    for switch in switches:
        beside = np.concatenate([np.arange(5), -np.arange(4, 0, -1) if switch else []]) * BESIDE + switch
        order = np.argsort(beside)
        found, outputs = scene.run(beside[order], END)
        assert found.outcome == "finished"
        outputs = {name: values[np.argsort(order)] for name, values in outputs.items()}
        ends = outputs
        if switch:
            found, ends = scene.run([0.5 * switch, switch], switch)
            assert (found.outcome, found.times[-1]) == ("finished", switch)
        for name, scale in scales.items():
            wanted, row = limits(outputs, name, 1), outputs[name][0]
            close = {"rtol": 1e-9, "atol": 1e-6 * scale + 1e-12, "err_msg": f"{name} at {switch:g} s"}
            assert_allclose(row, wanted, **close)
            assert_allclose(ends[name][-1 if switch else 0], row, **close)
            if switch:
                jumps[name] = max(jumps[name], np.max(abs(limits(outputs, name, -1) - wanted)) / (scale or 1.0))
    # And there is something to tell the two limits apart by, but where rope and drive are both elastic.
    assert (max(jumps.values()) > 1e-2) == (kind != "basic")


def test_lanes_look_at_the_right_limit_at_the_end_too():
    scene = KINDS["radial"]()
    end = float(scene.motions["rope"].switch_times[-1])
    grid = np.array([0.0, end])
    found, _ = scene.run(grid, end, rtol=1e-8, atol=1e-10)
    cut = phases(tuple(scene.motions[channel] for channel in scene.model.channels), end)
    _, guards = evaluate(scene.model.system, cut, found.times, found.states)
    runs = [LaneRun(scene.model, cut, Start(along=0.05))]
    lanes = integrate_many(runs, grid, outputs=["hoist_rope_force"], threads=1, series=True)
    assert lanes.outcomes == ["finished"]
    tension = guards[:, 0]
    assert_allclose(lanes.series[0, :, -1], tension, rtol=0, atol=0)
    assert_allclose(
        lanes.extremes[0, -1], [tension.max(), grid[tension.argmax()], tension.min(), grid[tension.argmin()]], rtol=0
    )
    # The hoist stops there, which the left limit does not know.
    _, before = evaluate(scene.model.system, cut, np.array([end - 1e-6]), found.states[-1:])
    assert abs(before[0, 0] - tension[-1]) > 1e-3 * tension[-1]


def test_friction_that_gives_way_at_once_slips_in_the_first_row():
    scene = lumped("enhanced", friction_law="stick-slip", drive_soft_stiffness=750.0)
    start = scene.model.start(phases(tuple(scene.motions[c] for c in scene.model.channels), 1.0).inputs[0])
    # Wound up against more than friction can hold, at rest.
    start[scene.model.crane.coordinates.index("platform_angle")] = 0.2
    _, outputs = scene.run(BESIDE * np.arange(5), 1.0, start)
    for name, values in outputs.items():
        assert_allclose(values[0], limits(outputs, name, 1), rtol=1e-8, atol=1e-8, err_msg=name)

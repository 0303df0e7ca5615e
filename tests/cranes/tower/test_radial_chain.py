"""The radial model on towers of segments: stepped, shear-flexible, softened by weight, on springs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from samples.qtz5613 import in_plane

from modal import Chain, EndBody, Foundation, Segment, crane_structure
from towercrane import load_case
from towercrane.cases.models import motions_of
from towercrane.cranes.parts.load import load_of
from towercrane.cranes.tower.equations.small_motions import plane_modes
from towercrane.cranes.tower.file.build import crane_frame, crane_of
from towercrane.cranes.tower.file.members import joined
from towercrane.cranes.tower.modes.parameters import as_chain
from towercrane.simulation.simulate import simulate

CASE = load_case("qtz5613/condition-3")
CRANE = crane_of(CASE.checked)
EI = CRANE.tower.bending_stiffness
STEPPED = Chain(
    (Segment(12.0, 350.0, EI, 1.2e8, 40.0), Segment(11.8, 300.0, 0.8 * EI, 1.1e8, 30.0, end_ratio=0.9)),
    {1: EndBody(300.0, 10.0, 0.2), 2: EndBody(1500.0, 4000.0, 1.0)},
    foundation=Foundation(2e9, 5e8),
)


def frame_on(tower):
    """The crane on another tower, weight included, exactly."""
    frame = crane_frame(CASE.checked, weight=True)
    top = len(tower.segments)
    body = joined(tower.bodies.get(top, EndBody()), frame.tower.bodies[1])
    return replace(frame, tower=replace(tower, bodies={**tower.bodies, top: body}, gravity=9.81))


@pytest.mark.parametrize(("modes", "bound"), [(2, 1e-3), (4, 1e-5), (8, 1e-6)])
def test_frequencies_converge_to_the_exact_frame(modes, bound):
    model = in_plane(replace(CRANE, tower=STEPPED), load_of(CASE.payload), modes, modes, weight_softening=True)
    exact = crane_structure(frame_on(STEPPED), 41.0).angular_frequencies(4)
    error = plane_modes(model, 41.0, 18.0)[0][:4] / exact - 1.0
    assert error.min() > -1e-10
    assert bound / 30 < error.max() < bound


def test_a_uniform_tower_as_a_chain_runs_the_same():
    runs = [
        simulate(
            in_plane(replace(CRANE, tower=tower), load_of(CASE.payload), 2, 3), motions_of(CASE), 20.0, rtol=1e-10
        )
        for tower in (CRANE.tower, as_chain(CRANE.tower))
    ]
    for name in ("tower_tip_displacement", "sway_radial", "jib_tip_deflection"):
        one, other = (run[name].values for run in runs)
        assert np.abs(one - other).max() < 1e-8 * np.abs(one).max()


def test_energy_is_kept_on_a_general_tower():
    model = in_plane(replace(CRANE, tower=STEPPED), load_of(CASE.payload), 3, 3, weight_softening=True)
    run = simulate(model, motions_of(CASE), 60.0, rtol=1e-10)
    energy, work = run["total_energy"].values, run["input_work"].values
    assert run.attrs["outcome"] == "finished"
    assert np.abs(energy - energy[0] - work).max() < 1e-8 * np.ptp(energy)


def test_two_bodies_on_one_node():
    both = joined(EndBody(2.0, 3.0, 1.0), EndBody(6.0, 5.0, -1.0))
    assert (both.mass, both.offset) == (8.0, -0.5)
    assert both.rotary_inertia == pytest.approx(3.0 + 5.0 + 2.0 * 1.5**2 + 6.0 * 0.5**2)
    assert joined(EndBody(), EndBody(0.0, 4.0)) == EndBody(0.0, 4.0)

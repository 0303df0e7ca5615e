"""Modes of the whole plane crane: shapes that can be compared, energies, static outputs as sums over modes."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.plane_crane import BENDING, FRAME, HEIGHT, REACH, TOWER

from modal import Chain, EndBody, Foundation, Segment
from towercrane.studies.plane_modes import LOADS, MEMBERS, STATIC_OUTPUTS, PlaneCrane

COUNTER = Chain((Segment(12.0, 160.0, 5e8),), {1: EndBody(15000.0)})
SPRUNG = replace(
    FRAME,
    tower=replace(
        TOWER,
        segments=(Segment(10.0, 400.0, BENDING, 3e8, 80.0, 0.8), Segment(14.0, 350.0, 0.64 * BENDING, 2e8)),
        bodies={1: EndBody(500.0, 100.0, 0.5), 2: EndBody(2000.0, 4000.0, 1.0)},
        foundation=Foundation(3e9, 4e8),
    ),
    counter_jib=COUNTER,
)


def static(modes, load, output):
    return modes.static[LOADS.index(load), STATIC_OUTPUTS.index(output)]


@pytest.mark.parametrize("position", [0.0, 5.0, 31.0, REACH])
def test_static_outputs_of_a_clamped_tower_by_hand(position):
    modes = PlaneCrane(FRAME).modes(position, 2)
    turn = HEIGHT / BENDING  # of the top, per moment
    deflected = position**2 * (3.0 * REACH - position) / (6.0 * 7e8)
    assert_allclose(static(modes, "vertical", "base_moment"), position, rtol=1e-11)
    assert_allclose(static(modes, "vertical", "tower_tip"), position * HEIGHT * turn / 2.0, rtol=1e-11)
    assert_allclose(static(modes, "vertical", "jib_tip"), position * REACH * turn + deflected, rtol=1e-10)
    assert_allclose(static(modes, "horizontal", "base_moment"), HEIGHT, rtol=1e-10)
    assert_allclose(static(modes, "horizontal", "tower_tip"), HEIGHT**3 / (3.0 * BENDING), rtol=1e-10)
    assert_allclose(static(modes, "horizontal", "jib_tip"), REACH * HEIGHT * turn / 2.0, rtol=1e-10)


@pytest.mark.parametrize("gravity", [0.0, 9.81])
@pytest.mark.parametrize("frame", [FRAME, SPRUNG], ids=["clamped", "sprung"])
def test_parts_of_all_modes_add_up_to_the_static_outputs(frame, gravity):
    crane = PlaneCrane(replace(frame, tower=replace(frame.tower, gravity=gravity)))
    for position in (7.0, REACH):
        modes = crane.modes(position, 40)
        gap = np.abs(modes.modal_static.sum(axis=0) / modes.static - 1.0)
        # Displacements converge with the fourth power of the mode's number, moments with the second.
        assert gap[:, :2].max() < 4e-6
        assert gap[:, 2].max() < 3e-5


def test_weight_softens_what_holds_the_tower():
    light = PlaneCrane(FRAME).modes(20.0, 1)
    heavy = PlaneCrane(replace(FRAME, tower=replace(TOWER, gravity=9.81))).modes(20.0, 1)
    assert 1.01 < static(heavy, "horizontal", "tower_tip") / static(light, "horizontal", "tower_tip") < 1.05
    assert 1.005 < static(heavy, "horizontal", "base_moment") / HEIGHT < 1.05


@pytest.mark.parametrize("frame", [FRAME, SPRUNG], ids=["clamped", "sprung"])
@pytest.mark.parametrize("position", [0.0, 17.0, REACH])
def test_shapes_are_orthonormal_in_the_mass(frame, position):
    shapes = PlaneCrane(frame).modes(position, 6).shapes
    # Under the trolley the shear force jumps; the fixed points do not see where.
    assert_allclose(shapes @ shapes.T, np.eye(6), atol=1e-8 if position in (0.0, REACH) else 2e-4)


def test_shapes_at_neighbouring_places_are_alike():
    crane = PlaneCrane(SPRUNG)
    here, there = (crane.modes(position, 6).shapes for position in (25.0, 25.01))
    assert_allclose(np.diag(here @ there.T) ** 2, 1.0, atol=1e-5)


@pytest.mark.parametrize("frame", [FRAME, SPRUNG], ids=["clamped", "sprung"])
def test_energy_is_half_the_frequency_squared(frame):
    # Twice the potential energy of a mode of unit modal mass is omega^2: a check of every member's part.
    crane = PlaneCrane(frame)
    modes = crane.modes(REACH, 6)
    strain = sum(points.strain(modes.modes.parts[name]) for name, points in crane.points.items())
    shares = dict(zip(MEMBERS, modes.energy_shares.T, strict=True))
    beams = sum(shares[name] for name in crane.points)
    assert_allclose(strain / modes.modes.angular_frequencies**2, beams, rtol=1e-9)
    assert (shares["foundation"] > 0.0).all() == (frame is SPRUNG)
    assert np.argmax(modes.energy_shares[0]) == MEMBERS.index("load")
    assert shares["load"][0] > 0.99


def test_crane_without_jib_or_load_is_refused():
    with pytest.raises(ValueError, match=r"frame.jib: wanted a flexible jib, got None"):
        PlaneCrane(replace(FRAME, jib=None))
    with pytest.raises(ValueError, match=r"frame.payload_mass: wanted a mass above 0 kg, got 0.0"):
        PlaneCrane(replace(FRAME, payload_mass=0.0))
    with pytest.raises(ValueError, match="position: wanted 0 to"):
        PlaneCrane(FRAME).modes(REACH + 0.1, 2)

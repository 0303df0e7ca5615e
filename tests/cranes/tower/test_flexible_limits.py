"""The flexible crane with one shape per member is the lumped slewing crane with a rigid counterweight."""

import dataclasses
from dataclasses import dataclass

import numpy as np
import pytest
from samples import lab_crane

from towercrane.cranes.slewing.reduce import make_rigid
from towercrane.cranes.tower.equations.small_motions import natural_modes
from towercrane.cranes.tower.model import FlexibleModel
from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.cranes.tower.modes.mass_sums import point_sums, rigid_sums
from towercrane.cranes.tower.modes.modal_crane import FlexibleCrane
from towercrane.cranes.tower.outputs.kinematics import Kinematics
from towercrane.linear.linearise import linearise
from towercrane.motions.motion import rest
from towercrane.simulation.observed import Instant
from towercrane.simulation.simulate import simulate

P = lab_crane.MULTI_MASS
HEIGHT, REACH = P.geometry_tower_height, P.geometry_jib_radius


@dataclass(frozen=True)
class Member:
    """One shape (z / L)^power without mass, of a given stiffness."""

    length: float
    power: int
    stiffness: float
    count: int = 1

    @property
    def angular_frequencies(self):
        return np.array([np.sqrt(self.stiffness)])

    def __call__(self, position, derivative=0):
        polynomial = np.polynomial.Polynomial([0.0] * self.power + [self.length**-self.power])
        return np.atleast_1d(polynomial.deriv(derivative)(np.asarray(position, dtype=float)))[None].reshape(
            1, *np.shape(position)
        )

    def mass_matrix(self):
        return np.zeros((1, 1))

    slope_matrix = weight_matrix = mass_matrix

    def mass_moments(self):
        return np.zeros(1), np.zeros(1)

    def mass_moment(self):
        return np.zeros(1)

    rotary_moments = deflection_integrals = mass_moment

    def stiffness_matrix(self):
        return np.array([[self.stiffness]])

    def rotation(self, position):
        return self(position, 1)


def members():
    """Slope at the tower's top 2 x / H, a jib hinged at its root with the mass at its tip."""
    lateral = Member(REACH, 1, P.stiffness_jib_lateral / REACH**2)
    vertical = Member(REACH, 1, P.stiffness_jib_vertical)
    counter = P.mass_counterweight * P.geometry_counterweight_radius
    rigid = rigid_sums(
        P.mass_tower_top + P.mass_counterweight,
        -counter,
        counter * P.geometry_counterweight_radius,
        2,
        yaw=P.inertia_tower_top,
    )
    crane = FlexibleCrane(
        name="laboratory crane",
        tower_height=HEIGHT,
        jib_length=REACH,
        tower=Member(HEIGHT, 2, P.stiffness_tower_x),
        torsion=Member(HEIGHT, 1, P.stiffness_tower_torsion),
        lateral=lateral,
        vertical=vertical,
        jib=point_sums([REACH], [P.mass_jib_tip], lateral, vertical),
        counter=rigid,
        tower_mass=1.0,
        trolley_mass=0.0,
        gravity=P.gravity,
    )
    ratios = [
        damping / (2.0 * np.sqrt(stiffness))
        for damping, stiffness in (
            (P.damping_tower_x, P.stiffness_tower_x),
            (P.damping_tower_torsion, P.stiffness_tower_torsion),
            (P.damping_jib_lateral / REACH**2, P.stiffness_jib_lateral / REACH**2),
            (P.damping_jib_vertical, P.stiffness_jib_vertical),
        )
    ]
    # Only forces of modes carry these ratios: each shape's mass is one by definition.
    drive = lumped().crane.drive
    return FlexibleModel(
        crane, lab_crane.LOAD, slewing=drive, drive_inertia=P.inertia_platform, damping=ModalDamping(*ratios)
    )


def lumped(whole=None):
    whole = whole or lab_crane.crane()
    rigid = make_rigid(whole.crane, ["counter_jib_lateral", "counter_jib_vertical"])
    return dataclasses.replace(whole, crane=rigid)


def test_first_example_of_the_slewing_crane():
    motions = lab_crane.motions()
    options = {"rtol": 1e-10, "atol": 1e-12, "output_step": 0.02}
    expected = simulate(lumped(), motions, 14.0, **options)
    scene = members()
    drives = {"trolley": rest(REACH), **motions}
    result = simulate(scene, drives, 14.0, **options)
    # Sway counts along the lumped jib, which turns with its hinge.
    sideways = result["jib_tip_deflection_sideways"].values / REACH
    radial, across = np.tan(result["sway_radial"].values), np.tan(result["sway_tangential"].values)
    c, s = np.cos(sideways), np.sin(sideways)
    found = {
        "sway_radial": np.arctan(radial * c + across * s),
        "sway_tangential": np.arctan(across * c - radial * s),
    }
    for name, angle in found.items():
        assert np.degrees(np.max(abs(angle - expected[name].values))) < 0.005, name
    assert np.max(abs(result["slewing_angle"].values - expected["platform_angle"].values)) < 1e-4
    assert np.degrees(np.max(found["sway_radial"])) == pytest.approx(26.47, abs=0.01)
    assert np.max(abs(result["slewing_torque"].values - expected["drive_torque"].values)) < 0.1


def test_frequencies_of_the_slewing_crane():
    # At rest, on the soft line of the drive. The tower of the lumped crane leans along its jib only.
    model = lumped(lab_crane.lossless())
    found = np.array([mode.angular_frequency for mode in natural_modes(members(), REACH, 2.0)])
    expected = 2 * np.pi * linearise(model, {"shaft": rest(0.0), "rope": rest(2.0)}, outputs=[]).frequencies
    error = abs(found / expected - 1)
    assert np.max(error[:4]) < 1e-4
    assert np.max(error) < 6e-3


def test_section_and_state_of_the_lumped_scene_have_their_names():
    scene = members()
    assert list(scene.state_names) == [
        "tower_x_mode_1",
        "tower_y_mode_1",
        "torsion_mode_1",
        "slewing_angle",
        "jib_lateral_mode_1",
        "jib_vertical_mode_1",
    ]
    assert scene.channels == ("trolley", "rope", "shaft")
    motion = Kinematics(scene.seen, Instant(np.zeros(scene.size), (), (), np.zeros((3, 3))))
    assert np.allclose(motion.head.rows, np.eye(3))

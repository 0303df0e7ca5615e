"""The slewing cranes of two papers as data.

Multi-mass: Marinovic, Sprecic, Jerman (2012), ten degrees of freedom with the load. Basic (seven) and enhanced
(eight): Jerman (2006). The frames follow the first: the tower's top moves by x and y in the frame that turns with the
tower, its tilt is the tip slope 2 x / H of a cantilever bent by a moment, the jib turns with an angle of its own.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from towercrane.cranes.slewing.description import Drive, LinearOutput, Link, LumpedCrane, Point, Spring
from towercrane.kernels.elastic_rope import Elasticity

if TYPE_CHECKING:
    from towercrane.cranes.slewing.parameters import BasicParameters, EnhancedParameters, MultiMassParameters

PLATFORM, TOWER, JIB = "platform_angle", "tower_angle", "jib_angle"
TOWER_X, TOWER_Y, JIB_Z = "tower_x", "tower_y", "jib_vertical"
COUNTER_JIB, COUNTER_JIB_Z = "counter_jib_angle", "counter_jib_vertical"


def _drive(p: BasicParameters | EnhancedParameters | MultiMassParameters) -> Drive:
    return Drive(
        on=PLATFORM,
        soft=p.drive_soft_stiffness,
        stiff=p.drive_stiff_stiffness,
        corner=p.drive_corner,
        damping=p.drive_damping,
        friction=p.friction_law,
        friction_torque=p.friction_torque,
        friction_rate=p.friction_rate,
    )


def enhanced(p: EnhancedParameters | MultiMassParameters) -> LumpedCrane:
    """Eight degrees of freedom: platform, tower bending and torsion, jib lateral and vertical, and the load.

    The counterweight is part of the tower top's mass and inertia; its weight bends the tower by a steady moment.
    """
    top = p.geometry_tower_height + p.geometry_top_height
    tower = Link(TOWER, {TOWER_X: 1.0}, {TOWER_Y: 1.0})
    slope = 2.0 / p.geometry_tower_height
    reach = p.geometry_jib_radius
    lateral, vertical = p.stiffness_jib_lateral, p.stiffness_jib_vertical
    counter_moment = getattr(p, "mass_counter_moment", 0.0)
    return LumpedCrane(
        name=p.name,
        coordinates=(JIB_Z, JIB, TOWER_Y, TOWER_X, TOWER, PLATFORM),
        points={
            "tower top": Point(p.mass_tower_top, (tower,), {"": top}, p.drag_tower_top),
            "jib tip": Point(
                p.mass_jib_tip,
                (tower, Link(JIB, {"": reach})),
                {"": top, JIB_Z: 1.0, TOWER_X: -slope * reach},
                p.drag_jib_tip,
            ),
        },
        springs=(
            Spring("tower_x", {TOWER_X: 1.0}, p.stiffness_tower_x, p.damping_tower_x),
            Spring("tower_y", {TOWER_Y: 1.0}, p.stiffness_tower_y, p.damping_tower_y),
            Spring("jib_vertical", {JIB_Z: 1.0}, vertical, p.damping_jib_vertical),
            Spring("tower_torsion", {TOWER: 1.0, PLATFORM: -1.0}, p.stiffness_tower_torsion, p.damping_tower_torsion),
            Spring("jib_lateral", {JIB: 1.0, TOWER: -1.0}, lateral, p.damping_jib_lateral),
        ),
        drive=_drive(p),
        inertias={TOWER: p.inertia_tower_top, PLATFORM: p.inertia_platform},
        steady_force={TOWER_X: -slope * p.gravity * counter_moment},
        counter_moments={TOWER: p.gravity * counter_moment},
        suspension="jib tip",
        jib_angle=JIB,
        linear_outputs={
            "jib_moment_horizontal": LinearOutput(
                "N m", "moment of the jib's lateral spring", {JIB: lateral, TOWER: -lateral}
            ),
            "jib_moment_vertical": LinearOutput(
                "N m", "moment of the jib's vertical spring, positive under load", {JIB_Z: -reach * vertical}
            ),
        },
        gravity=p.gravity,
    )


def multi_mass(p: MultiMassParameters) -> LumpedCrane:
    """Ten degrees of freedom: the enhanced crane with its counterweight on a flexible counter-jib of its own."""
    from dataclasses import replace

    crane = enhanced(p)
    reach, slope = p.geometry_counterweight_radius, 2.0 / p.geometry_tower_height
    counterweight = Point(
        p.mass_counterweight,
        # The counter-jib's angle is zero opposite to the jib, so its spring needs no offset.
        (Link(TOWER, {TOWER_X: 1.0}, {TOWER_Y: 1.0}), Link(COUNTER_JIB, {"": -reach})),
        {
            "": p.geometry_tower_height + p.geometry_top_height,
            COUNTER_JIB_Z: 1.0,
            TOWER_X: slope * reach,
        },
        p.drag_counterweight,
    )
    return replace(
        crane,
        coordinates=(*crane.coordinates, COUNTER_JIB, COUNTER_JIB_Z),
        points={**crane.points, "counterweight": counterweight},
        springs=(
            *crane.springs,
            Spring(
                "counter_jib_lateral",
                {COUNTER_JIB: 1.0, TOWER: -1.0},
                p.stiffness_counter_jib_lateral,
                p.damping_counter_jib_lateral,
            ),
            Spring(
                "counter_jib_vertical",
                {COUNTER_JIB_Z: 1.0},
                p.stiffness_counter_jib_vertical,
                p.damping_counter_jib_vertical,
            ),
        ),
    )


def basic(p: BasicParameters, rope_length: float) -> LumpedCrane:
    """Seven degrees of freedom: platform, three shifts of the jib tip, and the load on an elastic rope.

    Its spring and damper are those of the rope's length at the start [m].
    """
    top, reach = p.geometry_tower_height + p.geometry_top_height, p.geometry_jib_radius
    x, y, z = "jib_radial", "jib_lateral", JIB_Z
    lateral, vertical = p.stiffness_jib_lateral, p.stiffness_jib_vertical
    return LumpedCrane(
        name=p.name,
        coordinates=(z, y, x, PLATFORM),
        points={
            "jib tip": Point(
                p.mass_jib_tip, (Link(PLATFORM, {"": reach, x: 1.0}, {y: 1.0}),), {"": top, z: 1.0}, p.drag_jib_tip
            )
        },
        springs=(
            Spring("jib_radial", {x: 1.0}, p.stiffness_jib_radial, p.damping_jib_radial),
            Spring("jib_lateral", {y: 1.0}, lateral, p.damping_jib_lateral),
            Spring("jib_vertical", {z: 1.0}, vertical, p.damping_jib_vertical),
        ),
        drive=_drive(p),
        inertias={PLATFORM: p.inertia_platform},
        suspension="jib tip",
        jib_angle=PLATFORM,
        linear_outputs={
            "jib_moment_horizontal": LinearOutput("N m", "moment of the jib's lateral spring", {y: reach * lateral}),
            "jib_moment_vertical": LinearOutput(
                "N m", "moment of the jib's vertical spring, positive under load", {z: -reach * vertical}
            ),
        },
        rope=Elasticity.of_spring(p.stiffness_rope, p.damping_rope, rope_length),
        gravity=p.gravity,
    )

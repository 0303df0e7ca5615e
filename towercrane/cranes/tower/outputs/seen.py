"""What the outputs of a flexible crane know of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.tower.outputs.cut_sums import TowerCut

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.tower.equations.constants import Constants
    from towercrane.cranes.tower.equations.flexible import Equations
    from towercrane.cranes.tower.modes.exposures import Exposure
    from towercrane.cranes.tower.modes.mass_sums import MassSums
    from towercrane.cranes.tower.outputs.cut_sums import Cuts

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Seen:
    """Constants of the outputs.

    Parameters
    ----------
    crane : Constants
        Those of the equations.
    heading : float
        Angle from the fixed x axis to the first axis of the coordinates, not zero in a plane alone [rad].
    jib, counter : MassSums
        Masses of the jib, and of what else turns.
    exposure : Exposure or None
        What a wind meets.
    tip, counter_tip : ndarray, shape (modes of jib and counter-jib,)
        Their shapes at the tip of the jib, and at that of the counter-jib.
    counter_roll : float
        Moment of inertia about the jib's axis of what else turns than jib and counter-jib [kg m^2].
    tower_height : float
        [m]
    foot : TowerCut
        All of the tower: what is above its undeformed foot.
    cuts : Cuts
        Named sections of tower and jib.
    collar_heights : ndarray, shape (c,)
        Of what ties the tower to a building, the lowest first [m].
    collar_springs : ndarray, shape (c, 3)
        Stiffness against deflection, rotation and twist [N/m, N m/rad, N m/rad].
    collar_bends, collar_turns : ndarray, shape (c, tower modes)
        Deflection and rotation of the tower there.
    collar_twists : ndarray, shape (c, torsion modes)
        Its twist there.
    """

    crane: Constants
    heading: float
    jib: MassSums
    counter: MassSums
    exposure: Exposure | None
    tip: Floats
    counter_tip: Floats
    counter_roll: float
    tower_height: float
    foot: TowerCut
    cuts: Cuts
    collar_heights: Floats
    collar_springs: Floats
    collar_bends: Floats
    collar_turns: Floats
    collar_twists: Floats


def seen_of(model: Equations, cuts: Cuts) -> Seen:
    """Constants of a crane's outputs in its chosen coordinates."""
    crane = model.crane
    zeroth, first = crane.tower_moments
    heights = np.array([collar.height for collar in crane.collars])
    springs = [(own.stiffness, own.rotation_stiffness, own.torsional_stiffness) for own in crane.collars]
    return Seen(
        crane=model.constants,
        heading=model.heading,
        jib=crane.jib,
        counter=crane.counter,
        exposure=crane.exposure,
        tip=crane.tip_shapes[:, 0],
        counter_tip=crane.counter_tip_shapes,
        counter_roll=crane.written.roll_inertia if crane.written is not None else 0.0,
        tower_height=crane.tower_height,
        foot=TowerCut(
            name="",
            height=0.0,
            bends=np.zeros(crane.tower.count),
            mass=crane.tower_mass,
            moment=crane.tower_moment,
            zeroth=zeroth,
            first=first + crane.tower.rotary_moments(),
            products=crane.tower_matrices[0],
            torsion=crane.torsion.mass_moment(),
            collars=0,
            exposed=crane.exposure.tower if crane.exposure is not None else (),
        ),
        cuts=cuts,
        collar_heights=heights,
        collar_springs=np.array(springs).reshape(-1, 3),
        collar_bends=crane.tower(heights).T,
        collar_turns=crane.tower.rotation(heights).T,
        collar_twists=crane.torsion(heights).T,
    )

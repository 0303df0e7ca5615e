"""The constants of a flexible crane's compiled equations, as :mod:`towercrane.cranes.tower.kernels.layout` orders
them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.tower.kernels import layout

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.tower.equations.coordinates import Coordinates

    Floats = NDArray[np.float64]

TILT_LIMIT = 0.5
"""Tilt of the tower top at which a run ends as buckled [rad]: far beyond what a beam theory of small slopes holds."""


def geometric_stiffness(model: Coordinates) -> Floats:
    """Stiffness that the weight takes from the tower modes, int N phi' phi' (tower, tower) [1/s^2].

    N(s) is the weight of all that is above the height s.
    """
    crane = model.crane
    own = 1.0 if model.self_weight else 0.0
    above = own * crane.slewing.mass + crane.trolley_mass + model.load.mass
    slopes, weights = crane.tower_softening
    return np.asarray(crane.gravity * (above * slopes + own * weights))


def numbers(model: Coordinates) -> Floats:
    """Places of coordinates, rigid masses, load, channels, drive; shape (layout.NUMBERS,)."""
    crane, load, drive, slewing = model.crane, model.load, model.drive, model.crane.slewing
    values = np.zeros(layout.NUMBERS)
    values[: len(model.counts)] = np.cumsum(list(model.counts.values()))
    values[layout.TROLLEY_MASS] = crane.trolley_mass
    values[layout.GRAVITY] = crane.gravity
    values[layout.SELF_GRAVITY] = crane.gravity if model.self_weight else 0.0
    values[layout.SLEWING_MASS], values[layout.STATIC_MOMENT] = slewing.mass, slewing.moment
    values[layout.ROLL], values[layout.PITCH], values[layout.YAW] = slewing.roll, slewing.pitch, slewing.yaw
    values[layout.JIB_LENGTH] = crane.jib_length
    values[layout.TILT_LIMIT] = TILT_LIMIT
    values[layout.LOAD_MASS] = load.mass
    values[layout.DRAG] = load.drag
    values[layout.HINGE_DAMPING] = load.rope_damping
    values[layout.SLEWING_CHANNEL] = -1 if model.slewing == "fixed" else layout.SLEWING
    values[layout.WIND_CHANNEL] = len(model.channels) - 3 if model.wind else -1
    values[layout.PLANE_COSINE], values[layout.PLANE_SINE] = np.cos(model.heading), np.sin(model.heading)
    values[layout.FRICTION_RATE] = 1.0
    if drive is not None:
        values[layout.SOFT], values[layout.STIFF] = drive.soft, drive.stiff
        values[layout.CORNER], values[layout.DRIVE_DAMPING] = drive.corner, drive.damping
        if drive.friction == "tanh":
            values[layout.FRICTION_TORQUE] = drive.friction_torque
            values[layout.FRICTION_RATE] = drive.friction_rate
    if crane.exposure is not None:
        values[layout.HEAD_AREA], values[layout.HEAD_AREA_MOMENT] = crane.exposure.mass, crane.exposure.moment
    return values


def vectors(model: Coordinates) -> Floats:
    """What each coordinate moves, carries, loses and shows the wind; shape (layout.VECTORS, coordinates)."""
    crane, parts, n = model.crane, model.parts, model.coordinates
    values = np.zeros((layout.VECTORS, n))
    # One mode list per plane of the tower: both see the same tip, slope and wind.
    swept = crane.tower_drag * crane.tower.deflection_integrals()
    planes = ("tower_x", layout.SLIDE_X, layout.TILT_Y, 1.0), ("tower_y", layout.SLIDE_Y, layout.TILT_X, -1.0)
    for plane, slide, tilt, sense in planes:
        if model.counts[plane]:
            values[slide, parts[plane]] = crane.tower(crane.tower_height)
            values[tilt, parts[plane]] = sense * crane.top_slope
            values[layout.EXPOSURE, parts[plane]] = swept
    values[layout.TURN, parts["torsion"]] = crane.torsion(crane.tower_height)
    values[layout.TURN, parts["slewing"]] = 1.0
    jib = slice(parts["jib_lateral"].start, n)
    values[layout.JIB_MASS, jib] = crane.slewing.first
    values[layout.JIB_MOMENT, jib] = crane.slewing.second
    if crane.exposure is not None:
        values[layout.EXPOSURE, jib] = crane.exposure.first
    d = model.damping
    ratios = np.repeat([d.tower, d.tower, d.torsion, 0.0, d.lateral, d.vertical], list(model.counts.values()))
    # Of a mode that a cap slows, of its slowed frequency and greater mass: the ratio is as stated.
    values[layout.DAMPING] = 2.0 * ratios * model.angular_frequencies * np.sqrt(1.0 + model.added_mass)
    values[layout.CAP] = model.added_mass
    return values


def matrices(model: Coordinates) -> Floats:
    """Own mass and stiffness of the coordinates; shape (2, coordinates, coordinates)."""
    crane, parts, n = model.crane, model.parts, model.coordinates
    own, stiffness = np.zeros((n, n)), np.diag(model.angular_frequencies**2)
    for plane in ("tower_x", "tower_y"):
        if model.counts[plane]:
            own[parts[plane], parts[plane]], stiffness[parts[plane], parts[plane]] = crane.tower_matrices
            if model.weight_softening:
                stiffness[parts[plane], parts[plane]] -= geometric_stiffness(model)
    own[parts["torsion"], parts["torsion"]] = crane.torsion.mass_matrix()
    own[parts["slewing"], parts["slewing"]] = model.drive_inertia
    jib = slice(parts["jib_lateral"].start, n)
    own[jib, jib] = crane.slewing.products
    return np.array([own, stiffness])


def scale(model: Coordinates) -> Floats:
    """Tolerance of each state: metres where a mode moves most, radians of twist and swing, joules of work."""
    # The tip alone would not do: higher tower modes move it little and the mast below it a lot.
    crane = model.crane
    height, reach = (np.linspace(0.0, length, 201) for length in (crane.tower_height, crane.jib_length))
    bends, sides, rises = crane.tower(height), crane.lateral(reach), crane.vertical(reach)
    shapes = [bends, bends[: model.counts["tower_y"]], crane.torsion(height)]
    shapes += [np.ones((model.counts["slewing"], 1)), sides, rises]
    largest = np.concatenate([abs(shape).max(axis=1) for shape in shapes])
    sizes = np.concatenate([1.0 / largest, np.ones(model.axes)])
    return np.concatenate([sizes, sizes, [model.load.work_scale(crane.gravity, crane.jib_length)]])

"""Mass and stiffness of a flexible crane in its coordinates, what weight takes from the stiffness, and tolerances."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.tower.equations.coordinates import Coordinates

    Floats = NDArray[np.float64]


def geometric_stiffness(model: Coordinates) -> Floats:
    """Stiffness that the weight takes from the tower modes, int N phi' phi' (tower, tower) [1/s^2].

    N(s) is the weight of all that is above the height s.
    """
    return model.crane.gravity * _taken(model, 1.0 if model.self_weight else 0.0)


def _taken(model: Coordinates, own: float) -> Floats:
    """What unit gravity takes from the stiffness of the tower modes, by so much of the structure's own mass."""
    crane = model.crane
    above = own * crane.turning_mass + crane.trolley_mass + model.load.whole_mass
    slopes, weights = crane.tower_softening
    return np.asarray(above * slopes + own * weights)


def softening(model: Coordinates) -> Floats:
    """Stiffness that a unit acceleration of the ground, upward, takes from the tower; shape (n, n)."""
    found = np.zeros((model.coordinates, model.coordinates))
    for plane in ("tower_x", "tower_y"):
        if model.ground and model.weight_softening and model.counts[plane]:
            found[model.parts[plane], model.parts[plane]] = _taken(model, 1.0)
    return found


def own_mass(model: Coordinates) -> Floats:
    """Mass of the tower alone, of the drive and of the jib's modes; shape (n, n)."""
    crane, parts, n = model.crane, model.parts, model.coordinates
    own = np.zeros((n, n))
    for plane in ("tower_x", "tower_y"):
        if model.counts[plane]:
            own[parts[plane], parts[plane]] = crane.tower_matrices[0]
    own[parts["torsion"], parts["torsion"]] = crane.torsion.mass_matrix()
    own[parts["slewing"], parts["slewing"]] = model.drive_inertia
    jib = slice(parts["jib_lateral"].start, parts["counter_jib_vertical"].stop)
    own[jib, jib] = crane.slewing.products
    if crane.tied is not None:
        carried = slice(jib.start, n)
        own[carried, carried] = np.einsum("ijkk->ij", crane.tied_sums.products)
    return own


def rotary_mass(model: Coordinates) -> Floats:
    """What the own rotary inertia of jib and counter-jib adds to that; shape (n, n)."""
    found = np.zeros((model.coordinates, model.coordinates))
    jib = slice(model.parts["jib_lateral"].start, model.parts["counter_jib_vertical"].stop)
    found[jib, jib] = model.crane.slewing.turned_products
    return found


def stiffness(model: Coordinates) -> Floats:
    """Stiffness of the coordinates, less what the weight takes; shape (n, n)."""
    found = np.diag(model.angular_frequencies**2)
    for plane in ("tower_x", "tower_y"):
        if model.counts[plane]:
            found[model.parts[plane], model.parts[plane]] = model.crane.tower_matrices[1]
            if model.weight_softening:
                found[model.parts[plane], model.parts[plane]] -= geometric_stiffness(model)
    return found


def scale(model: Coordinates) -> Floats:
    """Tolerance of each state: metres where a mode moves most, radians of turns and swing, joules of work."""
    # The tip alone would not do: higher tower modes move it little and the mast below it a lot.
    crane = model.crane
    height, reach = (np.linspace(0.0, length, 201) for length in (crane.tower_height, crane.jib_length))
    bends = crane.tower(height)
    largest = [abs(bends).max(axis=1), abs(bends[: model.counts["tower_y"]]).max(axis=1)]
    largest += [abs(crane.torsion(height)).max(axis=1), np.ones(model.counts["slewing"])]
    for jib, counter in ((crane.lateral, crane.counter_lateral), (crane.vertical, crane.counter_vertical)):
        largest.append(abs(jib(reach)).max(axis=1))
        if counter is not None:
            largest.append(abs(counter(np.linspace(0.0, counter.length, 201))).max(axis=1))
    largest.append(np.ones(model.counts.get("luffing", 0)))
    if crane.tied is not None:
        largest += [
            abs(crane.tied.column([crane.tied.bars.head.height]))[:, 0],
            np.ones(model.counts["tie"] + model.counts["tie_sideways"]),
        ]
    sizes = np.concatenate([1.0 / np.concatenate(largest), np.ones(model.axes * len(model.load.bodies))])
    return np.concatenate([sizes, sizes, [model.load.work_scale(crane.gravity, crane.jib_length)]])


def met_by_wind(model: Coordinates) -> dict[str, Any]:
    """What the wind meets; nothing where none blows."""
    exposure, parts, n = model.crane.exposure, model.parts, model.coordinates
    head, tower = ((), ()) if exposure is None else (exposure.head, exposure.tower)
    turning, head_exposure, tower_exposure = (
        [own.jib + own.counter for own in head], np.zeros((len(head), n)), np.zeros((len(tower), n))
    )  # fmt: skip
    jib = slice(parts["jib_lateral"].start, parts["counter_jib_vertical"].stop)
    for row, sums in zip(head_exposure, turning, strict=True):
        row[jib] = sums.first
    for row, part in zip(tower_exposure, tower, strict=True):
        for plane in ("tower_x", "tower_y"):
            # One mode list per plane of the tower: both see the same wind.
            row[parts[plane]] = part.swept[: model.counts[plane]]
    return {
        "head_nodes": tuple(own.node for own in head), "tower_nodes": tuple(own.node for own in tower),
        "head_places": np.array([own.place for own in head]),
        "head_area": np.array([sums.mass for sums in turning]),
        "head_area_moment": np.array([sums.moment for sums in turning]),
        "head_exposure": head_exposure, "tower_exposure": tower_exposure,
    }  # fmt: skip

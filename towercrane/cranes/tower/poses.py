"""Poses of a flexible tower crane in the plane or in space: its members' shapes from their modal coordinates."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.parts.poses import Poses, sampled

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import NDArray

    from towercrane.cranes.tower.file.case_tables import TowerCase
    from towercrane.cranes.tower.model import FlexibleModel
    from towercrane.cranes.tower.modes.luffing_jib import LuffingJib

    Floats = NDArray[np.float64]

BENDING = "jib_lateral", "counter_jib_lateral", "jib_vertical", "counter_jib_vertical"
"""Kinds of modes of jib and counter-jib in the order of their shapes."""

POINTS = 40
"""Points along a member."""


def tower_poses(model: FlexibleModel, tables: TowerCase, result: xr.Dataset, times: Floats) -> Poses:
    """Poses of a tower crane.

    The positions are those of the equations of motion, in which tilt and twist of the head are finite rotations.

    Parameters
    ----------
    model : FlexibleModel
        In the modes that the result has.
    tables : TowerCase
    result : xarray.Dataset
    times : ndarray, shape (f,)
        [s]

    Raises
    ------
    ValueError
        If the result holds no coordinates of such a crane.
    """
    from scipy.spatial.transform import Rotation

    crane, behind = model.crane, tables.crane.counter_jib
    # In the plane the head does not turn.
    heading = sampled(result, "slewing_angle", times) if "slewing_angle" in result else np.zeros(len(times))
    q = {kind: _coordinates(result, kind, times) for kind in ("tower_x", "tower_y", "torsion", *BENDING)}
    amplitudes = np.concatenate([q[kind] for kind in BENDING], axis=1)
    height, middle = crane.tower_height, sum(crane.groups[:2])

    up = np.linspace(0.0, height, POINTS)
    upright = np.broadcast_to(np.stack([0.0 * up, 0.0 * up, up], axis=1), (len(times), POINTS, 3))
    tower = upright.copy()
    shapes, slopes = crane.tower(up), crane.top_slope
    slope = np.zeros((2, len(times)))
    for axis, kind in enumerate(("tower_x", "tower_y")):
        if q[kind].shape[1]:
            tower[..., axis] += q[kind] @ shapes
            slope[axis] = q[kind] @ slopes
    tilt = Rotation.from_rotvec(np.stack([-slope[1], slope[0], 0.0 * heading], axis=1))
    twist = q["torsion"] @ crane.torsion(height)
    head = (tilt * Rotation.from_euler("z", (heading + twist)[:, None])).as_matrix()
    turned = Rotation.from_euler("z", heading[:, None]).as_matrix()
    top = tower[:, -1]

    def placed(places: Floats, straight: Floats) -> tuple[Floats, Floats]:
        """Points in the head's axes, shape (f, p, 3): deformed, and undeformed."""
        return (
            top[:, None] + np.einsum("tij,tpj->tpi", head, places),
            upright[:, -1:] + np.einsum("tij,tpj->tpi", turned, straight),
        )

    def on_head(along: Floats, deflection: Floats) -> tuple[Floats, Floats]:
        """Points on the jib's line, shapes (f or 1, p) and (2, f, p): deformed, and undeformed."""
        places = np.stack(np.broadcast_arrays(along, *deflection), axis=-1)
        return placed(places, np.stack(np.broadcast_arrays(along, *np.zeros_like(deflection)), axis=-1))

    def bent(shapes: Floats) -> Floats:
        """Deflections to the left and up, shape (2, f, p), of shapes at places or at a place for each time."""
        at = "ti,ipt->tp" if shapes.ndim == 3 else "ti,ip->tp"
        parts = (slice(middle), slice(middle, None))
        return np.stack([np.einsum(at, amplitudes[:, part], shapes[part]) for part in parts])

    along = np.linspace(0.0, crane.jib_length, POINTS)
    deflection = bent(crane.jib_shapes(along))
    pairs = {"tower": (tower, upright)}
    if crane.collars:
        # They are parts of a building, which does not bend with the tower.
        held = np.array([[0.0, 0.0, collar.height] for collar in crane.collars])
        pairs["collars"] = (np.broadcast_to(held, (len(times), *held.shape)),) * 2
    if crane.luffing is not None:
        angles = sampled(result, "luffing_angle", times), sampled(result, "luffing_command", times)
        pairs |= {
            name: placed(*lines)
            for name, lines in luffing_lines(crane.luffing, along, deflection, angles).items()
        }  # fmt: skip
        return _poses(result, times, heading, pairs, height)
    back, hung = np.linspace(0.0, behind.reach, POINTS), np.array(behind.weights)
    joints = np.array(tables.crane.jib.joints)
    # A trolley that leaves the jib ends the run; its last row stands a hair beyond the end.
    trolley = np.clip(sampled(result, "trolley_position", times), 0.0, crane.jib_length)
    pairs |= {
        "jib": on_head(along[None], deflection),
        "counter-jib": on_head(-back[None], bent(crane.counter_shapes(back))),
        "suspension": on_head(trolley[:, None], bent(crane.jib_shapes(trolley[None]))),
    }
    if joints.size:
        pairs["joints"] = on_head(joints[None], bent(crane.jib_shapes(joints)))
    if hung.size:
        pairs["ballast"] = on_head(-hung[None], bent(crane.counter_shapes(hung)))
    if crane.tied is not None:
        kinds = *BENDING, "tower_head", "tie", "tie_sideways"
        bows = [_coordinates(result, kind, times) for kind in kinds]
        for name, (moved, straight) in crane.tied.lines(np.concatenate(bows, axis=1)).items():
            pairs[name] = placed(moved, np.broadcast_to(straight, moved.shape))
    return _poses(result, times, heading, pairs, height)


def luffing_lines(
    jib: LuffingJib, along: Floats, deflection: Floats, angles: tuple[Floats, Floats]
) -> dict[str, tuple[Floats, Floats]]:
    """Lines of a head whose jib pivots, in its axes, deformed and undeformed; shapes (f, p, 3).

    Parameters
    ----------
    jib : LuffingJib
    along : ndarray, shape (p,)
        Points from foot to head [m].
    deflection : ndarray, shape (2, f, p)
        Of the jib there, to the left and up from the chord [m].
    angles : tuple of 2 ndarrays, shape (f,)
        Of the chord, and of a straight jib on a rope that does not stretch [rad].
    """
    found: dict[str, list[Floats]] = {
        name: [] for name in ("jib", "frame", "luffing rope", "counter-jib", "ballast", "suspension")
    }
    for angle, (left, up) in zip(angles, (deflection, np.zeros_like(deflection)), strict=True):
        c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
        line = np.stack([jib.foot[0] + along * c - up * s, left, jib.foot[1] + along * s + up * c], axis=-1)
        still = np.zeros((len(angle), 1, 3))
        frame = still + np.array([jib.frame_head[0], 0.0, jib.frame_head[1]])
        last = min((body.place for body in jib.bodies), default=(0.0, 0.0))
        found["jib"].append(line)
        found["frame"].append(np.concatenate([still, frame], axis=1))
        found["luffing rope"].append(np.concatenate([frame, line[:, -1:]], axis=1))
        found["ballast"].append(still + np.array([last[0], 0.0, last[1]]))
        found["counter-jib"].append(np.concatenate([still, found["ballast"][-1]], axis=1))
        found["suspension"].append(line[:, -1:])
    return {name: (moved, straight) for name, (moved, straight) in found.items()}


def _poses(
    result: xr.Dataset, times: Floats, heading: Floats, pairs: dict[str, tuple[Floats, Floats]], height: float
) -> Poses:
    return Poses(
        times,
        heading,
        {name: deformed for name, (deformed, _) in pairs.items()},
        {name: still for name, (_, still) in pairs.items()},
        sampled(result, "payload_position", times) + np.array([0.0, 0.0, height]),
    )


def _coordinates(result: xr.Dataset, kind: str, times: Floats) -> Floats:
    """Amplitudes of the modes of a kind, none of them where the result has none; shape (f, modes)."""
    name = f"{kind}_coordinate"
    return sampled(result, name, times) if name in result else np.zeros((len(times), 0))

"""Lines of a crane in space that moves in one of its natural modes, seen along its jib."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.tower.poses import luffing_lines

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.tower.equations.small_motions import NaturalMode
    from towercrane.cranes.tower.model import FlexibleModel
    from towercrane.studies.space_modes import Place

    Floats = NDArray[np.float64]

POINTS = 60
"""Points along a member."""


def crane_lines(
    model: FlexibleModel, mode: NaturalMode, place: Place, counter_jib: float, scale: float = 0.0
) -> dict[str, Floats]:
    """Tower, jib, counter-jib and rope, moved by a mode times a scale.

    Parameters
    ----------
    model : FlexibleModel
    mode : NaturalMode
        Small motion about the equilibrium at ``place``.
    place : Place
    counter_jib : float
        Length of the counter-jib [m].
    scale : float
        Zero for the undeformed crane.

    Returns
    -------
    dict of str to ndarray, shape (points, 3)
        "tower", "jib", "counter-jib" and "rope" down to the load, past a hook; of jibs that pivot or hang on ties
        also what holds them; along the jib, across it in the turning sense,
        and up from the ground [m].
    """
    crane, parts = model.crane, model.parts
    height, n = crane.tower_height, model.coordinates
    heading = 0.0 if model.slewing == "fixed" else place.slewing_angle
    turn = np.array([[np.cos(heading), np.sin(heading)], [-np.sin(heading), np.cos(heading)]])
    bent = np.zeros((2, crane.tower.count))
    for row, kind in enumerate(("tower_x", "tower_y")):
        if model.counts[kind]:
            bent[row] = mode.shape[parts[kind]]
    bent = turn @ bent
    top, slope = bent @ crane.tower(height), bent @ crane.top_slope
    twist = mode.shape[parts["torsion"]] @ crane.torsion(height) + mode.shape[parts["slewing"]].sum()
    jib, middle = mode.shape[parts["jib_lateral"].start : n], sum(crane.groups[:2])

    def on_head(along: Floats) -> Floats:
        """Displacement of points of the head on the line of jib and counter-jib."""
        shapes = crane.jib_shapes(np.maximum(along, 0.0)) + crane.counter_shapes(np.maximum(-along, 0.0))
        across, up = jib[:middle] @ shapes[:middle], jib[middle : len(shapes)] @ shapes[middle:]
        moved = [np.full_like(along, top[0]), top[1] + twist * along + across, -slope[0] * along + up]
        return np.stack(moved, axis=1)

    def line(along: Floats) -> Floats:
        still = np.stack([along, np.zeros_like(along), np.full_like(along, height)], axis=1)
        return still + scale * on_head(along)

    def swayed(moved: Floats, still: Floats) -> Floats:
        """Points of the head that have moved in its axes, as these move."""
        x, _, z = still.T
        sway = np.stack([top[0] + slope[0] * z, top[1] + twist * x + slope[1] * z, -slope[0] * x], axis=1)
        return np.asarray(moved + scale * sway + np.array([0.0, 0.0, height]))

    z = np.linspace(0.0, height, POINTS)
    tower = np.stack([np.zeros_like(z), np.zeros_like(z), z], axis=1)
    tower[:, :2] += scale * (bent @ crane.tower(z)).T
    if crane.luffing is not None:
        points = np.linspace(0.0, crane.jib_length, POINTS)
        shapes = crane.jib_shapes(points)
        bends = np.stack([jib[:middle] @ shapes[:middle], jib[middle:-1] @ shapes[middle:]])[:, None]
        angle = np.array([place.position])
        found = {}
        for name, (moved, still) in luffing_lines(
            crane.luffing, points, scale * bends, (angle + scale * jib[-1], angle)
        ).items():
            found[name] = swayed(moved[0], still[0])
        hung = found.pop("suspension")[0]
        del found["ballast"]
    else:
        hung = line(np.array([place.position]))[0]
        found = {
            "jib": line(np.linspace(0.0, crane.jib_length, POINTS)),
            "counter-jib": line(np.linspace(-counter_jib, 0.0, POINTS)),
        }
    if crane.tied is not None:
        for name, (moved, still) in crane.tied.lines(scale * jib[None]).items():
            found[name] = swayed(moved[0], still[0])
    # The stretch of a rope that does stands before the ways of what hangs on rope and slings.
    links, drops = [hung], [place.rope_length, *(sling.length for sling in model.load.slings)]
    if model.load.elasticity is not None:
        drops[0] += scale * mode.shape[n]
    for drop, way in zip(drops, mode.shape[-2 * len(drops) :].reshape(-1, 2), strict=True):
        links.append(links[-1] + [*(scale * (turn @ way)), -drop])
    return {"tower": tower, **found, "rope": np.stack(links)}

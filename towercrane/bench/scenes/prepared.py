"""Runs made ready to be solved many times, one for each kind of crane."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from towercrane.cases.case import load_case
from towercrane.cases.models import model_of, motions_of
from towercrane.cranes.tower.file.build import tower_model
from towercrane.cranes.tower.file.case_tables import TowerCase
from towercrane.cranes.tower.outputs.kinematics import Kinematics
from towercrane.motions.motion import phases
from towercrane.simulation.observed import Instant

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from towercrane.bench.scenes.plain import Rhs
    from towercrane.cranes.tower.model import FlexibleModel
    from towercrane.motions.motion import Phases
    from towercrane.simulation.system import System

    Floats = NDArray[np.float64]


SPACE = "qtz5613/manoeuvre"
"""Case in space: slews, travels and hoists at once."""


@dataclass(frozen=True, eq=False)
class Plain:
    """The scene's equations in NumPy: model, right-hand side, start, absolute tolerances, way back to its states."""

    model: FlexibleModel
    rhs: Rhs
    start: Floats
    scale: Floats
    back: Callable[[Floats], Floats]


@dataclass(frozen=True, eq=False)
class Scene:
    """A run that every solver is given alike; nothing is watched for, on any side.

    Parameters
    ----------
    name : str
        Name of the subject.
    title : str
    system, cut, start : System, Phases, ndarray
    grid : ndarray, shape (p,)
        Times at which states are compared [s].
    outputs : callable
        States (p, size) to the quantities that errors are measured on (p, k).
    measured : str
        What those are.
    plain : Plain, optional
    wanted : float
        Error at which the solvers' costs are compared.
    """

    name: str
    title: str
    system: System
    cut: Phases
    start: Floats
    grid: Floats
    outputs: Callable[[Floats], Floats]
    measured: str
    plain: Plain | None = None
    wanted: float = 1e-6


def unwatched(system: System) -> System:
    """The system without guards that end a run: SciPy would pay for them at every step."""
    return dataclasses.replace(system, floors=np.full(len(system.floors), -np.inf))


def radial_scene(tower_modes: int = 2, jib_modes: int = 3, case: str = "qtz5613/condition-3") -> Scene:
    """120 s of condition 3, from equilibrium."""
    from towercrane.bench.scenes.plain import model_states, plain_rhs, plain_state

    loaded = load_case(case)
    model = tower_model(loaded.tables(TowerCase), tower_modes=tower_modes, jib_vertical_modes=jib_modes)
    motions = motions_of(loaded)
    cut = phases((motions["trolley"], motions["rope"]), loaded.run.duration)
    start = model.start(cut.inputs[0])
    half = np.append(model.system.scale[: model.coordinates], 1.0)
    plain = Plain(
        model,
        plain_rhs(model),
        plain_state(model, start[None])[0],
        np.tile(half, 2),
        lambda found: model_states(model, found),
    )
    return Scene(
        "radial",
        f"120 s of condition 3 ({tower_modes} tower and {jib_modes} jib modes, from equilibrium)",
        unwatched(model.system), cut, start, np.linspace(0.0, loaded.run.duration, 2401),
        lambda states: radial_outputs(model, states), "tower top, jib tip and swing", plain,
    )  # fmt: skip


def radial_outputs(model: FlexibleModel, states: Floats) -> Floats:
    """Tower top, jib tip and swing over time; shape (p, 3)."""
    n, tower, crane = model.coordinates, model.counts["tower_x"], model.crane
    q = states[:, :n]
    top = q[:, :tower] @ crane.tower(crane.tower_height)
    tip = q[:, tower:] @ crane.vertical(crane.jib_length)
    return np.stack([top, tip, np.arctan2(states[:, n], -states[:, n + 1])], axis=1)


def space_scene(duration: float = 30.0) -> Scene:
    """The first seconds of a crane in space that slews, travels and hoists at once, from equilibrium."""
    loaded = load_case(SPACE)
    model = tower_model(
        loaded.tables(TowerCase), tower_modes=2, torsion_modes=1, jib_lateral_modes=3, jib_vertical_modes=3
    )
    motions = motions_of(loaded)
    cut = phases(tuple(motions[channel] for channel in model.channels), duration)
    grid = np.linspace(0.0, duration, round(20.0 * duration) + 1)
    return Scene(
        "space",
        f"{duration:g} s of the crane in space (2+2+1 tower, 3+3 jib modes; slewing, trolley and hoist at once)",
        unwatched(model.system), cut, model.start(cut.inputs[0]), grid,
        lambda states: space_outputs(model, states),
        "tower top, twist, jib tip and the rope's direction",
    )  # fmt: skip


def space_outputs(model: FlexibleModel, states: Floats) -> Floats:
    """Tower top along x and y, its twist, jib tip left and up, rope's direction along x and y; shape (p, 7)."""
    at = Kinematics(model.seen, Instant(states.T, (), (), ()))
    q = at.state.coordinates
    return np.stack([*at.top(q)[:2], at.twist, *at.deflection(model.seen.tip, q), *at.rope[:2]], axis=1)


def lumped_scene(kind: str) -> Scene:
    """Example 1 of a slewing crane."""
    loaded = load_case(f"slewing/{kind}/example-1")
    model = model_of(loaded)
    cut = phases(tuple(motions_of(loaded)[channel] for channel in model.channels), loaded.run.duration)
    rope: int = model.rope  # type: ignore[attr-defined]
    return Scene(
        kind, f"Example 1 of the slewing crane, {kind} model, {loaded.run.duration:g} s",
        unwatched(model.system), cut, model.start(cut.inputs[0]),
        np.arange(0.0, loaded.run.duration, 0.01),
        lambda states: states[:, rope : rope + 2], "the rope's direction",
    )  # fmt: skip


def jib_scene() -> Scene:
    """All joints of the jib crane and the winch at once."""
    loaded = load_case("jib-crane/combined")
    model = model_of(loaded)
    cut = phases(tuple(motions_of(loaded)[channel] for channel in model.channels), loaded.run.duration)
    start = model.start(cut.inputs[0])
    return Scene(
        "jib", f"Jib crane: slewing, luffing, folding and hoisting at once, {loaded.run.duration:g} s",
        unwatched(model.system), cut, start, np.linspace(0.0, loaded.run.duration, 2401),
        lambda states: states[:, :2], "the rope's direction", wanted=1e-5,
    )  # fmt: skip

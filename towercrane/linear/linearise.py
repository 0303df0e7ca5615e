"""Linear state-space model of any crane about an equilibrium or another state."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from towercrane.linear.chart import Chart, per_second
from towercrane.linear.statespace import RATE, OperatingPoint, Signal, StateSpace
from towercrane.motions.motion import Motion
from towercrane.simulation.differences import jacobian
from towercrane.simulation.outcomes import LANDS, ON_THE_GROUND, ROPE_SLACK
from towercrane.simulation.starts.begin import begin, rope_direction
from towercrane.simulation.system import NoEquilibrium, start_inputs

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from towercrane.results.recording import Quantity
    from towercrane.simulation.system import Model

    Floats = NDArray[np.float64]

AT_REST = 1e-9
"""Resultant, beside the largest output of its unit, that is nothing."""

NEARLY = 1e-9
"""Height over the ground that is none [m]."""

NOTHING = 1e-12
"""Entries of the matrices smaller than this, relative to the largest of their row, are differences' rounding."""


def linearise(
    model: Model,
    motions: Mapping[str, Motion] | Floats,
    *,
    time: float = 0.0,
    state: Floats | None = None,
    outputs: Sequence[str] | None = None,
    inputs: Literal["acceleration", "motion"] = "acceleration",
    turning: str | None = None,
) -> StateSpace:
    """Linear model of small departures from an operating point.

    Parameters
    ----------
    model : Model
        The crane; its state is (q, n, q', p, work). Optional attributes: ``axes`` (2 or 3, default 3),
        ``state_names`` (a dict from the name of each coordinate q, and of the sways if they have other names, to its
        units), ``channel_units`` and ``value_channels`` (those that act by their value alone, such as a wind);
        ``settled`` (model and motions without what only switches, as a load that lets go).
    motions : dict of str to Motion, or ndarray
        One for each channel; or, for each channel, ascending coefficients of a polynomial in time.
    time : float
        Where on the motions [s].
    state : ndarray, shape (size,), optional
        State of the model. Without it, the equilibrium with every drive at rest at its value at ``time`` and the
        wind at its mean (see :func:`towercrane.simulation.system.start_inputs`); seen from a turning frame and in
        still air the steady rotation at the rate at which the head is turned then. With it, all is as it is at
        ``time``.
    outputs : sequence of str, optional
        Names of what the model observes, by default every number but energies and resultants that are
        nothing there. A vector becomes one output for each component.
    inputs : {"acceleration", "motion"}
        "acceleration": a channel's value and rate are states and its acceleration is the input, as drives are
        controlled. "motion": value, rate and acceleration are three inputs; they must be consistent. A channel that
        acts by its value alone is an input by its value, either way.
    turning : str, optional
        Coordinate or channel that is an angle about the vertical: direction of the rope and its rate are then seen
        from a frame that turns with it, "outward" along its first axis, so a steady rotation is an equilibrium (but
        for the angles themselves). Without it sways are along fixed axes, of a crane that turns called x and y.

    Returns
    -------
    StateSpace
        States: coordinates and sways, their rates, then values and rates of the drives.

    Raises
    ------
    NoEquilibrium
        If there is none to start from, or a run would end at once in the state.
    ValueError
        If an argument does not fit the model.
    """
    if inputs not in ("acceleration", "motion"):
        raise ValueError(f"inputs: wanted 'acceleration' or 'motion', got {inputs!r}")
    if (settled := getattr(model, "settled", None)) is not None:
        model, motions = settled(motions, time)
    drives = _drives(model, motions, time)
    if state is None:
        turns, drives[1:] = drives[1].copy(), 0.0
        if not isinstance(motions, np.ndarray):
            drives[0] = start_inputs(model, motions, _polynomials(drives))[:, 0]
        blown = [model.channels.index(name) for name in getattr(model, "value_channels", ())]
        group = getattr(model, "turning", None)
        if turning is not None and group is not None and not drives[0, blown].any():
            drives[1, group.channel] = turns[group.channel]
        state = begin(model, _polynomials(drives))
    elif np.shape(state) != (model.system.size,):
        raise ValueError(f"state: wanted shape ({model.system.size},), got {np.shape(state)}")
    state = np.array(state, dtype=float)
    _check_state(model, state, drives)
    chart = Chart.about(model, state, drives, turning)
    alone = state[None], drives[None]
    quantities = _observed(model, *alone, *_slopes(model, *alone))
    if outputs is None:
        outputs = [
            name
            for name, q in quantities.items()
            if q.dims == ("time",) and q.units != "J" and not _kinked(model, name, quantities)
        ]
    if unknown := [name for name in outputs if name not in quantities]:
        raise ValueError(f"outputs: {unknown[0]!r} is none of {', '.join(quantities)}")
    seen = tuple(signal for name in outputs for signal in _components(name, quantities[name]))

    size, channels = len(chart.at), len(model.channels)

    def respond(arguments: Floats) -> Floats:
        """Slope of the minimal state, then outputs, from minimal states and drives in columns."""
        states, moving = arguments[:size].T, arguments[size:].T.reshape(arguments.shape[1], 3, channels)
        full = np.array([chart.full(*own) for own in zip(states, moving, strict=True)])
        slopes, guards = _slopes(model, full, moving)
        parts = [np.transpose([chart.slope(*own) for own in zip(states, slopes, moving, strict=True)])]
        values = _observed(model, full, moving, slopes, guards) if outputs else {}
        parts += [values[name].values.reshape(len(full), -1).T for name in outputs]
        return np.concatenate(parts)

    arguments = np.concatenate([chart.at, drives.ravel()])
    matrix, errors = jacobian(respond, arguments, scale := np.concatenate([chart.scale, np.ones(3 * channels)]))
    steady = _steady(model, drives, size) if turning is not None else np.zeros(size + 3 * channels)
    largest = np.max(abs(matrix) * scale, axis=1, initial=0.0)[:, None]
    matrix[abs(matrix) * scale < NOTHING * largest] = 0.0
    relative = errors * scale / np.where(largest > 0.0, largest, 1.0)
    here = respond(arguments[:, None])[:, 0]
    by_value = np.isin(model.channels, getattr(model, "value_channels", ()))
    states, given = _roles(size, by_value, inputs)
    driven, count = np.flatnonzero(~by_value), channels - int(np.count_nonzero(by_value))
    a, b, slope = matrix[:size, states], matrix[:size, given], here[:size]
    if len(states) > size:
        # The drives integrate: values grow by rates, rates by the inputs, which come last.
        rows = np.zeros((2 * count, len(states) + len(given)))
        rows[:count, size + count : size + 2 * count] = rows[count:, -count:] = np.eye(count)
        a, b = np.vstack([a, rows[:, : len(states)]]), np.vstack([b, rows[:, len(states) :]])
        slope = np.concatenate([slope, *drives[1:, driven]])
    signals = (*chart.names, *_drive_signals(model))
    return StateSpace(
        a=a,
        b=b,
        c=matrix[size:, states],
        d=matrix[size:, given],
        states=tuple(signals[k] for k in states),
        inputs=tuple(signals[k] for k in given),
        outputs=seen,
        point=OperatingPoint(
            arguments[states],
            arguments[given],
            here[size:],
            slope,
            state,
            _inclination(model, chart, drives, state),
            steady[states],
        ),
        error=float(np.max(relative[:size], initial=0.0)),
    )


def _kinked(model: Model, name: str, quantities: Mapping[str, Quantity]) -> bool:
    """Whether an output is a resultant that is nothing there, and so has no slope."""
    about = getattr(model, "about", {})
    if name not in about or not about[name].kink:
        return False
    own = quantities[name]
    sizes = (float(abs(other.values).max()) for other in quantities.values() if other.units == own.units)
    return float(abs(own.values).max()) < AT_REST * max(sizes)


def _check_state(model: Model, state: Floats, drives: Floats) -> None:
    """Refuse a state in which a run would end at once, as with a trolley off its jib, or the load flies free."""
    guards, names = model.system.slope(0.0, state, _polynomials(drives))[1], model.system.guards
    why = "no small motions are about such a state"
    if len(fallen := np.flatnonzero(guards < model.system.floors)):
        raise NoEquilibrium(names[fallen[0]], why)
    if LANDS in names and not guards[names.index(LANDS)] > NEARLY:
        raise NoEquilibrium(ON_THE_GROUND, why)
    if ROPE_SLACK in names and not getattr(model, "rope_as_rod", False) and guards[names.index(ROPE_SLACK)] <= 0.0:
        raise NoEquilibrium(ROPE_SLACK, why)


def _steady(model: Model, drives: Floats, size: int) -> Floats:
    """Slopes of minimal state and channels' values, rates and accelerations in a steady rotation."""
    found, group = np.zeros(size + drives.size), getattr(model, "turning", None)
    if group is not None:
        found[[*group.angles, size + group.channel]] = drives[1, group.channel]
    return found


def _inclination(model: Model, chart: Chart, drives: Floats, state: Floats) -> float:
    """Angle of the rope from the vertical in a state [rad]."""
    along = chart.direction if model.system.rope is None else rope_direction(model, state, _polynomials(drives))
    return float(np.arctan2(np.linalg.norm(along[:-1]), -along[-1]))


def _roles(size: int, by_value: NDArray[np.bool_], inputs: str) -> tuple[list[int], list[int]]:
    """Which of minimal state and of the channels' values, rates and accelerations are states and which are inputs."""
    channels = len(by_value)
    blown, driven = np.flatnonzero(by_value), np.flatnonzero(~by_value)
    values, rates, accelerations = (size + k * channels + driven for k in range(3))
    states, given = [np.arange(size)], [size + blown]
    if inputs == "motion":
        given += [values, rates, accelerations]
    else:
        states += [values, rates]
        given += [accelerations]
    return np.concatenate(states).tolist(), np.concatenate(given).tolist()


def _drive_signals(model: Model) -> list[Signal]:
    """Values, rates and accelerations of the channels."""
    units: Sequence[str] = getattr(model, "channel_units", ("",) * len(model.channels))
    pairs = list(zip(model.channels, units, strict=True))
    return [
        *(Signal(name, unit) for name, unit in pairs),
        *(Signal(f"{name}{RATE}", per_second(unit)) for name, unit in pairs),
        *(Signal(f"{name}_acceleration", f"{unit}/s^2" if unit else "") for name, unit in pairs),
    ]


def _drives(model: Model, motions: Mapping[str, Motion] | Floats, time: float) -> Floats:
    """Value, rate and acceleration of every channel; shape (3, channels)."""
    channels = model.channels
    if isinstance(motions, np.ndarray):
        if motions.ndim != 2 or len(motions) != len(channels):
            raise ValueError(f"motions: wanted a row for each of {channels}, got shape {motions.shape}")
        rows = np.polynomial.polynomial.Polynomial
        return np.array([[rows(row).deriv(k)(time) if k else rows(row)(time) for row in motions] for k in range(3)])
    if missing := [channel for channel in channels if channel not in motions]:
        raise ValueError(f"motions: wanted {', '.join(channels)}; {missing[0]!r} is missing")
    return np.array([[float(motions[channel](time, k)) for channel in channels] for k in range(3)])


def _polynomials(drives: Floats) -> Floats:
    return np.ascontiguousarray(drives.T * [1.0, 1.0, 0.5])


def _slopes(model: Model, states: Floats, drives: Floats) -> tuple[Floats, Floats]:
    """Right-hand side and guards of states (p, size) with drives (p, 3, channels)."""
    pairs = [model.system.slope(0.0, state, _polynomials(own)) for state, own in zip(states, drives, strict=True)]
    slopes, guards = zip(*pairs, strict=True)
    return np.array(slopes), np.array(guards)


def _observed(model: Model, states: Floats, drives: Floats, slopes: Floats, guards: Floats) -> dict[str, Quantity]:
    """What the model observes in states (p, size) with drives (p, 3, channels): each is an instant of one run."""
    instants = np.arange(len(states) + 1.0)
    coefficients = np.array([_polynomials(own) for own in drives])
    motions = {name: Motion(instants, coefficients[:, row]) for row, name in enumerate(model.channels)}
    return model.observe(motions, instants[:-1], states, slopes, guards)


def _components(name: str, quantity: Quantity) -> list[Signal]:
    from towercrane.results.recording import labels

    if len(quantity.dims) == 1:
        return [Signal(name, quantity.units)]
    ends = labels(quantity.dims[1], quantity.values.shape[1])
    return [Signal(f"{name}_{end}", quantity.units) for end in ends]

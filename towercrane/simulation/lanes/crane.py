"""What runs side by side ask of a crane, and one run that waits for a lane."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from towercrane.motions.motion import Phases

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class LaneRun:
    """One run that waits for a lane.

    Parameters
    ----------
    model : Model
        A :class:`towercrane.simulation.system.Model` of the crane that shares the lanes.
    phases : Phases
        Its motions.
    state : str
        "equilibrium" or "zero", as the model's start takes it.
    swing_angle : float
        Rope's angle from the vertical at the start [rad].
    """

    model: Any
    phases: Phases
    state: str = "equilibrium"
    swing_angle: float = 0.0


@dataclass(frozen=True, eq=False)
class LaneCrane:
    """A kind of crane whose runs share lanes.

    Parameters
    ----------
    observe : compiled function
        As in :func:`towercrane.kernels.arrays.lane_observer_signature`.
    outputs : dict of str to (str, str)
        Units and long names of what is observed.
    watched : callable
        Of a model, the weights of its coordinates in the outputs that are linear in them; (linear outputs, n).
    observed : callable
        Outputs of rows of states with those weights (rows, linear outputs, n), states (rows, size) and guards
        (rows, guards): the same as ``observe``, for the few rows that no step writes; shape (rows, outputs).
    energy : callable
        Total energy of runs in states (runs, size), and their load's weight times the length of its rope, with values
        and rates of their channels (runs, channels, 2); both of shape (runs,) [J].
    alike : callable
        Of a model, a text that is equal for models which differ in their load alone.
    unstable : str
        Outcome of a run that finds no equilibrium to start from.
    """

    observe: Any
    outputs: Mapping[str, tuple[str, str]]
    watched: Callable[[Any], Floats]
    observed: Callable[[Floats, Floats, Floats], Floats]
    energy: Callable[[Sequence[Any], Floats, Floats], tuple[Floats, Floats]]
    alike: Callable[[Any], str]
    unstable: str

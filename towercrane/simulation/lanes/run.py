"""One run that waits for a lane."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Protocol

from towercrane.simulation.starts.begin import begin
from towercrane.simulation.starts.start import HANGING, Start
from towercrane.simulation.system import NoEquilibrium

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np
    from numpy.typing import NDArray

    from towercrane.motions.motion import Phases
    from towercrane.simulation.observed import Observed
    from towercrane.simulation.system import Model

    Floats = NDArray[np.float64]

    class LaneModel(Observed, Model, Protocol):
        """What lanes ask of a crane."""


@dataclass(frozen=True, eq=False)
class LaneRun:
    """One run that waits for a lane.

    Parameters
    ----------
    model : LaneModel
        Of the kind of crane that shares the lanes.
    phases : Phases
        Its motions.
    begins : Start
    means : mapping of int to float
        Channels that a start knows by their mean, see :func:`towercrane.simulation.system.start_inputs`.
    """

    model: LaneModel
    phases: Phases
    begins: Start = HANGING
    means: Mapping[int, float] = field(default_factory=dict)

    def cut(self) -> LaneRun:
        """The same run with its phases cut where its rates jump."""
        crossings = self.model.system.crossings
        return self if crossings is None else replace(self, phases=crossings.cut(self.phases))

    @property
    def start_inputs(self) -> Floats:
        """Polynomials of the first phase as a state at rest knows them."""
        inputs = self.phases.inputs[0, : len(self.model.channels)].copy()
        for channel, mean in self.means.items():
            inputs[channel] = 0.0
            inputs[channel, 0] = mean
        return inputs

    def start(self) -> tuple[Floats, str]:
        """State at the start, and the outcome of a run that has no equilibrium to start from, else nothing."""
        inputs = self.start_inputs
        try:
            return begin(self.model, inputs, self.begins), ""
        except NoEquilibrium as failure:
            return begin(self.model, inputs, replace(self.begins, state="zero")), failure.outcome

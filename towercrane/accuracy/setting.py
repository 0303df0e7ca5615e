"""Model and solver of one run."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.tower.crane_model import MODE_KINDS

if TYPE_CHECKING:
    from collections.abc import Mapping


@dataclass(frozen=True)
class Setting:
    """Model and solver of one run.

    Parameters
    ----------
    tower_modes, torsion_modes, jib_lateral_modes, jib_vertical_modes : int
        0 for rigid; those of the tower count in both directions.
    counter_jib_lateral_modes, counter_jib_vertical_modes : int
    planar : bool
        Whether all stays in the jib's vertical plane, along x.
    cap : float
        Highest frequency of a mode after the member's second [Hz], see
        :class:`towercrane.cranes.tower.model.FlexibleModel`.
    weight_softening : bool
    method : str
    rtol, atol : float
        As in :func:`towercrane.simulation.integrate.integrate`.
    """

    tower_modes: int = 0
    torsion_modes: int = 0
    jib_lateral_modes: int = 0
    jib_vertical_modes: int = 0
    counter_jib_lateral_modes: int = 0
    counter_jib_vertical_modes: int = 0
    planar: bool = False
    cap: float = np.inf
    weight_softening: bool = True
    method: str = "dop853"
    rtol: float = 1e-8
    atol: float = 1e-10

    @property
    def counts(self) -> dict[str, int]:
        """Number of modes by kind."""
        return {kind: getattr(self, kind) for kind in MODE_KINDS}

    def with_counts(self, counts: Mapping[str, int]) -> Setting:
        """The same with other numbers of modes of some kinds."""
        changes: dict[str, Any] = dict(counts)
        return replace(self, **changes)

    def with_more(self, more: Mapping[str, int]) -> Setting:
        """The same with so many modes more of some kinds."""
        return self.with_counts({kind: getattr(self, kind) + count for kind, count in more.items()})

    def tightened(self, factor: float) -> Setting:
        """The same with tolerances times a factor below 1, as far down as they make sense."""
        return replace(self, rtol=max(factor * self.rtol, 1e-12), atol=max(factor * self.atol, 1e-14))

    def provenance(self) -> dict[str, Any]:
        """The setting for JSON; no cap is null."""
        return {key: None if value == np.inf else value for key, value in vars(self).items()}


def setting_from(written: Mapping[str, Any]) -> Setting:
    """A setting as :meth:`Setting.provenance` wrote it."""
    return Setting(**{**written, "cap": written["cap"] or np.inf})

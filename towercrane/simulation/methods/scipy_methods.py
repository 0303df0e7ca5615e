"""SciPy's solvers as methods: they run the same right-hand side as a cross-check."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from towercrane.simulation.methods.method import Method

if TYPE_CHECKING:
    from towercrane.motions.motion import Phases
    from towercrane.simulation.trajectory import Floats, Progress, Run


@dataclass(frozen=True, eq=False, kw_only=True)
class SciPyMethod(Method):
    """One of SciPy's solvers.

    Parameters
    ----------
    name, order, energy_drift, loosest
        As in :class:`towercrane.simulation.methods.method.Method`.
    solver : str
        Name of its class in :mod:`scipy.integrate`.
    """

    solver: str

    crosses_phases: ClassVar[bool] = True

    def carry(self, run: Run, phases: Phases, sample_times: Floats, split: bool, progress: Progress | None) -> str:
        """Carry a run on through its phases, in place; how it ended."""
        from towercrane.simulation.methods.scipy_solver import solve

        return solve(run, phases, sample_times, self.solver, split, progress)


SCIPY_METHODS = (
    SciPyMethod(
        name="scipy-dop853",
        solver="DOP853",
        order=8,
        energy_drift=((1e-2, -0.40), (1e-3, -0.19), (1e-4, -0.017), (1e-5, -1.2e-3), (1e-6, -9.5e-5)),
    ),
    SciPyMethod(
        name="scipy-rk45",
        solver="RK45",
        order=5,
        energy_drift=((1e-3, 7.0), (1e-4, -0.038), (1e-5, -5.5e-3), (1e-6, -6.0e-4)),
        loosest=1e-3,
    ),
    SciPyMethod(
        name="scipy-radau",
        solver="Radau",
        order=5,
        energy_drift=((1e-2, -0.32), (1e-3, -0.034), (1e-4, -1.7e-3), (1e-5, -9.0e-5)),
    ),
    SciPyMethod(
        name="scipy-lsoda",
        solver="LSODA",
        order=12,
        energy_drift=((1e-3, 0.33), (1e-4, -0.055), (1e-5, -0.013), (1e-6, -1.1e-3)),
        # Beyond, it feeds vibration sixtyfold or fails.
        loosest=1e-3,
    ),
)

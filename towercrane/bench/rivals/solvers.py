"""Other solvers on the same equations: who they are, how they are called, and what is missing if they are.

All restart at the switch points of the motion unless said otherwise, as the compiled solvers here do.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib.util import find_spec
from typing import TYPE_CHECKING

import numpy as np

from towercrane.bench.clock import whole
from towercrane.simulation.integrate import integrate
from towercrane.simulation.outcomes import FINISHED

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from towercrane.bench.scenes.prepared import Scene

    Floats = NDArray[np.float64]
    Solve = Callable[[Scene, float], tuple[Floats, int]]

EXTRA = "pip install 'towercrane-dynamics[rivals]'"


class Failed(ArithmeticError):
    """A solver that gave up; the message says how."""


@dataclass(frozen=True)
class Family:
    """A solver with the tolerances that it is measured at.

    Parameters
    ----------
    name : str
        In tables and pictures.
    solve : callable
        Scene and rtol to states on the scene's grid and number of right-hand sides; raises Failed.
    tolerances : tuple of float
        For the whole benchmark; the quick one takes the last.
    package : str
        What has to be importable besides this package's own dependencies.
    plain : bool
        Whether it runs the plain equations, which not every scene has.
    slow : bool
        Whether the quick benchmark leaves it out.
    """

    name: str
    solve: Solve
    tolerances: tuple[float, ...]
    package: str = ""
    plain: bool = False
    slow: bool = False

    @property
    def installed(self) -> bool:
        """Whether it can be run."""
        return not self.package or find_spec(self.package) is not None


def own(method: str, split: bool = True) -> Solve:
    """A method of :data:`towercrane.simulation.methods.registry.METHODS`, on the compiled right-hand side."""

    def solve(scene: Scene, rtol: float) -> tuple[Floats, int]:
        run = whole(
            integrate(
                scene.system, scene.cut, scene.start, scene.grid,
                method=method, rtol=rtol, atol=1e-2 * rtol, split=split,
            )
        )  # fmt: skip
        if run.outcome != FINISHED:
            raise Failed(f"{run.outcome} at {run.end_time:.3g} s")
        return run.states, run.evaluations

    return solve


def plain(method: str) -> Solve:
    """A method of SciPy on the equations written in NumPy."""

    def solve(scene: Scene, rtol: float) -> tuple[Floats, int]:
        from scipy.integrate import solve_ivp

        equations = scene.plain
        assert equations is not None
        atol = 1e-2 * rtol * equations.scale

        counted = Counted(equations.rhs)

        def phase(inputs: Floats, end: float, y: Floats, at: Floats) -> Floats:
            found = solve_ivp(counted.under(inputs), (0.0, end), y, method=method, t_eval=at, rtol=rtol, atol=atol)
            if not found.success:
                raise Failed(found.message)
            return np.asarray(found.y.T)

        return equations.back(_phase_by_phase(scene, phase, equations.start)), counted.calls

    return solve


def cvode(method: str) -> Solve:
    """SUNDIALS CVODE through scikit-sundae."""

    def solve(scene: Scene, rtol: float) -> tuple[Floats, int]:
        from sksundae.cvode import CVODE

        atol, counted = 1e-2 * rtol * scene.system.scale, _compiled_rhs(scene)

        def phase(inputs: Floats, end: float, y: Floats, at: Floats) -> Floats:
            rhs = counted.under(inputs)

            def in_place(t: float, state: Floats, out: Floats) -> None:
                out[:] = rhs(t, state)

            # With two times it would choose its own; three and more are met exactly.
            times = np.unique(np.concatenate([[0.0], at, [0.5 * end, end]]))
            solver = CVODE(in_place, method=method, rtol=rtol, atol=atol, max_num_steps=10_000_000)
            found = solver.solve(times, y)
            if not found.success:
                raise Failed(str(found.message))
            return np.asarray(found.y)[np.searchsorted(times, at)]

        return _phase_by_phase(scene, phase, scene.start), counted.calls

    return solve


def cyrk(method: str) -> Solve:
    """CyRK, calling the compiled right-hand side through Python."""

    def solve(scene: Scene, rtol: float) -> tuple[Floats, int]:
        from CyRK import pysolve_ivp

        atol, counted = 1e-2 * rtol * scene.system.scale, _compiled_rhs(scene)

        def phase(inputs: Floats, end: float, y: Floats, at: Floats) -> Floats:
            found = pysolve_ivp(
                counted.under(inputs), (0.0, end), y, method=method, t_eval=at,
                rtol=np.full(len(y), rtol), atol=atol, max_num_steps=10_000_000,
            )  # fmt: skip
            if not found.success:
                raise Failed(str(found.message))
            return np.ascontiguousarray(found.y.T)

        return _phase_by_phase(scene, phase, scene.start), counted.calls

    return solve


def taylor_series(scene: Scene, tolerance: float) -> tuple[Floats, int]:
    """heyoka's Taylor series, on the plain equations as expressions; compiled in the first run at a tolerance.

    The count is that of steps times order: each order takes what an evaluation takes.
    """
    from heyoka import taylor_outcome

    from towercrane.bench.rivals.taylor import coefficients, compiled

    equations, solver = scene.plain, compiled(scene, tolerance)
    assert equations is not None
    steps = 0

    def phase(inputs: Floats, end: float, y: Floats, at: Floats) -> Floats:
        nonlocal steps
        solver.time, solver.pars[:], solver.state[:] = 0.0, coefficients(scene, inputs), y
        outcome, *_, taken, _, found = solver.propagate_grid(np.unique(np.append(0.0, at)))
        if outcome != taylor_outcome.time_limit:
            raise Failed(str(outcome))
        steps += taken
        return np.asarray(found)[-len(at) :]

    return equations.back(_phase_by_phase(scene, phase, equations.start)), steps * solver.order


class Counted:
    """A right-hand side f(t, y, inputs) that counts its calls."""

    def __init__(self, rhs: Callable[[float, Floats, Floats], Floats]) -> None:
        self._rhs, self.calls = rhs, 0

    def under(self, inputs: Floats) -> Callable[[float, Floats], Floats]:
        """The right-hand side of one phase."""

        def slope(t: float, y: Floats) -> Floats:
            self.calls += 1
            return np.asarray(self._rhs(t, y, inputs))

        return slope


def _compiled_rhs(scene: Scene) -> Counted:
    system = scene.system
    slope, guards = np.empty(system.size), np.empty(len(system.guards))

    def rhs(t: float, y: Floats, inputs: Floats) -> Floats:
        compiled, numbers = system.code(inputs)
        compiled(t, np.ascontiguousarray(y).copy(), slope, inputs, numbers, system.table, guards)
        return slope.copy()

    return Counted(rhs)


def _phase_by_phase(scene: Scene, solve: Callable[[Floats, float, Floats, Floats], Floats], start: Floats) -> Floats:
    """States on the grid from a solver that knows one smooth phase.

    It is called with the phase's inputs, its length [s], the state at its start and the times wanted since then, and
    gives the states at these; the last of the times is the phase's end.
    """
    times, y = scene.cut.times, start
    states = np.empty((len(scene.grid), len(start)))
    for index, inputs in enumerate(scene.cut.inputs):
        begin, end = float(times[index]), float(times[index + 1])
        last = index == len(scene.cut.inputs) - 1
        mine = (scene.grid >= begin) & ((scene.grid < end) | last)
        wanted = np.append(np.clip(scene.grid[mine] - begin, 0.0, end - begin), end - begin)
        at, rows = np.unique(wanted, return_inverse=True)
        found = solve(inputs, end - begin, y, at)
        states[mine], y = found[rows[:-1]], found[-1].copy()
    return states


OWN = (
    Family("towercrane dop853", own("dop853"), (1e-3, 1e-4, 1e-7, 1e-8, 1e-10, 1e-6)),
    Family("towercrane dopri5", own("dopri5"), (1e-4, 1e-7, 1e-8, 1e-6)),
)

RIVALS = (
    Family("SciPy DOP853", own("scipy-dop853"), (1e-4, 1e-7, 1e-8, 1e-6)),
    Family("SciPy DOP853, not restarted", own("scipy-dop853", split=False), (1e-6, 1e-7, 1e-8), slow=True),
    Family("SciPy RK45", own("scipy-rk45"), (1e-4, 1e-7, 1e-6)),
    Family("SciPy LSODA", own("scipy-lsoda"), (1e-5, 1e-6, 1e-8, 1e-7)),
    Family("SciPy Radau", own("scipy-radau"), (1e-4, 1e-6), slow=True),
    Family("SUNDIALS CVODE BDF", cvode("BDF"), (1e-5, 1e-6, 1e-8, 1e-7), package="sksundae"),
    Family("SUNDIALS CVODE Adams", cvode("Adams"), (1e-5, 1e-6, 1e-8, 1e-7), package="sksundae"),
    Family("CyRK DOP853", cyrk("DOP853"), (1e-4, 1e-7, 1e-8, 1e-6), package="CyRK"),
    Family("heyoka Taylor", taylor_series, (1e-4, 1e-5, 1e-7, 1e-8, 1e-10, 1e-6), package="heyoka", plain=True),
    Family("SciPy LSODA, NumPy equations", plain("LSODA"), (1e-7,), plain=True, slow=True),
    Family("SciPy RK45, NumPy equations", plain("RK45"), (1e-3,), plain=True, slow=True),
)
"""The rivals; the last tolerance of each is that of the quick benchmark."""

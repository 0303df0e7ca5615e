"""What the looks at a run show of its vibration: period of the swing, lines of the spectrum, and what is unseen."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from towercrane.results.spectral_lines import Lines, lines
from towercrane.results.spectrum import SAMPLES_PER_PERIOD, swing_period
from towercrane.simulation.simulate import LOOK

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from towercrane.cranes.kind import Signals
    from towercrane.results.recording import Result

    Floats = NDArray[np.float64]

CYCLES = 3.0
"""Free cycles of the slowest mode that make a spectrum of the free vibration."""


class Vibration(NamedTuple):
    """What is read off a run's looks.

    Parameters
    ----------
    signal : str
        Output whose spectrum it is.
    period : float or None
        Of the swing after the drives have stopped [s].
    lines : Lines
        Of the spectrum.
    step : float
        Between two looks [s].
    unseen : list of str
        What the looks are too far apart for, in sentences.
    """

    signal: str
    period: float | None
    lines: Lines
    step: float
    unseen: list[str]

    def report(self) -> dict[str, Any]:
        """The same for JSON."""
        return {
            "spectrum_of": self.signal,
            "spectrum_peaks_hz": self.lines.own,
            "spectrum_other_hz": self.lines.others,
            "spectrum_to_hz": self.lines.highest,
            "spectrum_beyond_hz": self.lines.beyond,
            "swing_period_s": self.period,
        }


def vibration(
    signals: Signals,
    result: Result,
    free: slice,
    swings: Sequence[float],
    natural: Sequence[float],
    at_the_start: Callable[[], Sequence[float]],
) -> Vibration:
    """Read period and spectrum off a run.

    Parameters
    ----------
    signals : Signals
        What shows the structure's vibration and the load's swing.
    result : Recording or Dataset
    free : slice
        Rows after the last drive has stopped.
    swings : sequence of float
        Natural frequencies of the load's swing [Hz], as far as they are told apart.
    natural : sequence of float
        Natural frequencies where the run ended [Hz], ascending.
    at_the_start : callable
        Gives those where it began, asked for if the spectrum is not that of a free vibration.
    """
    times, step = result["time"].values, step_of(result)
    # A load swings about as fast as on its rope alone.
    fastest = np.sqrt(result.attrs["gravity"] / result["rope_length"].values.min()) / (2.0 * np.pi)
    known = [*swings, float(fastest)]
    swing = next(name for name in signals.swings if name in result)
    near = step * SAMPLES_PER_PERIOD * max(known) <= 1.0
    period = swing_period(times[free], result[swing].values[free]) if near else None
    known += [1.0 / period] if period else []
    # Free vibration shows the crane's own lines; a moving trolley drags them along and adds its own.
    calm = len(natural) > 1 and cycles(times[free], natural[0]) >= CYCLES
    shown = free if calm else slice(None)
    own = natural if calm else [*natural, *at_the_start()]
    found = lines(times[shown], result[signals.vibration].values[shown], own, known, LOOK)
    return Vibration(signals.vibration, period, found, step, _unseen(step, near, found))


def step_of(result: Result) -> float:
    """Time between two looks at a run [s]."""
    times = result["time"].values
    return float(times[1] - times[0]) if len(times) > 2 else float(result.attrs["output_step"])


def cycles(times: Floats, frequency: float) -> float:
    """Cycles of a frequency in a span."""
    return float((times[-1] - times[0]) * frequency) if len(times) > 1 else 0.0


def _unseen(step: float, near: bool, found: Lines) -> list[str]:
    """What looks are too far apart for, in sentences."""
    apart, said = f"looks {step:g} s apart", []
    if not near:
        said.append(f"{apart} are too far for the load's swing: no period is read off them, and extremes are missed")
    if found.highest is None and found.beyond:
        said.append(
            f"{apart} show nothing above {0.5 / step:g} Hz, and the crane has {found.beyond[0]:.4g} Hz and more: "
            "no spectrum, for its peaks could be folded back from there"
        )
    return said

"""Balance of energy of a run."""

import numpy as np


def imbalance(outputs) -> float:
    """Largest gap between energy gained and work put in, relative to the energy's range."""
    energy, work = (np.asarray(outputs[name]) for name in ("total_energy", "input_work"))
    return float(np.max(abs(energy - energy[0] - work)) / np.ptp(energy))

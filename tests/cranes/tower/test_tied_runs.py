"""A hammerhead on tie bars over time: energy, sections, and what happens where a tie goes slack."""

import numpy as np
from samples import hammerhead as sample

from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.kernels.payload import Load
from towercrane.motions.profiles import trapezoid
from towercrane.simulation.simulate import simulate

MOTIONS = {
    "trolley": trapezoid(14.0, 47.0, 1.2, 0.3),
    "rope": trapezoid(25.0, 20.0, 0.5, 0.2),
    "slewing": trapezoid(0.0, 0.8, 0.06, 0.02),
}


def test_energy_of_a_manoeuvre_is_what_drives_put_in():
    """The head slews, the trolley passes two ties and a joint of the jib, the load is hoisted."""
    options = {"tower": 1, "torsion": 1, "lateral": 1, "vertical": 1, "back": 0}
    load, damping = Load(3000.0, rope_damping=300.0), ModalDamping(0.01, 0.01, 0.01, 0.01)
    model = sample.model(load=load, damping=damping, **options)
    run = simulate(model, MOTIONS, 20.0, output_step=0.25, rtol=1e-11, atol=1e-13)
    energy, work = run["total_energy"].values, run["input_work"].values
    passed = np.sum(abs(np.diff(energy)))
    assert run.attrs["outcome"] == "finished"
    assert float(run["trolley_position"][-1]) > 30.0
    assert np.max(abs(energy - energy[0] - work)) < 1e-10 * passed

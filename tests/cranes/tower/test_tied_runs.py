"""A hammerhead on tie bars over time: energy, sections, and what happens where a tie goes slack."""

import numpy as np
from samples import hammerhead as sample

from towercrane.cranes.parts.wind import WindAreas
from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.cranes.tower.modes.modal_crane import flexible_crane
from towercrane.cranes.tower.modes.mode_counts import ModeCounts
from towercrane.cranes.tower.tied_model import TiedModel
from towercrane.kernels.load import Load
from towercrane.motions.motion import rest
from towercrane.motions.profiles import trapezoid
from towercrane.simulation.outcomes import SLACK_TIE
from towercrane.simulation.simulate import simulate
from towercrane.simulation.starts.start import Start

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


def test_a_slack_tie_ends_the_run():
    """A heavy load far out, dropped into its rope, throws the jib up at the tie within it."""
    model = sample.model(load=12000.0, vertical=1, back=0, lateral=0, planes=1, axes=2, slewing="fixed")
    run = simulate(model, {"trolley": rest(58.0), "rope": rest(10.0)}, 4.0, output_step=0.02, start=Start("zero"))
    assert run.attrs["outcome"] == SLACK_TIE
    assert abs(float(run["jib_tie_1_tension"][-1])) < 1e-3
    assert float(run["jib_tie_2_tension"].min()) > 1.6e5


def test_a_tied_jib_stands_in_wind_and_on_a_ground_that_shakes():
    """The work of both is in the balance."""
    areas = WindAreas(tower=1.0, jib=0.4, counter_jib=0.4, counterweight=4.0)
    crane = flexible_crane(sample.CRANE, ModeCounts(1, 1, 1, 1, 0, 0), areas)
    model = TiedModel(crane, Load(3000.0, drag_area=5.0), wind=True, ground=True)
    shaken = {f"ground_{axis}": trapezoid(0.0, 0.05, 0.1, 0.4) for axis in "xyz"}
    blown = {"wind_x": rest(3.0), "wind_y": rest(12.0), "wind_z": rest(0.0)}
    motions = {"trolley": rest(40.0), "rope": rest(20.0), "slewing": rest(0.3), **shaken, **blown}
    run = simulate(model, motions, 6.0, output_step=0.1, rtol=1e-11, atol=1e-13)
    energy, work = run["total_energy"].values, run["input_work"].values
    assert run.attrs["outcome"] == "finished"
    assert np.ptp(energy) > 100.0
    assert np.max(abs(energy - energy[0] - work)) < 1e-9 * np.ptp(energy)

"""The laboratory crane of the tests, without a case file; what no source prints is assumed."""

from dataclasses import dataclass, replace
from functools import partial
from types import SimpleNamespace

import numpy as np

from towercrane.cranes.slewing import models as slewing
from towercrane.cranes.slewing.model import LumpedModel
from towercrane.kernels.load import AIR_DENSITY, Load
from towercrane.motions.motion import phases, rest
from towercrane.motions.profiles import trapezoid
from towercrane.simulation.integrate import evaluate, integrate
from towercrane.simulation.system import Switch

MULTI_MASS = SimpleNamespace(
    name="laboratory crane",
    gravity=9.81,
    geometry_tower_height=1.8,
    geometry_top_height=0.4,
    geometry_jib_radius=2.0,
    geometry_counterweight_radius=0.9,
    mass_tower_top=35.0,
    mass_jib_tip=14.0,
    mass_counterweight=100.0,
    inertia_platform=6.0,
    inertia_tower_top=8.0,
    stiffness_tower_x=1.6e5,
    stiffness_tower_y=1.6e5,
    stiffness_jib_vertical=6e4,
    stiffness_counter_jib_vertical=1.2e5,
    stiffness_tower_torsion=4e4,
    stiffness_jib_lateral=6e4,
    stiffness_counter_jib_lateral=6e4,
    damping_tower_x=150.0,
    damping_tower_y=150.0,
    damping_jib_vertical=60.0,
    damping_counter_jib_vertical=100.0,
    damping_tower_torsion=50.0,
    damping_jib_lateral=80.0,
    damping_counter_jib_lateral=80.0,
    drive_soft_stiffness=20.0,
    drive_stiff_stiffness=750.0,
    drive_corner=0.25,
    drive_damping=60.0,
    friction_law="tanh",
    friction_torque=22.0,
    friction_rate=0.01,
    drag_tower_top=0.0,
    drag_jib_tip=0.0,
    drag_counterweight=0.0,
)
ENHANCED = SimpleNamespace(
    **{**vars(MULTI_MASS), "mass_tower_top": 135.0, "inertia_tower_top": 89.0, "mass_counter_moment": 90.0}
)
BASIC = SimpleNamespace(
    **{
        **vars(MULTI_MASS),
        "inertia_platform": 95.0,
        "stiffness_jib_lateral": 5800.0,
        "stiffness_jib_radial": 1.6e5,
        "stiffness_rope": 7.5e5,
        "damping_jib_lateral": 20.0,
        "damping_jib_radial": 150.0,
        "damping_rope": 100.0,
        "drag_jib_tip": 0.02,
    }
)
LOAD = Load(50.5, drag_area=2 * 0.08 / AIR_DENSITY)
BUILDERS = {
    "multi-mass": slewing.multi_mass,
    "enhanced": slewing.enhanced,
    "basic": partial(slewing.basic, rope_length=2.0),
}
PARAMETERS = {"multi-mass": MULTI_MASS, "enhanced": ENHANCED, "basic": BASIC}


def crane(kind: str = "multi-mass", **changes) -> LumpedModel:
    """Model of one kind with changed parameters."""
    return LumpedModel(BUILDERS[kind](SimpleNamespace(**{**vars(PARAMETERS[kind]), **changes})), LOAD)


def motions(ramp: float = 0.71, hold: float = 8.0, speed: float = 0.738, rope: float = 2.0) -> dict:
    """Trapezoid of the shaft's speed, rope at rest."""
    return {"shaft": trapezoid(0.0, speed * (ramp + hold), speed, speed / ramp), "rope": rest(rope)}


def lossless(kind: str = "multi-mass", **changes) -> LumpedModel:
    """Model without dampers, drag and friction."""
    none = {name: 0.0 for name in vars(PARAMETERS[kind]) if name.startswith(("damping", "drag"))}
    return replace(crane(kind, **{**none, "drive_damping": 0.0, "friction_law": "none", **changes}), load=Load(50.5))


@dataclass
class Counted:
    """Switch that writes down which guards were met."""

    switch: Switch
    met: list

    @property
    def changes_equations(self):
        return self.switch.changes_equations

    def begin(self, *arguments):
        self.switch.begin(*arguments)

    def cross(self, guard, *arguments):
        self.met.append(guard)
        return self.switch.cross(guard, *arguments)


def run(
    model: LumpedModel, drive: dict, duration: float, start=None, step: float = 0.05, rtol: float = 1e-8, **options
):
    """Run from any start: trajectory, outputs by name, and the guards that were met on the way."""
    cut = phases((drive["shaft"], drive["rope"]), duration)
    start = model.start(cut.inputs[0]) if start is None else start
    switch = model.system.switch
    counted = Counted(switch, [])
    system = replace(model.system, switch=counted if switch else None)
    times = np.minimum(np.arange(round(duration / step) + 1) * step, duration)
    found = integrate(system, cut, start, times, rtol=rtol, atol=1e-2 * rtol, **options)
    slopes, guards = evaluate(model.system, cut, found.times, found.states)
    outputs = model.observe(drive, found.times, found.states, slopes, guards)
    return found, {name: quantity.values for name, quantity in outputs.items()}, counted.met


def inputs(rope: float = 2.0) -> np.ndarray:
    return phases((rest(0.0), rest(rope)), 1.0).inputs[0]


def degrees(outputs: dict, name: str) -> np.ndarray:
    return np.degrees(outputs[f"sway_{name}"])

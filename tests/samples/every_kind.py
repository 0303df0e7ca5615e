"""One model of every kind of crane with motions whose accelerations jump, for what holds of all of them."""

from dataclasses import dataclass

import numpy as np
from samples import jib_cranes, lab_crane, overhead_crane, qtz5613, space_crane

from towercrane.cranes.jib.linear import static_torques
from towercrane.cranes.jib.model import TORQUES, DrivenJibCrane
from towercrane.cranes.jib.tracking import TrackingJibCrane
from towercrane.cranes.overhead.model import OverheadModel
from towercrane.cranes.parts.wind import WindAreas
from towercrane.cranes.slewing.description import Drive
from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.kernels.load import Load
from towercrane.motions.motion import Motion, phases, rest, sequence
from towercrane.motions.profiles import trapezoid
from towercrane.simulation.integrate import evaluate, integrate
from towercrane.simulation.starts.begin import begin
from towercrane.simulation.starts.start import Start
from towercrane.simulation.system import Model
from towercrane.simulation.trajectory import Trajectory

COUPLING = Drive("slewing", 2e6, 8e6, 0.004, 2e4, "tanh", 3e3, 0.01)
LOAD = Load(1500.0, rope_damping=300.0, drag_area=2.0)


@dataclass(frozen=True)
class Driven:
    """A model and what drives it; ``turned`` is the channel that turns about the vertical, if one does."""

    model: Model
    motions: dict[str, Motion]
    turned: str = ""

    def run(self, times, duration: float, start=None, **options) -> tuple[Trajectory, dict]:
        """Rows at any times, tightly solved."""
        cut = phases(tuple(self.motions[channel] for channel in self.model.channels), duration)
        if start is None:
            start = begin(self.model, cut.inputs[0], Start(options.pop("state", "equilibrium"), along=0.05))
        options = {"rtol": 1e-9, "atol": 1e-11} | options
        found = integrate(self.model.system, cut, start, np.asarray(times, dtype=float), **options)
        slopes, guards = evaluate(self.model.system, cut, found.times, found.states)
        outputs = self.model.observe(self.motions, found.times, found.states, slopes, guards)
        return found, {name: quantity.values for name, quantity in outputs.items()}


def hoist(length: float) -> Motion:
    return sequence(rest(length, 0.5), trapezoid(length, 0.8 * length, 0.1 * length, 0.1 * length))


def turn(start: float = 0.0, speed: float = 0.3) -> Motion:
    """Ramps of half a second, at rest after two."""
    return trapezoid(start, start + 1.5 * speed, abs(speed), 2.0 * abs(speed))


def wind(blown: np.ndarray) -> dict:
    """A gust that grows and falls at even rates."""
    times, shape = np.array([0.0, 0.7, 1.5]), np.array([[1.0, 1.0], [1.7, -1.2]])
    return {f"wind_{axis}": Motion(times, speed * shape) for axis, speed in zip("xyz", blown, strict=True)}


def flexible(turned: float = 0.0, speed: float = 0.05, **options) -> Driven:
    areas = WindAreas(tower=0.5, jib=0.4, counter_jib=0.3, counterweight=4.0)
    modes = {"tower": 1, "torsion": 1, "lateral": 2, "vertical": 1}
    damping = ModalDamping(0.01, 0.01, 0.02, 0.03)
    model = space_crane.model(**modes, areas=areas, load=LOAD, wind=True, damping=damping, **options)
    channel = model.channels[2]
    blown = [6.0 * np.cos(turned) + 2.0 * np.sin(turned), 6.0 * np.sin(turned) - 2.0 * np.cos(turned), 0.5]
    motions = {"trolley": trapezoid(10.0, 11.0, 0.8, 0.8), "rope": hoist(12.0), channel: turn(turned, speed)}
    return Driven(model, motions | wind(np.array(blown)), channel)


def lumped(kind: str, turned: float = 0.0, **changes) -> Driven:
    return Driven(lab_crane.crane(kind, **changes), {"shaft": turn(turned), "rope": hoist(2.0)}, "shaft")


def jib_plan(turned: float = 0.0) -> dict:
    joints = {"slew": turn(turned, 0.05), "luff": turn(0.5, 0.02), "fold": turn(-0.2, -0.03)}
    return joints | {"rope": hoist(10.0)}


def jib_torques() -> dict:
    """Torques that hold the crane at rest, and a little more of each for a while, with jumps."""
    times, more = np.array([0.0, 0.5, 1.5]), np.array([[0.0, 1.0, 0.0], [1.0, -1.0, 0.0]])
    held = zip(TORQUES[:3], static_torques(jib_cranes.HEAVY, LOAD, 0.5, -0.2), (3e4, 2e4, 1e4), strict=True)
    torques = {name: Motion(times, [[level, 0.0, 0.0]] + size * more) for name, level, size in held}
    return torques | {"rope": hoist(10.0)}


KINDS = {
    "radial": lambda: Driven(
        qtz5613.model(2, 2, load=LOAD.mass, damping=(0.01, 0.0)),
        {"trolley": trapezoid(10.0, 11.0, 0.8, 0.8), "rope": hoist(12.0)},
    ),
    "prescribed slewing": flexible,
    "slewing drive": lambda: flexible(slewing=COUPLING, drive_inertia=5e4),
    "basic": lambda: lumped("basic"),
    "enhanced": lambda: lumped("enhanced"),
    "multi-mass": lambda: lumped("multi-mass"),
    "stick-slip": lambda: lumped("enhanced", friction_law="stick-slip"),
    "planned jib crane": lambda: Driven(jib_cranes.planned(load=LOAD), jib_plan(), "slew"),
    "driven jib crane": lambda: Driven(DrivenJibCrane(jib_cranes.HEAVY, LOAD, (0.0, 0.5, -0.2)), jib_torques()),
    "tracking jib crane": lambda: Driven(
        TrackingJibCrane(jib_cranes.HEAVY, LOAD, stiffness=2e6, damping=1e6), jib_plan(), "slew"
    ),
    "overhead crane": lambda: Driven(
        OverheadModel(overhead_crane.SMALL, LOAD),
        {"bridge": trapezoid(2.0, 3.0, 0.8, 0.8), "trolley": trapezoid(4.0, 5.0, 0.7, 0.6), "rope": hoist(6.0)},
    ),
}
"""What makes each of them, by name."""

TURNED = {
    "prescribed slewing": flexible,
    "slewing drive": lambda turned: flexible(turned, slewing=COUPLING, drive_inertia=5e4),
    "basic": lambda turned: lumped("basic", turned),
    "enhanced": lambda turned: lumped("enhanced", turned),
    "multi-mass": lambda turned: lumped("multi-mass", turned),
    "stick-slip": lambda turned: lumped("enhanced", turned, friction_law="stick-slip"),
    "planned jib crane": lambda turned: Driven(jib_cranes.planned(load=LOAD), jib_plan(turned), "slew"),
    "tracking jib crane": lambda turned: Driven(
        TrackingJibCrane(jib_cranes.HEAVY, LOAD, stiffness=2e6, damping=1e6), jib_plan(turned), "slew"
    ),
}
"""Those that turn about the vertical, begun at an angle."""

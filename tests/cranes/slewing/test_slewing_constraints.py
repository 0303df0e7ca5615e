"""A compiled slewing crane over whole runs against Cartesian points held by constraints with multipliers.

SciPy integrates the points. The crane of Marinovic, Sprecic and Jerman (2012) is written out once more instead of
reading its data.
"""

import itertools
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from samples.lab_crane import PARAMETERS, crane, lossless, motions, run
from scipy.integrate import solve_ivp

from towercrane.cranes.slewing.model import LumpedModel
from towercrane.motions.motion import phases, rest
from towercrane.motions.profiles import trapezoid


class Points:
    """Multi-mass crane as points with three constraints: tower top - jib tip, - counterweight, jib tip - load.

    State: W3, r4, r5, r6, phi1, phi2 in the inertial frame (13), then their rates. Multipliers of index 1.
    """

    def __init__(self, model: LumpedModel, p: SimpleNamespace, drive: dict):
        self.p, self.drag, self.drive = p, model.load.drag, drive
        masses = [p.mass_tower_top] * 2 + [p.mass_jib_tip] * 3 + [50.5] * 3 + [p.mass_counterweight] * 3
        self.mass = np.array([*masses, p.inertia_platform, p.inertia_tower_top])

    def start(self, outward: float) -> np.ndarray:
        """At rest but for the load's speed outward and three tenths of a metre per second ahead."""
        p, g, y = self.p, 9.81, np.zeros(26)
        hung = p.mass_jib_tip + 50.5
        reach, back, height = p.geometry_jib_radius, p.geometry_counterweight_radius, p.geometry_tower_height
        x = 2 * g * (hung * reach - p.mass_counterweight * back) / (height * p.stiffness_tower_x)
        top, tilt = height + p.geometry_top_height, 2 * x / height
        tip = top - hung * g / p.stiffness_jib_vertical - reach * tilt
        y[0], y[2], y[4], y[5] = x, x + reach, tip, x + reach
        y[7], y[8] = tip - float(self.drive["rope"](0.0)), x - back
        y[10] = top - p.mass_counterweight * g / p.stiffness_counter_jib_vertical + back * tilt
        if outward:
            y[18:20] = outward, 0.3
        return y

    def rhs(self, t: float, y: np.ndarray, inputs: np.ndarray) -> np.ndarray:
        p, v = self.p, y[13:]
        (shaft, shaft_rate), (length, haul) = ((a + t * (b + t * c), b + 2 * t * c) for a, b, c in inputs)
        hauling = 2 * inputs[1, 2]
        w3, w4, w6 = complex(y[0], y[1]), complex(y[2], y[3]), complex(y[8], y[9])
        v3, v4, v6 = complex(v[0], v[1]), complex(v[2], v[3]), complex(v[8], v[9])
        phi1, phi2 = y[11], y[12]
        turned = np.exp(-1j * phi2)
        shift = w3 * turned
        shifting = (v3 - 1j * v[12] * w3) * turned
        height = p.geometry_tower_height
        jib, back = 2 * p.geometry_jib_radius / height, 2 * p.geometry_counterweight_radius / height
        top = height + p.geometry_top_height
        bend4 = -p.stiffness_jib_vertical * (y[4] - top + jib * shift.real)
        bend4 -= p.damping_jib_vertical * (v[4] + jib * shifting.real)
        bend6 = -p.stiffness_counter_jib_vertical * (y[10] - top - back * shift.real)
        bend6 -= p.damping_counter_jib_vertical * (v[10] - back * shifting.real)
        fx = -p.stiffness_tower_x * shift.real - p.damping_tower_x * shifting.real + jib * bend4 - back * bend6
        fy = -p.stiffness_tower_y * shift.imag - p.damping_tower_y * shifting.imag
        push = complex(fx, fy) / turned
        arm4, arm6 = w4 - w3, w3 - w6
        lead4, lead6 = np.angle(arm4 * turned), np.angle(arm6 * turned)
        rate4 = ((v4 - v3) / arm4).imag
        rate6 = ((v3 - v6) / arm6).imag
        twist4 = -p.stiffness_jib_lateral * lead4 - p.damping_jib_lateral * (rate4 - v[12])
        twist6 = -p.stiffness_counter_jib_lateral * lead6 - p.damping_counter_jib_lateral * (rate6 - v[12])
        twist2 = -p.stiffness_tower_torsion * (phi2 - phi1) - p.damping_tower_torsion * (v[12] - v[11])
        side4, side6 = twist4 * 1j / arm4.conjugate(), twist6 * 1j / arm6.conjugate()
        gap = phi1 - shaft
        over = abs(gap) - p.drive_corner
        spring = p.drive_soft_stiffness * gap
        if over > 0:
            spring = np.sign(gap) * (p.drive_soft_stiffness * p.drive_corner + p.drive_stiff_stiffness * over)
        drive = -spring - p.drive_damping * (v[11] - shaft_rate)
        drive -= p.friction_torque * np.tanh(v[11] / p.friction_rate)
        force = np.zeros(13)
        on3 = push - side4 + side6
        force[0], force[1] = on3.real, on3.imag
        force[2], force[3], force[4] = side4.real, side4.imag, bend4
        force[5:8] = -self.drag * np.sqrt(v[5:8] @ v[5:8]) * v[5:8]
        force[8], force[9], force[10] = -side6.real, -side6.imag, bend6
        force[11] = drive - twist2
        force[12] = twist2 - twist4 - twist6 + fx * shift.imag - fy * shift.real
        force[[4, 7, 10]] -= 9.81 * self.mass[[4, 7, 10]]
        rows = np.zeros((3, 13))
        rows[0, :4] = -arm4.real, -arm4.imag, arm4.real, arm4.imag
        rope = y[5:8] - y[2:5]
        rows[1, 2:5], rows[1, 5:8] = -rope, rope
        rows[2, [0, 1, 8, 9]] = arm6.real, arm6.imag, -arm6.real, -arm6.imag
        moving = v[5:8] - v[2:5]
        bias = np.array([-(abs(v4 - v3) ** 2), haul**2 + length * hauling - moving @ moving, -(abs(v3 - v6) ** 2)])
        light = rows / self.mass
        pull = np.linalg.solve(light @ rows.T, bias - light @ force)
        return np.concatenate([v, (force + rows.T @ pull) / self.mass])

    def run(self, times: np.ndarray, outward: float, **options) -> np.ndarray:
        """States at the times, with a restart where an input changes its polynomial."""
        cut = phases((self.drive["shaft"], self.drive["rope"]), times[-1])
        y = self.start(outward)
        found = [y[None]]
        for (start, stop), inputs in zip(itertools.pairwise(cut.times), cut.inputs, strict=True):
            mine = times[(times > start) & (times <= stop)] - start
            leg = solve_ivp(self.rhs, (0, stop - start), y, "DOP853", args=(inputs,), dense_output=True, **options)
            found += [leg.sol(mine).T] if len(mine) else []
            y = leg.y[:, -1]
        return np.vstack(found)


PLAIN, BARE = crane(), replace(lossless(), rope_as_rod=True)
QUIET = SimpleNamespace(
    **{name: 0.0 if name.startswith(("damping", "drag")) else v for name, v in vars(PARAMETERS["multi-mass"]).items()}
)
QUIET.drive_damping = QUIET.friction_torque = 0.0
RUNS = {
    "example 1": (PLAIN, PARAMETERS["multi-mass"], motions(), 25.0, 0.0),
    "hoisting": (
        PLAIN,
        PARAMETERS["multi-mass"],
        {**motions(hold=3.0), "rope": trapezoid(2.0, 1.2, 0.3, 0.4)},
        8.0,
        0.0,
    ),
    "over the horizontal": (BARE, QUIET, {"shaft": rest(0.0), "rope": rest(2.0)}, 2.0, 12.0),
}


@pytest.mark.parametrize(("model", "parameters", "drive", "duration", "outward"), RUNS.values(), ids=RUNS)
def test_whole_run_is_that_of_points_with_constraints(model, parameters, drive, duration, outward):
    start = model.start(phases((drive["shaft"], drive["rope"]), duration).inputs[0])
    if outward:
        start[11 + 8 : 11 + 10] = outward / 2.0, 0.3 / 2.0
    trajectory, result, _ = run(model, drive, duration, start, step=0.1, rtol=1e-12)
    y = Points(model, parameters, drive).run(trajectory.times, outward, rtol=1e-11, atol=1e-12)
    arm = y[:, 2] - y[:, 0] + 1j * (y[:, 3] - y[:, 1])
    rope = y[:, 5:8] - y[:, 2:5]
    across = (rope[:, 0] + 1j * rope[:, 1]) * arm.conj() / abs(arm)
    expected = {
        "sway_radial": np.arctan2(across.real, -rope[:, 2]),
        "sway_tangential": np.arctan2(across.imag, -rope[:, 2]),
        "platform_angle": y[:, 11],
        "payload_position": y[:, 5:8],
        "rope_length": np.linalg.norm(rope, axis=1),
    }
    for name, values in expected.items():
        assert np.max(abs(result[name] - values)) < 1e-8 * np.max(abs(values)), name

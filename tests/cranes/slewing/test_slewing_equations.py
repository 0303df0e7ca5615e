"""The compiled slewing cranes against two formulations that share nothing with them.

Positions alone, in 40-digit arithmetic: every mass is a point whose position follows from the coordinates, and the
virtual work of inertia, weight, springs, dampers, drag and friction vanishes for each coordinate. And Cartesian
points held by constraints with multipliers, integrated by SciPy over a whole run. Both write the cranes of Marinovic,
Sprecic and Jerman (2012) and Jerman (2006) out once more instead of reading their data.
"""

import itertools
from dataclasses import replace
from types import SimpleNamespace

import mpmath as mp
import numpy as np
import pytest
from samples.lab_crane import BUILDERS, PARAMETERS, crane, lossless, motions, run
from scipy.integrate import solve_ivp

from towercrane.cranes.slewing import kernel
from towercrane.cranes.slewing.model import LumpedModel
from towercrane.kernels.payload import Load
from towercrane.motions.motion import phases, rest
from towercrane.motions.profiles import trapezoid

ORDER = {
    "multi-mass": ("z4", "phi3", "y3", "x3", "phi2", "phi1", "phi4", "z6"),
    "enhanced": ("z4", "phi3", "y3", "x3", "phi2", "phi1"),
    "basic": ("z4", "y3", "x3", "phi1"),
}
"""Symbols of the coordinates in the model's order; the basic crane's jib tip moves by x3, y3, z4."""

LOAD = Load(50.5, rope_damping=30.0, drag_area=1.5)
DRAGS = {
    "multi-mass": {"drag_tower_top": 0.7, "drag_jib_tip": 0.4, "drag_counterweight": 0.9},
    "enhanced": {"drag_tower_top": 0.7, "drag_jib_tip": 0.4},
    "basic": {"drag_jib_tip": (0.2, 0.6, 0.4)},
}


def unit(angle):
    return mp.mpc(mp.cos(angle), mp.sin(angle))


class VirtualWork:
    """What is left of the virtual work of a crane's motion: zero for each coordinate, if the motion is right."""

    def __init__(self, kind: str, parameters: SimpleNamespace, shaft, rope):
        self.kind, self.p, self.shaft, self.rope = kind, parameters, shaft, rope
        self.names = (*ORDER[kind], "theta", "psi", *(("e",) if kind == "basic" else ()))

    def points(self, q, at):
        """Points as (mass, drag per axis, direction of the axes, position), the load last; its direction."""
        p, c = self.p, SimpleNamespace(**dict(zip(self.names, q, strict=True)))
        height = mp.mpf(p.geometry_tower_height) + p.geometry_top_height
        jib = mp.mpf(p.geometry_jib_radius)
        found, length = [], mp.polyval(self.rope[::-1], at)
        if self.kind == "basic":
            hung, top = unit(c.phi1) * mp.mpc(jib + c.x3, c.y3), height + c.z4
            found.append((p.mass_jib_tip, p.drag_jib_tip, unit(c.phi1), hung, top))
            length += c.e
        else:
            tower = unit(c.phi2) * mp.mpc(c.x3, c.y3)
            tilt = 2 * c.x3 / mp.mpf(p.geometry_tower_height)
            hung, top = tower + jib * unit(c.phi3), height + c.z4 - jib * tilt
            found.append((p.mass_tower_top, (p.drag_tower_top,) * 3, 1, tower, height))
            found.append((p.mass_jib_tip, (p.drag_jib_tip,) * 3, 1, hung, top))
            if self.kind == "multi-mass":
                back = mp.mpf(p.geometry_counterweight_radius)
                place = tower - back * unit(c.phi4), height + c.z6 + back * tilt
                found.append((p.mass_counterweight, (p.drag_counterweight,) * 3, 1, *place))
        n = (mp.sin(c.theta) * mp.cos(c.psi), mp.sin(c.psi), -mp.cos(c.theta) * mp.cos(c.psi))
        place = hung + length * mp.mpc(n[0], n[1]), top + length * n[2]
        found.append((LOAD.mass, (mp.mpf("0.6125") * LOAD.drag_area,) * 3, 1, *place))
        return [(m, d, e, (w.real, w.imag, z)) for m, d, e, w, z in found], n

    def members(self, c):
        """Stretch, stiffness and damping of every spring."""
        p = self.p
        rows = [(c.x3, "jib_radial"), (c.y3, "jib_lateral"), (c.z4, "jib_vertical")]
        if self.kind == "basic":
            return [*((s, *self.pair(name)) for s, name in rows), (c.e, p.stiffness_rope, p.damping_rope)]
        rows = [(c.x3, "tower_x"), (c.y3, "tower_y"), (c.z4, "jib_vertical")]
        rows += [(c.phi2 - c.phi1, "tower_torsion"), (c.phi3 - c.phi2, "jib_lateral")]
        if self.kind == "multi-mass":
            rows += [(c.z6, "counter_jib_vertical"), (c.phi4 - c.phi2, "counter_jib_lateral")]
        return [(s, *self.pair(name)) for s, name in rows]

    def pair(self, name):
        return getattr(self.p, f"stiffness_{name}"), getattr(self.p, f"damping_{name}")

    def energy(self, q):
        """Energy of springs, coupling and, in the enhanced crane, the counterweight's moment."""
        p, c = self.p, SimpleNamespace(**dict(zip(self.names, q, strict=True)))
        total = sum(mp.mpf(k) * s * s / 2 for s, k, _ in self.members(c))
        if self.kind == "enhanced":
            total += 2 * p.gravity * mp.mpf(p.mass_counter_moment) / mp.mpf(p.geometry_tower_height) * c.x3
        twist, corner = abs(c.phi1 - self.shaft[0]), mp.mpf(p.drive_corner)
        soft, stiff = mp.mpf(p.drive_soft_stiffness), mp.mpf(p.drive_stiff_stiffness)
        within, beyond = min(twist, corner), max(twist - corner, mp.mpf(0))
        return total + soft * within**2 / 2 + soft * corner * beyond + stiff * beyond**2 / 2

    def loss(self, rate):
        """Half the power lost in the dampers, as a function of the rates."""
        p, c = self.p, SimpleNamespace(**dict(zip(self.names, rate, strict=True)))
        slip = c.phi1 - self.shaft[1]
        return sum(mp.mpf(d) * s * s / 2 for s, _, d in self.members(c)) + mp.mpf(p.drive_damping) * slip**2 / 2

    def defect(self, q, rate, acceleration):
        """Sum of virtual works without friction, and of their sizes, per coordinate; the rope's pull on the load."""
        h = mp.mpf(10) ** -10

        def along(e):
            return self.points([a + e * b + e * e / 2 * c for a, b, c in zip(q, rate, acceleration, strict=True)], e)

        (before, n_before), (now, n), (after, n_after) = along(-h), along(mp.mpf(0)), along(h)
        swing = [(b - a) / (2 * h) for a, b in zip(n_before, n_after, strict=True)]
        pulls = []
        for (_, _, _, r0), (m, d, e, r1), (_, _, _, r2) in zip(before, now, after, strict=True):
            v = [(b - a) / (2 * h) for a, b in zip(r0, r2, strict=True)]
            speed = mp.sqrt(sum(x * x for x in v))
            own = mp.mpc(v[0], v[1]) * mp.conj(e)
            air = mp.mpc(d[0] * own.real, d[1] * own.imag) * e * speed
            inertia = [m * (a - 2 * b + c) / h**2 for a, b, c in zip(r0, r1, r2, strict=True)]
            pulls.append(
                [inertia[0] + air.real, inertia[1] + air.imag, inertia[2] + m * self.p.gravity + d[2] * speed * v[2]]
            )
        sums, sizes = [], []
        for i in range(len(q)):
            shift = [h if k == i else 0 for k in range(len(q))]
            ahead = [a + s for a, s in zip(q, shift, strict=True)]
            back = [a - s for a, s in zip(q, shift, strict=True)]
            (plus, n_plus), (minus, n_minus) = self.points(ahead, mp.mpf(0)), self.points(back, mp.mpf(0))
            terms = [
                pull[k] * (a[3][k] - b[3][k]) / (2 * h)
                for pull, a, b in zip(pulls, plus, minus, strict=True)
                for k in range(3)
            ]
            terms += [LOAD.rope_damping * swing[k] * (n_plus[k] - n_minus[k]) / (2 * h) for k in range(3)]
            terms.append((self.energy(ahead) - self.energy(back)) / (2 * h))
            inertia = {"phi1": self.p.inertia_platform, "phi2": self.p.inertia_tower_top}
            terms.append(mp.mpf(inertia.get(self.names[i], 0.0)) * acceleration[i])
            faster = [a + s for a, s in zip(rate, shift, strict=True)]
            slower = [a - s for a, s in zip(rate, shift, strict=True)]
            terms.append((self.loss(faster) - self.loss(slower)) / (2 * h))
            sums.append(float(sum(terms)))
            sizes.append(float(sum(abs(t) for t in terms)))
        return np.array(sums), np.array(sizes), -float(sum(a * b for a, b in zip(pulls[-1], n, strict=True)))


@pytest.mark.parametrize("law", ["tanh", "stick-slip"])
@pytest.mark.parametrize("kind", ORDER)
def test_accelerations_fulfil_the_virtual_work_of_positions(kind, law):
    rng = np.random.default_rng(7)
    p = SimpleNamespace(**{**vars(PARAMETERS[kind]), **DRAGS[kind], "friction_law": law, "friction_rate": 0.8})
    model = LumpedModel(BUILDERS[kind](p), LOAD)
    n, names, elastic = model.coordinates, ORDER[kind], kind == "basic"
    driven = names.index("phi1")
    size = np.array([1.0 if name.startswith("phi") else 0.1 for name in names])
    for _ in range(12):
        q, rates = size * rng.normal(size=n), 5 * size * rng.normal(size=n)
        shaft = np.array([q[driven] + rng.uniform(-0.5, 0.5), rng.normal(), rng.normal()])
        rope = np.array([rng.uniform(0.5, 5), rng.normal(), rng.normal()])
        stretch, stretching = (0.02 * rng.normal(size=1), rng.normal(size=1)) if elastic else ([], [])
        if law == "stick-slip":
            rates[driven] = 0.0
        theta, psi, theta_rate, psi_rate = rng.uniform(-3, 3), rng.uniform(-1, 1), *(2 * rng.normal(size=2))
        s, c, sp, cp = np.sin(theta), np.cos(theta), np.sin(psi), np.cos(psi)
        e_theta, e_psi = np.array([c, 0, s]), np.array([-s * sp, cp, c * sp])
        swing = cp * theta_rate * e_theta + psi_rate * e_psi
        state = np.concatenate([q, stretch, [s * cp, sp, -c * cp], rates, stretching, swing, [0.0]])
        slope, guards = model.system.slope(0.0, state, np.array([shaft, rope]))
        second = slope[(model.size - 1) // 2 : -1]
        bending = second[model.rope : model.rope + 3]
        theta_acc = bending @ e_theta / cp + 2 * theta_rate * psi_rate * sp / cp
        psi_acc = bending @ e_psi - theta_rate**2 * sp * cp
        with mp.workdps(40):
            work = VirtualWork(kind, p, [mp.mpf(v) for v in shaft], [mp.mpf(v) for v in rope])
            sums, sizes, pull = work.defect(
                [mp.mpf(v) for v in (*q, theta, psi, *stretch)],
                [mp.mpf(v) for v in (*rates, theta_rate, psi_rate, *stretching)],
                [mp.mpf(v) for v in (*second[:n], theta_acc, psi_acc, *second[n : model.rope])],
            )
        if law == "tanh":
            sums[driven] += 22.0 * np.tanh(rates[driven] / 0.8)
        else:
            # What is left on the coordinate at rest is the torque that friction has to exert.
            assert second[driven] == 0.0
            assert guards[kernel.HOLDING] == 22.0 - abs(guards[kernel.NEEDED])
            sums[driven] -= guards[kernel.NEEDED]
        assert np.max(abs(sums) / sizes) < 1e-13
        np.testing.assert_allclose(guards[kernel.TENSION], pull, rtol=1e-11, atol=1e-9)


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

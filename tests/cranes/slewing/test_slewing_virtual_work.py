"""The compiled slewing cranes against the virtual work of positions alone.

In 40-digit arithmetic: every mass is a point whose position follows from the coordinates, and the virtual work of
inertia, weight, springs, dampers, drag and friction vanishes for each coordinate. It writes the cranes of Marinovic,
Sprecic and Jerman (2012) and Jerman (2006) out once more instead of reading their data.
"""

from types import SimpleNamespace

import mpmath as mp
import numpy as np
import pytest
from samples.lab_crane import BUILDERS, PARAMETERS

from towercrane.cranes.slewing import equations
from towercrane.cranes.slewing.model import LumpedModel
from towercrane.kernels.load import Load

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
        self.drift = 0

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
            # Spring and damper are those of two metres of rope.
            rope = [2 * mp.mpf(value) / self.rope[0] for value in (p.stiffness_rope, p.damping_rope)]
            return [*((s, *self.pair(name)) for s, name in rows), (c.e, *rope)]
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
        # Rope that is let out under strain stretches by itself.
        c.e = getattr(c, "e", 0) - self.drift
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
    model = LumpedModel(BUILDERS[kind](p), LOAD, rope_as_rod=True)
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
        n_load, w = np.array([s * cp, sp, -c * cp]), swing
        if elastic:
            held, _ = equations.structure(model.constants, q, rates, shaft, equations.winds_of(model.constants, []))
            reach, growing = rope[0] + stretch[0], rope[1] + stretching[0]
            n_load = np.array(held.place) + reach * n_load
            swing = np.array(held.velocity) + growing * (n_load - held.place) / reach + reach * w
        state = np.concatenate([q, n_load, rates, swing, [0.0]])
        slope, guards = model.system.slope(0.0, state, np.array([shaft, rope]))
        second = slope[(model.size - 1) // 2 : -1]
        bending, longer = second[n : n + 3], []
        if elastic:
            along = (n_load - held.place) / reach
            apart = bending - (held.bias + np.array(held.jacobian) @ second[:n])
            longer = [apart @ along + reach * (w @ w)]
            bending = (apart - longer[0] * along - 2 * growing * w) / reach
            longer[0] -= 2 * rope[2]
        theta_acc = bending @ e_theta / cp + 2 * theta_rate * psi_rate * sp / cp
        psi_acc = bending @ e_psi - theta_rate**2 * sp * cp
        with mp.workdps(40):
            work = VirtualWork(kind, p, [mp.mpf(v) for v in shaft], [mp.mpf(v) for v in rope])
            work.drift = mp.mpf(stretch[0]) / work.rope[0] * work.rope[1] if elastic else 0
            sums, sizes, pull = work.defect(
                [mp.mpf(v) for v in (*q, theta, psi, *stretch)],
                [mp.mpf(v) for v in (*rates, theta_rate, psi_rate, *stretching)],
                [mp.mpf(v) for v in (*second[:n], theta_acc, psi_acc, *longer)],
            )
        if law == "tanh":
            sums[driven] += 22.0 * np.tanh(rates[driven] / 0.8)
        else:
            # What is left on the coordinate at rest is the torque that friction has to exert.
            assert second[driven] == 0.0
            assert guards[equations.HOLDING] == 22.0 - abs(guards[equations.NEEDED])
            sums[driven] -= guards[equations.NEEDED]
        # The elastic rope's accelerations go through those of the load's place.
        assert np.max(abs(sums) / sizes) < (5e-13 if elastic else 1e-13)
        np.testing.assert_allclose(guards[equations.TENSION], pull, rtol=1e-11, atol=1e-9)

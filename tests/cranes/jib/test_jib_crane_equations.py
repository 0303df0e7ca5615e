"""The jib crane's equations against formulations that share nothing with them.

d'Alembert's principle on positions alone in 40-digit arithmetic (no mass matrix, no chart, no Jacobian), and over
whole runs the two sway equations in angles.
"""

import itertools

import mpmath as mp
import numpy as np
import pytest
from samples.jib_cranes import HEAVY, LOAD, PRINTED, planned, smooth_plan, trapezoid_plan
from scipy.integrate import solve_ivp

from towercrane.cranes.jib.equations import PLANNED_TENSION, TENSION, TORQUE, structure
from towercrane.cranes.jib.model import DrivenJibCrane, PlannedJibCrane
from towercrane.cranes.jib.tracking import TrackingJibCrane
from towercrane.kernels.load import AIR_DENSITY, Load
from towercrane.motions.motion import Motion
from towercrane.simulation.simulate import simulate

LOSSY = Load(5000.0, rope_damping=2e4, drag_area=30.0)


class VirtualWork:
    """Points that carry all masses, and what is left of the virtual work of one motion of them."""

    def __init__(self, crane, load, rope):
        self.crane, self.load, self.rope = crane, load, rope

    def suspension(self, theta, along_primary=1, along_secondary=1):
        crane, (th1, th2, th3) = self.crane, theta
        first, second = along_primary * crane.primary_length, along_secondary * crane.secondary_length
        reach = first * mp.cos(th2) + second * mp.cos(th2 + th3)
        up = crane.post_height + first * mp.sin(th2) + second * mp.sin(th2 + th3)
        return mp.matrix([reach * mp.cos(th1), reach * mp.sin(th1), up])

    def points(self, theta, n, e):
        """Mass, weight counts, position; two Gauss points per boom are exact for a uniform rod."""
        crane = self.crane
        gauss = [(1 - 1 / mp.sqrt(3)) / 2, (1 + 1 / mp.sqrt(3)) / 2]
        primary = mp.mpf(crane.primary_mass_per_length) * crane.primary_length
        secondary = mp.mpf(crane.secondary_mass_per_length) * crane.secondary_length
        yield crane.post_inertia, False, mp.matrix([mp.cos(theta[0]), mp.sin(theta[0]), 0])
        for x in gauss:
            yield primary / 2, True, self.suspension(theta, x, 0)
            yield secondary / 2, True, self.suspension(theta, 1, x)
        length = mp.polyval(self.rope[::-1], e)
        yield self.load.mass, True, self.suspension(theta) + length * n

    def defect(self, theta, rates, accelerations, n, p, pp, torques):
        """Largest virtual work left over, relative to the sizes of its terms, of joints and both ways to swing."""
        h = mp.mpf(10) ** -10

        def at(e):
            moved = [a + e * b + e * e / 2 * c for a, b, c in zip(theta, rates, accelerations, strict=True)]
            return [*self.points(moved, n + e * p + e * e / 2 * pp, e)]

        before, now, after = at(-h), at(0), at(h)
        velocity = (after[-1][2] - before[-1][2]) / (2 * h)
        drag = mp.mpf(AIR_DENSITY) * self.load.drag_area / 2 * mp.norm(velocity) * velocity
        across = mp.matrix(np.cross([float(v) for v in n], [0.3, -0.5, 0.8]).tolist())
        across -= mp.fdot(across, n) * n
        other = mp.matrix([n[1] * across[2] - n[2] * across[1], n[2] * across[0] - n[0] * across[2],
                           n[0] * across[1] - n[1] * across[0]])  # fmt: skip
        nothing = mp.zeros(3, 1)
        worst = 0.0
        shifts = [([h if i == k else 0 for k in range(3)], nothing) for i in range(3)]
        shifts += [([0, 0, 0], h * across), ([0, 0, 0], h * other)]
        for i, (joint, swing) in enumerate(shifts):
            plus = [*self.points([a + s for a, s in zip(theta, joint, strict=True)], n + swing, 0)]
            minus = [*self.points([a - s for a, s in zip(theta, joint, strict=True)], n - swing, 0)]
            moved = (plus[-1][2] - minus[-1][2]) / (2 * h)
            terms = [mp.fdot(drag, moved), self.load.rope_damping * mp.fdot(p, swing) / h]
            if i < 3:
                terms.append(-torques[i])
            for (m, heavy, a), (_, _, b), (_, _, c), (_, _, u), (_, _, v) in zip(
                before, now, after, plus, minus, strict=True
            ):
                pull = (c - 2 * b + a) / h**2
                if heavy:
                    pull[2] += mp.mpf(self.crane.gravity)
                terms += [m * pull[k] * (u[k] - v[k]) / (2 * h) for k in range(3)]
            worst = max(worst, float(abs(mp.fsum(terms)) / mp.fsum(abs(t) for t in terms)))
        return worst


def random_state(rng):
    """Joint angles and rates, rope and its rates, direction of the rope and its rate."""
    theta, rates = rng.uniform(-1.5, 1.5, 3), rng.normal(size=3)
    rope = np.array([rng.uniform(2, 25), rng.normal(), rng.normal()])
    n = rng.normal(size=3)
    n /= np.linalg.norm(n)
    p = rng.normal(size=3)
    return theta, rates, rope, n, p - (p @ n) * n


def exact(values):
    return mp.matrix([mp.mpf(float(v)) for v in values])


@pytest.mark.parametrize("crane", [PRINTED, HEAVY], ids=["printed", "heavy"])
@pytest.mark.parametrize("load", [LOAD, LOSSY], ids=["lossless", "lossy"])
def test_torques_and_accelerations_fulfil_the_virtual_work_of_positions(crane, load):
    rng = np.random.default_rng(3)
    for _ in range(10):
        theta, rates, rope, n, p = random_state(rng)
        asked = rng.normal(size=3)
        inputs = np.array([*np.stack([theta, rates, asked / 2], axis=1), rope])
        slope, guards = PlannedJibCrane(crane, load).system.slope(0.0, np.concatenate([n, p, [0.0]]), inputs)
        torques = guards[TORQUE : TORQUE + 3]
        driven = DrivenJibCrane(crane, load, (0.0, 0.0, 0.0))
        given = np.zeros((4, 3))
        given[:3, 0], given[3] = rng.normal(size=3) * 1e5, rope
        free, _ = driven.system.slope(0.0, np.concatenate([theta, n, rates, p, [0.0]]), given)
        with mp.workdps(40):
            work = VirtualWork(crane, load, [mp.mpf(float(c)) for c in rope])
            # The unit vector to more digits than the state's, or its stretch would show as work.
            n_exact = exact(n) / mp.norm(exact(n))
            p_exact = exact(p) - mp.fdot(exact(p), n_exact) * n_exact
            here = [mp.mpf(float(v)) for v in theta], [mp.mpf(float(v)) for v in rates]
            asked = [mp.mpf(float(v)) for v in asked]
            assert work.defect(*here, asked, n_exact, p_exact, exact(slope[3:6]), torques.tolist()) < 1e-12
            freely = [mp.mpf(float(v)) for v in free[6:9]]
            left = work.defect(*here, freely, n_exact, p_exact, exact(free[9:12]), given[:3, 0].tolist())
            assert left < 1e-12


def test_forward_dynamics_undoes_inverse_dynamics():
    rng = np.random.default_rng(4)
    tracking = TrackingJibCrane(HEAVY, LOSSY)
    for _ in range(200):
        theta, rates, rope, n, p = random_state(rng)
        asked = rng.normal(size=3)
        inputs = np.array([*np.stack([theta, rates, asked / 2], axis=1), rope])
        state = np.concatenate([theta, n, rates, p, [0.0], n, p, [0.0]])
        slope, guards = tracking.system.slope(0.0, state, inputs)
        assert np.max(abs(slope[6:9] - asked)) < 1e-11
        np.testing.assert_allclose(slope[9:12], slope[16:19], atol=1e-10)
        np.testing.assert_allclose(guards[TENSION], guards[PLANNED_TENSION], rtol=1e-11, atol=1e-5)


def test_gains_pull_the_joints_to_their_plan():
    rng = np.random.default_rng(5)
    theta, rates, rope, n, p = random_state(rng)
    inputs = np.array([*np.stack([theta, rates, np.zeros(3)], axis=1), rope])
    late, fast = rng.normal(size=(2, 3))
    state = np.concatenate([theta + late, n, rates + fast, p, [0.0], n, p, [0.0]])
    torque = [
        TrackingJibCrane(HEAVY, LOAD, *gains).system.slope(0.0, state, inputs)[1][TORQUE : TORQUE + 3]
        for gains in ((0.0, 0.0), (8e6, 4e6))
    ]
    np.testing.assert_allclose(torque[1] - torque[0], -8e6 * late - 4e6 * fast, rtol=1e-9)


def test_mass_matrix_is_symmetric_positive_definite_at_5000_states():
    rng = np.random.default_rng(6)
    for crane in (PRINTED, HEAVY):
        for _ in range(2500):
            theta, rates, _, n, _ = random_state(rng)
            booms = structure(crane, 2.0 * theta, rates)
            mass = np.zeros((3, 3))
            mass[np.tril_indices(3)] = np.concatenate(booms.mass)
            along = n @ booms.jacobian
            mass += np.tril(mass, -1).T + LOAD.mass * np.outer(along, along)
            d = 1 / np.sqrt(np.diag(mass))
            assert np.linalg.eigvalsh(mass * np.outer(d, d)).min() > 1e-6


def sway_in_angles(crane, motions, stop):
    """Lateral and in-plane sway by their own two equations, restarted at every switch; times, angles and rates."""
    g, a2, a3 = crane.gravity, crane.primary_length, crane.secondary_length
    switches = np.unique(np.concatenate([[0.0, stop], *(m.switch_times for m in motions.values())]))
    switches = switches[switches <= stop]
    y = np.zeros(4)
    times, rows = [], []
    for begin, end in itertools.pairwise(switches):
        if end - begin < 1e-9:
            continue

        def rhs(t, y, begin=begin, end=end):
            # Inside the piece: at its end the plan already reports the next one.
            t = min(max(t, begin + 1e-8), end - 1e-8)
            (_, w, wd), (b, bd, bdd), (c, cd, cdd), (length, rate, _) = (
                [float(motions[k](t, d)) for d in range(3)] for k in ("slew", "luff", "fold", "rope")
            )
            f, fd, fdd = b + c, bd + cd, bdd + cdd
            r = a2 * np.cos(b) + a3 * np.cos(f)
            rd = -a2 * np.sin(b) * bd - a3 * np.sin(f) * fd
            rdd = -a2 * (np.cos(b) * bd**2 + np.sin(b) * bdd) - a3 * (np.cos(f) * fd**2 + np.sin(f) * fdd)
            zdd = a2 * (np.cos(b) * bdd - np.sin(b) * bd**2) + a3 * (np.cos(f) * fdd - np.sin(f) * fd**2)
            out, side, fall = rdd - r * w * w, r * wd + 2 * rd * w, zdd + g
            t4, t5, v4, v5 = y
            s4, c4, s5, c5 = np.sin(t4), np.cos(t4), np.sin(t5), np.cos(t5)
            a4 = 2 * length * s5 * v4 * v5 - 2 * rate * c5 * v4 + 2 * length * w * c4 * c5 * v5
            a4 += (
                2 * rate * w * c4 * s5 + length * wd * c4 * s5 + length * w * w * s4 * c4 * c5 - c4 * out - s4 * fall
            )
            a5 = -length * s5 * c5 * v4**2 - 2 * rate * v5 - 2 * length * w * c4 * c5**2 * v4 - 2 * rate * w * s4
            a5 += -length * wd * s4 + length * w * w * c4**2 * s5 * c5 + s4 * s5 * out - c5 * side - c4 * s5 * fall
            return [v4, v5, a4 / (length * c5), a5 / length]

        leg = solve_ivp(rhs, (begin, end), y, "DOP853", rtol=1e-12, atol=1e-14)
        y = leg.y[:, -1]
        times.append(end)
        rows.append(y)
    return np.array(times), np.array(rows)


@pytest.mark.parametrize("motions", [smooth_plan(), trapezoid_plan()], ids=["smooth", "trapezoids"])
def test_whole_run_is_the_one_of_the_sway_equations_in_angles(motions):
    times, angles = sway_in_angles(HEAVY, motions, 45.0)
    result = simulate(planned(), motions, 45.0, output_step=1.0, rtol=1e-11, atol=1e-13)
    common = np.isin(times, result.time.values)
    assert np.count_nonzero(common) >= 6
    rows = result.sel(time=times[common])
    peak = np.max(abs(result["sway_in_plane"].values))
    assert np.max(abs(rows["sway_in_plane"].values - angles[common, 0])) < 1e-8 * peak
    assert np.max(abs(rows["sway_lateral"].values - angles[common, 1])) < 1e-8 * peak


def test_rope_rates_reach_the_tension():
    # Hanging still, m (g - l'').
    still = {
        k: Motion(np.array([0.0, 5.0]), np.array([[v]])) for k, v in (("slew", 0.0), ("luff", 0.5), ("fold", 0.2))
    }
    still["rope"] = Motion(np.array([0.0, 5.0]), np.array([[10.0, -0.5, 0.3]]))
    result = simulate(planned(), still, 4.0, output_step=0.5)
    np.testing.assert_allclose(result["hoist_rope_force"], 5000 * (9.81 - 0.6), rtol=1e-12)

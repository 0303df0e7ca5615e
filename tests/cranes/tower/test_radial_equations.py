"""The compiled equations against d'Alembert's principle on positions alone, in 40-digit arithmetic.

The check knows nothing of mass matrices: every mass is a point whose position follows from the coordinates, its
acceleration is the second derivative of that position along the motion, and the virtual work of inertia, weight,
elasticity, damping and drag vanishes for each coordinate. The load is written in angles.
"""

import mpmath as mp
import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss
from samples.qtz5613 import CRANE, in_plane

from towercrane.kernels.load import Load

GAUSS = leggauss(32)


def on(length, start=0.0):
    """Gauss points and weights on [start, start + length]."""
    return start + 0.5 * length * (GAUSS[0] + 1), 0.5 * length * GAUSS[1]


def clamped_free(mode, x):
    """Textbook shape of the jib in hyperbolic functions, mass-normalised, positive at the tip."""
    root = mp.findroot(lambda z: mp.cos(z) + 1 / mp.cosh(z), (mode - 0.5) * mp.pi + (0.3 if mode == 1 else 0))
    sigma = (mp.cosh(root) + mp.cos(root)) / (mp.sinh(root) + mp.sin(root))
    z = root * x / CRANE.jib.length
    shape = mp.cosh(z) - mp.cos(z) - sigma * (mp.sinh(z) - mp.sin(z))
    return (-1) ** (mode + 1) * shape / mp.sqrt(CRANE.jib.mass)


class VirtualWork:
    """Positions of all masses for given coordinates, and what is left of the virtual work."""

    def __init__(self, model, trolley, rope):
        self.model, self.trolley, self.rope = model, trolley, rope
        nt, nb = model.counts["tower_x"], model.counts["jib_vertical"]
        z, self.tower_weights = on(CRANE.tower.length)
        tower = model.crane.tower
        self.tower_shapes, self.tower_slopes = tower(z).T, tower(z, 1).T
        self.tip, self.slope = tower(CRANE.tower.length), tower(CRANE.tower.length, 1)
        self.jib_points, self.jib_weights = on(CRANE.jib.length)
        with mp.workdps(40):
            self.jib_shapes = [[clamped_free(b + 1, mp.mpf(x)) for b in range(nb)] for x in self.jib_points]
            self.roots = [
                mp.findroot(lambda y: mp.cos(y) + 1 / mp.cosh(y), (b + 0.5) * mp.pi + (0.3 if b == 0 else 0))
                for b in range(nb)
            ]
        self.counter_points, self.counter_weights = on(CRANE.counter_jib_length, -CRANE.counter_jib_length)
        self.nt, self.nb = nt, nb

    def masses(self, q, at):
        """List of (mass, weight counts, position) of every point; position (outward, sideways, up)."""
        nt, nb = self.nt, self.nb
        own = self.model.self_weight
        points = []
        for shapes, weight in zip(self.tower_shapes, self.tower_weights, strict=True):
            v = sum((s * a for s, a in zip(shapes, q[:nt], strict=True)), mp.mpf(0))
            points.append((CRANE.tower.mass_per_length * weight, False, (v, 0, 0)))
        u = sum((s * a for s, a in zip(self.tip, q[:nt], strict=True)), mp.mpf(0))
        tilt = sum((s * a for s, a in zip(self.slope, q[:nt], strict=True)), mp.mpf(0))

        def place(x, w):
            return (u + x * mp.cos(tilt) + w * mp.sin(tilt), 0, -x * mp.sin(tilt) + w * mp.cos(tilt))

        for x, shapes, weight in zip(self.jib_points, self.jib_shapes, self.jib_weights, strict=True):
            w = sum((s * a for s, a in zip(shapes, q[nt : nt + nb], strict=True)), mp.mpf(0))
            points.append((CRANE.jib.mass_per_length * weight, own, place(mp.mpf(x), w)))
        for x, weight in zip(self.counter_points, self.counter_weights, strict=True):
            points.append((CRANE.counter_jib_mass_per_length * weight, own, place(mp.mpf(x), 0)))
        points.append((CRANE.counterweight, own, place(-mp.mpf(CRANE.counter_jib_length), 0)))
        x = mp.polyval(self.trolley[::-1], at)
        w = sum((clamped_free(b + 1, x) * q[nt + b] for b in range(nb)), mp.mpf(0))
        hung = place(x, w)
        points.append((CRANE.trolley_mass, True, hung))
        length = mp.polyval(self.rope[::-1], at)
        theta, phi = q[nt + nb], q[nt + nb + 1]
        direction = (mp.sin(theta) * mp.cos(phi), mp.sin(phi), -mp.cos(theta) * mp.cos(phi))
        points.append(
            (self.model.load.mass, True, tuple(a + length * n for a, n in zip(hung, direction, strict=True)))
        )
        return points, direction

    def defect(self, q, rate, acceleration, at, coordinates):
        """Sum of virtual works and of their sizes, per coordinate; both lists."""
        h = mp.mpf(10) ** -10

        def along(e):
            moved = [a + e * b + e * e / 2 * c for a, b, c in zip(q, rate, acceleration, strict=True)]
            return self.masses(moved, at + e)

        before, (now, _), after = along(-h)[0], along(0), along(h)[0]
        n_before, n_after = along(-h)[1], along(h)[1]
        gravity = mp.mpf(CRANE.gravity)
        model, load = self.model, self.model.load
        velocity = [(b - a) / (2 * h) for a, b in zip(before[-1][2], after[-1][2], strict=True)]
        speed = mp.sqrt(sum(v * v for v in velocity))
        swing = [(b - a) / (2 * h) for a, b in zip(n_before, n_after, strict=True)]
        sums, sizes = [], []
        for i in coordinates:
            shift = [h if k == i else 0 for k in range(len(q))]
            plus, n_plus = self.masses([a + s for a, s in zip(q, shift, strict=True)], at)
            minus, n_minus = self.masses([a - s for a, s in zip(q, shift, strict=True)], at)
            terms = []
            for (m, heavy, a), (_, _, b), (_, _, c), (_, _, p), (_, _, r) in zip(
                before, now, after, plus, minus, strict=True
            ):
                for k in range(3):
                    pull = (c[k] - 2 * b[k] + a[k]) / h**2 + (gravity if heavy and k == 2 else 0)
                    terms.append(m * pull * (p[k] - r[k]) / (2 * h))
            for k in range(3):
                terms.append(
                    0.5 * 1.225 * load.drag_area * speed * velocity[k] * (plus[-1][2][k] - minus[-1][2][k]) / (2 * h)
                )
                terms.append(load.rope_damping * swing[k] * (n_plus[k] - n_minus[k]) / (2 * h))
            if i < self.nt:
                omega = model.crane.tower.angular_frequencies[i]
                terms += [omega**2 * q[i], 2 * model.damping.tower * omega * rate[i]]
                if model.weight_softening:
                    # The weight above each section works on the shortening 1/2 V'^2.
                    height = CRANE.tower.length
                    hung = CRANE.trolley_mass + load.mass
                    for z, weight, slopes in zip(*on(height), self.tower_slopes, strict=True):
                        above = CRANE.slewing_mass + hung + CRANE.tower.mass_per_length * (height - z)
                        lean = sum(s * a for s, a in zip(slopes, q[: self.nt], strict=True))
                        terms.append(-weight * gravity * above * slopes[i] * lean)
            elif i < self.nt + self.nb:
                beam, root = CRANE.jib, self.roots[i - self.nt]
                omega = root**2 * mp.sqrt(mp.mpf(beam.bending_stiffness) / beam.mass_per_length) / beam.length**2
                terms += [omega**2 * q[i], 2 * model.damping.vertical * omega * rate[i]]
            sums.append(float(sum(terms)))
            sizes.append(float(sum(abs(t) for t in terms)))
        return np.array(sums), np.array(sizes)


CASES = {
    "rigid": {"tower": 0, "jib": 0},
    "rigid tower": {"tower": 0, "jib": 2},
    "rigid jib": {"tower": 2, "jib": 0},
    "planar": {"tower": 2, "jib": 3},
    "damped": {
        "tower": 2,
        "jib": 2,
        "damping": (0.02, 0.05),
        "weight_softening": True,
    },
    "weightless": {"tower": 1, "jib": 2, "self_weight": False},
    "spatial": {"tower": 2, "jib": 2, "axes": 3},
}


@pytest.mark.parametrize("options", CASES.values(), ids=CASES)
def test_accelerations_fulfil_the_virtual_work_of_positions(options):
    rng = np.random.default_rng(20)
    model = in_plane(CRANE, Load(800.0, rope_damping=300.0, drag_area=4.0), **options)
    n, axes = model.coordinates, model.axes
    for _ in range(10):
        trolley = np.array([rng.uniform(2, 50), rng.normal(), rng.normal()])
        rope = np.array([rng.uniform(2, 20), rng.normal(), rng.normal()])
        # Displacements of half a metre, tilts up to a few tenths of a radian, any swing.
        amplitude = 0.5 * model.system.scale[:n]
        q, rates = amplitude * rng.normal(size=n), amplitude * rng.normal(size=n)
        theta, phi = rng.uniform(-3, 3), rng.uniform(-1, 1) if axes == 3 else 0.0
        theta_rate, phi_rate = rng.normal(), rng.normal() if axes == 3 else 0.0
        s, c, sp, cp = np.sin(theta), np.cos(theta), np.sin(phi), np.cos(phi)
        e_theta, e_phi = np.array([c, 0, s]), np.array([-s * sp, cp, c * sp])
        direction = np.array([s * cp, sp, -c * cp])
        swing = cp * theta_rate * e_theta + phi_rate * e_phi
        keep = [0, 2] if axes == 2 else [0, 1, 2]
        state = np.concatenate([q, direction[keep], rates, swing[keep], [0.0]])
        slope, _ = model.system.slope(0.0, state, np.array([trolley, rope]))
        bending = np.zeros(3)
        bending[keep] = slope[2 * n + axes : -1]
        # n'' in angles: the centripetal and chart terms taken off, then projected.
        theta_acc = (bending @ e_theta / cp + 2 * theta_rate * phi_rate * sp / cp) if axes == 3 else bending @ e_theta
        phi_acc = bending @ e_phi - theta_rate**2 * sp * cp if axes == 3 else 0.0
        coordinates = [*range(n), n] + ([n + 1] if axes == 3 else [])
        with mp.workdps(40):
            work = VirtualWork(model, [mp.mpf(v) for v in trolley], [mp.mpf(v) for v in rope])
            sums, sizes = work.defect(
                [mp.mpf(v) for v in (*q, theta, phi)],
                [mp.mpf(v) for v in (*rates, theta_rate, phi_rate)],
                [mp.mpf(v) for v in (*slope[n + axes : 2 * n + axes], theta_acc, phi_acc)],
                mp.mpf(0),
                coordinates,
            )
        assert np.max(abs(sums) / sizes) < (3e-13 if axes == 2 else 2e-12)


def test_mass_matrix_is_symmetric_positive_definite_anywhere():
    # The whole matrix that is factored: structure, trolley, and the load along the rope.
    rng = np.random.default_rng(0)
    model = in_plane(CRANE, Load(800.0), 3, 4)
    n = model.coordinates
    for _ in range(1000):
        q = 2.0 * model.system.scale[:n] * rng.normal(size=n)
        at_rest = model.at_rest(q, np.array([[rng.uniform(0, 55.6), 0, 0], [10.0, 0, 0]]))
        theta = rng.uniform(-np.pi, np.pi)
        along = np.transpose(at_rest.jacobian) @ [np.sin(theta), -np.cos(theta)]
        mass = at_rest.mass_matrix() + 800.0 * np.outer(along, along)
        d = 1 / np.sqrt(np.diag(mass))
        assert np.linalg.eigvalsh(mass * np.outer(d, d)).min() > 1e-3

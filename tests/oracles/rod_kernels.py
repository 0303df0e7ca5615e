"""Compiled equations of motion of geometrically exact rods in space: hinges between them, ropes, trolley and load.

Two-node elements after Reissner (1981) and Simo (1985): each node has a place and a quaternion, the strains are
measured once per element, in the frame half-way between its nodes:

    gamma = R_m^T (x_b - x_a) / h - e,      kappa = 4 tan(phi / 4) / h  along the axis of the rotation from a to b.

Forces and moments are the derivatives of the strain energy, so energy and momenta are conserved.
"""

import numpy as np
from numba import njit

PLACE, TURN, SPEED, SPIN = 0, 3, 7, 10
"""Where a node's place, quaternion, velocity and angular velocity (in its own axes) begin in its row of the state."""

MASS, INERTIA, MOMENT, SHAFT, GRAVITY, RAISED, PRODUCT = 0, 1, 4, 5, 6, 7, 8
"""Where in a node's row are its mass (infinite: clamped), moments of inertia, first moment along its e1, what part of
its inertia about e3 stays behind when the joint turns, the gravity on it, first moment along its e3, and the element
e1, e3 of its inertia."""

LENGTH, AXIS, STRETCH, BEND, JOINT, SHEARED = 0, 1, 4, 7, 10, 11
"""Where in an element's row are its length, axis, stiffness to strain and to curvature, whether its second node
is seen from below the slewing joint, and what part of its strain across it is shear."""

WAY, ROPE, ANGLE, RATE, ACCELERATION, HELD = range(6)
"""Inputs: place of the trolley along the jib, length of the rope, slewing angle and its derivatives, length of
another rope without tension."""

STRENGTH, SLACK, PAID = range(3)
"""Where in a row of the ropes are E A, the length without tension, and which input has that instead (-1: none)."""

OF, UPPER, LOWER, FALLS, FROM, TO = 0, 1, 2, 3, 4, 7
"""Where in a row of the spans are the rope that they are of, the nodes they are between, how often it goes there, and
where it is tied on in the axes of either node."""

OUTER, INNER, HINGE, HOLD, ALIGN = 0, 1, 2, 5, 6
"""Where in a row of the hinges are the nodes, the place in the axes of the first one where the second one is held,
and the stiffness to gaps and to any turn but that about e2."""

STIFF = 1e9
"""Of the springs that stand for constraints [N/m]."""


def kernel(**_):
    """Compiled by another compiler than the program's own."""
    return njit(cache=True, error_model="numpy")


@kernel()
def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@kernel()
def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel()
def add(a, b, factor):
    return a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]


@kernel()
def turn(scalar, vector, v):
    """A vector turned by a unit quaternion."""
    twice = cross(vector, v)
    twice = (2.0 * twice[0], 2.0 * twice[1], 2.0 * twice[2])
    return add(add(v, twice, scalar), cross(vector, twice), 1.0)


@kernel()
def vector(rows, i, first):
    return rows[i, first], rows[i, first + 1], rows[i, first + 2]


@kernel()
def push(forces, node, first, v, factor):
    for k in range(3):
        forces[node, first + k] += factor * v[k]


@kernel()
def strain(state, ends, elements, inputs, forces):
    """Add forces and moments (in the nodes' axes) of the elements; returns their energy."""
    energy = 0.0
    half = 0.5 * inputs[ANGLE]
    c, s = np.cos(half), np.sin(half)
    for i in range(len(elements)):
        a, b, h, joint = ends[i, 0], ends[i, 1], elements[i, LENGTH], elements[i, JOINT] > 0.0
        q0, q = state[a, TURN], vector(state, a, TURN + 1)
        p0, p = state[b, TURN], vector(state, b, TURN + 1)
        if joint:
            p0, p = c * p0 + s * p[2], (c * p[0] - s * p[1], c * p[1] + s * p[0], c * p[2] - s * p0)
        # From a to b in their own axes: 1 + cosine and sine of half the angle, along the axis.
        u = add(add((q0 * p[0], q0 * p[1], q0 * p[2]), q, -p0), cross(q, p), -1.0)
        cosine = q0 * p0 + dot(q, p)
        w = 1.0 / (1.0 + cosine)
        kappa = (4.0 * w / h * u[0], 4.0 * w / h * u[1], 4.0 * w / h * u[2])
        # Frame half-way.
        scale = np.sqrt(0.5 * w)
        m0, m = -(q0 + p0) * scale, ((q[0] + p[0]) * scale, (q[1] + p[1]) * scale, (q[2] + p[2]) * scale)
        chord = add(vector(state, b, PLACE), vector(state, a, PLACE), -1.0)
        g = turn(m0, m, chord)
        gamma = add((g[0] / h, g[1] / h, g[2] / h), vector(elements, i, AXIS), -1.0)
        stretch, bend = vector(elements, i, STRETCH), vector(elements, i, BEND)
        n = (stretch[0] * gamma[0], stretch[1] * gamma[1], stretch[2] * gamma[2])
        moment = (bend[0] * kappa[0], bend[1] * kappa[1], bend[2] * kappa[2])
        energy += 0.5 * h * (dot(n, gamma) + dot(moment, kappa))
        pull = turn(-m0, m, n)
        push(forces, a, 0, pull, 1.0)
        push(forces, b, 0, pull, -1.0)
        lever = cross(g, n)
        tilt, bow = cross(lever, u), cross(moment, u)
        on_a = add(add(lever, tilt, -w), moment, 4.0 * cosine * w)
        on_b = add(add(lever, tilt, w), moment, -4.0 * cosine * w)
        along = 4.0 * dot(moment, u) * w * w
        on_a = add(add(on_a, bow, -4.0 * w), u, along)
        on_b = add(add(on_b, bow, -4.0 * w), u, -along)
        if joint:
            cc, ss = np.cos(inputs[ANGLE]), np.sin(inputs[ANGLE])
            on_b = (cc * on_b[0] + ss * on_b[1], cc * on_b[1] - ss * on_b[0], on_b[2])
        push(forces, a, 3, on_a, 0.5)
        push(forces, b, 3, on_b, 0.5)
    return energy


@kernel()
def tie(state, ropes, spans, lengths, inputs, forces):
    """Add the pulls of ropes, massless and each with one tension along all its spans; returns their energy."""
    energy = 0.0
    lengths[:] = 0.0
    for leg in range(2):
        for i in range(len(spans)):
            own, a, b, falls = int(spans[i, OF]), int(spans[i, UPPER]), int(spans[i, LOWER]), spans[i, FALLS]
            start, end = vector(spans, i, FROM), vector(spans, i, TO)
            qa, qb = vector(state, a, TURN + 1), vector(state, b, TURN + 1)
            way = add(vector(state, b, PLACE), vector(state, a, PLACE), -1.0)
            way = add(add(way, turn(state[b, TURN], qb, end), 1.0), turn(state[a, TURN], qa, start), -1.0)
            length = np.sqrt(dot(way, way))
            if leg == 0:
                lengths[own] += falls * length
                continue
            slack = ropes[own, SLACK] if ropes[own, PAID] < 0.0 else inputs[int(ropes[own, PAID])]
            pull = ropes[own, STRENGTH] * (lengths[own] / slack - 1.0) * falls / length
            push(forces, a, 0, way, pull)
            push(forces, b, 0, way, -pull)
            push(forces, a, 3, cross(start, turn(-state[a, TURN], qa, way)), pull)
            push(forces, b, 3, cross(end, turn(-state[b, TURN], qb, way)), -pull)
    for own in range(len(ropes)):
        slack = ropes[own, SLACK] if ropes[own, PAID] < 0.0 else inputs[int(ropes[own, PAID])]
        energy += 0.5 * ropes[own, STRENGTH] / slack * (lengths[own] - slack) ** 2
    return energy


@kernel()
def hinge(state, hinges, forces):
    """Add the springs of hinges about e2; returns their energy."""
    energy = 0.0
    for i in range(len(hinges)):
        a, b, e = int(hinges[i, OUTER]), int(hinges[i, INNER]), (0.0, 1.0, 0.0)
        at, held, align = vector(hinges, i, HINGE), hinges[i, HOLD], hinges[i, ALIGN]
        qa, qb = vector(state, a, TURN + 1), vector(state, b, TURN + 1)
        gap = add(vector(state, b, PLACE), vector(state, a, PLACE), -1.0)
        gap = add(gap, turn(state[a, TURN], qa, at), -1.0)
        push(forces, a, 0, gap, held)
        push(forces, b, 0, gap, -held)
        push(forces, a, 3, cross(at, turn(-state[a, TURN], qa, gap)), held)
        one, other = turn(state[a, TURN], qa, e), turn(state[b, TURN], qb, e)
        twist = cross(one, other)
        push(forces, a, 3, turn(-state[a, TURN], qa, twist), align)
        push(forces, b, 3, turn(-state[b, TURN], qb, twist), -align)
        energy += 0.5 * held * dot(gap, gap) + align * (1.0 - dot(one, other))
    return energy


@kernel()
def hang(state, ends, elements, rail, inputs, forces):
    """Add the springs of trolley and rope, the last two nodes; returns their energy."""
    trolley, load = len(state) - 2, len(state) - 1
    h = elements[rail, LENGTH]
    i = min(rail + int(inputs[WAY] / h), len(elements) - 1)
    x = inputs[WAY] / h - (i - rail)
    a, b, e = ends[i, 0], ends[i, 1], (1.0, 0.0, 0.0)
    near, far = 1.0 - x * x * (3.0 - 2.0 * x), x * x * (3.0 - 2.0 * x)
    slope_a, slope_b = h * x * (1.0 - x) * (1.0 - x), -h * x * x * (1.0 - x)
    # Sheared, the rail is as steep as the chord rather than as the sections.
    sheared = elements[i, SHEARED] * (slope_a + slope_b)
    near, far, slope_a, slope_b = (
        near - sheared / h,
        far + sheared / h,
        slope_a - 0.5 * sheared,
        slope_b - 0.5 * sheared,
    )
    along_a = turn(state[a, TURN], vector(state, a, TURN + 1), e)
    along_b = turn(state[b, TURN], vector(state, b, TURN + 1), e)
    place = vector(state, trolley, PLACE)
    gap = add((-place[0], -place[1], -place[2]), vector(state, a, PLACE), near)
    gap = add(add(add(gap, vector(state, b, PLACE), far), along_a, slope_a), along_b, slope_b)
    push(forces, trolley, 0, gap, STIFF)
    push(forces, a, 0, gap, -STIFF * near)
    push(forces, b, 0, gap, -STIFF * far)
    push(forces, a, 3, cross(e, turn(-state[a, TURN], vector(state, a, TURN + 1), gap)), -STIFF * slope_a)
    push(forces, b, 3, cross(e, turn(-state[b, TURN], vector(state, b, TURN + 1), gap)), -STIFF * slope_b)
    rope = add(vector(state, load, PLACE), place, -1.0)
    length = np.sqrt(dot(rope, rope))
    pull = STIFF * (1.0 - inputs[ROPE] / length)
    push(forces, trolley, 0, rope, pull)
    push(forces, load, 0, rope, -pull)
    return 0.5 * STIFF * (dot(gap, gap) + (length - inputs[ROPE]) ** 2)


@kernel(python_entry=True)
def rates(state, ends, elements, nodes, ropes, spans, hinges, lengths, rail, inputs, forces, out):
    """Write the state's time derivative and the lengths of ropes; returns the potential energy."""
    forces[:] = 0.0
    energy = strain(state, ends, elements, inputs, forces)
    energy += tie(state, ropes, spans, lengths, inputs, forces) + hinge(state, hinges, forces)
    if rail >= 0:
        energy += hang(state, ends, elements, rail, inputs, forces)
    for i in range(len(nodes)):
        mass, first, raised, fixed = nodes[i, MASS], nodes[i, MOMENT], nodes[i, RAISED], nodes[i, SHAFT]
        if np.isinf(mass):
            out[i] = 0.0
            continue
        q0, q, w = state[i, TURN], vector(state, i, TURN + 1), vector(state, i, SPIN)
        arm = (first, 0.0, raised)
        energy += nodes[i, GRAVITY] * (mass * state[i, PLACE + 2] + turn(q0, q, arm)[2])
        j, product = vector(nodes, i, INERTIA), nodes[i, PRODUCT]
        spin = (j[0] * w[0] + product * w[2], j[1] * w[1], j[2] * w[2] + product * w[0] - fixed * inputs[RATE])
        # In the node's own axes, about its place: m a + w' x S and J w' + S x a, with S in the plane of e1 and e3.
        down = turn(-q0, q, (0.0, 0.0, -nodes[i, GRAVITY]))
        f = add(turn(-q0, q, vector(forces, i, 0)), down, mass)
        f = add(f, cross(w, cross(w, arm)), -1.0)
        m = add(add(vector(forces, i, 3), cross(w, spin), -1.0), cross(arm, down), 1.0)
        mx, my, mz = m[0] + raised * f[1] / mass, m[1], m[2] + fixed * inputs[ACCELERATION] - first * f[1] / mass
        my -= (raised * f[0] - first * f[2]) / mass
        pitch = my / (j[1] - (first * first + raised * raised) / mass)
        x, z, xz = j[0] - raised * raised / mass, j[2] - first * first / mass, product + first * raised / mass
        roll, yaw = (z * mx - xz * mz) / (x * z - xz * xz), (x * mz - xz * mx) / (x * z - xz * xz)
        a = add(f, cross((roll, pitch, yaw), arm), -1.0)
        a = turn(q0, q, (a[0] / mass, a[1] / mass, a[2] / mass))
        for k in range(3):
            out[i, PLACE + k] = state[i, SPEED + k]
            out[i, SPEED + k] = a[k]
        out[i, SPIN], out[i, SPIN + 1], out[i, SPIN + 2] = roll, pitch, yaw
        out[i, TURN] = -0.5 * dot(q, w)
        turning = add(cross(q, w), w, q0)
        for k in range(3):
            out[i, TURN + 1 + k] = 0.5 * turning[k]
    return energy


@kernel()
def gradient(state, ends, elements, nodes, ropes, spans, hinges, rail, inputs, free, small):
    """Derivatives of the accelerations of free nodes by their places and turns."""
    forces, lengths, out = np.zeros((len(nodes), 6)), np.zeros(len(ropes)), np.zeros_like(state)
    moved, found = state.copy(), np.zeros((6 * len(free), 6 * len(free)))
    for i, own in enumerate(free):
        q0, q = state[own, TURN], vector(state, own, TURN + 1)
        for k in range(6):
            for sign in (1.0, -1.0):
                if k < 3:
                    moved[own, PLACE + k] += sign * small
                else:
                    # The quaternion times (1, half the turn).
                    half = 0.5 * sign * small
                    unit = half * (k == 3), half * (k == 4), half * (k == 5)
                    moved[own, TURN] = q0 - dot(q, unit)
                    push(moved, own, TURN + 1, add(cross(q, unit), unit, q0), 1.0)
                rates(moved, ends, elements, nodes, ropes, spans, hinges, lengths, rail, inputs, forces, out)
                moved[own] = state[own]
                for j in range(len(free)):
                    for m in range(6):
                        found[6 * j + m, 6 * i + k] += sign / (2.0 * small) * out[free[j], SPEED + m]
    return found


@kernel(python_entry=True, allocates=True)
def march(state, ends, elements, nodes, ropes, spans, hinges, rail, inputs, step):
    """Steps of the classical Runge-Kutta method, in place; ``inputs`` (2 steps + 1, 5) at steps and half-way."""
    forces, lengths = np.zeros((len(nodes), 6)), np.zeros(len(ropes))
    slope, stage, total = np.zeros_like(state), np.zeros_like(state), np.zeros_like(state)
    for n in range(len(inputs) // 2):
        total[:] = state
        stage[:] = state
        for leg in range(4):
            drives = inputs[2 * n + (leg + 1) // 2]
            rates(stage, ends, elements, nodes, ropes, spans, hinges, lengths, rail, drives, forces, slope)
            ahead, share = step * (0.5 if leg < 2 else 1.0), step / (3.0 if leg in (1, 2) else 6.0)
            for i in range(len(state)):
                for k in range(13):
                    total[i, k] += share * slope[i, k]
                    stage[i, k] = state[i, k] + ahead * slope[i, k]
        state[:] = total
        for i in range(len(state)):
            norm = np.sqrt(state[i, 3] ** 2 + state[i, 4] ** 2 + state[i, 5] ** 2 + state[i, 6] ** 2)
            for k in range(TURN, TURN + 4):
                state[i, k] /= norm

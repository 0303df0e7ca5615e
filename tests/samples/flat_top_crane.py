"""A crane in the plane of its jib: the flat-top jib in uniform pieces, a counter-jib of segments; all assumed."""

from dataclasses import replace

import numpy as np
from samples.flat_top import FLAT_TOP

from modal import Chain, CraneFrame, EndBody, Segment

PIECES = tuple(
    replace(lattice, height=height, end_height=height).segments(2.5, "vertical")[0]
    for lattice in FLAT_TOP
    for height in lattice.height + (lattice.end_height - lattice.height) * (np.arange(4) + 0.5) / 4.0
)
JIB = Chain(PIECES)
INNER = Segment(1.0, 230.0, 1.1e9, shear_stiffness=2e8, rotary_inertia=120.0)
OUTER = Segment(1.0, 200.0, 0.7e9, shear_stiffness=1.5e8, rotary_inertia=100.0)
WINCH, BALLAST = EndBody(3500.0, 1500.0), EndBody(21000.0, 15000.0)
COUNTER_JIB = Chain(
    (replace(INNER, length=9.0), INNER, replace(OUTER, length=4.0), OUTER), {1: WINCH, 3: BALLAST}
)  # fmt: skip
TOP = EndBody(9000.0, 2e4, 1.2)
TOWER = Chain((Segment(48.0, 520.0, 5.356e9, shear_stiffness=1.6e8, rotary_inertia=420.0),), {1: TOP})
FRAME = CraneFrame(TOWER, JIB, COUNTER_JIB, trolley_mass=420.0, payload_mass=2000.0, rope_length=20.0)

"""A crane whose jib and counter-jib are segments with bodies, both with shear strain and rotary inertia."""

import dataclasses

from samples import space_crane

from modal.beams.beam import EndBody
from modal.beams.chain import Chain
from modal.beams.segment import Segment


def chain(rows, bodies):
    """Segments of length [m], mass [kg/m], bending stiffness [N m^2], shear stiffness [N], rotary inertia [kg m]; and
    mass [kg] and rotary inertia [kg m^2] at nodes."""
    segments = tuple(
        Segment(length, mass, bending, shear_stiffness=shear, rotary_inertia=inertia)
        for length, mass, bending, shear, inertia in rows
    )
    return Chain(segments, {node: EndBody(*body) for node, body in bodies.items()})


JIB = chain(
    [
        (5.0, 260.0, 3.1e9, 1.5e8, 130.0),
        (15.0, 260.0, 3.1e9, 1.5e8, 130.0),
        (18.0, 180.0, 2.0e9, 1.2e8, 90.0),
        (17.6, 120.0, 0.8e9, 0.8e8, 0.0),
    ],
    {1: (1800.0, 1500.0), 4: (250.0, 0.0)},
)
JIB_SIDEWAYS = chain(
    [
        (5.0, 260.0, 1.0e9, 0.7e8, 100.0),
        (15.0, 260.0, 1.0e9, 0.7e8, 100.0),
        (18.0, 180.0, 0.8e9, 0.6e8, 0.0),
        (17.6, 120.0, 0.4e9, 0.55e8, 60.0),
    ],
    {1: (1800.0, 2500.0), 4: (250.0, 0.0)},
)
COUNTER_JIB = chain(
    [(9.0, 230.0, 1.1e9, 2.0e8, 120.0), (6.0, 200.0, 0.7e9, 1.5e8, 100.0)],
    {1: (3500.0, 1500.0), 2: (17000.0, 15000.0)},
)
COUNTER_JIB_SIDEWAYS = chain(
    [(9.0, 230.0, 0.8e9, 1.2e8, 0.0), (6.0, 200.0, 0.6e9, 1.0e8, 80.0)],
    {1: (3500.0, 900.0), 2: (17000.0, 9000.0)},
)

CRANE = dataclasses.replace(
    space_crane.CRANE,
    name="of segments",
    jib=JIB,
    jib_lateral=JIB_SIDEWAYS,
    counter_jib_length=15.0,
    counter_jib_mass_per_length=0.0,
    counterweight=0.0,
    counter_jib=COUNTER_JIB,
    counter_jib_lateral=COUNTER_JIB_SIDEWAYS,
)

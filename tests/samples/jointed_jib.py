"""A crane whose jib has five joints close to each other, one of them at a body, and what its trolley does there."""

import dataclasses

from samples import sectioned_crane, space_crane

from towercrane.motions.motion import rest, sequence
from towercrane.motions.profiles import speed_trapezoid, trapezoid

LENGTHS = (10.0, 0.5, 0.5, 1.0, 0.5, 43.1)
UPWARD = [
    (260.0, 3.1e9, 1.5e8, 130.0), (240.0, 2.8e9, 1.2e8, 110.0), (180.0, 2.0e9, 1.2e8, 90.0),
    (180.0, 2.0e9, 1.2e8, 90.0), (150.0, 1.2e9, 0.9e8, 40.0), (120.0, 0.8e9, 0.8e8, 0.0),
]  # fmt: skip
SIDEWAYS = [
    (260.0, 1.0e9, 7.0e7, 100.0), (240.0, 0.9e9, 6.5e7, 90.0), (180.0, 0.8e9, 6.0e7, 0.0),
    (180.0, 0.8e9, 6.0e7, 0.0), (150.0, 0.6e9, 5.7e7, 10.0), (120.0, 0.4e9, 5.5e7, 60.0),
]  # fmt: skip
JOINTS = (10.0, 10.5, 11.0, 12.0, 12.5)


def _jib(rows, inertia):
    segments = [(length, *row) for length, row in zip(LENGTHS, rows, strict=True)]
    return sectioned_crane.chain(segments, {3: (900.0, inertia), 6: (250.0, 0.0)})


CRANE = dataclasses.replace(
    sectioned_crane.CRANE, name="five joints", jib=_jib(UPWARD, 400.0), jib_lateral=_jib(SIDEWAYS, 600.0)
)


def model(planar, **options):
    if planar:
        options |= {"torsion": 0, "lateral": 0, "counter": (0, 1), "planes": 1, "slewing": "fixed", "axes": 2}
    else:
        options |= {"torsion": 1, "lateral": 1, "counter": (1, 1)}
    return space_crane.model(tower=1, vertical=2, crane=CRANE, load=2000.0, **options)


def motions(planar, trolley=None):
    """Out past all joints, hoisting, in space with a head that turns."""
    found = {
        "trolley": trolley or trapezoid(9.8, 14.0, 3.0, 4.0),
        "rope": sequence(rest(14.0, 0.2), trapezoid(14.0, 9.0, 0.6, 0.2)),
    }
    return found if planar else found | {"slewing": speed_trapezoid(0.3, 0.1, 2.0, 4.0)}

"""A small overhead crane whose bridge bends well."""

from towercrane.cranes.overhead.parameters import OverheadCrane

SMALL = OverheadCrane(
    name="small",
    runway_height=8.0,
    runway_length=40.0,
    bridge_span=12.0,
    bridge_mass_per_length=90.0,
    bridge_youngs_modulus=2.1e11,
    bridge_second_moment_of_area=2e-5,
    bridge_damping_ratio=0.05,
    bridge_end_carriage_mass=400.0,
    trolley_mass=600.0,
)

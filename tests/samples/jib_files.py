"""Case files with jibs and counter-jibs of every sort, for the tests of the door and of what comes behind it."""

from samples import case_files

TOWER = """name = "Small"
[tower]
height = "30 m"
mass_per_length = "300 kg/m"
youngs_modulus = "210 GPa"
second_moment_of_area = "0.01 m^4"
[trolley]
mass = "300 kg"
"""

UNIFORM = """[counter_jib]
length = "10 m"
mass_per_length = "150 kg/m"
counterweight = "10 t"
[jib]
length = "40 m"
mass_per_length = "100 kg/m"
youngs_modulus = "210 GPa"
second_moment_of_area = "0.003 m^4"
"""

MEMBERS = """height = "1.2 m"
breadth = "1.4 m"
base_chord_area = "27.8 cm^2"
opposite_chord_area = "60 cm^2"
panel_length = "1.5 m"
side_diagonal_area = "6 cm^2"
base_diagonal_area = "5 cm^2"
base_lacing = "X"
"""

JIB_LATTICE = f'[jib.lattice]\n{MEMBERS}side_lacing = "zigzag"\n'

SEGMENTS = f"""[jib]
youngs_modulus = "206 GPa"
[[jib.segments]]
length = "25 m"
mass_per_length = "200 kg/m"
second_moment_of_area = "0.015 m^4"
lateral_second_moment_of_area = "0.005 m^4"
shear_stiffness = "150 MN"
lateral_shear_stiffness = "70 MN"
rotary_inertia_per_length = "130 kg m"
lateral_rotary_inertia_per_length = "100 kg m"
[[jib.segments]]
length = "15 m"
[jib.segments.lattice]
{MEMBERS}
[[jib.bodies]]
position = "5 m"
mass = "1.8 t"
rotary_inertia = "1500 kg m^2"
[[jib.bodies]]
position = "40 m"
mass = "250 kg"
[counter_jib]
youngs_modulus = "206 GPa"
[[counter_jib.segments]]
length = "12.5 m"
mass = "2600 kg"
second_moment_of_area = "0.0053 m^4"
lateral_second_moment_of_area = "0.004 m^4"
[[counter_jib.bodies]]
position = "12 m"
mass = "20 t"
rotary_inertia = "15 t m^2"
"""
"""A stated segment and a laced one, bodies at the tip and on the way, a counter-jib that bends under its ballast."""


def write_case(folder, jib):
    """Write a case and its crane with these jibs; return the case's path."""
    (folder / "crane.toml").write_text(TOWER + jib, "utf-8")
    (folder / "case.toml").write_text(case_files.CASE, "utf-8")
    return folder / "case.toml"

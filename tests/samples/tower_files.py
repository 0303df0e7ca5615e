"""Case files with towers of every sort, for the tests of the door and of what comes behind it."""

from samples import case_files

REST = """
[jib]
length = "40 m"
mass_per_length = "100 kg/m"
youngs_modulus = "210 GPa"
second_moment_of_area = "0.003 m^4"
[counter_jib]
length = "10 m"
mass_per_length = "150 kg/m"
counterweight = "10 t"
[trolley]
mass = "300 kg"
"""

UNIFORM = """[tower]
height = "30 m"
mass_per_length = "300 kg/m"
youngs_modulus = "210 GPa"
second_moment_of_area = "0.01 m^4"
"""

ONE_SEGMENT = """[[tower.segments]]
length = "30 m"
mass_per_length = "300 kg/m"
youngs_modulus = "210 GPa"
second_moment_of_area = "0.01 m^4"
"""

MEMBERS = """leg_area = "50 cm^2"
leg_spacing = "1.7 m"
panel_height = "1.4 m"
lacing = "X"
diagonal_area = "8 cm^2"
horizontal_area = "6 cm^2"
"""

LACED = UNIFORM.replace('second_moment_of_area = "0.01 m^4"\n', "") + "[tower.lattice]\n" + MEMBERS

SEGMENTS = f"""[tower]
youngs_modulus = "210 GPa"
shear_theory = "engesser"
[[tower.segments]]
length = "12 m"
mass_per_length = "500 kg/m"
youngs_modulus = "206 GPa"
second_moment_of_area = "0.02 m^4"
shear_stiffness = "150 MN"
rotary_inertia_per_length = "300 kg m"
top_breadth_ratio = "60 %"
taper = "wedge"
[[tower.segments]]
length = "18 m"
mass_per_length = "350 kg/m"
[tower.segments.lattice]
{MEMBERS}
[[tower.bodies]]
height = "0 m"
mass = "100 t"
[[tower.bodies]]
height = "20 m"
mass = "2 t"
rotary_inertia = "3 t m^2"
offset = "-40 cm"
[[tower.bodies]]
height = "30 m"
mass = "5 t"
offset = "1 m"
[foundation]
rotation_stiffness = "2 GN m/rad"
translation_stiffness = "300 MN/m"
"""

TIED = f"""{SEGMENTS}coupling_stiffness = "-200 MN"
[foundation.block]
mass = "40 t"
rotary_inertia = "300 t m^2"
offset = "-1 m"
[[tower.collars]]
height = "8 m"
stiffness = "10 MN/m"
gap = "0 mm"
[[tower.collars]]
height = "20 m"
stiffness = "20 MN/m"
rotation_stiffness = "30 MN m/rad"
torsional_stiffness = "400 MN m/rad"
"""
"""The same on coupled springs with a block under its foot, and tied to a building."""

FLEXIBLE = 'youngs_modulus = "210 GPa"\nsecond_moment_of_area = "0.002 m^4"\n'
"""What a counter-jib is said by that bends."""

CASE = case_files.CASE.replace("A case", "A tower").replace("60 s", "20 s")


def write_case(folder, tower, *changes, case=CASE):
    """Write a case and its crane with this tower, with replacements in the crane; return the case's path."""
    crane = f'name = "Towers"\n{tower}{REST}'
    for old, new in changes:
        assert old in crane
        crane = crane.replace(old, new, 1)
    (folder / "crane.toml").write_text(crane, "utf-8")
    path = folder / "case.toml"
    path.write_text(case, "utf-8")
    return path

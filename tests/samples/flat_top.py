"""Flat-top jib of 60 m in six sections, all its values assumed, and a round of parallel diagonals."""

from modal.lattices.jib import JibLattice

SECTION_LENGTH = 10.0

_ROWS = [
    (1.8, 1.8, 9600, 5200, 1250, 900, 700, 40), (1.8, 1.8, 8200, 4600, 1100, 800, 650, 34),
    (1.8, 1.5, 6800, 3900, 950, 700, 600, 30), (1.5, 1.5, 5200, 3100, 850, 650, 550, 28),
    (1.5, 1.2, 3600, 2300, 700, 600, 500, 26), (1.2, 1.2, 2200, 1600, 600, 550, 450, 26),
]  # fmt: skip
"""Heights [m]; areas of top and base chords, side diagonals, base diagonals and posts [mm^2]; further mass [kg/m]."""

FLAT_TOP = tuple(
    JibLattice(
        height=near, end_height=far, breadth=1.4, base_chord_area=1e-6 * base, opposite_chord_area=1e-6 * top,
        panel_length=2.0, side_diagonal_area=1e-6 * side, base_diagonal_area=1e-6 * diagonal,
        base_post_area=1e-6 * post, youngs_modulus=206e9, density=1.08 * 7850.0, further_mass_per_length=further,
    )
    for near, far, top, base, side, diagonal, post, further in _ROWS
)  # fmt: skip
"""The sections from the root to the tip, each of five panels."""

LIEGE = JibLattice(
    height=0.75**0.5, breadth=1.0, base_chord_area=50e-4, opposite_chord_area=50e-4, panel_length=2.0,
    side_diagonal_area=25e-4, base_diagonal_area=25e-4, side_post_area=25e-4, base_post_area=25e-4,
    side_lacing="N", base_lacing="N", youngs_modulus=210e9, density=7800.0,
)  # fmt: skip
"""Equilateral, all walls of parallel diagonals, one against the other two going round; 12 m long."""

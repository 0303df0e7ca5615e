"""Kernels of exact structures: plain functions of numbers and arrays, compiled together.

They take a structure as five arrays: ``segments`` (s, 15) and ``nodes`` (s, 3, 3), see
`modal.structures.kernels.stiffness`; ``runs`` (r, 3), the first segment of each run, the first after it, and whether
it is a single block; ``motions`` (r, 4, n), how (v, theta) of a run's near and far end follow the n unknowns;
``points`` (3, n, n), stiffness of springs, geometric stiffness of bodies under unit load (to be taken away), mass of
bodies. A circular frequency and a load factor say which dynamic stiffness is meant.
"""

from modal.compiler.native import native
from modal.structures.kernels import roots, runs, shapes, structure

(
    dynamic_stiffness,
    scaled_stiffness,
    count_below,
    find_roots,
    find_runs,
    block_counts,
    piece_ends,
    run_shape,
) = native(
    "structures",
    structure.dynamic_stiffness,
    structure.scaled_stiffness,
    roots.count_below,
    roots.find_roots,
    runs.find_runs,
    runs.block_counts,
    runs.piece_ends,
    shapes.run_shape,
)

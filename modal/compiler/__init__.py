"""The compiler's tools: compiled functions and their cache. Imports nothing else of modal.

What numba promises to nobody is used here and for lane vectors in `towercrane.kernels`, nowhere else.
"""

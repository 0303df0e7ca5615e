"""The compiler's tools: compiled functions and their cache. Imports nothing else of modal.

LLVM is used here and in `towercrane.kernels.straight`, nowhere else.
"""

"""Compiled kernels of dynamic stiffness: pieces, blocks, runs and structures, and their shapes; all on arrays."""

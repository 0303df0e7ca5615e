"""Exact roots, structures and lattices beside finite elements. Never imports bench.runs."""

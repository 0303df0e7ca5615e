"""Exact structures: dynamic stiffness, frequencies, shapes, planes of a crane. Never imports elements or lattices."""

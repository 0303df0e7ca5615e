"""Finite elements, a check of exact structures. Never imports lattices."""

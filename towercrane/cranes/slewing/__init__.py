"""Slewing cranes of point masses and springs. Imports no other family."""

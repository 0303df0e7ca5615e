"""Equations of a scene written out as straight code. Imports nothing but the compiler's tools of ``modal``."""

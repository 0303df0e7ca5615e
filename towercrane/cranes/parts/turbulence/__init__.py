"""Wind that differs in place and time: its profile with height, spectra, coherence, and series of them.

Imports no family.
"""

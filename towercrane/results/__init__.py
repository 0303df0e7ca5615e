"""Recordings, their files, and what is measured in them. Imports no crane, no case and no solver."""

"""Compiled equations of tower cranes: numbers and arrays only, no tables and no models."""

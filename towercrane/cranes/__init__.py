"""Crane models: parameters and a structure each."""

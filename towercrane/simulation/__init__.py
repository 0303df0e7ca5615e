"""Solves any system over time. Never imports a crane or a case."""

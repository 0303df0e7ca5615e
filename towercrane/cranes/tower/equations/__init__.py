"""Equations of motion in chosen coordinates, at rest and in small motions. Never imports outputs, models or files."""

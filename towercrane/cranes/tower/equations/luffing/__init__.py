"""Equations of a tower crane whose jib pivots and is held by a rope. Never imports outputs, models or files."""

"""Cycles in the outputs of runs, and what they come to. Never imports reports."""

"""Frequencies, maps, comparisons, shaped motions, sensitivity. Never imports reports."""

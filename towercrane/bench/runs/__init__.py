"""Runs over time: their cost, their errors, what they promise, what breaks them. Never imports bench.structures."""

"""Solver methods, one object each, with all that is known of it. Never imports cranes, cases or files."""

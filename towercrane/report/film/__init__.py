"""Runs as moving pictures: which moments, what is drawn, into which file. Never imports a crane or runs anything."""

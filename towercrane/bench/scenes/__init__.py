"""What is measured: runs made ready to be solved many times, and scenes drawn by seeded generators.

Never imports who solves them.
"""

"""How a tower crane vibrates and how its load swings."""

__version__ = "0.1.0"

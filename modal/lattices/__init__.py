"""Laced columns: from members to beams, and the truss that they are."""

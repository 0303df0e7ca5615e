"""Beams, shafts and chains of segments: what they are, roots and shapes of uniform ones. Never imports structures."""

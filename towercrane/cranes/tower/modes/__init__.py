"""The crane as beams, and the modes that they move in. Never imports equations of motion, files or outputs."""

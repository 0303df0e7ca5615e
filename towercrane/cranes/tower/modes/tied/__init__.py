"""Jibs on tie bars: their data, shapes and sums. Never imports equations of motion, files or outputs."""

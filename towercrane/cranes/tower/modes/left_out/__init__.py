"""What the chosen modes of a tower leave out of forces, in sentences. Never imports equations, outputs or files."""

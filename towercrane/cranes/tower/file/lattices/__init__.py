"""What members of lattices in crane files are besides beams: shafts, and frames in space."""

"""Natural modes of cranes that are no frame of beams alone, in the modes of a rich model."""

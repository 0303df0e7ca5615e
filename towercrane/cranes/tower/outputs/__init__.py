"""What a run of a tower crane shows: places, energy, forces in sections. Never imports models or files."""

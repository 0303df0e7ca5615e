"""What acts on a tower crane besides its load: drive, wind, shaking ground. Never imports outputs or files."""

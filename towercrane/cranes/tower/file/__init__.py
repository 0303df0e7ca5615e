"""What a case file says of a tower crane, and what is built from it. Never imports the whole case."""

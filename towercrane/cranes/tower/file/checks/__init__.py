"""What belongs together in a tower crane's files, checked as written. Never imports equations or outputs."""

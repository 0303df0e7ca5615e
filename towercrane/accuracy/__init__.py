"""Model and tolerance for an error that is asked for. Never imports runs or reports."""

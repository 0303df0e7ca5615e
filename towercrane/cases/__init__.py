"""From a case file to a checked case. Never imports accuracy, runs or reports."""
